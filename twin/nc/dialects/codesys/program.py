"""Variables and jumps of CODESYS SoftMotion."""

import dataclasses
import math
import operator
import re
from collections.abc import Mapping

from twin.nc.control.control import Control
from twin.nc.geometry.planes import Vector
from twin.nc.path.blends import BlendKind
from twin.nc.text.blocks import Statement, Word
from twin.nc.text.expressions import arithmetic
from twin.nc.text.expressions.expressions import (
    ARITHMETIC,
    COMPARISON,
    Computed,
    Expression,
    ExpressionError,
    ExpressionSyntax,
    FunctionOf,
    Number,
    Operator,
    Variable,
)

COUNTER = "$"
"""The decoder's internal variable among the others, as no program writes it."""
COUNTER_AT_START = -1.0
"""Its value before G36 sets it (manual): a bare G20 L jumps."""

EXPRESSIONS = ExpressionSyntax(
    operators={
        **ARITHMETIC,
        **COMPARISON,
        "=": Operator(3, operator.eq),
        "<>": Operator(3, operator.ne),
        "AND": Operator(2, arithmetic.both),
        "XOR": Operator(1, arithmetic.one_alone),
        "OR": Operator(0, arithmetic.either),
    },
    functions={
        "SIN": FunctionOf(math.sin),
        "COS": FunctionOf(math.cos),
        "TAN": FunctionOf(math.tan),
        "ASIN": FunctionOf(math.asin),
        "ACOS": FunctionOf(math.acos),
        "ATAN": FunctionOf(math.atan),
        "ABS": FunctionOf(math.fabs),
        "SQRT": FunctionOf(math.sqrt),
        "EXP": FunctionOf(math.exp),
        "LN": FunctionOf(math.log),
        "LOG": FunctionOf(math.log10),
        "TRUNC": FunctionOf(int),
        "EXPT": FunctionOf(math.pow, 2),
        "MIN": FunctionOf(min, 2),
        "MAX": FunctionOf(max, 2),
        "LIMIT": FunctionOf(arithmetic.limited, 3),
        "SEL": FunctionOf(lambda choice, no, yes: yes if choice != 0.0 else no, 3),
    },
    constants={"PI": math.pi, "TRUE": 1.0, "FALSE": 0.0},
    variable=r"\$[A-Z_][\w.]*\$|#[A-Z_]\w*",
    brackets="()",
    prefixes={"NOT": operator.not_},
)
"""Angles of functions are radians, as IEC 61131-3 has them."""

STATEMENT = (
    r"LET\b|END_SUBPROGRAM\b|SUBPROGRAM\b|RETURN\b"
    r"|#[A-Z_]\w*[ \t]*(?=:=)|[A-Z_]\w*(?=[ \t]*\{)|[A-Z_]{3,}\w*(?=[ \t]*\()"
)

_LET = re.compile(
    r"[ \t]*(#[A-Z_]\w*)[ \t]*(?::[ \t]*(?:L?REAL|BOOL|[DU]?INT))?[ \t]*(:=)?", re.IGNORECASE
)


@dataclasses.dataclass(frozen=True, slots=True)
class SubprogramHeading:
    """A subprogram's heading.

    Attributes:
        lines: Those between its heading and its end, from 0.
        restores: It puts modal codes back when it returns.
    """

    lines: range
    formals: tuple[str, ...]
    restores: bool


@dataclasses.dataclass(slots=True)
class CodesysMemory:
    """What the dialect keeps in addition to the state that all have in common.

    Attributes:
        radius: That D has given compensation last [mm].
        length_ramp: What G43 has changed and no move has led into yet [mm].
        smoothing: Distance from a corner at which its moves are cut [mm].
        smoothed_by: What takes the corners' place; None: nothing.
        periods: Modulo periods of additional axes by column [mm or deg].
        subprograms: By name; None before the program was searched for them.
    """

    radius: float = 0.0
    length_ramp: Vector = (0.0, 0.0, 0.0)
    smoothing: float = 0.0
    smoothed_by: BlendKind | None = None
    periods: dict[int, float] = dataclasses.field(default_factory=dict)
    subprograms: dict[str, SubprogramHeading] | None = None


def memory_of(control: Control) -> CodesysMemory:
    """The dialect's memory."""
    assert isinstance(control.memory, CodesysMemory)
    return control.memory


def acts_on_lines(control: Control) -> bool:
    """A period, or a length that the next move leads into."""
    memory = memory_of(control)
    return bool(memory.periods) or any(memory.length_ramp)


def read_variable(control: Control, name: str, _index: float | None) -> float:
    """Value of ``$name$`` or ``#name``; application variables may come from the job."""
    value = control.variables.read(name)
    if value is not None:
        return value
    if name.startswith("#"):
        message = f"{name} is not declared"
        raise ExpressionError("unknown-variable", message, None, f"write LET {name} : LREAL")
    message = f"the application's variable {name} has no value"
    hint = f"give it one in the job: [variables] {name.strip('$')} = 0.0"
    raise ExpressionError("unknown-variable", message, None, hint)


def is_local(name: str) -> bool:
    """Whether a variable belongs to the call; those of the application belong to none."""
    return not name.startswith("$")


def given_variable(given: Mapping[str, float], name: str) -> float | None:
    """The job's value of a variable: of the application's and of the internal one."""
    if name == COUNTER:
        return COUNTER_AT_START
    if name.startswith("$"):
        for each, value in given.items():
            if each.strip("$").upper() == name.strip("$"):
                return value
    return None


def let(control: Control, statement: Statement) -> None:
    """LET: declare a local variable, 0 unless it is given a value."""
    match = _LET.match(statement.text)
    if match is None:
        hint = "LET #x : LREAL := 1"
        control.report.fail("declaration", "LET needs a variable", statement.column, 3, hint)
    rest, column = statement.text[match.end() :], statement.text_column + match.end()
    value = 0.0
    if match[2]:
        value = control.compute(control.statements.expression(rest, column), column)
    elif rest.strip():
        hint = "LET #x : LREAL := 1"
        control.report.fail("declaration", "this cannot follow a declaration", column, 1, hint)
    control.variables.write(match[1].upper(), value)


def assign(control: Control, statement: Statement) -> None:
    """``#x := value``."""
    name = statement.keyword.strip()
    text, column = statement.text.lstrip()[2:], statement.text_column + 2
    value = control.compute(control.statements.expression(text, column), column)
    _require_declared(control, name, statement)
    control.variables.write(name, value)


def _require_declared(control: Control, name: str, error_at: Statement | None = None) -> None:
    """A local variable must have been declared."""
    if name.startswith("#") and control.variables.read(name) is None:
        hint = f"write LET {name} : LREAL"
        control.fail("unknown-variable", f"{name} is not declared", error_at, hint)


def _reference(control: Control, word: Word | None) -> str:
    """The variable that O names; without O the internal one."""
    if word is None:
        return COUNTER
    name = word.value.text.upper() if isinstance(word.value, Expression) else ""
    if not re.fullmatch(EXPRESSIONS.variable, name, re.IGNORECASE):
        control.fail("variable-name", "O must name a variable", word, "write O$name$ or O#name")
    return name


def write_variable(control: Control) -> None:
    """G36: variable O, or the internal one, gets the value D."""
    name = _reference(control, control.take("O"))
    value = control.number(_value_word(control))
    _require_declared(control, name)
    control.variables.write(name, value)


def add_to_variable(control: Control) -> None:
    """G37: D is added to variable O, or to the internal one."""
    name, word = _reference(control, control.take("O")), _value_word(control)
    total = Computed("+", operator.add, (Variable(name), Number(control.number(word))))
    control.variables.write(name, control.compute(Expression(name, total), word))


def _value_word(control: Control) -> Word:
    word = control.take("D")
    if word is None:
        control.fail("variable-value", "the code needs its value D", hint="write D5")
    return word
