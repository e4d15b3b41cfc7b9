"""Statements of the Fagor CNC 8070: those that are not flow, and the table of all."""

import re
from collections.abc import Iterable
from typing import NoReturn

from twin.nc.control.codes import StatementAction
from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070 import flow, subroutines
from twin.nc.dialects.fagor8070.frames import inclined_planes
from twin.nc.dialects.fagor8070.frames.machine_coordinates import machine_coordinates
from twin.nc.dialects.fagor8070.frames.transformations import set_scale
from twin.nc.dialects.fagor8070.known_statements import ENDED_ONLY, PASSED_OVER, REFUSED
from twin.nc.dialects.fagor8070.polar import forget_polar
from twin.nc.dialects.fagor8070.variables import VARIABLE_STATEMENT, assign
from twin.nc.iso.base import wait
from twin.nc.iso.orientation.tool_center import begin_tool_center, end_tool_center
from twin.nc.text.blocks import Location, Statement
from twin.nc.text.expressions.expressions import Expression

_ROUNDED = (1, 4)
"""Kinds of #ROUNDPAR whose value is how far a rounded corner may lie from the programmed one."""
_QUOTED = re.compile(r"[^\"]*\"([^\"]*)\".*")


def _dwell(control: Control, statement: Statement) -> None:
    """#TIME [s]."""
    wait(control, flow.value_of(control, statement), statement)


def skip_comment(control: Control, statement: Statement) -> None:
    """#COMMENT BEGIN: everything up to #COMMENT END is comment."""
    lines = control.program_counter.lines
    for line in range(control.block.line, len(lines)):
        if re.match(r"[ \t]*#COMMENT[ \t]+END\b", lines[line], re.IGNORECASE):
            control.program_counter.go(Location(line + 1, 0))
            return
    control.fail("open-comment", "#COMMENT END is missing", statement)


def _scale(control: Control, statement: Statement) -> None:
    """#SCALE[2]: lengths are multiplied; #SCALE alone or [1] ends it."""
    values = _bracketed(control, statement, 1) if statement.text.strip() else []
    set_scale(control, control.compute(*values[0]) if values else 1.0, statement)


def round_parameters(control: Control, statement: Statement) -> None:
    """#ROUNDPAR[1, e]: how far G05 may round corners.

    Decision: kinds 1 and 4 give the largest distance from the programmed path, as the machine
    file's tolerance does; the others shape the curve, which the twin chooses itself.
    """
    values = [control.compute(*each) for each in _bracketed(control, statement)]
    kind = values[0] if values else 0.0
    if kind not in _ROUNDED or len(values) < 2 or values[1] <= 0.0:
        kinds = " and ".join(map(str, _ROUNDED))
        message = f"only the kinds {kinds} of #ROUNDPAR are simulated, with a distance above 0"
        control.fail("unsupported-statement", message, statement, "write #ROUNDPAR[1,0.05]")
    control.modal.corner_tolerance = values[1] * control.modal.unit


def _bracketed(
    control: Control, statement: Statement, count: int | None = None
) -> list[tuple[Expression, int]]:
    """The expressions in the square brackets behind a keyword, and the column of each."""
    text = statement.text.rstrip()
    begin = len(text) - len(text.lstrip())
    if not (text[begin : begin + 1] == "[" and text.endswith("]")):
        message = f"{statement.keyword} needs its values in square brackets"
        control.fail("expression", message, statement)
    column = statement.text_column + begin + 1
    found = control.statements.expressions(text[begin + 1 : -1], column, count)
    return [(each, column) for each in found]


def warning(control: Control, statement: Statement) -> None:
    """#WARNING["..."]: the program warns its operator."""
    span = statement.column, len(statement.keyword)
    control.report.warn("program-warning", f"the program warns: {_quoted(statement)}", *span)


def error(control: Control, statement: Statement) -> None:
    """#ERROR["..."]: the program stops itself."""
    message = f"the program stops itself: {_quoted(statement)}"
    control.fail("program-error", message, statement, "the program's own checks have failed")


def _quoted(statement: Statement) -> str:
    match = _QUOTED.fullmatch(statement.text)
    return match[1] if match is not None else statement.text.strip() or "no reason is given"


def pass_over(control: Control, statement: Statement) -> None:
    """A statement that changes nothing of the path: reported once."""
    keyword = _words(statement)
    if statement.text.strip().upper() != "OFF":
        message = f"{keyword} does not change the path here: {PASSED_OVER[keyword]}"
        control.report.notice(keyword, message, statement.column, len(statement.keyword))


def end_only(control: Control, statement: Statement) -> None:
    """A statement whose OFF alone can be followed, because nothing has begun."""
    if statement.text.strip().upper() != "OFF":
        refuse_known(control, statement)


def refuse_known(control: Control, statement: Statement) -> NoReturn:
    """A statement of the control that the twin does not follow."""
    keyword = _words(statement)
    reason = {**ENDED_ONLY, **REFUSED}[keyword]
    message = f"{keyword} is known to the control and not simulated: {reason}"
    control.fail("unsupported-statement", message, statement)


def _words(statement: Statement) -> str:
    """The keyword with single blanks."""
    return " ".join(statement.keyword.split())


def warn_of_missing_end(control: Control) -> None:
    """The program's last line is reached without M30 or M02 (decision: a warning)."""
    if control.program_counter.is_calling:
        control.report.fail("return-outside", "the subroutine has no M17, M29 or #RET")
    control.report.warn("no-end", "the program ends without M30", hint="write M30 at its end")


def _lead_tip(control: Control, statement: Statement) -> None:
    """#RTCP ON, #RTCP ON[n], #RTCP OFF: the tip is led while rotary axes turn; F counts its path."""
    match = _RTCP.fullmatch(statement.text)
    if match is None:
        message = "#RTCP is written as #RTCP ON or #RTCP OFF"
        control.fail("unreadable-statement", message, statement, "#RTCP ON")
    if match[1].upper() == "ON":
        begin_tool_center(control, "#RTCP")
    else:
        end_tool_center(control, "#RTCP", keeps_length=True)
    forget_polar(control)


_RTCP = re.compile(r"[ \t]*(ON|OFF)(?:[ \t]*\[[ \t]*[0-9]+[ \t]*\])?[ \t]*", re.IGNORECASE)

STATEMENTS: dict[str, StatementAction] = {
    **flow.STATEMENTS,
    **subroutines.STATEMENTS,
    **inclined_planes.STATEMENTS,
    "#TIME": _dwell,
    "#COMMENT BEGIN": skip_comment,
    "#COMMENT END": lambda control, statement: control.fail(
        "open-comment", "#COMMENT BEGIN is missing", statement
    ),
    "#MCS": machine_coordinates,
    "#SCALE": _scale,
    "#RTCP": _lead_tip,
    "#ROUNDPAR": round_parameters,
    "#WARNING": warning,
    "#WARNINGSTOP": warning,
    "#ERROR": error,
    **dict.fromkeys(PASSED_OVER, pass_over),
    **dict.fromkeys(ENDED_ONLY, end_only),
    **dict.fromkeys(REFUSED, refuse_known),
}


def _pattern(keywords: Iterable[str]) -> str:
    """A regular expression of what begins a statement, the longer keywords first."""
    names = sorted((each[1:] for each in keywords if each[0] in "$#"), key=len, reverse=True)
    of_kind = {
        mark: "|".join(
            re.escape(name).replace(r"\ ", r"[ \t]+") for name in names if mark + name in keywords
        )
        for mark in "$#"
    }
    return (
        rf"%|\$(?:{of_kind['$']})\b|#(?:{of_kind['#']})\b"
        rf"|LL(?=[ \t]+[A-Z_]\w*)|L(?=[ \t]+[A-Z_])|{VARIABLE_STATEMENT}"
    )


PATTERN = _pattern(STATEMENTS)
"""What begins a statement."""


def other_statement(control: Control, statement: Statement) -> None:
    """An assignment, or a statement written with other blanks."""
    known = STATEMENTS.get(_words(statement))
    if known is None:
        assign(control, statement)
    else:
        known(control, statement)
