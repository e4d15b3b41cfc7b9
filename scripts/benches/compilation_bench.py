"""The whole compilation, kernel by kernel: processor time of each on an empty folder.

A kernel's time holds that of its parts, which have no compiled form of their own, and none of the kernels
that it calls. Numba reports both; the steps of its compiler are distinguished in the last rows.
"""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator

from benches.row import Row

_SHOWN_S = 1.0
"""Kernels that take less are one row."""
_COMPILE = """
import collections, json, time
from numba.core import event
from twin.commands.compilation import compile_kernels

class Timer(event.Listener):
    def __init__(self, name_of):
        self.spent, self.inner, self.name_of = collections.Counter(), [], name_of
    def on_start(self, told):
        self.inner.append([time.process_time(), 0.0])
    def on_end(self, told):
        began, inner = self.inner.pop()
        passed = time.process_time() - began
        self.spent[self.name_of(told.data)] += passed - inner
        if self.inner:
            self.inner[-1][1] += passed

def kernel(data):
    function = data["dispatcher"].py_func
    return f"{function.__module__.removeprefix('twin.')}.{function.__name__}"

timers = {"numba:compile": Timer(kernel), "numba:run_pass": Timer(lambda data: data["name"].partition(" [")[0])}
for kind, timer in timers.items():
    event.register(kind, timer)
began = time.process_time()
compile_kernels()
whole = time.process_time() - began
print(json.dumps([whole, *(timer.spent for timer in timers.values())]))
"""
"""Prints what the whole takes with the runs that ask for the kernels, each kernel, and each step [s]."""


def rows() -> Iterator[Row]:
    """Each kernel that takes long, all others, the runs besides, and the compiler's steps."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(  # noqa: S603 (this interpreter)
            [sys.executable, "-c", _COMPILE],
            env=os.environ | {"XDG_CACHE_HOME": folder, "NUMBA_CACHE_DIR": folder},
            check=True, capture_output=True, text=True,
        )  # fmt: skip
    whole, kernels, steps = json.loads(done.stdout.splitlines()[-1])
    compiled = sum(kernels.values())
    yield _row(f"all {len(kernels)} kernels", compiled)
    yield from _longest(kernels, "other kernels")
    yield _row("the runs that ask for them", whole - compiled)
    yield from (_row(f"step: {task}", seconds) for task, seconds in _above(steps))


def _above(seconds: dict[str, float]) -> list[tuple[str, float]]:
    """Those that are shown, the longest first."""
    shown = [(name, each) for name, each in seconds.items() if each >= _SHOWN_S]
    return sorted(shown, key=lambda item: -item[1])


def _longest(seconds: dict[str, float], others: str) -> Iterator[Row]:
    shown = _above(seconds)
    yield from (_row(name, each) for name, each in shown)
    yield _row(others, sum(seconds.values()) - sum(each for _, each in shown))


def _row(task: str, seconds: float) -> Row:
    return Row("compilation", task, seconds, "s")
