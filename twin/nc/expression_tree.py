"""Expressions that were read: trees that compute themselves over a ``Scope``.

The general way calls them; the fast way (``translator``) writes them as instructions.
"""

import dataclasses
from collections.abc import Callable

from twin.nc.expressions import ExpressionError, Scope, checked


@dataclasses.dataclass(frozen=True, slots=True)
class Number:
    """A plain number or a constant."""

    value: float

    def __call__(self, _scope: Scope) -> float:
        """Its value."""
        return self.value


@dataclasses.dataclass(frozen=True, slots=True)
class Variable:
    """A variable by its name."""

    name: str

    def __call__(self, scope: Scope) -> float:
        """Its value; raises ``ExpressionError`` where it has none."""
        return scope.read_variable(self.name, None)


@dataclasses.dataclass(frozen=True, slots=True)
class NumberedVariable:
    """A variable by a name and a computed number, such as ``P[P1 + 2]``."""

    name: str
    index: "Tree"

    def __call__(self, scope: Scope) -> float:
        """Its value; raises ``ExpressionError`` where it has none."""
        return scope.read_variable(self.name, self.index(scope))


@dataclasses.dataclass(frozen=True, slots=True)
class Negative:
    """A value with a minus before it."""

    operand: "Tree"

    def __call__(self, scope: Scope) -> float:
        """Its value."""
        return -self.operand(scope)


@dataclasses.dataclass(frozen=True, slots=True)
class Prefixed:
    """A value with a word before it, such as NOT."""

    compute: Callable[[float], float]
    operand: "Tree"

    def __call__(self, scope: Scope) -> float:
        """Its value."""
        return self.compute(self.operand(scope))


@dataclasses.dataclass(frozen=True, slots=True)
class Computed:
    """An operator or a function, called ``what`` in errors, with its operands."""

    what: str
    compute: Callable[..., float]
    operands: tuple["Tree", ...]

    def __call__(self, scope: Scope) -> float:
        """Its value; raises ``ExpressionError`` where it is undefined or too large."""
        values = [each(scope) for each in self.operands]
        try:
            result = self.compute(*values)
        except (ArithmeticError, ValueError) as error:
            raise ExpressionError.undefined(self.what, values) from error
        return checked(result)


@dataclasses.dataclass(frozen=True, slots=True)
class Exists:
    """Whether a value is defined."""

    operand: "Tree"

    def __call__(self, scope: Scope) -> float:
        """1 or 0."""
        try:
            self.operand(scope)
        except ExpressionError:
            return 0.0
        return 1.0


Tree = Number | Variable | NumberedVariable | Negative | Prefixed | Computed | Exists
