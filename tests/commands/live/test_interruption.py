"""The first Ctrl+C is the regular end, the second an interruption."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from twin.commands.live.interruption import stop_on_sigint

pytestmark = pytest.mark.processes

NUMBERS = (signal.SIGINT, signal.SIGTERM)
IN_COMPILED_CODE = """
import os, signal, sys, threading, time, types
from typing import NamedTuple
import numba
import numpy as np
from twin import __main__ as program

class Sums(NamedTuple):
    values: np.ndarray
    count: int

@numba.njit
def work(count):
    total = 0.0
    for number in range(count):
        total += np.sin(number)
    return Sums(np.zeros(2) + total, count)

def command(stopped):
    work(10)
    threading.Timer(0.2, os.kill, (os.getpid(), signal.{name})).start()
    work(60_000_000)
    time.sleep(20.0)

sys.modules["twin.cli"] = types.SimpleNamespace(main=command)
program.main()
"""


@pytest.mark.parametrize("number", NUMBERS)
def test_the_first_stops_and_the_second_interrupts(number: signal.Signals) -> None:
    def interrupt(number: int, _: object) -> None:
        raise KeyboardInterrupt(number)

    before = {each: signal.signal(each, interrupt) for each in NUMBERS}
    stops: list[None] = []
    try:
        with stop_on_sigint(lambda: stops.append(None)) as came:
            signal.raise_signal(number)
            assert came == [number]
            assert len(stops) == 1
            with pytest.raises(KeyboardInterrupt):
                signal.raise_signal(number)
        assert len(stops) == 1
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)


def test_what_interrupted_before_does_so_again() -> None:
    before = {each: signal.getsignal(each) for each in NUMBERS}
    with stop_on_sigint(lambda: None) as came:
        assert all(signal.getsignal(each) != before[each] for each in NUMBERS)
    assert not came
    assert {each: signal.getsignal(each) for each in NUMBERS} == before


@pytest.mark.parametrize("number", NUMBERS)
def test_an_interruption_of_compiled_code_is_one(number: signal.Signals) -> None:
    script = IN_COMPILED_CODE.format(name=number.name)
    ran = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False, timeout=60
    )
    assert (ran.returncode, ran.stderr) == (130, "interrupted before anything was begun\n")


SWALLOWED = """
import os, signal, sys
import twin.__main__, twin.cli

def run(stopped):
    import swallows
    for _ in range(1000):
        signal.pause()

twin.cli.main = run
sys.argv = ["twin"]
twin.__main__.main()
"""
SWALLOWS = """
import os, signal
try:
    os.kill(os.getpid(), signal.SIGINT)
except BaseException:
    pass
"""


def test_an_interruption_while_a_library_is_loaded_comes_behind_it(tmp_path: Path) -> None:
    (tmp_path / "swallows.py").write_text(SWALLOWS)
    here = os.pathsep.join((str(tmp_path), str(Path(__file__).parents[2])))
    ran = subprocess.run(
        [sys.executable, "-c", SWALLOWED], capture_output=True, text=True, check=False, timeout=60,
        env=os.environ | {"PYTHONPATH": here},
    )  # fmt: skip
    assert (ran.returncode, ran.stderr) == (130, "interrupted before anything was begun\n")
