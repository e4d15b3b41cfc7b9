"""Messages about a program's lines: alarms, near misses, broken tolerances and warnings, with place and caret."""

import dataclasses
import re
from collections.abc import Iterable, Iterator

from twin.compare.verdict import Reason
from twin.machine.watching.clearance import TOUCH
from twin.nc.functions import SPINDLE_LIMITED
from twin.nc.text.diagnostics.diagnostics import Diagnostic, ProgramError, Severity
from twin.nc.text.source import Source
from twin.recording.alarms import Alarm, NearMiss

_FIRST_WORD = re.compile(r"\S+")
_SPEED_WORD = re.compile(r"S\d*\s*=?\s*[\d.#$]\S*", re.IGNORECASE)
_WHOLE_LINE = re.compile(r".*", re.DOTALL)
_WITHOUT_INDENT = re.compile(r"\S(.*\S)?", re.DOTALL)


def alarm_diagnostic(alarm: Alarm, source: Source) -> Diagnostic:
    """Point an alarm at the word of its axis in the program line that raised it.

    A line that does not name the axis is marked at its first word.
    """
    marked = [_FIRST_WORD]
    if alarm.axis:
        axis_word = rf"{re.escape(alarm.axis)}\s*=?\s*[-+]?[\d.#$]\S*"
        marked.insert(0, re.compile(axis_word, re.IGNORECASE))
    message = f"{alarm.message} (alarm after {alarm.time_s:.3f} s)"
    return at_line(source, alarm.line, alarm.code, message, *marked)


def near_miss_diagnostic(near_miss: NearMiss, source: Source) -> Diagnostic:
    """Show a near miss as a warning at the line in which it was closest.

    Two faces that lie on each other are no collision, since the axes tremble by as much.
    """
    one, two = near_miss.between
    passing = f"passes the {two} with {near_miss.clearance_mm:.2f} mm to spare"
    if near_miss.clearance_mm <= TOUCH:
        passing = f"touches the {two}: there is no room between them"
    message = f"the {one} {passing} (after {near_miss.time_s:.3f} s)"
    return at_line(source, near_miss.line, "near-miss", message, _WHOLE_LINE, severity="warning")


def speed_notice(line: int, message: str, source: Source) -> Diagnostic:
    """Show a speed of the spindle that was limited as a warning at its S."""
    return at_line(
        source, line, SPINDLE_LIMITED, message, _SPEED_WORD, _FIRST_WORD, severity="warning"
    )


def reason_text(reason: Reason, source: Source) -> str:
    """Point a reason at the program line that it is about; one about the whole program has none.

    Args:
        reason: Why the run does not pass.
    """
    if not 0 < reason.line <= len(source.lines):
        return f"{source.name}: error {reason.what}: {reason.message}"
    when = f" ({reason.time_s:.3f} s)" if reason.time_s else ""
    message = reason.message + when
    return str(at_line(source, reason.line, reason.what, message, _WITHOUT_INDENT))


def at_line(
    source: Source,
    line: int,
    code: str,
    message: str,
    *marked: re.Pattern[str],
    severity: Severity = "error",
) -> Diagnostic:
    """Point at a program line.

    Args:
        line: Its line; without one, an empty line 1 is shown.
        marked: What the caret is under: the first of these that the line holds; none: the line.
    """
    text = source.lines[line - 1] if 0 < line <= len(source.lines) else ""
    patterns = marked or (_WITHOUT_INDENT,)
    found = next((match for pattern in patterns if (match := pattern.search(text))), None)
    return Diagnostic(
        severity=severity,
        code=code,
        message=message,
        file=source.name,
        line=max(line, 1),
        column=1 if found is None else found.start() + 1,
        width=1 if found is None else max(found.end() - found.start(), 1),
        source=text,
    )


@dataclasses.dataclass(frozen=True, slots=True)
class Notice:
    """One warning of a run.

    Attributes:
        code: Its name in ``twin explain``.
        line: Source line of the program; 0 where it concerns the whole program.
    """

    code: str
    line: int
    message: str

    def diagnostic(self, source: Source) -> Diagnostic:
        """The notice at its line of the program."""
        return at_line(source, self.line, self.code, self.message, severity="warning")


def shown(notices: Iterable[Notice], source: Source, *, strict: bool) -> Iterator[Diagnostic]:
    """Notices as warnings of a program, by line.

    Raises:
        ProgramError: There is one, and ``strict`` makes it an error.
    """
    for notice in sorted(notices, key=lambda each: (each.line, each.code)):
        warning = notice.diagnostic(source)
        if strict:
            raise ProgramError(dataclasses.replace(warning, severity="error"))
        yield warning
