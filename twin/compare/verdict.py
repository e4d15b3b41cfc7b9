"""The verdict: pass, fail or alarm, with every reason."""

import dataclasses
from collections.abc import Sequence
from typing import Literal, Protocol

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


def judge(figures: Figures, tolerance: ToleranceTable, alarms: Sequence[AlarmLike] = ()) -> Verdict:
    """Hold a run to its tolerances.

    A value equal to its tolerance is within it.

    Args:
        figures: What the comparison found.
        tolerance: What the job allows.
        alarms: What the machine raised.
    """
    alarmed = [Reason(a.code, a.message, a.line, a.time_s) for a in alarms]
    failed = [*_contour_reasons(figures, tolerance), *_following_reasons(figures, tolerance)]
    outcome: Outcome = "alarm" if alarmed else "fail" if failed else "pass"
    return Verdict(outcome, (*alarmed, *failed))


def _contour_reasons(figures: Figures, tolerance: ToleranceTable) -> list[Reason]:
    contour = figures.contour
    if contour.max <= tolerance.contour_um:
        return []
    message = f"contour error {contour.max:.1f} µm exceeds contour_um = {tolerance.contour_um:g}"
    return [Reason("contour_um", message, contour.worst_line, contour.worst_time_s)]


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
