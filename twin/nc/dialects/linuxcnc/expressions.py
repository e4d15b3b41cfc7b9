"""Expressions and variables of RS274/NGC as LinuxCNC reads them.

Operators are in square brackets: powers bind tightest, then products, sums, comparisons, and the
logical operators, all from left to right. Angles are degrees.
"""

import math
import operator
import re

from twin.nc.text import arithmetic
from twin.nc.text.expressions import IN_DEGREES, ExpressionSyntax, FunctionOf, Operator

_SAME_NUMBER = 0.0001
"""Numbers that differ by less are equal for EQ and NE (LinuxCNC)."""
_VARIABLE = r"#[ \t]*(?:[0-9]+(?![0-9.])|<[^<>#]*>)"


def spelled(name: str) -> str:
    """One spelling of a variable: ``#5``, ``#<depth>``; blanks and capitals do not count."""
    name = re.sub(r"\s", "", name).lower()
    return name if name.startswith("#<") else f"#{int(name[1:])}"


EXPRESSIONS = ExpressionSyntax(
    operators={
        "**": Operator(6, math.pow),
        "*": Operator(5, operator.mul),
        "/": Operator(5, operator.truediv),
        "MOD": Operator(5, arithmetic.positive_remainder),
        "+": Operator(4, operator.add),
        "-": Operator(4, operator.sub),
        "EQ": Operator(3, lambda a, b: abs(a - b) < _SAME_NUMBER),
        "NE": Operator(3, lambda a, b: not abs(a - b) < _SAME_NUMBER),
        "GT": Operator(3, operator.gt),
        "GE": Operator(3, operator.ge),
        "LT": Operator(3, operator.lt),
        "LE": Operator(3, operator.le),
        "AND": Operator(2, arithmetic.both),
        "OR": Operator(2, arithmetic.either),
        "XOR": Operator(2, arithmetic.one_alone),
    },
    functions={
        **{name: each for name, each in IN_DEGREES.items() if name != "ATAN"},
        "FIX": FunctionOf(math.floor),
        "FUP": FunctionOf(math.ceil),
        "ROUND": FunctionOf(arithmetic.nearest_whole_away),
    },
    constants={},
    variable=_VARIABLE,
    brackets="[]",
    existence=("EXISTS",),
    spelled=spelled,
    indirect="#",
    quotients={"ATAN": arithmetic.direction_of_quotient},
    bracketed=True,
)
"""Angles are degrees."""
