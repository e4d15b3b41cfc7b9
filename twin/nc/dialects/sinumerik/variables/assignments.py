"""Assignments and DEF: ``R1=5``, tables with SET and REP, texts, axes."""

import dataclasses
import re

from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik.memory import TEXTS, CallFrame, VariableType, memory_of
from twin.nc.dialects.sinumerik.variables.expressions import NAME, SECOND, bracketed, split_values
from twin.nc.dialects.sinumerik.variables.variables import axis_at, write_variable
from twin.nc.text.blocks import Statement
from twin.nc.text.expressions.expressions import (
    Expression,
    ExpressionError,
    NumberedVariable,
    Variable,
)


@dataclasses.dataclass(frozen=True, slots=True)
class MultipleAssignment:
    """One assignment of a statement: to what, where that stands, and the values.

    SET has several, None where it leaves an element as it is; REP has one, and how many elements get it.
    """

    target: Expression
    column: int
    values: tuple[tuple[Expression | None, int], ...]
    text: str = ""
    repeats: bool = False


_SEPARATOR = re.compile(r"[ \t]*")
_EQUALS = re.compile(r"[ \t]*=(?!=)[ \t]*")
_FRAME = re.compile(r"(CTRANS|CFINE|CROTS?|CSCALE|CMIRROR)[ \t]*\(", re.IGNORECASE)
_OFFSET = re.compile(r"(\$P_UIFR\[[^,\]]+)\]")
_QUOTED = re.compile(r'"([^"]*)"')
_MANY = re.compile(r"(SET|REP)[ \t]*\(", re.IGNORECASE)


def assign(control: Control, statement: Statement) -> None:
    """``R1=5 R2=R1+1 NAME[3]=2 TABLE=SET(1,2)``: one after the other."""
    parsed = control.program_counter.parsed(statement, lambda: _assignments(control, statement))
    for each in parsed:
        _assign(control, each)


def _assignments(control: Control, statement: Statement) -> list[MultipleAssignment]:
    line = statement.keyword + statement.text
    column, at, found = statement.column, 0, list[MultipleAssignment]()
    variable = control.program_counter.lexer.expressions.variable
    while at < len(line.rstrip()):
        if variable.match(line, at) is None:
            message = "only further assignments can follow"
            hint = "write the words in a block of their own"
            control.report.fail("assignment", message, column + at, 1, hint)
        target, end = control.statements.operand(line, at, column)
        equals = _EQUALS.match(line, end)
        if equals is None or not isinstance(target.tree, Variable | NumberedVariable):
            message = "an assignment gives a variable a value: R1=5"
            control.report.fail("assignment", message, column + at, max(1, end - at))
        if (frame := _FRAME.match(line, equals.end())) is not None:
            shifts, at = _work_offset(control, line, frame, column, target)
            found += shifts
        else:
            each, at = _value_of(control, line, equals.end(), column, target, column + at)
            found.append(each)
        blanks = _SEPARATOR.match(line, at)
        assert blanks is not None
        at = blanks.end()
    return found


def _work_offset(
    control: Control, line: str, frame: re.Match[str], column: int, target: Expression
) -> tuple[list[MultipleAssignment], int]:
    """``$P_UIFR[1]=CTRANS(X,10,Y,5)``: the shifts of all axes, 0 where it names none."""
    begin, shown = frame.end() - 1, column + frame.start()
    inner, at, length = bracketed(control, line[begin:], column + begin)
    assert isinstance(target.tree, Variable | NumberedVariable)
    offset, end = _OFFSET.fullmatch(target.tree.name), begin + length
    values = split_values(inner) if inner.strip() else []
    is_shift = frame[1].upper() == "CTRANS" and not line[end:].lstrip().startswith(":")
    if offset is None or not is_shift or len(values) % 2:
        message = "of frames as values a shift of a work offset is followed alone"
        hint = "$P_UIFR[1]=CTRANS(X,10,Y,5); or TRANS, ROT, SCALE and MIRROR"
        control.report.fail("frame", message, shown, len(frame[1]), hint)
    given = dict[str, tuple[str, int]]()
    for (name, place), (text, of_value) in zip(values[::2], values[1::2], strict=True):
        axis, _ = axis_at(control, name, len(name) - len(name.lstrip()), at + place)
        given[axis] = (text, at + of_value)
    shifts = []
    for axis in control.settings.axes.names:
        text, place = given.get(axis, ("0", shown))
        value = control.statements.expression(text, place)
        name = f"{offset[1]},{axis},TR]"
        shifts.append(
            MultipleAssignment(Expression(name, Variable(name)), shown, ((value, place),))
        )
    return shifts, end


def _value_of(
    control: Control, line: str, at: int, column: int, target: Expression, begin: int
) -> tuple[MultipleAssignment, int]:
    quoted, many = _QUOTED.match(line, at), _MANY.match(line, at)
    if quoted is not None:
        return MultipleAssignment(target, begin, (), quoted[0]), quoted.end()
    name = target.tree.name if isinstance(target.tree, Variable) else ""
    if memory_of(control).calls[-1].types.get(name) is VariableType.AXIS:
        axis, end = axis_at(control, line, at, column)
        return MultipleAssignment(target, begin, (), axis), end
    if many is None:
        value, end = control.statements.longest(line, at, column)
        return MultipleAssignment(target, begin, ((value, column + at),)), end
    inner, begin_inner, end = bracketed(control, line[many.end() - 1 :], column + many.end() - 1)
    given = tuple(
        (
            control.statements.expression(each, begin_inner + place) if each.strip() else None,
            begin_inner + place,
        )
        for each, place in split_values(inner)
    )
    repeats = many[1].upper() == "REP"
    if repeats and (len(given) > 2 or None in (each for each, _ in given)):
        message = "REP has a value, and how many elements get it"
        control.report.fail("assignment", message, begin, many.end() - at, "REP(0) or REP(0,12)")
    return MultipleAssignment(target, begin, given, repeats=repeats), many.end() - 1 + end


def _assign(control: Control, each: MultipleAssignment) -> None:
    tree, call = each.target.tree, memory_of(control).calls[-1]
    assert isinstance(tree, Variable | NumberedVariable)
    if each.text or call.types.get(tree.name) in TEXTS:
        _assign_text(control, each, tree.name)
        return
    try:
        index = None
        if isinstance(tree, NumberedVariable):
            index = control.compute(Expression("", tree.index), each.column)
        values = [
            None if value is None else control.compute(value, column)
            for value, column in each.values
        ]
        many = each.repeats or len(values) > 1 or index is None
        if tree.name in call.sizes and many:
            _fill(control, each, tree.name, index or 0.0, values)
        elif len(values) > 1 or values[0] is None:
            message = f"{tree.name} is one number: it takes one value"
            control.report.fail("assignment", message, each.column, len(each.target.text))
        else:
            write_variable(control, tree.name, index, values[0])
    except ExpressionError as error:
        width = len(each.target.text)
        control.report.fail(error.code, str(error), each.column, width, error.hint)


def _fill(
    control: Control, each: MultipleAssignment, name: str, index: float, values: list[float | None]
) -> None:
    """SET(...) gives the elements of a table from one on their values, the last index first; REP(...) one value."""
    rows, columns = memory_of(control).calls[-1].sizes[name]
    second, first = divmod(int(index), int(SECOND))
    begin = first * columns + second
    if each.repeats:
        count = values[1] if len(values) > 1 else float(rows * columns - begin)
        values = values[:1] * int(min(max(count or 0.0, 0.0), MOST_ELEMENTS + 1))
    if not (each.repeats or len(values) > 1) or begin + len(values) > rows * columns:
        message = f"{name} has {rows * columns} elements"
        control.report.fail("assignment", message, each.column, len(name), f"write {name}[0]=5")
    for number, value in enumerate(values):
        row, column = divmod(begin + number, columns)
        if value is not None:
            write_variable(control, name, row + column * SECOND, value)


def _assign_text(control: Control, each: MultipleAssignment, name: str) -> None:
    call = memory_of(control).calls[-1]
    text = each.text.strip('"') if each.text else _named_text(call, each)
    if call.types.get(name) not in TEXTS or text is None:
        message = (
            f"{name} holds no text"
            if text is not None
            else "only a text in quotes is followed here"
        )
        hint = f'DEF STRING[20] {name}="..."'
        control.report.fail("text-value", message, each.column, len(name), hint)
    call.texts[name] = text


def _named_text(call: CallFrame, each: MultipleAssignment) -> str | None:
    value = each.values[0][0]
    if value is None or not isinstance(value.tree, Variable):
        return None
    return call.texts.get(value.tree.name)


# --- DEF


MOST_ELEMENTS = 32_767
"""Elements of one table."""
_DEFINED = re.compile(
    r"[ \t]*(?:(?:NCK|CHAN)[ \t]+)?(REAL|INT|BOOL|CHAR|AXIS|STRING[ \t]*\[[ \t]*\d+[ \t]*\])[ \t]+",
    re.IGNORECASE,
)
_DEFINED_NAME = re.compile(rf"[ \t]*({NAME})[ \t]*(?:\[([^\]]*)\])?[ \t]*(=)?[ \t]*", re.IGNORECASE)


def define(control: Control, statement: Statement) -> None:
    """``DEF REAL A, B=5, C[3,2]=SET(...)``: variables of the program that runs."""
    kind = _DEFINED.match(statement.text)
    if kind is None:
        message = "DEF needs a type and names"
        hint = "types: REAL, INT, BOOL, CHAR, STRING[20]; DEF REAL DEPTH=5"
        control.fail("definition", message, statement, hint)
    variable_type = VariableType(re.split(r"[ \t\[]", kind[1].upper())[0])
    text, at, column = statement.text.rstrip(), kind.end(), statement.text_column
    while True:
        name = _DEFINED_NAME.match(text, at)
        if name is None:
            message = "a variable's name begins with two letters"
            control.report.fail("definition", message, column + at, 1, "DEF REAL DEPTH")
        _define(control, name[1].upper(), variable_type, name[2], column + name.start(1))
        at = name.end()
        if name[3]:
            target = Expression(name[1], Variable(name[1].upper()))
            each, at = _value_of(control, text, at, column, target, column + name.start(1))
            _assign(control, each)
        rest = text[at:].lstrip()
        if not rest:
            return
        if not rest.startswith(","):
            control.report.fail("definition", "only a comma can follow here", column + at)
        at = len(text) - len(rest) + 1


def _define(
    control: Control, name: str, kind: VariableType, sizes: str | None, column: int
) -> None:
    call = memory_of(control).calls[-1]
    if name in call.types:
        control.report.fail("definition", f"{name} is defined already", column, len(name))
    call.types[name] = kind
    if kind in TEXTS:
        call.texts[name] = ""
        return
    if sizes is None:
        control.variables.write(name, 0.0)
        return
    given = [
        control.compute(each, column) for each in control.statements.expressions(sizes, column)
    ]
    rows, columns = (*(int(each) for each in given), 1)[:2] if given else (0, 0)
    if (
        any(each != int(each) for each in given)
        or not 1 <= rows * columns <= MOST_ELEMENTS
        or len(given) > 2
    ):
        message = f"a table has one or two sizes, and 1 to {MOST_ELEMENTS} elements"
        control.report.fail("definition", message, column, len(name), f"DEF REAL {name}[10]")
    call.sizes[name] = rows, columns
    for row in range(rows):
        for second in range(columns):
            control.variables.write(f"{name}[{row},{second}]", 0.0)
