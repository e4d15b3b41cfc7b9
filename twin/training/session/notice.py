"""An alarm as the control's screen shows it."""

import dataclasses


@dataclasses.dataclass(frozen=True, slots=True)
class Notice:
    """An alarm.

    Attributes:
        code: Stable, searchable name of its kind: those of ``twin.machine.watching.alarms``, and
            ``program`` (the interpreter refused a block), ``external`` (a safety circuit).
        message: What happened, with numbers.
        axis: Name of the axis, or empty.
        line: Source line of the program, 0 where none.
        time_s: When, in machine time [s].
    """

    code: str
    message: str
    axis: str
    line: int
    time_s: float
