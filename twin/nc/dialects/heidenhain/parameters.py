"""Q parameters: FN 0 to FN 20, formulas, texts, and what the control itself puts into them."""

import dataclasses
import re

from twin.nc.control.control import Control
from twin.nc.control.settings import ToolData
from twin.nc.dialects.heidenhain.cycles.parameters import continued
from twin.nc.dialects.heidenhain.memory import memory_of
from twin.nc.dialects.heidenhain.values import text_of, value_at
from twin.nc.iso.offsets import machine_zero
from twin.nc.text.blocks import Statement
from twin.nc.text.expressions.expressions import ExpressionError

_ASSIGNMENT = re.compile(r"[ \t]*(Q[LR]?[0-9]{1,4})[ \t]*=", re.IGNORECASE)
_ERROR = re.compile(r"[ \t]*ERROR[ \t]*=[ \t]*(.+)", re.IGNORECASE)
_TEXT = re.compile(
    r"[ \t]*=[ \t]*((?:\"[^\"]*\"|QS[0-9]+)(?:[ \t]*\|\|[ \t]*(?:\"[^\"]*\"|QS[0-9]+))*)[ \t]*",
    re.IGNORECASE,
)
_DATUM = (
    r"ID[ \t]*(?P<id>[0-9]+)[ \t]*NR[ \t]*(?P<number>[0-9]+)"
    r"(?:[ \t]*IDX[ \t]*(?P<index>Q[LR]?[0-9]+|[0-9]+))?[ \t]*"
)
"""What FN 17 and FN 18 call a datum of the control."""
_READ = re.compile(
    rf"[ \t]*SYSREAD[ \t]*(?P<name>Q[LR]?[0-9]{{1,4}})[ \t]*=[ \t]*{_DATUM}", re.IGNORECASE
)
_WRITE = re.compile(rf"[ \t]*SYSWRITE[ \t]*{_DATUM}=", re.IGNORECASE)
_PIECE = re.compile(r"\"[^\"]*\"|QS[0-9]+", re.IGNORECASE)

_AXES = "XYZABCUVW"
"""Axes as FN 18 numbers them, from 1 (manual)."""
COMPUTING = frozenset((*range(9), 13))
"""FN 0 to FN 8 and FN 13 give a parameter a value."""
_PASSED = {
    15: "prints, and moves nothing",
    16: "writes a file, and moves nothing",
    19: "tells the PLC values, and moves nothing",
    20: "waits for the PLC or the look-ahead, and the twin has none of both",
    37: "exports values, and moves nothing",
    38: "writes to the log, and moves nothing",
}
_REFUSED = {
    26: "opens a table, which the twin has none of",
    27: "writes into a table, which the twin has none of",
    28: "reads a table, which the twin has none of",
    29: "tells the PLC values, which the twin has none of",
}
SPINDLE_STANDS, SPINDLE_TURNS = -1.0, 0.0
"""Q110 (manual): no spindle state is known; M3 is in force."""


def is_local(name: str) -> bool:
    """Whether programs that are called have a parameter of this name again."""
    return name.startswith("QL")


def assign(control: Control, statement: Statement) -> None:
    """``Q1 = Q2 * SIN Q3``."""
    lines = (line for _, line in continued(control, while_=None))
    text = " ".join((statement.text.replace("=", " ", 1).rstrip("~ \t"), *lines))
    value = control.compute(
        control.statements.expression(text, statement.text_column), statement.text_column
    )
    control.variables.write(statement.keyword, value)


def assign_text(control: Control, statement: Statement) -> None:
    """``QS1 = "part" || QS2``."""
    match = _TEXT.fullmatch(statement.text)
    if match is None:
        hint = 'QS1 = "text" || QS2'
        message = "texts are joined by || and no more"
        control.fail("unreadable-statement", message, statement, hint)
    pieces = (text_of(control, each) for each in _PIECE.findall(match[1]))
    memory_of(control).texts[statement.keyword] = "".join(pieces)


def function(control: Control, statement: Statement) -> None:
    """FN: computes, or does what its number says; those that jump are elsewhere."""
    number = int(re.sub("[^0-9]", "", statement.keyword))
    if number in _PASSED:
        message = f"FN {number} {_PASSED[number]}"
        control.report.notice(f"FN {number}", message, statement.column, len(statement.keyword))
        return
    if number == 14:
        match = _ERROR.match(statement.text)
        told = statement.text.strip() if match is None else f"error {match[1].strip()}"
        control.fail("program-alarm", f"the program stops itself: {told}", statement)
    if number in (17, 18):
        (_write_system if number == 17 else _read_system)(control, statement)
        return
    match = _ASSIGNMENT.match(statement.text)
    if number not in COMPUTING or match is None:
        reason = _REFUSED.get(number, "is no function here")
        hint = "FN 0: Q1 = +5 gives a value, FN 9: IF +Q1 EQU +Q2 GOTO LBL 1 jumps"
        control.fail("unsupported-statement", f"FN {number} {reason}", statement, hint)
    column = statement.text_column + match.end()
    value = control.compute(
        control.statements.expression(statement.text[match.end() :], column), column
    )
    control.variables.write(match[1].upper(), value)


def _read_system(control: Control, statement: Statement) -> None:
    """FN 18: the tool in the spindle, its radius and length, and where the axes are."""
    match = _READ.fullmatch(statement.text)
    index, tool = 0.0, control.tools.spindle or 0
    if match is not None and match["index"]:
        index, _ = value_at(control, statement, match.start("index"))
    value: float | None = None
    asked = (0, 0) if match is None else (int(match["id"]), int(match["number"]))
    if asked == (20, 1):
        value = float(tool)
    elif asked[0] == 50 and asked[1] in (1, 2):
        data = control.tools.data(int(index) or tool)
        value = None if data is None else (data.length, data.radius)[asked[1] - 1]
    elif asked in ((240, 1), (270, 1)) and 1.0 <= index <= len(_AXES):
        value = _position(control, _AXES[int(index) - 1], of_machine=asked[0] == 240)
    if value is None or match is None:
        message = f"{statement.keyword.rstrip(':').strip()} reads data of the control that the twin does not keep"
        hint = (
            "known: ID20 NR1, ID50 NR1 and NR2, ID240 NR1, ID270 NR1; else give Q its value by FN 0"
        )
        control.fail("unsupported-statement", message, statement, hint)
    control.variables.write(match["name"].upper(), value)


def _write_system(control: Control, statement: Statement) -> None:
    """FN 17: the length and the radius of a tool, from its next call on."""
    match = _WRITE.match(statement.text)
    number = 0 if match is None or match["id"] != "50" else int(match["number"])
    if match is None or number not in (1, 2) or match["index"] is None:
        message = "FN 17 writes data of the control that the twin does not keep"
        hint = "known: FN 17: SYSWRITE ID50 NR1 IDX5 = +60, the length of tool 5; NR2, its radius"
        control.fail("unsupported-statement", message, statement, hint)
    index, _ = value_at(control, statement, match.start("index"))
    column, text = statement.text_column + match.end(), statement.text[match.end() :]
    value = control.compute(control.statements.expression(text, column), column)
    change = {("length", "radius")[number - 1]: value * control.modal.unit}
    old = control.tools.data(int(index)) or ToolData(0.0, 0.0)
    control.tools.table = {**control.tools.table, int(index): dataclasses.replace(old, **change)}


def _position(control: Control, axis: str, *, of_machine: bool) -> float | None:
    """Where an axis stands, as the program or the machine counts it; None: the machine lacks it."""
    column = control.axis_index.get(axis)
    if column is None:
        return None
    value = control.motion.programmed[column]
    if of_machine:
        value = control.motion.part[column] - machine_zero(control, "ID240").get(axis, 0.0)
    return value / control.motion.unit_of(column)


def read_variable(control: Control, name: str, _index: float | None) -> float:
    """Value of a parameter, the control's own ones included.

    Raises:
        ExpressionError: It has none.
    """
    value = control.variables.read(name)
    if value is None:
        value = _own(control, name)
    if value is None:
        message = f"{name} has no value"
        hint = f"write FN 0: {name} = +0 before, or in the job: [variables] {name} = 0.0"
        raise ExpressionError("unknown-variable", message, None, hint)
    return value


def _own(control: Control, name: str) -> float | None:
    """What the control keeps in Q108 to Q122 (manual); None where it is nothing that the twin knows."""
    memory, tool = memory_of(control), control.tools.data(control.tools.spindle)
    if name == "Q108" and tool is not None:
        return tool.radius + memory.deltas.radius
    if name == "Q114" and tool is not None:
        return tool.length
    known = {
        "Q109": 2.0,
        "Q110": SPINDLE_TURNS if control.motion.spindle_turns else SPINDLE_STANDS,
        "Q113": 0.0 if control.modal.unit == 1.0 else 1.0,
        **dict.fromkeys(("Q120", "Q121", "Q122"), 0.0),
    }
    return known.get(name)
