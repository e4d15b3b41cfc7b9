"""Expressions and variables of RS274/NGC as LinuxCNC reads them.

Operators are in square brackets: powers bind tightest, then products, sums, comparisons, and the
logical operators, all from left to right. Angles are degrees.
"""

import math
import re

from twin.nc.text import arithmetic
from twin.nc.text.expressions import ExpressionSyntax, FunctionOf, Operator

_VARIABLE = r"#[ \t]*(?:[0-9]+(?![0-9.])|<[^<>#]*>)"


def spelled(name: str) -> str:
    """One spelling of a variable: ``#5``, ``#<depth>``; blanks and capitals do not count."""
    name = re.sub(r"\s", "", name).lower()
    return name if name.startswith("#<") else f"#{int(name[1:])}"


EXPRESSIONS = ExpressionSyntax(
    operators={
        "**": Operator(6, math.pow),
        "*": Operator(5, arithmetic.multiply),
        "/": Operator(5, arithmetic.divide),
        "MOD": Operator(5, arithmetic.positive_remainder),
        "+": Operator(4, arithmetic.add),
        "-": Operator(4, arithmetic.subtract),
        "EQ": Operator(3, arithmetic.nearly_equal),
        "NE": Operator(3, arithmetic.not_nearly_equal),
        "GT": Operator(3, arithmetic.greater),
        "GE": Operator(3, arithmetic.at_least),
        "LT": Operator(3, arithmetic.less),
        "LE": Operator(3, arithmetic.at_most),
        "AND": Operator(2, arithmetic.both),
        "OR": Operator(2, arithmetic.either),
        "XOR": Operator(2, arithmetic.one_alone),
    },
    functions={
        "ABS": FunctionOf(math.fabs),
        "ACOS": FunctionOf(arithmetic.arc_cosine_in_degrees),
        "ASIN": FunctionOf(arithmetic.arc_sine_in_degrees),
        "COS": FunctionOf(arithmetic.cosine_of_degrees),
        "EXP": FunctionOf(math.exp),
        "FIX": FunctionOf(arithmetic.whole_below),
        "FUP": FunctionOf(arithmetic.next_whole),
        "LN": FunctionOf(math.log),
        "ROUND": FunctionOf(arithmetic.nearest_whole_away),
        "SIN": FunctionOf(arithmetic.sine_of_degrees),
        "SQRT": FunctionOf(math.sqrt),
        "TAN": FunctionOf(arithmetic.tangent_of_degrees),
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
