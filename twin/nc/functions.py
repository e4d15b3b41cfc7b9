"""What the words of canonical functions ask of a machine, for all who act on them."""

import dataclasses

from twin.nc.canonical import Function

SPINDLE_COUNTER_CLOCKWISE = "M4"
_STARTS, _STOPS = (3, 4), (5, 6)
"""M codes behind which the spindle turns, and behind which it is stopped until it is started again, whichever
tool M6 has brought (LinuxCNC, "M6 Tool Change": when the change is complete the spindle is stopped)."""
SPINDLE_STARTS = frozenset(f"M{number}" for number in _STARTS)
SPINDLE_STOPS = frozenset({"M5", "M19"})
"""M19 holds the spindle at an angle."""
SPINDLE_LIMITED = "spindle-limited"
"""Code of the notice that more was asked for than the machine's greatest speed."""
SPINDLE_SPEED = "S"
"""Sets the speed, and starts nothing."""
COOLANT_ON = frozenset({"M7", "M8"})
COOLANT_OFF = frozenset({"M9"})
BLANK = "BLK FORM"
"""What a program says of its blank, before it moves: X1 to Z2 of two corners, or D, L and Z2 of a cylinder about Z
[mm]."""
TOOL_CHANGE = "M6"
OPTIONAL_STOP = "M1"
"""Stops where the operator's switch says so."""
PROGRAM_STOPS = frozenset({"M0", OPTIONAL_STOP})
"""The operator starts the program again."""
PROGRAM_ENDS = frozenset({"M2", "M30"})
"""The spindle and the coolant end with the program."""
_SPINDLE_ENDS = SPINDLE_STOPS | PROGRAM_ENDS | {f"M{number}" for number in _STOPS}
_ACTED_UPON = {
    **dict.fromkeys(SPINDLE_STARTS, "spindle start"),
    **dict.fromkeys(SPINDLE_STOPS, "spindle stop"),
    **dict.fromkeys(PROGRAM_STOPS, "program stop"),
    **dict.fromkeys(PROGRAM_ENDS, "end of program"),
    TOOL_CHANGE: "tool change",
}


def acts(number: int) -> str:
    """What the machine does at an M code in every dialect that has it; empty: it is reported, and no more."""
    return _ACTED_UPON.get(f"M{number}", "")


def starts_spindle(function: float) -> bool:
    """Whether an M code starts the spindle, at the speed that S has given last."""
    return function in _STARTS


def turns_behind(function: int, turned: float) -> float:
    """Whether the spindle turns behind an M code, where it did what was commanded before; 0 or 1.

    M19 is no stop here: whether a feed per revolution may follow it, no control page says.
    """
    if starts_spindle(function):
        return 1.0
    return 0.0 if function in _STOPS else turned


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class SpindleState:
    """The spindle as a program, or a hand, has left it.

    A speed alone starts nothing, and S0 stops. A start without any speed turns the spindle as the job
    says of the tool. Where the job says nothing either, a control with a word for the speed lets it
    stand, as if S0 were in force (LinuxCNC, "M3, M4, M5"), and one without (CODESYS) turns it as its
    drive is set, nobody knows how fast. What is above the machine's greatest speed is limited to it,
    and the program goes on (SINUMERIK 840D sl, "Axes and spindles", maximum speed of the gear stage).

    Attributes:
        counter_clockwise: Whether it turns, or last turned, counter-clockwise.
        speed: Its last speed [1/min]; None where nobody has given.
        tool_speed: What the job says of the tool in it [1/min], or None.
        has_word: The control has a word for the speed.
        fastest: The machine's greatest speed [1/min]; None: not limited.
    """

    started: bool = False
    counter_clockwise: bool = False
    speed: float | None = None
    tool_speed: float | None = None
    has_word: bool = False
    fastest: float | None = None

    @property
    def asked(self) -> float | None:
        """The speed that a start turns it at, before it is limited [1/min]; None: not known."""
        if self.speed is not None:
            return self.speed
        return 0.0 if self.tool_speed is None and self.has_word else self.tool_speed

    @property
    def turning(self) -> float | None:
        """How fast it turns [1/min], negative counter-clockwise, 0 at a stand; None: not known."""
        if not self.started or self.asked is None:
            return None if self.started else 0.0
        speed = self.asked if self.fastest is None else min(self.asked, self.fastest)
        return -speed if self.counter_clockwise else speed

    @property
    def turns(self) -> bool:
        """Whether it turns."""
        return self.turning != 0.0

    def after(self, function: Function) -> "SpindleState":
        """The state after a function."""
        started, sense, speed = self.started, self.counter_clockwise, self.speed
        if function.word in SPINDLE_STARTS | {SPINDLE_SPEED}:
            speed = function.arguments.get("S", speed)
        if function.word in SPINDLE_STARTS:
            started, sense = True, function.word == SPINDLE_COUNTER_CLOCKWISE
        elif function.word in _SPINDLE_ENDS:
            started = False
        return dataclasses.replace(self, started=started, counter_clockwise=sense, speed=speed)

    def stopped(self) -> "SpindleState":
        """At a stand; the speed is remembered."""
        return dataclasses.replace(self, started=False)

    def limited_by(self, function: Function) -> str:
        """What there is to say where a function asks for more than the machine gives; else nothing."""
        asked = function.arguments.get("S", 0.0)
        if function.word not in SPINDLE_STARTS | {SPINDLE_SPEED}:
            return ""
        return self.limit_of(asked)

    def limit_of(self, asked: float | None) -> str:
        """What there is to say where a speed is more than the machine gives [1/min]; else nothing."""
        if asked is None or self.fastest is None or asked <= self.fastest:
            return ""
        return f"S{asked:g} is more than this spindle gives: it turns at {self.fastest:g} /min"
