"""Alarms: what a control raises when a program asks for more than the machine can give.

| code | raised when |
|---|---|
| ``soft-limit`` | a move would leave an axis's travel; seen before anything moves |
| ``hard-limit`` | an axis ran onto its limit switch |
| ``following-error`` | an axis trails its setpoint by more than its limit |
| ``drive-saturation`` | a drive was at its force limit for longer than it may |
| ``collision`` | head, spindle or holder met table, fixture or column, or the table the column |
| ``rapid-into-stock`` | a rapid move cut into the stock |
| ``spindle-off`` | a feed cut into the stock with the spindle standing |
| ``tool-broken`` | force, chip or speed were more than the tool bears; it has no edge then |
| ``spindle-stall`` | the cut took more torque than the spindle has, until it stood |
| ``spindle-overload`` | the spindle gave more than it can for long, for longer than it may |
| ``emergency-stop`` | an operator pressed the button |
| ``control-stop`` | a real control that drives the twin stopped by itself, or was killed |
"""

import dataclasses
from typing import Literal

from twin.errors import ExitCode, TwinError

AlarmCode = Literal[
    "soft-limit",
    "hard-limit",
    "following-error",
    "drive-saturation",
    "collision",
    "rapid-into-stock",
    "spindle-off",
    "gouge",
    "tool-broken",
    "spindle-stall",
    "spindle-overload",
    "emergency-stop",
    "control-stop",
]


@dataclasses.dataclass(frozen=True, slots=True)
class Alarm:
    """One alarm.

    Attributes:
        code: Stable, searchable name of the kind.
        line: Source line of the program, 0 before the first.
        time_s: When, from the start of the program [s]; 0 for what is seen before motion starts.
        axis: Name of the axis, empty where it concerns the whole machine.
        between: Names of the two bodies that met; empty: none did.
        stops: Whether it ends the run; a tool that breaks does not.
    """

    code: AlarmCode
    line: int
    time_s: float
    axis: str
    message: str
    between: tuple[str, ...] = ()
    stops: bool = True

    def __str__(self) -> str:
        """One line for a person."""
        return f"line {self.line}, {self.time_s:.3f} s: {self.code}: {self.message}"


@dataclasses.dataclass(frozen=True, slots=True)
class NearMiss:
    """The closest that the tool's side and the part's came without touching.

    Attributes:
        clearance_mm: Between the two [mm].
        time_s: When, from the start of the program [s].
    """

    clearance_mm: float
    line: int
    time_s: float
    between: tuple[str, str]


class SimulationError(TwinError):
    """The simulation itself failed: MuJoCo warned, or a number is not finite."""

    exit_code = ExitCode.ALARM


class AlarmStandsError(TwinError):
    """The machine was asked to move, or to forget an alarm, when it may not."""

    exit_code = ExitCode.ALARM
