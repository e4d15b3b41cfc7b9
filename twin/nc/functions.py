"""What the words of canonical functions ask of a machine, for all who act on them."""

import dataclasses

from twin.compilation.compilable import compilable
from twin.nc.canonical import Function

SPINDLE_CLOCKWISE = "M3"
SPINDLE_COUNTER_CLOCKWISE = "M4"
SPINDLE_STARTS = frozenset({SPINDLE_CLOCKWISE, SPINDLE_COUNTER_CLOCKWISE})
SPINDLE_STOPS = frozenset({"M5", "M19"})
"""M19 holds the spindle at an angle."""
SPINDLE_SPEED = "S"
"""Sets the speed, and starts nothing."""
COOLANT_ON = frozenset({"M7", "M8"})
COOLANT_OFF = frozenset({"M9"})
TOOL_CHANGE = "M6"
OPTIONAL_STOP = "M1"
"""Stops where the operator's switch says so."""
PROGRAM_STOPS = frozenset({"M0", OPTIONAL_STOP})
"""The operator starts the program again."""
PROGRAM_ENDS = frozenset({"M2", "M30"})
"""The spindle and the coolant end with the program."""


@compilable
def turns_behind(function: int, turned: float) -> float:
    """Whether the spindle turns behind an M code, where it did as told before; 0 or 1.

    M19 is no stop here: whether a feed per revolution may follow it, no seed says.
    """
    if function in (3, 4):
        return 1.0
    return 0.0 if function == 5 else turned


@dataclasses.dataclass(frozen=True, slots=True)
class SpindleState:
    """The spindle as a program, or a hand, has left it.

    A start turns the spindle even where nobody has given a speed (the control of CODESYS has no word
    for one): it turns at whatever its drive is set to. A speed alone starts nothing, and S0 stops.

    Attributes:
        started: Whether it has been started.
        speed: Its last speed [1/min]; None where nobody has said.
    """

    started: bool = False
    speed: float | None = None

    @property
    def turns(self) -> bool:
        """Whether it turns."""
        return self.started and self.speed != 0.0

    def after(self, function: Function) -> "SpindleState":
        """The state after a function."""
        started, speed = self.started, self.speed
        if function.word in SPINDLE_STARTS | {SPINDLE_SPEED}:
            speed = function.arguments.get("S", speed)
        if function.word in SPINDLE_STARTS | SPINDLE_STOPS:
            started = function.word in SPINDLE_STARTS
        return SpindleState(started, speed)

    def stopped(self) -> "SpindleState":
        """At a stand; the speed is remembered."""
        return SpindleState(started=False, speed=self.speed)
