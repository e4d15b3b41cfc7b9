"""Variables and jumps of CODESYS SoftMotion."""

import dataclasses
import math
import re
from collections.abc import Mapping

from twin.nc.bytecode.registers import RADIUS_GIVEN
from twin.nc.control.control import Control
from twin.nc.geometry.planes import Vector
from twin.nc.path.blends import BlendKind
from twin.nc.text import arithmetic
from twin.nc.text.blocks import Statement, Word
from twin.nc.text.expressions import (
    ARITHMETIC,
    COMPARISON,
    Expression,
    ExpressionError,
    ExpressionSyntax,
    FunctionOf,
    Operator,
)

COUNTER = "$"
"""The decoder's internal variable among the others, as no program writes it."""
COUNTER_AT_START = -1.0
"""Its value before G36 sets it (manual): a bare G20 L jumps."""

EXPRESSIONS = ExpressionSyntax(
    operators={
        **ARITHMETIC,
        **COMPARISON,
        "=": Operator(3, arithmetic.equal),
        "<>": Operator(3, arithmetic.unequal),
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
        "TRUNC": FunctionOf(arithmetic.whole_part),
        "EXPT": FunctionOf(math.pow, 2),
        "MIN": FunctionOf(arithmetic.smaller, 2),
        "MAX": FunctionOf(arithmetic.larger, 2),
        "LIMIT": FunctionOf(arithmetic.limited, 3),
        "SEL": FunctionOf(arithmetic.chosen, 3),
    },
    constants={"PI": math.pi, "TRUE": 1.0, "FALSE": 0.0},
    variable=r"\$[A-Z_][\w.]*\$|#[A-Z_]\w*",
    brackets="()",
    prefixes={"NOT": arithmetic.opposite},
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
class Subprogram:
    """A subprogram's heading.

    Attributes:
        lines: Those between its heading and its end, from 0.
        formals: Names of its parameters.
        restores: It puts modal codes back when it returns.
    """

    lines: range
    formals: tuple[str, ...]
    restores: bool


@dataclasses.dataclass(slots=True)
class Variables:
    """What a program knows by name.

    Attributes:
        tool_radius: The last D of G41 or G42 [mm].
        length_ramp: What G43 has changed and no move has led into yet [mm].
        smoothing: Distance from a corner at which its moves are cut [mm].
        smoothed_by: What takes the corners' place; None: nothing.
        rapid_feed: FF as programmed, 0 where it is not.
        periods: Modulo periods of additional axes by column [mm or deg].
        subprograms: By name; None before the program was searched for them.
    """

    tool_radius: float = 0.0
    length_ramp: Vector = (0.0, 0.0, 0.0)
    smoothing: float = 0.0
    smoothed_by: BlendKind | None = None
    rapid_feed: float = 0.0
    periods: dict[int, float] = dataclasses.field(default_factory=dict)
    subprograms: dict[str, Subprogram] | None = None


def variables(control: Control) -> Variables:
    """The dialect's memory."""
    assert isinstance(control.memory, Variables)
    return control.memory


def acts_on_plain_blocks(control: Control) -> bool:
    """A period, or a length that the next move leads into: plain blocks heed them."""
    memory = variables(control)
    return bool(memory.periods) or any(memory.length_ramp)


def read_variable(control: Control, name: str, _index: float | None) -> float:
    """Value of ``$name$`` or ``#name``; application variables may come from the job."""
    value = control.variables.read(name)
    if value is not None:
        return value
    if name.startswith("#"):
        raise ExpressionError(
            "unknown-variable", f"{name} is not declared", None, f"write LET {name} : LREAL"
        )
    raise ExpressionError(
        "unknown-variable",
        f"the application's variable {name} has no value",
        None,
        f"give it one in the job: [variables] {name.strip('$')} = 0.0",
    )


def registers(control: Control) -> dict[int, float]:
    """What the compiled tier is given of the memory."""
    return {RADIUS_GIVEN: variables(control).tool_radius}


def take_registers(control: Control, values: list[float]) -> None:
    """Take it back."""
    variables(control).tool_radius = values[RADIUS_GIVEN]


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


def declaration(control: Control, statement: Statement) -> tuple[str, Expression | None, int]:
    """What LET declares: name, value or None, and where that stands.

    Raises:
        ProgramError: It cannot be read.
    """
    match = _LET.match(statement.text)
    if match is None:
        control.report.fail(
            "declaration", "LET needs a variable", statement.column, 3, "LET #x : LREAL := 1"
        )
    rest, column = statement.text[match.end() :], statement.text_column + match.end()
    value = None
    if match[2]:
        value = control.expression(rest, column)
    elif rest.strip():
        control.report.fail("declaration", "this cannot follow a declaration", column)
    return match[1].upper(), value, column


def let(control: Control, statement: Statement) -> None:
    """LET: declare a local variable, 0 unless it is given a value."""
    name, value, column = declaration(control, statement)
    control.variables.write(name, 0.0 if value is None else control.compute(value, column))


def assigned(control: Control, statement: Statement) -> tuple[str, Expression, int]:
    """What ``#x := value`` assigns: name, value, and where that stands."""
    text, column = statement.text.lstrip()[2:], statement.text_column + 2
    return statement.keyword.strip(), control.expression(text, column), column


def assign(control: Control, statement: Statement) -> None:
    """``#x := value``."""
    name = statement.keyword.strip()
    if control.variables.read(name) is None:
        hint = f"write LET {name} : LREAL"
        control.report.fail(
            "unknown-variable", f"{name} is not declared", statement.column, len(name), hint
        )
    _, value, column = assigned(control, statement)
    control.variables.write(name, control.compute(value, column))


def reference(control: Control, word: Word | None) -> str:
    """The variable that O names; without O the internal one."""
    if word is None:
        return COUNTER
    name = word.value.text.upper() if isinstance(word.value, Expression) else ""
    if not re.fullmatch(EXPRESSIONS.variable, name, re.IGNORECASE):
        control.fail("variable-name", "O must name a variable", word, "write O$name$ or O#name")
    return name


def _store(control: Control, name: str, change: float, *, add: bool) -> None:
    must_exist = add or name.startswith("#")
    try:
        before = read_variable(control, name, None) if must_exist else 0.0
    except ExpressionError as error:
        control.fail(error.code, str(error), None, error.hint)
    control.variables.write(name, before + change if add else change)


def write_variable(control: Control) -> None:
    """G36: variable O, or the internal one, gets the value D."""
    _change(control, add=False)


def add_to_variable(control: Control) -> None:
    """G37: D is added to variable O, or to the internal one."""
    _change(control, add=True)


def _change(control: Control, *, add: bool) -> None:
    name, word = reference(control, control.take("O")), control.take("D")
    if word is None:
        control.fail("variable-value", "the code needs its value D")
    _store(control, name, control.number(word), add=add)
