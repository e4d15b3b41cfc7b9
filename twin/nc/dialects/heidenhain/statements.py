"""What each keyword of Klartext does, and those that the twin does not follow."""

import re
from collections.abc import Mapping

from twin.nc.control.codes import StatementAction
from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain import flow, parameters, tool_tip, tools
from twin.nc.dialects.heidenhain.cycles import calls, definitions, patterns, planes
from twin.nc.dialects.heidenhain.cycles.transformations import (
    DefinitionStep,
    apply_transformations,
    shift_datum,
)
from twin.nc.dialects.heidenhain.memory import memory_of
from twin.nc.dialects.heidenhain.paths import corners, leads, paths
from twin.nc.text.blocks import Statement

_COMMENT = re.compile(r"[ \t]*(?:[0-9]+[ \t]*)?[;*]")
_DATUM = re.compile(r"[ \t]*DATUM[ \t]+(RESET|AXIS(.*))[ \t]*", re.IGNORECASE)

FREE_CONTOURS = (
    "free contours (FK) compute points that the program leaves open, which the twin does not"
)
REFUSED: Mapping[str, tuple[str, str]] = {
    "SPL": ("splines are not followed", "write L and C"),
    **dict.fromkeys(
        ("FL", "FLT", "FC", "FCT", "FPOL", "FSELECT"),
        (FREE_CONTOURS, "write L, C, CR or CT with all points"),
    ),
    "APPR": ("the approach is not known", "APPR LT, LN, CT, LCT, PLT, PLN, PCT or PLCT"),
    "DEP": ("the departure is not known", "DEP LT, LN, CT, LCT or PLCT"),
    "TCH PROBE": ("nothing touches the twin's probe", "leave the probing cycle out"),
    "CALL SELECTED PGM": ("the program is selected where it runs", "write CALL PGM and its name"),
    "DECLARE": ("structures of texts are not followed", "write QS1 and its text"),
    "CONTOUR DEF": ("contours of subprograms are not followed", "write the moves themselves"),
    "SEL PATTERN": ("tables of points are not kept", "write PATTERN DEF and its places"),
    "SEL TABLE": ("datum tables are not kept", "write CYCL DEF 7 or TRANS DATUM AXIS"),
    "SEL PGM": ("the program is selected where it runs", "write CALL PGM and its name"),
    "SEL CONTOUR": ("contours of subprograms are not followed", "write the moves themselves"),
    "GLOBAL DEF": ("values of all cycles are not kept", "write them into each CYCL DEF"),
    "ERROR": ("the control's editor has marked this block as wrong", "write the block again"),
    "POLARKIN": ("polar kinematics are not followed", "write X and Y"),
    **dict.fromkeys(
        ("TABDATA", "OPEN", "CLOSE"),
        ("tables of the control are not kept", "write the values into Q parameters"),
    ),
}
"""Keywords that the control knows: why the twin does not follow them, and what to write."""


def pass_over(_control: Control, _statement: Statement) -> None:
    """A heading of the program's structure."""


def go_on(control: Control, statement: Statement) -> None:
    """``~``: a comment goes on; what else does has taken its lines before."""
    lines, line = control.program_counter.lines, control.block.line - 2
    while line > 0 and lines[line - 1].rstrip().endswith("~"):
        line -= 1
    if _COMMENT.match(lines[line]) is None:
        message = "no block of this kind goes on in a further line"
        hint = "write it on one line; CYCL DEF, PATTERN DEF and formulas go on behind ~"
        control.report.fail("continuation", message, 0, len(statement.text), hint)


def transform(control: Control, statement: Statement) -> None:
    """TRANS DATUM: as cycle 7."""
    match = _DATUM.fullmatch(statement.text)
    if match is None:
        message = "TRANS is followed with DATUM AXIS and DATUM RESET alone"
        control.fail("unsupported-statement", message, statement, "TRANS DATUM AXIS X+10 Y+20")
    if match[2]:
        step = DefinitionStep(7, 1, match[2], statement.text_column + match.start(2))
        shift_datum(control, step)
        return
    memory = memory_of(control)
    memory.shift = {}
    memory.order = [each for each in memory.order if each != "shift"]
    apply_transformations(control)


STATEMENTS: Mapping[str, StatementAction] = {
    **{
        keyword: paths.path_function(interpolation, calls.after_block)
        for keyword, interpolation in paths.KEYWORDS.items()
    },
    "CC": paths.pole_alone,
    **leads.KEYWORDS,
    "RND": corners.round_corner,
    "CHF": corners.cut_corner,
    "TOOL CALL": tools.call_tool,
    "TOOL DEF": tools.define_tool,
    "BLK FORM": tools.blank,
    "BEGIN PGM": flow.begin_program,
    "END PGM": flow.end_program,
    "LBL": flow.label,
    "CALL LBL": flow.call_label,
    "CALL PGM": flow.call_program,
    "IF": flow.jump_if,
    "STOP": flow.stop,
    "CYCL DEF": definitions.define,
    "CYCL CALL": calls.call_here,
    "CYCL CALL POS": calls.call_at,
    "CYCL CALL PAT": calls.call_pattern,
    "PATTERN DEF": patterns.define_pattern,
    "PLANE": planes.plane,
    "FUNCTION": tool_tip.function,
    "TRANS": transform,
    "*": pass_over,
    "~": go_on,
}
"""Keywords, and what they do; FN and the Q parameters are apart."""
_JUMP = re.compile(r"FN ?(?:9|10|11|12) ?:")


def other_statement(control: Control, statement: Statement) -> None:
    """A formula, FN, or a keyword that is not followed."""
    keyword = statement.keyword
    if keyword.startswith("QS"):
        parameters.assign_text(control, statement)
    elif keyword.startswith("Q"):
        parameters.assign(control, statement)
    elif _JUMP.fullmatch(keyword):
        flow.jump_if(control, statement)
    elif keyword.startswith("FN"):
        parameters.function(control, statement)
    elif keyword == "CYCLE DEF":
        definitions.define(control, statement)
    else:
        kind = next((each for each in REFUSED if keyword.startswith(each)), keyword)
        reason, hint = (
            REFUSED.get(keyword)
            or REFUSED.get(kind)
            or (
                "this is not followed",
                "what is: twin dialects heidenhain",
            )
        )
        control.fail("unsupported-statement", f"{keyword}: {reason}", statement, hint)
