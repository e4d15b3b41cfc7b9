"""Which form of the kernel a program's lines run in: the compiled one where it is there and pays, else none."""

import functools
import sys

from twin.compilation.speed import Speed, usual_speed
from twin.nc.line_kernel.kernel import MoveRows, PageColumns, PlainRules, PlainState, run_lines
from twin.nc.line_kernel.plain_state import LineKernel

LONG_PROGRAM = 50_000
"""Lines of a program for which it pays to load the compiler, which takes about a second."""
PAYS_LOADED = 500
"""The same where the compiler is loaded already."""
PAYS_COMPILED = 500_000
"""The same to compile the kernel where it was not: Python would take longer."""
_COMPILER = "twin.compilation.kernel"


@functools.cache
def compiled_kernel() -> LineKernel:
    """The compiled form; the first call loads the compiler, the first run compiles or loads the kernel."""
    from twin.compilation.kernel import branching_kernel

    return branching_kernel(run_lines)


def usual_kernel(lines: int) -> LineKernel | None:
    """The compiled form for a program of so many lines, where it pays; it runs nothing where it is not there."""
    if lines < (PAYS_LOADED if _COMPILER in sys.modules else LONG_PROGRAM):
        return None
    if usual_speed() is Speed.HOT or lines >= PAYS_COMPILED:
        return compiled_kernel()
    return _WhereCompiled()


class _WhereCompiled:
    """The compiled form, if it was compiled before; else no line is plain."""

    def __init__(self) -> None:
        self._is_there: bool | None = None

    def __call__(
        self, page: PageColumns, rules: PlainRules, state: PlainState, rows: MoveRows
    ) -> int:
        if self._is_there is None:
            from twin.compilation.cache import is_compiled

            self._is_there = is_compiled(compiled_kernel(), (page, rules, state, rows))
        return compiled_kernel()(page, rules, state, rows) if self._is_there else 0
