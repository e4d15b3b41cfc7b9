"""Statements of the SINUMERIK: keywords, assignments, calls of subprograms and cycles."""

import re

from twin.nc.control.codes import StatementAction
from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik import orientation
from twin.nc.dialects.sinumerik.codes import NUMBERS, PASSED_STATEMENTS, REFUSED_STATEMENTS
from twin.nc.dialects.sinumerik.cycles import CYCLES, call_cycle
from twin.nc.dialects.sinumerik.cycles.calls import CycleCall, CycleForm, read_call
from twin.nc.dialects.sinumerik.flow import calls, structures
from twin.nc.dialects.sinumerik.flow.repeats import repeat_blocks
from twin.nc.dialects.sinumerik.variables.assignments import assign, define
from twin.nc.dialects.sinumerik.variables.expressions import bracketed
from twin.nc.functions import BLANK
from twin.nc.text.blocks import Statement

_BOX, _CYLINDER = 112.0, 192.0
"""Modes in which all that is written counts from the datum, as the control's mask writes them."""


def _report_workpiece(call: CycleCall) -> None:
    """Report a box by two corners, or a cylinder, by heights from the datum; others only in words."""
    shape, mode = call.texts.get("SHAPE", "").upper(), call.get("MODE")
    top, bottom = call.length("ZA"), call.length("ZI")
    if shape == "BOX" and mode == _BOX:
        corners = {
            f"{name}{side}": call.length(f"{name}{side}") for name in "XY" for side in (1, 2)
        }
        call.control.function(BLANK, {**corners, "Z1": bottom, "Z2": top})
    elif shape == "CYLINDER" and mode == _CYLINDER:
        sizes = {"D": call.length("X1"), "L": top - bottom, "Z2": top}
        call.control.function(BLANK, sizes)
    else:
        message = f"{call.statement.keyword} in this form gives the twin no stock: the job does"
        report = call.control.report
        report.notice("WORKPIECE", message, call.statement.column, len(call.statement.keyword))


_WORKPIECE_FORM = CycleForm(
    "WP REF OFFSET SHAPE MODE ZA ZI ZB X1 Y1 X2 Y2 W1 W2 W3 W4", _report_workpiece
)


def workpiece(control: Control, statement: Statement) -> None:
    """WORKPIECE(, , , "BOX", 112, ZA, ZI, ZB, X1, Y1, X2, Y2)."""
    _WORKPIECE_FORM.run(read_call(control, statement, _WORKPIECE_FORM))


_INDEXED = re.compile(r"[ \t]*\[[^\]]*\][ \t]*=[ \t]*[-+.\w]+")
"""What ``ACC[X]=50`` is set to."""
_ASSIGNED = re.compile(r"[ \t]*(?:\[[^\]]*\])?[ \t]*=(?!=)")


def _pass_over(control: Control, statement: Statement) -> None:
    """A statement that changes nothing of the path: reported once; words behind it are a block."""
    keyword, text, column = statement.keyword, statement.text, statement.text_column
    message = f"{keyword} does not change the path here: {PASSED_STATEMENTS[keyword]}"
    control.report.notice(keyword, message, statement.column, len(keyword))
    index = _INDEXED.match(text)
    _run_rest(control, statement, bracketed(control, text, column)[2] if not index else index.end())


def _run_rest(control: Control, statement: Statement, at: int) -> None:
    """Run what is in a line behind a statement as a block."""
    text, column = statement.text[at:], statement.text_column + at
    for block in control.statements.blocks(text, column, control.block.line):
        control.run(block)


def _end_transformation(control: Control, statement: Statement) -> None:
    orientation.end_transformation(control)
    _run_rest(control, statement, 0)


def _refuse(control: Control, statement: Statement) -> None:
    """A statement of the control that the twin does not follow."""
    keyword = statement.keyword
    message = f"{keyword} is known to the control and not simulated: {REFUSED_STATEMENTS[keyword]}"
    control.fail("unsupported-statement", message, statement)


def _repeat(control: Control, statement: Statement) -> None:
    """REPEAT alone begins a loop; with a label it runs blocks again."""
    if statement.text.strip():
        repeat_blocks(control, statement)
    else:
        structures.begin_repeat(control, statement)


def _alarm(control: Control, statement: Statement) -> None:
    """SETAL(65000): the program stops itself."""
    message = f"the program stops itself: SETAL{statement.text.strip()}"
    control.fail("program-error", message, statement, "the program's own checks have failed")


STATEMENTS: dict[str, StatementAction] = {
    **dict.fromkeys(PASSED_STATEMENTS, _pass_over),
    **dict.fromkeys(REFUSED_STATEMENTS, _refuse),
    **structures.STATEMENTS,
    **calls.STATEMENTS,
    **dict.fromkeys(CYCLES, call_cycle),
    "DEF": define,
    "REPEAT": _repeat,
    "SETAL": _alarm,
    "CYCLE800": orientation.swivel,
    "TRAORI": orientation.begin_transformation,
    "TRAFOOF": _end_transformation,
    "WORKPIECE": workpiece,
}


def other_statement(control: Control, statement: Statement) -> None:
    """An assignment, or the call of a subprogram."""
    keyword = statement.keyword
    if keyword[0] == "$" or keyword == "R" or _ASSIGNED.match(statement.text) is not None:
        assign(control, statement)
    elif keyword[0] == "L" and keyword[1:].isdigit():
        calls.numbered(control, statement)
    else:
        calls.call_named(control, statement, keyword, statement.text, statement.text_column)


LONG_WORDS = (
    *("CR", "AR", "AP", "RP", "TURN", "I1", "J1", "K1", "ANG", "RPL"),
    *("RND", "RNDM", "CHR", "CHF", "ADIS", "ADISPOS", "OFFN", "DISC", "FB", "SPOS", "LIMS", "FP"),
    *("FRC", "FRCM", "OVR", "OVRRAP", "DISR", "DISCL", "DISRP", "FAD", "SPOSA", "CTOL", "OTOL"),
)
"""Addresses of several letters, which = follows."""

_LONG = "|".join(word for word in LONG_WORDS if word.isalpha())
PATTERN = (
    r"%|R[0-9]+(?=[ \t]*=(?!=))|R(?=[ \t]*\[)|\$[A-Z_]\w*|L[0-9]+\b(?![ \t]*=)"
    rf"|(?!AX[ \t]*\[|(?:{'|'.join(NUMBERS)})\b|(?:{_LONG})[ \t]*=)[A-Z_][A-Z_]\w*\b(?![ \t]*:(?!=))"
)
"""What begins a statement."""
