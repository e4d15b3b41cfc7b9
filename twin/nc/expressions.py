"""Values that a program computes: numbers, variables, operators, functions.

A dialect declares its operators, its functions and how its variables look; reading and computing
are the same for all.
"""

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Protocol

from twin.nc import arithmetic

if TYPE_CHECKING:
    from twin.nc.expression_tree import Tree

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


@dataclasses.dataclass(frozen=True, slots=True)
class Expression:
    """A computed value.

    Attributes:
        text: As the program writes it.
        evaluate: Computes it.
    """

    text: str
    evaluate: "Tree"


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


ARITHMETIC: Mapping[str, Operator] = {
    "+": Operator(5, arithmetic.add),
    "-": Operator(5, arithmetic.subtract),
    "*": Operator(6, arithmetic.multiply),
    "/": Operator(6, arithmetic.divide),
    "MOD": Operator(6, math.fmod),
}
"""Operators that every dialect with expressions has."""

COMPARISON: Mapping[str, Operator] = {
    "<": Operator(4, arithmetic.less),
    ">": Operator(4, arithmetic.greater),
    "<=": Operator(4, arithmetic.at_most),
    ">=": Operator(4, arithmetic.at_least),
}
"""Comparisons that every dialect with expressions has."""
