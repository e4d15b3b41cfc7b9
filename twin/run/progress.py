"""Progress on stderr: a bar with the remaining time on a terminal, plain lines in a log."""

import contextlib
import sys
from collections.abc import Callable, Iterator

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
