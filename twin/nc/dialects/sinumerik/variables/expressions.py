"""Expressions of the SINUMERIK: operators by their priority, functions, names of variables, values in brackets."""

import math
import operator
import re

from twin.nc.control.control import Control
from twin.nc.text.expressions import arithmetic
from twin.nc.text.expressions.expressions import IN_DEGREES, ExpressionSyntax, FunctionOf, Operator

RELATIVE = 1e-12
"""Numbers are equal that differ by a smaller share (manual: comparisons look at relative equality)."""
SECOND = 1_000_000.0
"""What the second index of a table counts within its one number."""


def _same(a: float, b: float) -> bool:
    return abs(a - b) <= RELATIVE * max(abs(a), abs(b))


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
    return first + second * SECOND


_WORDS = (
    *("DIV", "MOD", "B_AND", "B_XOR", "B_OR", "AND", "XOR", "OR", "NOT", "B_NOT", "EX", "TO", "OF"),
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
CONSTANT = r"'H[0-9A-F]+'|'B[01]+'"
"""A whole number by its digits to the base 16 or 2."""
SYSTEM = r"\$[A-Z_]\w*(?:[ \t]*\[[^\]]*\])?"
"""A variable of the control; what is in its brackets may be the name of an axis."""

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
        "==": Operator(0, _same),
        "<>": Operator(0, lambda a, b: not _same(a, b)),
        "<": Operator(0, lambda a, b: a < b and not _same(a, b)),
        ">": Operator(0, lambda a, b: a > b and not _same(a, b)),
        "<=": Operator(0, lambda a, b: a < b or _same(a, b)),
        ">=": Operator(0, lambda a, b: a > b or _same(a, b)),
    },
    functions=_FUNCTIONS,
    constants=_CONSTANTS,
    variable=rf"{CONSTANT}|R[0-9]+(?!\w)|R(?=[ \t]*\[)|{SYSTEM}|{NAME}(?![ \t]*\()",
    brackets="()",
    subscripts="[]",
    joined=_element,
    prefixes={"NOT": operator.not_, "B_NOT": lambda a: ~int(a)},
    spelled=lambda name: re.sub(r"[ \t]", "", name).upper(),
)
"""Comparisons bind least (manual); angles are degrees."""


def split_values(text: str) -> list[tuple[str, int]]:
    """The texts between the commas outside brackets and quotes, with their places."""
    found, depth, begin, quoted = list[tuple[str, int]](), 0, 0, False
    for at, character in enumerate(text):
        if character == '"':
            quoted = not quoted
        elif quoted:
            continue
        elif character in "([":
            depth += 1
        elif character in ")]":
            depth -= 1
        elif character == "," and depth == 0:
            found.append((text[begin:at], begin))
            begin = at + 1
    return [*found, (text[begin:], begin)]


def bracketed(control: Control, text: str, column: int) -> tuple[str, int, int]:
    """The text within the brackets that begin a text, its column, and the place behind them."""
    at = len(text) - len(text.lstrip())
    if text[at : at + 1] != "(":
        return "", column + at, at
    depth, quoted, end = 0, False, at
    while depth > 0 or end == at:
        if end == len(text):
            hint = "write ) where its bracket ends"
            at = column + len(text.rstrip())
            control.report.fail("expression", "')' is missing here", at, hint=hint)
        character = text[end]
        quoted ^= character == '"'
        depth += 0 if quoted else (character == "(") - (character == ")")
        end += 1
    return text[at + 1 : end - 1], column + at + 1, end
