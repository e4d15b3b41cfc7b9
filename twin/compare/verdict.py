"""The verdict: pass, fail or alarm, with every reason."""

import dataclasses
from collections.abc import Sequence
from typing import Literal, Protocol

import numpy as np

from twin.compare.figures import Figures
from twin.errors import ExitCode
from twin.job import ToleranceTable

Outcome = Literal["pass", "fail", "alarm"]
EXIT_CODES = {"pass": ExitCode.OK, "fail": ExitCode.FAILED, "alarm": ExitCode.ALARM}


class AlarmLike(Protocol):
    """What the verdict needs of an alarm of the machine."""

    @property
    def code(self) -> str:
        """Stable name, such as ``soft-limit``."""
        ...

    @property
    def line(self) -> int:
        """Program line at which it was raised."""
        ...

    @property
    def time_s(self) -> float:
        """When [s]."""
        ...

    @property
    def message(self) -> str:
        """What happened."""
        ...


@dataclasses.dataclass(frozen=True, slots=True)
class Reason:
    """Why a run does not pass.

    Attributes:
        what: The key of the tolerance, or the alarm's code.
        message: One sentence with value, limit and unit.
        line: Program line; 0 where none applies.
        time_s: When [s].
    """

    what: str
    message: str
    line: int
    time_s: float

    def __str__(self) -> str:
        return f"line {self.line}, {self.time_s:.3f} s: {self.message}"


@dataclasses.dataclass(frozen=True, slots=True)
class Verdict:
    """How a run came out.

    Attributes:
        outcome: ``alarm`` outweighs ``fail``, which outweighs ``pass``.
        reasons: Alarms first, then tolerances; empty when the run passed.
    """

    outcome: Outcome
    reasons: tuple[Reason, ...]

    @property
    def exit_code(self) -> ExitCode:
        """What a command returns for it."""
        return EXIT_CODES[self.outcome]


def judge(
    figures: Figures,
    tolerance: ToleranceTable,
    alarms: Sequence[AlarmLike] = (),
    *,
    cycle_time_s: float | None = None,
) -> Verdict:
    """Hold a run to its tolerances.

    A value equal to its tolerance is within it. Each tolerance gives at most one reason, its worst
    place.

    Args:
        figures: What the comparison found.
        tolerance: What the job allows.
        alarms: What the machine raised.
        cycle_time_s: Machine time of the program; by default the time of the last sample, which
            holds the settling at the end too [s].
    """
    alarmed = [Reason(a.code, a.message, a.line, a.time_s) for a in alarms]
    cycle_time = figures.duration_s if cycle_time_s is None else cycle_time_s
    failed = [
        *_contour_reasons(figures, tolerance),
        *_corner_reasons(figures, tolerance),
        *_circular_reasons(figures, tolerance),
        *_following_reasons(figures, tolerance),
        *_cycle_time_reasons(cycle_time, tolerance),
    ]
    outcome: Outcome = "alarm" if alarmed else "fail" if failed else "pass"
    return Verdict(outcome, (*alarmed, *failed))


def _contour_reasons(figures: Figures, tolerance: ToleranceTable) -> list[Reason]:
    """Every block is held to the last range that holds it, to the rapids' limit, or the program's."""
    blocks = figures.blocks
    limits = {"contour_um": tolerance.contour_um}
    key_of = np.zeros(len(blocks), np.int64)
    if tolerance.rapid_contour_um is not None:
        key_of[blocks.rapid] = len(limits)
        limits["rapid_contour_um"] = tolerance.rapid_contour_um
    for number, part in enumerate(tolerance.blocks):
        first, last = part.lines
        key_of[(blocks.line >= first) & (blocks.line <= last)] = len(limits)
        limits[f"blocks[{number}].contour_um"] = part.contour_um
    reasons = []
    for index, (key, limit) in enumerate(limits.items()):
        rows = np.flatnonzero((key_of == index) & (blocks.max_um > limit))
        if len(rows):
            row = int(rows[blocks.max_um[rows].argmax()])
            message = f"contour error {blocks.max_um[row]:.1f} µm exceeds {key} = {limit:g}"
            reasons.append(Reason(key, message, int(blocks.line[row]), float(blocks.time_s[row])))
    return reasons


def _corner_reasons(figures: Figures, tolerance: ToleranceTable) -> list[Reason]:
    corners, limit = figures.corners, tolerance.corner_um
    if limit is None or corners.rounding_um <= limit:
        return []
    message = f"corner rounded by {corners.rounding_um:.1f} µm exceeds corner_um = {limit:g}"
    return [Reason("corner_um", message, corners.line, corners.time_s)]


def _circular_reasons(figures: Figures, tolerance: ToleranceTable) -> list[Reason]:
    limit = tolerance.circular_deviation_um
    if limit is None or not figures.arcs:
        return []
    worst = max(figures.arcs, key=lambda arc: arc.circular_deviation_um)
    if worst.circular_deviation_um <= limit:
        return []
    message = (
        f"circular deviation {worst.circular_deviation_um:.1f} µm exceeds "
        f"circular_deviation_um = {limit:g}"
    )
    return [Reason("circular_deviation_um", message, worst.line, worst.time_s)]


def _cycle_time_reasons(cycle_time_s: float, tolerance: ToleranceTable) -> list[Reason]:
    limit = tolerance.cycle_time_s
    if limit is None or cycle_time_s <= limit:
        return []
    message = f"cycle time {cycle_time_s:.3f} s exceeds cycle_time_s = {limit:g}"
    return [Reason("cycle_time_s", message, 0, cycle_time_s)]


def _following_reasons(figures: Figures, tolerance: ToleranceTable) -> list[Reason]:
    reasons = []
    for name, axis in figures.tracking.items():
        linear = axis.kind == "linear"
        key, unit = ("following_um", "µm") if linear else ("following_mdeg", "mdeg")
        limit = tolerance.following_um if linear else tolerance.following_mdeg
        if limit is not None and axis.max > limit:
            message = f"following error of {name} {axis.max:.1f} {unit} exceeds {key} = {limit:g}"
            reasons.append(Reason(key, message, axis.line, axis.time_s))
    return reasons
