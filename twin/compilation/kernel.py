"""How kernels are compiled: the decorators of every compiled function of this package.

Numba counts the references to every column that a function takes from a tuple, with atomic
operations; of kernels that are given sixty columns and call each other once a block, that is two
thirds of the time. A kernel that makes no array works on what belongs to its caller, so that it is
compiled without the counting (``_nrt``, Numba's run time of references).
"""

import sys
from collections.abc import Callable
from typing import Any, TypeVar

from numba.extending import overload

from twin.compilation.compilable import take_declared
from twin.compilation.dispatcher import KernelDispatcher
from twin.compilation.shortcuts import take_shortcuts

_SUMS = {"reassoc", "nsz", "nnan"}
"""Freedoms that let a sum or a maximum over neighbours be taken several at a time: its terms may be
added in any order, and none is NaN."""

Kernel = TypeVar("Kernel", bound=Callable[..., object])

FRAMES = 4000
"""Depth of calls that the compiler may need: Numba types what a function calls while it types the function,
some 60 frames a level, and CPython's own limit of 1000 is reached from deep within a caller's stack."""
sys.setrecursionlimit(max(sys.getrecursionlimit(), FRAMES))
take_shortcuts()


def array_kernel(function: Kernel) -> Kernel:
    """Compile a function that may make arrays."""
    return _compiled(function)


def threaded_kernel(function: Kernel) -> Kernel:
    """Compile a function that may make arrays, and that several threads may run at a time.

    It holds no lock of Python's. A division by zero gives infinity or NaN.
    """
    return _compiled(function, error_model="numpy", nogil=True)


def array_arithmetic_kernel(function: Kernel) -> Kernel:
    """Compile a function that may make arrays, where a division by zero gives infinity or NaN."""
    return _compiled(function, error_model="numpy")


def summing_kernel(function: Kernel) -> Kernel:
    """Compile a function of sums whose order the compiler may choose, as long as it is one order.

    A division by zero gives infinity.
    """
    return _compiled(function, fastmath=_SUMS, error_model="numpy")


def kernel(function: Kernel) -> Kernel:
    """Compile a function that makes no array."""
    return _compiled(function, _nrt=False)


def branching_kernel(function: Kernel) -> Kernel:
    """Compile a function that makes no array, and whose loops gain nothing by several rounds at a time."""
    return _compiled(function, _nrt=False, vectorize=False)


def arithmetic_kernel(function: Kernel) -> Kernel:
    """Compile a function that makes no array, where a division by zero gives infinity or NaN."""
    return _compiled(function, error_model="numpy", _nrt=False)


def _compiled(function: Kernel, *, vectorize: bool = True, **options: Any) -> Kernel:
    for called, compiled, of_part in take_declared():
        # Kernels alone call a part: it needs no form for callers from C, which Numba makes of all.
        options_of_part: Any = {**of_part, "no_cfunc_wrapper": True}
        overload(called, jit_options=options_of_part, strict=False)(_always(compiled))
    made: Any = KernelDispatcher(function, vectorize=vectorize, **options)
    return made


def _always(function: Callable[..., object]) -> Callable[..., Callable[..., object]]:
    """What Numba asks for the form of a function that fits types: one form fits all."""

    def form(*_types: object) -> Callable[..., object]:
        return function

    return form
