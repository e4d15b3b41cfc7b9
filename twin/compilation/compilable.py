"""Functions of two speeds: CPython runs them as they stand, kernels compile them into themselves.

To declare one costs nothing: Numba is loaded by the first kernel, and with it what was declared
becomes known to the compiler. Such a function has one source for both speeds, and no compiled form
of its own: it is compiled once, as a part of the kernels that call it.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])


class Declared(NamedTuple):
    """A function that kernels may call.

    Attributes:
        called: What stands in their text.
        compiled: What is compiled for it.
        options: Of the compiler.
    """

    called: Callable[..., Any]
    compiled: Callable[..., Any]
    options: Mapping[str, Any]


_declared: list[Declared] = []
_ARITHMETIC: Mapping[str, Any] = {"_nrt": False, "error_model": "numpy"}
"""An undefined value is infinity or NaN, and raises nothing."""


def compilable(function: Function) -> Function:
    """Let kernels compile a function that makes no array."""
    _declared.append(Declared(function, function, {"_nrt": False}))
    return function


def compilable_as(compiled: Function) -> Callable[[Function], Function]:
    """Let kernels compile another function in the place of one that only CPython can run fast."""

    def declare(function: Function) -> Function:
        _declared.append(Declared(function, compiled, {"_nrt": False}))
        return function

    return declare


def inlined(function: Function) -> Function:
    """Let kernels compile a function that makes no array into each function that calls it.

    A call hands over hundreds of values, one for each size and step of a column, which may take
    longer than the block that is run.
    """
    _declared.append(Declared(function, function, {"_nrt": False, "forceinline": True}))
    return function


def compilable_choice(functions: Sequence[Callable[..., float]]) -> Callable[..., float]:
    """One function that calls the one of several that its first argument numbers.

    What Python refuses to compute is NaN; compiled it is infinity or NaN.
    """

    def run(number: int, *values: float) -> float:
        try:
            return functions[number](*values)
        except (ArithmeticError, ValueError):
            return math.nan

    chosen = _else(functions[-1])
    for number in range(len(functions) - 2, -1, -1):
        chosen = _either(number, functions[number], chosen)
    _declared.append(Declared(run, chosen, _ARITHMETIC))
    return run


def _either(
    number: int, function: Callable[..., float], others: Callable[..., float]
) -> Callable[..., float]:
    def choose(chosen: int, *values: float) -> float:
        return function(*values) if chosen == number else others(chosen, *values)

    _declared.append(Declared(choose, choose, _ARITHMETIC))
    return choose


def _else(function: Callable[..., float]) -> Callable[..., float]:
    def choose(_chosen: int, *values: float) -> float:
        return function(*values)

    _declared.append(Declared(choose, choose, _ARITHMETIC))
    return choose


def take_declared() -> list[Declared]:
    """What was declared since this was asked last."""
    taken = _declared.copy()
    _declared.clear()
    return taken
