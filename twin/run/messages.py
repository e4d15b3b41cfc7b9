"""Machine alarms and near misses shown as the interpreter shows errors: place, caret, hint."""

import re

from twin.compare.verdict import Reason
from twin.machine.alarms import Alarm, NearMiss
from twin.nc.text.diagnostics import Diagnostic
from twin.nc.text.source import Source


def alarm_diagnostic(alarm: Alarm, source: Source) -> Diagnostic:
    """Point an alarm at the word of its axis in the program line that raised it.

    A line that does not name the axis is marked at its first word.

    Args:
        alarm: The machine's alarm.
        source: The program that ran.
    """
    text = _line(source, alarm.line)
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


def near_miss_diagnostic(near_miss: NearMiss, source: Source) -> Diagnostic:
    """Show a near miss as a warning at the line in which it was closest.

    Args:
        near_miss: The closest approach of the run.
        source: The program that ran.
    """
    text = _line(source, near_miss.line)
    one, two = near_miss.between
    return Diagnostic(
        severity="warning",
        code="near-miss",
        message=(
            f"the {one} passes the {two} with {near_miss.clearance_mm:.2f} mm to spare "
            f"(after {near_miss.time_s:.3f} s)"
        ),
        file=source.name,
        line=max(near_miss.line, 1),
        column=1,
        width=max(len(text), 1),
        source=text,
    )


def _line(source: Source, number: int) -> str:
    return source.lines[number - 1] if 0 < number <= len(source.lines) else ""


def reason_text(reason: Reason, source: Source) -> str:
    """Point a reason at the program line that it is about; one about the whole program has none.

    Args:
        reason: Why the run does not pass.
        source: The program that ran.
    """
    if not 0 < reason.line <= len(source.lines):
        return f"{source.name}: error {reason.what}: {reason.message}"
    text = source.lines[reason.line - 1]
    column = len(text) - len(text.lstrip())
    when = f" ({reason.time_s:.3f} s)" if reason.time_s else ""
    return str(
        Diagnostic(
            severity="error",
            code=reason.what,
            message=reason.message + when,
            file=source.name,
            line=reason.line,
            column=column + 1,
            width=max(len(text.strip()), 1),
            source=text,
        )
    )
