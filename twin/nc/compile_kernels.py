"""How the kernels of the fast way are compiled.

Numba counts the references to every column that a function takes from a tuple, with atomic
operations; of kernels that are given sixty columns and call each other once a block, that is two
thirds of the time. None of these makes an array: what they work on belongs to their caller, so that
they are compiled without the counting (``_nrt``, Numba's run time of references).
"""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
import numpy as np

NONE_YET, ONCE, NO = (
    cast("int", np.int64(0)),
    cast("int", np.int64(1)),
    cast("bool", np.bool_(False)),
)
"""For what is given to other kernels: to Numba a plain 0, 1 or False is a type of its own, for which
it compiles a kernel once more."""

Kernel = TypeVar("Kernel", bound=Callable[..., object])


def kernel(function: Kernel) -> Kernel:
    """Compile a function that makes no array."""
    return _compiled(function)


def inlined_kernel(function: Kernel) -> Kernel:
    """The same, as a part of each function that calls it.

    A call hands over hundreds of values, one for each size and step of a column, which may take
    longer than the block that is run.
    """
    return _compiled(function, forceinline=True)


def arithmetic_kernel(function: Kernel) -> Kernel:
    """The same, where a division by zero gives infinity or NaN."""
    return _compiled(function, error_model="numpy")


def _compiled(function: Kernel, **options: Any) -> Kernel:
    jit: Any = numba.njit  # its declared options lack ``_nrt``
    return jit(cache=True, _nrt=False, **options)(function)
