"""Progress of a run on stderr, and the time of each of its stages."""

import contextlib
import sys
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

Progress = Callable[[str, float], None]
"""Called with the name of the stage and how much of it is done, 0 to 1."""

LOG_STEP = 0.25
"""In a log, a line is written each time that this share of a stage has passed."""


def no_progress(stage: str, done: float) -> None:
    """Show nothing."""


@contextlib.contextmanager
def shown_progress() -> Iterator[Progress]:
    """Show progress on stderr while the block runs."""
    if sys.stderr.isatty():
        with _bars() as progress:
            yield progress
    else:
        yield _log_lines()


@contextlib.contextmanager
def _bars() -> Iterator[Progress]:
    from rich.console import Console
    from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as RichProgress

    columns = (TextColumn("{task.description:>9}"), BarColumn(), TaskProgressColumn())
    with RichProgress(*columns, TimeRemainingColumn(), console=Console(stderr=True)) as bars:
        tasks = {}

        def show(stage: str, done: float) -> None:
            if stage not in tasks:
                tasks[stage] = bars.add_task(stage, total=1.0)
            bars.update(tasks[stage], completed=done)

        yield show


def _log_lines() -> Progress:
    written: dict[str, int] = {}

    def show(stage: str, done: float) -> None:
        step = int(done / LOG_STEP)
        if written.get(stage) != step:
            written[stage] = step
            sys.stderr.write(f"{stage}: {step * LOG_STEP:.0%}\n")
            sys.stderr.flush()

    return show


ItemT = TypeVar("ItemT")


class _Running(threading.local):
    """The stages that a thread is in, the innermost last, and since when."""

    def __init__(self) -> None:
        self.stages: list[str] = []
        self.since = 0.0


class StageClock:
    """Exclusive wall time by stage: while an inner stage runs, the outer one's clock is stopped.

    Stages of different threads are counted side by side; what one waits for another is its own time.

    Attributes:
        seconds: Time spent by stage name [s].
    """

    def __init__(self) -> None:
        self.seconds: dict[str, float] = defaultdict(float)
        self._running = _Running()
        self._began = time.perf_counter()

    @property
    def wall_s(self) -> float:
        """Wall time since the clock was made [s]."""
        return time.perf_counter() - self._began

    @contextlib.contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Count the time of the block for ``name``."""
        self._switch()
        self._running.stages.append(name)
        try:
            yield
        finally:
            self._switch()
            self._running.stages.pop()

    def watch(self, name: str, items: Iterable[ItemT]) -> Iterator[ItemT]:
        """Pass items on, counting the time that producing them takes."""
        iterator = iter(items)
        while True:
            with self.stage(name):
                try:
                    item = next(iterator)
                except StopIteration:
                    return
            yield item

    def _switch(self) -> None:
        now, running = time.perf_counter(), self._running
        if running.stages:
            self.seconds[running.stages[-1]] += now - running.since
        running.since = now
