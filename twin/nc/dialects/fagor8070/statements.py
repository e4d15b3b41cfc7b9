"""Statements of the Fagor CNC 8070: those that are not flow, and the table of all."""

import re
from collections.abc import Callable

from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070 import flow, subroutines
from twin.nc.dialects.fagor8070.variables import assign, refuse
from twin.nc.text.blocks import Location, Statement


def dwell(control: Control, statement: Statement) -> None:
    """#TIME [s]."""
    column = statement.text_column
    seconds = control.compute(control.expression(statement.text, column), column)
    if seconds < 0.0:
        refuse(control, statement, "dwell", "a dwell cannot be negative")
    control.dwell(seconds)


def skip_comment(control: Control, statement: Statement) -> None:
    """#COMMENT BEGIN: everything up to #COMMENT END is comment."""
    lines = control.program_counter.lines
    for line in range(control.block.line, len(lines)):
        if re.match(r"[ \t]*#COMMENT[ \t]+END\b", lines[line], re.IGNORECASE):
            control.program_counter.go(Location(line + 1, 0))
            return
    refuse(control, statement, "open-comment", "#COMMENT END is missing")


def stray_comment_end(control: Control, statement: Statement) -> None:
    """#COMMENT END without its beginning.

    Raises:
        ProgramError: Always.
    """
    refuse(control, statement, "open-comment", "#COMMENT BEGIN is missing")


def warn_of_missing_end(control: Control) -> None:
    """The program's last line is reached without M30 or M02 (decision: a warning)."""
    if control.program_counter.calls:
        control.report.fail("return-outside", "the subroutine has no M17, M29 or #RET")
    control.report.warn("no-end", "the program ends without M30", hint="write M30 at its end")


STATEMENTS: dict[str, Callable[[Control, Statement], None]] = {
    "%": subroutines.heading,
    "$IF": flow.if_,
    "$ELSEIF": flow.else_,
    "$ELSE": flow.else_,
    "$ENDIF": flow.nothing,
    "$WHILE": flow.while_,
    "$ENDWHILE": flow.again,
    "$DO": flow.nothing,
    "$ENDDO": flow.end_do,
    "$FOR": flow.for_,
    "$ENDFOR": flow.end_for,
    "$SWITCH": flow.switch,
    "$CASE": flow.case,
    "$DEFAULT": flow.case,
    "$ENDSWITCH": flow.nothing,
    "$BREAK": flow.leave_construct,
    "$CONTINUE": flow.next_round,
    "$GOTO": flow.go_to,
    "#RPT": subroutines.repeat_range,
    "#TIME": dwell,
    "#CALL": subroutines.call_any,
    "LL": subroutines.call_local,
    "L": subroutines.call_global,
    "#PCALL": subroutines.call_with_parameters,
    "#MCALL": subroutines.call_modally,
    "#MDOFF": subroutines.end_modal_call,
    "#RET": subroutines.return_statement,
    "#COMMENT BEGIN": skip_comment,
    "#COMMENT END": stray_comment_end,
}


def other_statement(control: Control, statement: Statement) -> None:
    """An assignment, or a comment's mark written with other blanks."""
    words = " ".join(statement.keyword.split())
    STATEMENTS.get(words, assign)(control, statement)
