"""Variables and expressions of Fanuc's custom macro B.

#1 to #33 belong to the call, #100 to #199 and #500 to #999 to all programs; #0 never has a value. A
variable without a value is vacant: it counts as 0 where something is computed of it, EQ and NE tell
it from 0, and a word that has it as its value is left out.
"""

import math
import operator
import re

from twin.nc.control.control import Control
from twin.nc.dialects.fanuc.macros import system_variables
from twin.nc.dialects.fanuc.memory import memory_of
from twin.nc.text.blocks import Assignment
from twin.nc.text.expressions import arithmetic
from twin.nc.text.expressions.expressions import (
    ARITHMETIC,
    COMPARISON,
    IN_DEGREES,
    Computed,
    Expression,
    ExpressionError,
    ExpressionSyntax,
    FunctionOf,
    Number,
    Operator,
    Tree,
)

LOCAL = range(1, 34)
COMMON = range(100, 200)
KEPT = range(500, 1000)
"""Variables that keep their value when the control is switched off."""
BY_THOUSANDS = range(10000, 11000)
"""Variables of programs on a Haas."""
_ZEROS = re.compile(r"#0+(?=[0-9])")
_COMPARE = 4

EXPRESSIONS = ExpressionSyntax(
    operators={
        **{symbol: ARITHMETIC[symbol] for symbol in "+-*/"},
        "MOD": Operator(6, arithmetic.remainder_of_wholes),
        "AND": Operator(6, arithmetic.bits_of_both),
        "OR": Operator(5, arithmetic.bits_of_either),
        "XOR": Operator(5, arithmetic.bits_of_one_alone),
        "EQ": Operator(_COMPARE, arithmetic.equal_or_vacant),
        "NE": Operator(_COMPARE, arithmetic.unequal_or_vacant),
        "GT": COMPARISON[">"],
        "GE": COMPARISON[">="],
        "LT": COMPARISON["<"],
        "LE": COMPARISON["<="],
    },
    functions={
        **IN_DEGREES,
        "ASIN": FunctionOf(arithmetic.arc_sine_from_zero),
        "SQR": FunctionOf(math.sqrt),
        "ROUND": FunctionOf(arithmetic.nearest_whole_away),
        "RND": FunctionOf(arithmetic.nearest_whole_away),
        "FIX": FunctionOf(int),
        "FUP": FunctionOf(lambda a: math.ceil(a) if a >= 0.0 else math.floor(a)),
        "POW": FunctionOf(math.pow, 2),
        "BIN": FunctionOf(arithmetic.from_binary_decimal),
        "BCD": FunctionOf(arithmetic.to_binary_decimal),
    },
    constants={},
    variable="#[0-9]+",
    spelled=lambda name: _ZEROS.sub("#", name),
    indirect="#",
    quotients={"ATAN": arithmetic.direction_from_zero},
    brackets="[]",
    bracketed=True,
    one_sign=True,
    vacant=True,
    of_vacant=("EQ", "NE"),
    exclusive=("EQ", "NE", "GT", "GE", "LT", "LE"),
    shortest_name=2,
)
"""Angles are degrees."""

_ROUNDING = (arithmetic.nearest_whole_away,)


def is_local(name: str) -> bool:
    """Whether a variable belongs to the call, not to all programs."""
    return name.startswith("#") and name[1:].isdigit() and int(name[1:]) in LOCAL


def _number(name: str, index: float | None) -> int:
    """The number of ``#5`` or of ``#[...]``, whose computed number is given."""
    if index is None:
        return int(name[1:])
    if math.isnan(index) or index < 0.0 or index != int(index):
        raise ExpressionError("parameter-number", f"there is no variable #[{index:g}]")
    return int(index)


def _stored(control: Control, number: int) -> int | None:
    """Under which number a variable of programs is stored; None: it belongs to the control.

    On a Haas #10000 to #10999 belong to programs too, and #10100 is another name of #100.
    """
    if number in BY_THOUSANDS and memory_of(control).variant.common_by_thousands:
        short = number - BY_THOUSANDS[0]
        return short if short in COMMON or short in KEPT else number
    return number if number in LOCAL or number in COMMON or number in KEPT else None


def read_variable(control: Control, name: str, index: float | None) -> float:
    """Value of a variable; NaN where it is vacant."""
    number = _number(name, index)
    if number == 0:
        return math.nan
    stored = _stored(control, number)
    if stored is not None:
        value = control.variables.read(f"#{stored}")
        if value is None and stored in KEPT:
            message = f"#{stored} keeps its value from earlier runs, which is not known: it is vacant here"
            hint = f'set it before, or in the job: [variables] "#{stored}" = 0.0'
            control.report.warn_once("vacant-variable", message, hint=hint)
        return math.nan if value is None else value
    given = control.settings.variables.get(f"#{number}")
    return system_variables.read(control, number) if given is None else given


def write_variable(
    control: Control, name: str, index: float | None, value: float, assignment: Assignment
) -> None:
    """Give a variable a value; NaN leaves it vacant."""
    try:
        number = _number(name, index)
        stored = _stored(control, number)
        if stored is not None:
            control.variables.write(f"#{stored}", value)
        else:
            system_variables.write(control, number, value)
    except ExpressionError as error:
        control.report.fail(error.code, str(error), assignment.column, assignment.width, error.hint)


def rounds(expression: Expression) -> bool:
    """Whether ROUND is in it."""
    return not expression.functions.isdisjoint(_ROUNDING)


def rounding_to(expression: Expression, increment: float) -> Expression:
    """The value of a word, whose ROUND goes to the least increment (manual)."""
    return Expression(expression.text, _rounding_to(expression.tree, increment))


def _rounding_to(tree: Tree, increment: float) -> Tree:
    if not isinstance(tree, Computed):
        return tree
    operands = tuple(_rounding_to(each, increment) for each in tree.operands)
    if tree.compute not in _ROUNDING:
        return Computed(tree.what, tree.compute, operands)
    shares = Computed("/", operator.truediv, (operands[0], Number(increment)))
    nearest = Computed(tree.what, tree.compute, (shares,))
    return Computed("*", operator.mul, (nearest, Number(increment)))
