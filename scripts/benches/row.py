"""One line of the bench's table, and how a figure is taken."""

import resource
import statistics
from collections.abc import Callable
from dataclasses import dataclass

REPEATS = 5
"""The median of so many runs is quoted: these machines are noisy."""


@dataclass(frozen=True)
class Row:
    """A figure of this project and that of a peer, taken in the same run.

    Attributes:
        unit: Its unit; a rate is better when higher, a time or a share when lower.
        peer: The peer's name and version; empty where there is none.
        peer_figure: The peer's figure in the same unit; None where it is not installed.
    """

    package: str
    task: str
    figure: float
    unit: str
    peer: str = ""
    peer_figure: float | None = None


def processor_seconds() -> float:
    """What processors have spent on this process and on those that it began and that ended [s]."""
    used = [resource.getrusage(whose) for whose in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(each.ru_utime + each.ru_stime for each in used)


def median_cpu_seconds(task: Callable[[], object], repeats: int = REPEATS) -> float:
    """The median time that processors spend on ``task``, its processes included [s].

    For work on one core it is the time that passes on a machine that does nothing else.
    """
    return cpu_seconds_in_turns(task, repeats=repeats)[0]


def cpu_seconds_in_turns(*tasks: Callable[[], object], repeats: int = REPEATS) -> list[float]:
    """As ``median_cpu_seconds``, of tasks taken in turns: a busy computer slows down all of them."""
    times: list[list[float]] = [[] for _ in tasks]
    for _ in range(repeats + 1):
        for task, kept in zip(tasks, times, strict=True):
            start = processor_seconds()
            task()
            kept.append(processor_seconds() - start)
    return [statistics.median(kept[1:]) for kept in times]
