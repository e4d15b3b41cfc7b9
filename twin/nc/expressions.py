"""Values that a program computes: numbers, variables, operators, functions.

A dialect declares its operators, its functions and how its variables look; reading and computing
are the same for all. Truth is 1, falsehood 0.
"""

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Protocol

NUMBER = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)"
"""An unsigned number, for regular expressions."""

LARGEST_NUMBER = 1e12
"""Largest magnitude of a value: beyond it neither a coordinate nor a count makes sense."""


class ExpressionError(Exception):
    """An expression cannot be read or computed.

    Attributes:
        code: Code of the diagnostic.
        column: Where in the text, from 0; None when computing.
        hint: What would have worked, or None.
    """

    def __init__(
        self, code: str, message: str, column: int | None = None, hint: str | None = None
    ) -> None:
        super().__init__(message)
        self.code = code
        self.column = column
        self.hint = hint

    @classmethod
    def undefined(cls, what: str, values: Sequence[float]) -> "ExpressionError":
        """An operator or a function has no value there, such as ``1 / 0``."""
        given = " and ".join(f"{value:g}" for value in values)
        return cls("undefined-value", f"{what} is undefined for {given}")


class Scope(Protocol):
    """Where an expression finds its variables."""

    def read_variable(self, name: str, index: float | None) -> float:
        """Value of a variable; ``index`` is the computed one of ``P[...]``, else None.

        Raises:
            ExpressionError: There is no such variable, or it has no value.
        """
        ...


Evaluate = Callable[[Scope], float]


@dataclasses.dataclass(frozen=True, slots=True)
class Expression:
    """A computed value.

    Attributes:
        text: As the program writes it.
        evaluate: Computes it.
    """

    text: str
    evaluate: Evaluate


@dataclasses.dataclass(frozen=True, slots=True)
class Operator:
    """An operator between two values.

    Attributes:
        precedence: Higher binds tighter.
        compute: What it does.
    """

    precedence: int
    compute: Callable[[float, float], float]


@dataclasses.dataclass(frozen=True, slots=True)
class FunctionOf:
    """A function of expressions.

    Attributes:
        compute: What it does.
        arguments: How many it takes.
    """

    compute: Callable[..., float]
    arguments: int = 1


@dataclasses.dataclass(frozen=True, slots=True)
class ExpressionSyntax:
    """How a dialect writes expressions.

    Attributes:
        operators: By symbol or word.
        functions: By name; a function's arguments stand in ``brackets``.
        constants: By name.
        variable: Regular expression of a variable's name.
        indexed: Names that may be followed by an index in brackets, such as ``P``.
        brackets: Opening and closing character.
        existence: Functions that tell whether their value is defined.
        prefixes: Operators before one value, besides + and -.
    """

    operators: Mapping[str, Operator]
    functions: Mapping[str, FunctionOf]
    constants: Mapping[str, float]
    variable: str
    brackets: str
    indexed: tuple[str, ...] = ()
    existence: tuple[str, ...] = ()
    prefixes: Mapping[str, Callable[[float], float]] = dataclasses.field(default_factory=dict)


def checked(value: float) -> float:
    """Refuse a number that no coordinate, count or feed could be.

    Raises:
        ExpressionError: It is not finite or too large.
    """
    if not abs(value) <= LARGEST_NUMBER:
        raise ExpressionError("number-range", f"the value is not within ±{LARGEST_NUMBER:g}")
    return value


def less(left: float, right: float) -> float:
    """1 where ``left`` is below ``right``."""
    return float(left < right)


ARITHMETIC: Mapping[str, Operator] = {
    "+": Operator(5, lambda a, b: a + b),
    "-": Operator(5, lambda a, b: a - b),
    "*": Operator(6, lambda a, b: a * b),
    "/": Operator(6, lambda a, b: a / b),
    "MOD": Operator(6, math.fmod),
}
"""Operators that every dialect with expressions has."""

COMPARISON: Mapping[str, Operator] = {
    "<": Operator(4, less),
    ">": Operator(4, lambda a, b: less(b, a)),
    "<=": Operator(4, lambda a, b: float(a <= b)),
    ">=": Operator(4, lambda a, b: float(a >= b)),
}
"""Comparisons that every dialect with expressions has."""
