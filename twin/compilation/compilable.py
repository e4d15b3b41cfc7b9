"""Functions that CPython runs as they are and that kernels compile into themselves.

To declare one costs nothing: Numba is loaded by the first kernel, and with it what was declared
becomes known to the compiler. Such a function has one source for both speeds, and no compiled form
of its own: it is compiled once, as a part of the kernels that call it.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])


class Declared(NamedTuple):
    """A function that kernels may call.

    Attributes:
        called: What is in their text.
        options: Of the compiler.
    """

    called: Callable[..., Any]
    compiled: Callable[..., Any]
    options: Mapping[str, Any]


_declared: list[Declared] = []


def compilable(function: Function) -> Function:
    """Let kernels compile a function that makes no array."""
    _declared.append(Declared(function, function, {"_nrt": False}))
    return function


def inlined(function: Function) -> Function:
    """Let kernels compile a function that makes no array into each function that calls it.

    A call hands over hundreds of values, one for each size and step of a column, which may take
    longer than the block that is run.
    """
    _declared.append(Declared(function, function, {"_nrt": False, "forceinline": True}))
    return function


def take_declared() -> list[Declared]:
    """What was declared since the last call."""
    taken = _declared.copy()
    _declared.clear()
    return taken
