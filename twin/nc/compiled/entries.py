"""The kernels of the language at both speeds: as CPython runs them, and as Numba compiles them.

Only these two have a compiled form of their own; all other functions of the language are parts of
them. To name them loads no compiler.
"""

import functools
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from twin.nc.compiled.kernels import program
from twin.nc.text.lines import Page


class Kernels(NamedTuple):
    """The entries of one speed.

    Attributes:
        run_program: As ``program`` has it.
        unread_lines: As ``program`` has it.
    """

    run_program: Callable[..., int]
    unread_lines: Callable[..., program.IntArray]


def _run_program(*arguments: Any) -> int:
    """An undefined value is infinity or NaN, as the compiled form has it, and stops its block."""
    with np.errstate(all="ignore"):
        return program.run_program(*arguments)


COLD = Kernels(_run_program, program.unread_lines)


def page_columns(page: Page) -> program.PageColumns:
    """A page as kernels read it."""
    return program.PageColumns(page.data, page.starts, page.ends, page.lines.start)


@functools.cache
def hot() -> Kernels:
    """The compiled ones; the first call loads Numba."""
    from twin.compilation.kernel import array_kernel, branching_kernel

    return Kernels(branching_kernel(program.run_program), array_kernel(program.unread_lines))


def at_hand() -> bool:
    """Whether this process has run the compiled ones before."""
    if hot.cache_info().currsize == 0:
        return False
    from twin.compilation.cache import is_loaded

    return is_loaded(hot().run_program)
