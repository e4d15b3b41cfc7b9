"""A long program on a fresh installation: it begins at once, and compiled kernels take it over.

Nothing stands in for anything here: an empty folder for kernels, a program that runs until they are
there, and the process beside it that compiles them. Every move is held against the program's formula.
"""

import os
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from twin.compilation.beside import beside
from twin.compilation.speed import Speed
from twin.nc.canonical import Axes
from twin.nc.control.settings import ControlSettings
from twin.nc.dialects import dialect_named
from twin.nc.interpreter import Interpretation
from twin.nc.text.source import source_from_text

LINES = 2_000
BEYOND = 100_000
"""Blocks that the compiled kernels run before it is enough."""
_AXES = Axes(("X", "Y", "Z", "C"), ("linear", "linear", "linear", "rotary"))
_STEP_MM = 0.5
_PROGRAM = "G1 F1000\nP1=0\n$WHILE P1<999999999\n{lines}$ENDWHILE\nM30"
_LINE = "P1=P1+1\nX[P1*.5]\n"


@dataclass(frozen=True)
class Takeover:
    """What was observed.

    Attributes:
        first_moves_s: Until the first moves were there [s].
        taken_over_s: Until the compiled kernels took over [s].
        cold_blocks: Blocks and moves until then.
        cold_rate: Of them a second.
        compiled_rate: Moves a second behind that.
    """

    first_moves_s: float
    taken_over_s: float
    cold_blocks: int
    cold_rate: float
    compiled_rate: float


def observe(folder: Path) -> Takeover:
    """Run the program with an empty folder for kernels.

    Raises:
        AssertionError: A move is not where the program wants it.
    """
    os.environ["NUMBA_CACHE_DIR"] = os.environ["XDG_CACHE_HOME"] = str(folder)
    source = source_from_text(_PROGRAM.format(lines=_LINE * (LINES // 2)))
    settings = ControlSettings(axes=_AXES, step_limit=10**9)
    interpretation = Interpretation(
        source, dialect_named("fagor8070"), settings, speed=Speed.WHEN_READY
    )
    began, moves, before = time.perf_counter(), 0, 0
    first = taken = 0.0
    for chunk in interpretation.chunks():
        ends = chunk.moves.end[:, 0]
        moves += len(ends)
        expected = np.arange(moves - len(ends) + 1, moves + 1) * _STEP_MM
        assert (ends == expected).all(), "a move is not where the program wants it"
        now = time.perf_counter() - began
        first = first or now
        if interpretation.compiled_after is not None and not taken:
            taken, before = now, moves
        if taken and moves - before >= BEYOND:
            break
    cold = interpretation.compiled_after or 0
    rate = (moves - before) / (time.perf_counter() - began - taken)
    return Takeover(first, taken, cold, cold / taken, rate)


def main() -> int:
    """Print what was observed; 1 if the kernels took over before anything ran without them."""
    with tempfile.TemporaryDirectory() as name:
        seen = observe(Path(name))
        while beside("twin.nc.compile_all").is_running():
            time.sleep(0.1)
    print(f"first moves after {seen.first_moves_s:.2f} s")
    print(
        f"compiled kernels took over after {seen.taken_over_s:.1f} s and {seen.cold_blocks:,} "
        f"blocks and moves, {seen.cold_rate:,.0f} a second; then {seen.compiled_rate:,.0f} moves a second"
    )
    return 0 if seen.cold_blocks > LINES and seen.compiled_rate > seen.cold_rate else 1


if __name__ == "__main__":
    sys.exit(main())
