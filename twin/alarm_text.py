"""Machine alarms shown as the interpreter shows errors: place, caret, hint."""

import re

from twin.machine.alarms import Alarm
from twin.nc.diagnostics import Diagnostic
from twin.nc.source import Source


def alarm_diagnostic(alarm: Alarm, source: Source) -> Diagnostic:
    """Point an alarm at the word of its axis in the program line that raised it.

    A line that does not name the axis is marked at its first word.

    Args:
        alarm: The machine's alarm.
        source: The program that ran.
    """
    text = source.lines[alarm.line - 1] if 0 < alarm.line <= len(source.lines) else ""
    word = re.search(rf"{re.escape(alarm.axis)}\s*=?\s*[-+]?[\d.#$]\S*", text, re.IGNORECASE)
    if not alarm.axis or word is None:
        word = re.search(r"\S+", text)
    return Diagnostic(
        severity="error",
        code=alarm.code,
        message=f"{alarm.message} (alarm after {alarm.time_s:.3f} s)",
        file=source.name,
        line=max(alarm.line, 1),
        column=1 if word is None else word.start() + 1,
        width=1 if word is None else word.end() - word.start(),
        source=text,
    )
