"""Values that a program computes: numbers, variables, operators, functions.

A dialect declares its operators, its functions and how its variables look; reading and computing
are the same for all.
"""

import dataclasses
import math
import operator
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Protocol

LARGEST_NUMBER = 1e12
"""Largest magnitude of a value: beyond it neither a coordinate nor a count makes sense."""


class ExpressionError(Exception):
    """An expression cannot be read or computed.

    Attributes:
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

    @classmethod
    def too_large(cls) -> "ExpressionError":
        """A value is not finite, or no coordinate, count or feed could be so large."""
        return cls("number-range", f"the value is not within ±{LARGEST_NUMBER:g}")


class Scope(Protocol):
    """Where an expression finds its variables."""

    def read_variable(self, name: str, index: float | None) -> float:
        """Value of a variable; ``index`` is the computed one of ``P[...]``, else None.

        Raises:
            ExpressionError: There is no such variable, or it has no value; where the syntax knows
                vacant variables, the value of one is NaN.
        """
        ...


@dataclasses.dataclass(frozen=True, slots=True)
class Expression:
    """A computed value.

    Attributes:
        compute: Its value in a scope; raises ``ExpressionError`` where it has none.
        functions: What its operators and functions compute.
    """

    text: str
    tree: "Tree"
    compute: "Compute" = dataclasses.field(init=False, compare=False, repr=False)
    functions: frozenset[Callable[..., float]] = dataclasses.field(
        init=False, compare=False, repr=False
    )

    def __post_init__(self) -> None:
        object.__setattr__(self, "compute", compiled(self.tree))
        object.__setattr__(self, "functions", frozenset(_functions(self.tree)))


@dataclasses.dataclass(frozen=True, slots=True)
class Operator:
    """An operator between two values.

    Attributes:
        precedence: Higher binds tighter.
    """

    precedence: int
    compute: Callable[[float, float], float]


@dataclasses.dataclass(frozen=True, slots=True)
class FunctionOf:
    """A function of expressions."""

    compute: Callable[..., float]
    arguments: int = 1


@dataclasses.dataclass(frozen=True, slots=True)
class ExpressionSyntax:
    """How a dialect writes expressions.

    Attributes:
        functions: By name; a function's arguments are in ``brackets``.
        variable: Regular expression of a variable's name.
        indexed: Names that may be followed by an index in brackets, such as ``P``.
        subscripts: Opening and closing character of the indices behind a variable, such as ``A[1,2]``; empty: it
            has none but those of ``indexed``.
        joined: Two such indices as one number.
        existence: Functions that tell whether their value is defined.
        prefixes: Operators before one value, besides + and -.
        spelled: One spelling for all forms of a variable's name.
        indirect: Character before a value that is a variable's number, such as ``#[#1+2]``; empty:
            there is none.
        quotients: Functions of two values, each in brackets, with a slash between them.
        one_sign: No sign follows a sign, unless a bracket is between them.
        bracketed: Operators are within brackets only, so that a word's value is one operand.
        vacant: A variable without a value counts as 0 where something is computed of it; alone it
            leaves its word out.
        of_vacant: Operators that see that a variable has no value.
        exclusive: Operators that need brackets where one follows another.
        shortest_name: Letters of a function's name that suffice; 0: it is written in full.
    """

    operators: Mapping[str, Operator]
    functions: Mapping[str, FunctionOf]
    constants: Mapping[str, float]
    variable: str
    brackets: str
    indexed: tuple[str, ...] = ()
    subscripts: str = ""
    joined: Callable[[float, float], float] = operator.add
    existence: tuple[str, ...] = ()
    prefixes: Mapping[str, Callable[[float], float]] = dataclasses.field(default_factory=dict)
    spelled: Callable[[str], str] = str.upper
    indirect: str = ""
    quotients: Mapping[str, Callable[[float, float], float]] = dataclasses.field(
        default_factory=dict
    )
    bracketed: bool = False
    one_sign: bool = False
    vacant: bool = False
    of_vacant: tuple[str, ...] = ()
    exclusive: tuple[str, ...] = ()
    shortest_name: int = 0

    def full_name(self, name: str) -> str:
        """The function that a name means, where the dialect lets it be shortened."""
        if len(name) != self.shortest_name:
            return name
        return next((full for full in self.functions if full.startswith(name)), name)


ARITHMETIC: Mapping[str, Operator] = {
    "+": Operator(5, operator.add),
    "-": Operator(5, operator.sub),
    "*": Operator(6, operator.mul),
    "/": Operator(6, operator.truediv),
    "MOD": Operator(6, math.fmod),
}
"""Operators that every dialect with expressions has."""

COMPARISON: Mapping[str, Operator] = {
    "<": Operator(4, operator.lt),
    ">": Operator(4, operator.gt),
    "<=": Operator(4, operator.le),
    ">=": Operator(4, operator.ge),
}
"""Comparisons that every dialect with expressions has."""

IN_DEGREES: Mapping[str, FunctionOf] = {
    "SIN": FunctionOf(lambda a: math.sin(math.radians(a))),
    "COS": FunctionOf(lambda a: math.cos(math.radians(a))),
    "TAN": FunctionOf(lambda a: math.tan(math.radians(a))),
    "ASIN": FunctionOf(lambda a: math.degrees(math.asin(a))),
    "ACOS": FunctionOf(lambda a: math.degrees(math.acos(a))),
    "ATAN": FunctionOf(lambda a: math.degrees(math.atan(a))),
    "SQRT": FunctionOf(math.sqrt),
    "ABS": FunctionOf(math.fabs),
    "LN": FunctionOf(math.log),
    "EXP": FunctionOf(math.exp),
}
"""Functions that most dialects have; their angles are degrees."""


@dataclasses.dataclass(frozen=True, slots=True)
class Number:
    """A plain number or a constant."""

    value: float


@dataclasses.dataclass(frozen=True, slots=True)
class Variable:
    """A variable by its name."""

    name: str


@dataclasses.dataclass(frozen=True, slots=True)
class NumberedVariable:
    """A variable by a name and a computed number, such as ``P[P1 + 2]``."""

    name: str
    index: "Tree"


@dataclasses.dataclass(frozen=True, slots=True)
class OrZero:
    """A variable, or 0 where it has no value."""

    operand: "Variable | NumberedVariable"


@dataclasses.dataclass(frozen=True, slots=True)
class Negative:
    """A value with a minus before it."""

    operand: "Tree"


@dataclasses.dataclass(frozen=True, slots=True)
class Computed:
    """An operator or a function, called ``what`` in errors, with its operands."""

    what: str
    compute: Callable[..., float]
    operands: tuple["Tree", ...]


@dataclasses.dataclass(frozen=True, slots=True)
class Exists:
    """Whether a value is defined: 1 or 0."""

    operand: "Tree"


Tree = Number | Variable | NumberedVariable | OrZero | Negative | Computed | Exists

Compute = Callable[[Scope], float]
"""A value in a scope."""


def _functions(tree: Tree) -> Iterator[Callable[..., float]]:
    match tree:
        case Computed(_, compute, operands):
            yield compute
            for each in operands:
                yield from _functions(each)
        case NumberedVariable(_, operand) | OrZero(operand) | Negative(operand) | Exists(operand):
            yield from _functions(operand)
        case _:
            pass


def compiled(tree: Tree) -> Compute:
    """A tree as a function of the scope, built once from functions of its parts."""
    match tree:
        case Number(value):
            return lambda _scope: value
        case Variable(name):
            return lambda scope: float(scope.read_variable(name, None))
        case NumberedVariable(name, index):
            at = compiled(index)
            return lambda scope: float(scope.read_variable(name, at(scope)))
        case OrZero(operand):
            vacant = compiled(operand)
            return lambda scope: value if (value := vacant(scope)) == value else 0.0
        case Negative(operand):
            positive = compiled(operand)
            return lambda scope: -positive(scope)
        case Exists(operand):
            return _existence(compiled(operand))
        case Computed(what, function, operands):
            return _computation(what, function, tuple(map(compiled, operands)))


def _existence(value: Compute) -> Compute:
    def exists(scope: Scope) -> float:
        try:
            value(scope)
        except ExpressionError:
            return 0.0
        return 1.0

    return exists


def _computation(
    what: str, function: Callable[..., float], operands: tuple[Compute, ...]
) -> Compute:
    """A function of values; of a first value that is not there (NaN) the result may be NaN too."""

    def one(scope: Scope) -> float:
        a = first(scope)
        try:
            value = float(function(a))
        except (ArithmeticError, ValueError):
            value = math.nan
        return value if -LARGEST_NUMBER <= value <= LARGEST_NUMBER else checked(value, (a,))

    def two(scope: Scope) -> float:
        a, b = first(scope), second(scope)
        try:
            value = float(function(a, b))
        except (ArithmeticError, ValueError):
            value = math.nan
        return value if -LARGEST_NUMBER <= value <= LARGEST_NUMBER else checked(value, (a, b))

    def several(scope: Scope) -> float:
        values = [operand(scope) for operand in operands]
        try:
            value = float(function(*values))
        except (ArithmeticError, ValueError):
            value = math.nan
        return checked(value, values)

    def checked(value: float, values: Sequence[float]) -> float:
        if not abs(value) <= LARGEST_NUMBER:
            if value == value:
                raise ExpressionError.too_large()
            if values[0] == values[0]:
                raise ExpressionError.undefined(what, values)
        return value

    if len(operands) == 1:
        (first,) = operands
        return one
    if len(operands) == 2:
        first, second = operands
        return two
    return several
