"""The verdict: pass, fail or alarm, with every reason."""

import dataclasses
from collections.abc import Iterator, Sequence
from typing import Literal

import numpy as np

from twin.compare.figures import Figures
from twin.errors import ExitCode
from twin.job.tolerance import ToleranceTable
from twin.recording.alarms import Alarm

Outcome = Literal["pass", "fail", "alarm"]
EXIT_CODES = {"pass": ExitCode.OK, "fail": ExitCode.FAILED, "alarm": ExitCode.ALARM}


@dataclasses.dataclass(frozen=True, slots=True)
class Check:
    """One figure held to one tolerance.

    Attributes:
        figure: Name of the figure, such as ``contour error``.
        limit: What is allowed; a value equal to it is within it.
        line: Program line of the worst value; 0 where none applies.
        time_s: When [s].
        note: What the value is made of, where that is known.
    """

    what: str
    figure: str
    value: float
    limit: float
    unit: str
    line: int
    time_s: float
    note: str = ""

    @property
    def holds(self) -> bool:
        """Whether the tolerance is kept."""
        return round(self.value, PRINTED_DIGITS) <= max(
            self.limit, round(self.limit, PRINTED_DIGITS)
        )

    @property
    def digits(self) -> int:
        """Decimals to print the value with, so that it shows on which side of its limit it is."""
        fewest = 3 if self.unit == "s" else 1
        enough = (
            digits
            for digits in range(fewest, PRINTED_DIGITS)
            if (round(self.value, digits) <= self.limit) == self.holds
        )
        return next(enough, PRINTED_DIGITS)

    @property
    def message(self) -> str:
        """One sentence with value, limit and unit."""
        relation = "is within" if self.holds else "exceeds"
        value = f"{self.value:.{self.digits}f} {self.unit}"
        return f"{self.figure} {value} {relation} {self.what} = {self.limit:.15g}{self.note}"


PRINTED_DIGITS = 6
"""Decimals of ``result.json``: values are compared with their limits as they are printed."""


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
        return (
            f"line {self.line}, {self.time_s:.3f} s: {self.message}" if self.line else self.message
        )


@dataclasses.dataclass(frozen=True, slots=True)
class Verdict:
    """How a run came out.

    Attributes:
        outcome: ``alarm`` outweighs ``fail``, which outweighs ``pass``.
        reasons: Alarms first, then tolerances; empty when the run passed.
        checks: Every figure that was held to a tolerance, whether it is kept or not.
    """

    outcome: Outcome
    reasons: tuple[Reason, ...]
    checks: tuple[Check, ...] = ()

    def with_more(self, reasons: Sequence[Reason]) -> "Verdict":
        """The verdict with more reasons against a pass, such as checks that have judged nothing."""
        outcome = "fail" if reasons and self.outcome == "pass" else self.outcome
        return Verdict(outcome, (*self.reasons, *reasons), self.checks)

    @property
    def exit_code(self) -> ExitCode:
        """What a command returns for it."""
        return EXIT_CODES[self.outcome]


def judge(
    figures: Figures,
    tolerance: ToleranceTable,
    alarms: Sequence[Alarm] = (),
    *,
    cycle_time_s: float | None = None,
    more: Sequence[Check] = (),
) -> Verdict:
    """Hold a run to its tolerances.

    Each tolerance gives one check, of its worst place; the time of a program that an alarm stopped is not known.

    Args:
        cycle_time_s: Machine time of the program; by default the time of the last sample, which
            holds the settling at the end too [s].
        more: Other figures that are held to a tolerance.
    """
    alarmed = [Reason(a.code, a.message, a.line, a.time_s) for a in alarms]
    checks = [
        *_contour_checks(figures, tolerance),
        *_corner_checks(figures, tolerance),
        *_circular_checks(figures, tolerance),
        *_following_checks(figures, tolerance),
        *more,
    ]
    if tolerance.cycle_time_s is not None and not any(alarm.stops for alarm in alarms):
        cycle_time = figures.duration_s if cycle_time_s is None else cycle_time_s
        limit = tolerance.cycle_time_s
        checks.append(Check("cycle_time_s", "cycle time", cycle_time, limit, "s", 0, cycle_time))
    failed = [Reason(c.what, c.message, c.line, c.time_s) for c in checks if not c.holds]
    outcome: Outcome = "alarm" if alarmed else "fail" if failed else "pass"
    return Verdict(outcome, (*alarmed, *failed), tuple(checks))


def _contour_checks(figures: Figures, tolerance: ToleranceTable) -> Iterator[Check]:
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
    for index, (key, limit) in enumerate(limits.items()):
        rows = np.flatnonzero(key_of == index)
        if len(rows):
            row = int(rows[blocks.max_um[rows].argmax()])
            place = int(blocks.line[row]), float(blocks.time_s[row])
            value = float(blocks.max_um[row])
            note = _shares_text(figures) if value == figures.contour.max else ""
            figure = "contour error" + (" of rapids" if key == "rapid_contour_um" else "")
            yield Check(key, figure, value, limit, "µm", *place, note)


def _shares_text(figures: Figures) -> str:
    """The shares of the greatest contour error, greatest first, such as ``9.0 squareness XY``."""
    ranked = sorted(figures.shares.items(), key=lambda share: -abs(share[1]))
    shares = [f"{value:.1f} {name}" for name, value in ranked if abs(value) >= _LEAST_SHARE]
    return f" ({', '.join(shares)})" if shares else ""


_LEAST_SHARE = 0.05
"""What is smaller would be written as nothing [µm]."""


def _corner_checks(figures: Figures, tolerance: ToleranceTable) -> Iterator[Check]:
    corners, limit = figures.corners, tolerance.corner_um
    if limit is not None and corners.count:
        place = corners.line, corners.time_s
        yield Check("corner_um", "corner rounding", corners.rounding_um, limit, "µm", *place)


def _circular_checks(figures: Figures, tolerance: ToleranceTable) -> Iterator[Check]:
    limit = tolerance.circular_deviation_um
    if limit is not None and figures.arcs:
        worst = max(figures.arcs, key=lambda arc: arc.circular_deviation_um)
        value, place = worst.circular_deviation_um, (worst.line, worst.time_s)
        yield Check("circular_deviation_um", "circular deviation", value, limit, "µm", *place)


def _following_checks(figures: Figures, tolerance: ToleranceTable) -> Iterator[Check]:
    for name, axis in figures.tracking.items():
        linear = axis.kind == "linear"
        key, unit = ("following_um", "µm") if linear else ("following_mdeg", "mdeg")
        limit = tolerance.following_um if linear else tolerance.following_mdeg
        if limit is not None:
            figure = f"following error of {name}"
            yield Check(key, figure, axis.max, limit, unit, axis.line, axis.time_s)
    direction, limit = figures.direction, tolerance.direction_mdeg
    if limit is not None and direction is not None:
        place = direction.line, direction.time_s
        figure = "error of the tool's direction"
        yield Check("direction_mdeg", figure, direction.max, limit, "mdeg", *place)
