"""Rows of phases: begin [s], duration [s], x, v, a, j, with their first and last piece."""

import math

from twin.compilation.kernel import array_kernel
from twin.nc.canonical import FloatArray, IntArray


@array_kernel
def put_phase(
    phases: FloatArray, pieces: IntArray, row: int,
    first: int, last: int, begin: float, duration: float, x: float, v: float, a: float, j: float,
) -> None:  # fmt: skip
    """Write one row."""
    pieces[row, 0] = first
    pieces[row, 1] = last
    phases[row, 0] = begin
    phases[row, 1] = duration
    phases[row, 2] = x
    phases[row, 3] = v
    phases[row, 4] = a
    phases[row, 5] = j


@array_kernel
def put_brake(
    phases: FloatArray, pieces: IntArray, row: int, lengths: FloatArray,
    i: int, last: int, now: float, x: float, v: float, a: float,
    w: float, deceleration: float, jerk: float,
) -> tuple[int, int, float, float]:  # fmt: skip
    """Write the brake from (v, a) to (w, 0): up to three rows, from piece i to piece ``last``.

    Returns:
        Row to go on with, piece, time [s], x at the brake's end.
    """
    drop = v + a * a / (2.0 * jerk) - w
    hardest = min(deceleration, math.sqrt(drop * jerk)) if drop > 0.0 else 0.0
    hold = max(0.0, drop / hardest - hardest / jerk) if hardest > 0.0 else 0.0
    for step in range(3):
        duration, j = max(0.0, (a + hardest) / jerk), -jerk
        if step == 1:
            duration, j = hold, 0.0
        elif step == 2:
            duration, j = hardest / jerk, jerk
        if duration > 0.0:
            put_phase(phases, pieces, row, i, last, now, duration, x, v, a, j)
            row += 1
            now += duration
            x += ((j / 6.0 * duration + 0.5 * a) * duration + v) * duration
            v += (0.5 * j * duration + a) * duration
            a += j * duration
            while x >= lengths[i] and i < last:
                x -= lengths[i]
                i += 1
    return row, i, now, x
