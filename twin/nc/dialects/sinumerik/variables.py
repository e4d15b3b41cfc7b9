"""Variables and expressions of the SINUMERIK: R parameters, DEF, tables, system variables."""

import dataclasses
import math
import operator
import re

from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik import system_variables
from twin.nc.dialects.sinumerik.memory import CallFrame, memory_of
from twin.nc.dialects.sinumerik.types import VariableType
from twin.nc.text import arithmetic
from twin.nc.text.blocks import Statement, Word
from twin.nc.text.expressions import (
    IN_DEGREES,
    Expression,
    ExpressionError,
    ExpressionSyntax,
    FunctionOf,
    NumberedVariable,
    Operator,
    Variable,
)

RELATIVE = 1e-12
"""Numbers are equal that differ by a smaller share (manual: comparisons look at relative equality)."""
MOST_ELEMENTS = 32_767
"""Elements of one table."""
_SECOND = 1_000_000.0
"""What the second index of a table counts within its one number."""


def _same(a: float, b: float) -> bool:
    return abs(a - b) <= RELATIVE * max(abs(a), abs(b))


def _equal(a: float, b: float) -> float:
    return 1.0 if _same(a, b) else 0.0


def _unequal(a: float, b: float) -> float:
    return 0.0 if _same(a, b) else 1.0


def _less(a: float, b: float) -> float:
    return 1.0 if a < b and not _same(a, b) else 0.0


def _greater(a: float, b: float) -> float:
    return _less(b, a)


def _at_most(a: float, b: float) -> float:
    return 1.0 if a < b or _same(a, b) else 0.0


def _at_least(a: float, b: float) -> float:
    return _at_most(b, a)


def _whole_quotient(a: float, b: float) -> float:
    return float(math.trunc(a / b))


def _remainder(a: float, b: float) -> float:
    """MOD, which is there for whole numbers (manual)."""
    if a != int(a) or b != int(b):
        raise ValueError(a)
    return math.fmod(a, b)


def _decimal(mantissa: float, exponent: float) -> float:
    """``2.5EX-3``: an exponent of ten."""
    return mantissa * 10.0**exponent


def _element(first: float, second: float) -> float:
    """The two indices of a table's element as one number."""
    if first < 0.0 or second < 0.0 or first != int(first) or second != int(second):
        raise ValueError(first)
    return first + second * _SECOND


_WORDS = (
    "DIV",
    "MOD",
    "B_AND",
    "B_XOR",
    "B_OR",
    "AND",
    "XOR",
    "OR",
    "NOT",
    "B_NOT",
    "EX",
    "TO",
    "OF",
)
_FUNCTIONS = {
    **{name: each for name, each in IN_DEGREES.items() if name != "ATAN"},
    "ATAN2": FunctionOf(arithmetic.direction_of_quotient, 2),
    "POT": FunctionOf(lambda a: a * a),
    "TRUNC": FunctionOf(int),
    "ROUND": FunctionOf(arithmetic.nearest_whole_away),
    "ROUNDUP": FunctionOf(math.ceil),
    "MINVAL": FunctionOf(min, 2),
    "MAXVAL": FunctionOf(max, 2),
    "BOUND": FunctionOf(lambda low, high, a: arithmetic.limited(low, a, high), 3),
}
_CONSTANTS = {"TRUE": 1.0, "FALSE": 0.0}
_RESERVED = "|".join([*_WORDS, *_FUNCTIONS, *_CONSTANTS])
NAME = rf"(?!(?:{_RESERVED})\b)[A-Z_][A-Z_]\w*\b"
"""A variable that the program has defined."""
SYSTEM = r"\$[A-Z_]\w*(?:[ \t]*\[[^\]]*\])?"
"""A variable of the control; what stands in its brackets may be the name of an axis."""

EXPRESSIONS = ExpressionSyntax(
    operators={
        "EX": Operator(10, _decimal),
        "*": Operator(8, operator.mul),
        "/": Operator(8, operator.truediv),
        "DIV": Operator(8, _whole_quotient),
        "MOD": Operator(8, _remainder),
        "+": Operator(7, operator.add),
        "-": Operator(7, operator.sub),
        "B_AND": Operator(6, arithmetic.bits_of_both),
        "B_XOR": Operator(5, arithmetic.bits_of_one_alone),
        "B_OR": Operator(4, arithmetic.bits_of_either),
        "AND": Operator(3, arithmetic.both),
        "XOR": Operator(2, arithmetic.one_alone),
        "OR": Operator(1, arithmetic.either),
        "==": Operator(0, _equal),
        "<>": Operator(0, _unequal),
        "<": Operator(0, _less),
        ">": Operator(0, _greater),
        "<=": Operator(0, _at_most),
        ">=": Operator(0, _at_least),
    },
    functions=_FUNCTIONS,
    constants=_CONSTANTS,
    variable=rf"R[0-9]+(?!\w)|R(?=[ \t]*\[)|{SYSTEM}|{NAME}(?![ \t]*\()",
    brackets="()",
    subscripts="[]",
    joined=_element,
    prefixes={"NOT": operator.not_, "B_NOT": lambda a: ~int(a)},
    spelled=lambda name: re.sub(r"[ \t]", "", name).upper(),
)
"""Comparisons bind least (manual); angles are degrees."""


# --- reading and writing


def read_variable(control: Control, name: str, index: float | None) -> float:
    """Value of ``R5``, ``R[..]``, ``NAME``, ``NAME[..]`` or ``$NAME[..]``."""
    if name.startswith("$"):
        return system_variables.read(control, name)
    if name == "R" and index is not None:
        name, index = f"R{_whole_index(name, index)}", None
    if not is_parameter(name):
        name = _element_name(control, name, index)
    value = control.variables.read(name)
    if value is not None:
        return value
    hint = f"set it before, or in the job: [variables] {name} = 0.0"
    if not is_parameter(name):
        hint = f"define it before: DEF REAL {name}; or give it to the job: [variables] {name} = 0.0"
    raise ExpressionError("unknown-variable", f"{name} has no value", None, hint)


def is_parameter(name: str) -> bool:
    """Whether a name is that of an R parameter, which all of a program shares."""
    return name[0] == "R" and name[1:].isdigit()


def is_local(name: str) -> bool:
    """Whether a variable belongs to the call: those that DEF or PROC have defined (LUD)."""
    return not is_parameter(name)


def _whole_index(name: str, index: float) -> int:
    if index < 0.0 or index != int(index):
        raise ExpressionError("parameter-number", f"there is no {name}[{index:g}]")
    return int(index)


def _element_name(control: Control, name: str, index: float | None) -> str:
    """How an element of a table, or a variable that is none, is called among the control's variables.

    Raises:
        ExpressionError: It is a table without an index, or the table has no such element.
    """
    call = memory_of(control).calls[-1]
    if name in call.texts:
        raise ExpressionError("text-value", f"{name} holds a text, and a number is wanted here")
    size = call.sizes.get(name)
    if size is None and index is None:
        return name
    if size is None or index is None:
        what = "is no table" if size is None else "is a table and needs an index"
        raise ExpressionError("parameter-number", f"{name} {what}", None, f"DEF REAL {name}[10]")
    second, first = divmod(_whole_index(name, index), int(_SECOND))
    if first >= size[0] or second >= size[1]:
        shown = f"{name}[{first},{second}]" if size[1] > 1 else f"{name}[{first}]"
        last = f"{size[0] - 1},{size[1] - 1}" if size[1] > 1 else f"{size[0] - 1}"
        raise ExpressionError("parameter-number", f"there is no {shown}: the last is [{last}]")
    return f"{name}[{first},{second}]"


def write_variable(control: Control, name: str, index: float | None, value: float) -> None:
    """Give a variable a value, as its type holds it.

    Raises:
        ExpressionError: There is no such variable.
    """
    if name.startswith("$"):
        system_variables.write(control, name, value)
        return
    if name == "R" and index is not None:
        name, index = f"R{_whole_index(name, index)}", None
    if not is_parameter(name):
        kind = memory_of(control).calls[-1].types.get(name)
        if kind is None:
            hint = f"define it before: DEF REAL {name}"
            raise ExpressionError("unknown-variable", f"{name} is not defined", None, hint)
        name, value = _element_name(control, name, index), kind.converted(value)
    control.variables.write(name, value)


@dataclasses.dataclass(frozen=True, slots=True)
class Assignment:
    """One assignment of a statement: to what, where that stands, and the values (SET has several)."""

    target: Expression
    column: int
    values: tuple[tuple[Expression, int], ...]
    text: str = ""
    repeats: bool = False


_SEPARATOR = re.compile(r"[ \t]*")
_EQUALS = re.compile(r"[ \t]*=(?!=)[ \t]*")
_QUOTED = re.compile(r'"([^"]*)"')
_MANY = re.compile(r"(SET|REP)[ \t]*\(", re.IGNORECASE)


def assign(control: Control, statement: Statement) -> None:
    """``R1=5 R2=R1+1 NAME[3]=2 TABLE=SET(1,2)``: one after the other."""
    parsed = control.program_counter.parsed(statement, lambda: _assignments(control, statement))
    for each in parsed:
        _assign(control, each)


def _assignments(control: Control, statement: Statement) -> list[Assignment]:
    line = statement.keyword + statement.text
    column, at, found = statement.column, 0, list[Assignment]()
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
        each, at = _value_of(control, line, equals.end(), column, target, column + at)
        found.append(each)
        blanks = _SEPARATOR.match(line, at)
        assert blanks is not None
        at = blanks.end()
    return found


def _value_of(
    control: Control, line: str, at: int, column: int, target: Expression, begin: int
) -> tuple[Assignment, int]:
    quoted, many = _QUOTED.match(line, at), _MANY.match(line, at)
    if quoted is not None:
        return Assignment(target, begin, (), quoted[0]), quoted.end()
    name = target.tree.name if isinstance(target.tree, Variable) else ""
    if memory_of(control).calls[-1].types.get(name) is VariableType.AXIS:
        axis, end = _axis_at(control, line, at, column)
        return Assignment(target, begin, (), axis), end
    if many is None:
        value, end = control.statements.longest(line, at, column)
        return Assignment(target, begin, ((value, column + at),)), end
    closing = line.find(")", many.end())
    if closing < 0:
        control.report.fail("expression", "')' is missing here", column + len(line.rstrip()))
    values = control.statements.expressions(line[many.end() : closing], column + many.end())
    given = tuple((each, column + many.end()) for each in values)
    return Assignment(target, begin, given, repeats=many[1].upper() == "REP"), closing + 1


def _assign(control: Control, each: Assignment) -> None:
    tree, call = each.target.tree, memory_of(control).calls[-1]
    assert isinstance(tree, Variable | NumberedVariable)
    if each.text or call.types.get(tree.name) in TEXTS:
        _assign_text(control, each, tree.name)
        return
    try:
        index = None
        if isinstance(tree, NumberedVariable):
            index = control.compute(Expression("", tree.index), each.column)
        values = [control.compute(value, column) for value, column in each.values]
        if tree.name in call.sizes and (len(values) > 1 or index is None):
            _fill(control, each, tree.name, index or 0.0, values)
        else:
            write_variable(control, tree.name, index, values[0])
    except ExpressionError as error:
        width = len(each.target.text)
        control.report.fail(error.code, str(error), each.column, width, error.hint)


def _fill(control: Control, each: Assignment, name: str, index: float, values: list[float]) -> None:
    """SET(...) gives the elements of a table from one on their values, the last index first; REP all of them one."""
    rows, columns = memory_of(control).calls[-1].sizes[name]
    second, first = divmod(int(index), int(_SECOND))
    begin = first * columns + second
    if not (each.repeats or len(values) > 1) or begin + len(values) > rows * columns:
        message = f"{name} has {rows * columns} elements"
        control.report.fail("assignment", message, each.column, len(name), f"write {name}[0]=5")
    count = rows * columns - begin if each.repeats else len(values)
    for number in range(count):
        row, column = divmod(begin + number, columns)
        value = values[0] if each.repeats else values[number]
        write_variable(control, name, row + column * _SECOND, value)


def _assign_text(control: Control, each: Assignment, name: str) -> None:
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


def _named_text(call: CallFrame, each: Assignment) -> str | None:
    (value, _), *_rest = each.values
    return call.texts.get(value.tree.name) if isinstance(value.tree, Variable) else None


# --- axes


TEXTS = (VariableType.STRING, VariableType.AXIS)
"""Types whose values are texts."""
_AXIS = re.compile(r"\(?[ \t]*(\w+)[ \t]*\)?")


def _axis_at(control: Control, line: str, at: int, column: int) -> tuple[str, int]:
    """The axis that stands in a line, also in brackets, and the place behind it.

    Raises:
        ProgramError: None does.
    """
    match = _AXIS.match(line, at)
    axis = None if match is None else system_variables.axis_named(control, match[1].upper())
    if match is None or axis is None:
        known = ", ".join(control.settings.axes.names)
        message = f"an axis must stand here: {known}"
        control.report.fail("no-such-axis", message, column + at, 1)
    return axis, match.end()


def axis_of_value(control: Control, text: str, column: int) -> str:
    """The axis that a call gives for a parameter of the type AXIS."""
    blanks = len(text) - len(text.lstrip())
    return _axis_at(control, text, blanks, column)[0]


def indexed_axis(control: Control, word: Word) -> str:
    """The axis of ``AX[NAME]=10``.

    Raises:
        ProgramError: There is none.
    """
    name = word.address.partition("[")[2].rstrip("] \t").strip()
    axis = system_variables.axis_named(control, name)
    if axis is None:
        message = f"{name} is no axis, and no variable that holds one"
        control.fail("no-such-axis", message, word, f"DEF AXIS {name}=X")
    return axis


def text_of(word: Word) -> str:
    """The text of a word, upper case, without its quotes."""
    return word.mark.strip('"').strip().upper()


# --- DEF


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
