"""Rows of phases: begin [s], duration [s], x, v, a, j, with their first and last segment."""

import math
from typing import NamedTuple

from twin.compilation.kernel import array_kernel, kernel
from twin.motion.profile.brake_kernels import after_jerk
from twin.motion.profile.state import Brake, State
from twin.nc.canonical import FloatArray, IntArray


class PhaseRows(NamedTuple):
    """Rows that are being written.

    Attributes:
        phases: Begin [s], duration [s], x, v, a, j, shape (m, 6).
        segments: First and last segment of each phase, shape (m, 2).
    """

    phases: FloatArray
    segments: IntArray


@kernel
def write_phase(
    rows: PhaseRows, row: int, last: int, now: float, duration: float, state: State, j: float
) -> None:
    """Write one row.

    Args:
        last: Segment in which the phase ends.
        now: When it begins [s].
        duration: [s]
    """
    rows.segments[row, 0], rows.segments[row, 1] = state.segment, last
    phase = rows.phases[row]
    phase[0], phase[1] = now, duration
    phase[2], phase[3], phase[4], phase[5] = state.x, state.v, state.a, j


@array_kernel
def write_brake(
    rows: PhaseRows, row: int, lengths: FloatArray, now: float, state: State, brake: Brake
) -> tuple[int, float, int, float]:
    """Write a brake: up to three rows.

    Args:
        row: Number of the first row.
        now: When it begins [s].
        brake: Its rows end in the segment before its border.

    Returns:
        Row to go on with, time at the brake's end [s], segment and x there.
    """
    k, w, deceleration, jerk = brake
    _, _, v, a = state
    drop = v + a * a / (2.0 * jerk) - w
    hardest = min(deceleration, math.sqrt(drop * jerk)) if drop > 0.0 else 0.0
    hold = max(0.0, drop / hardest - hardest / jerk) if hardest > 0.0 else 0.0
    for step in range(3):
        duration, j = max(0.0, (state.a + hardest) / jerk), -jerk
        if step == 1:
            duration, j = hold, 0.0
        elif step == 2:
            duration, j = hardest / jerk, jerk
        if duration > 0.0:
            write_phase(rows, row, k - 1, now, duration, state, j)
            row += 1
            now += duration
            i, x, v, a = after_jerk(state, j, duration)
            while x >= lengths[i] and i < k - 1:
                x -= lengths[i]
                i += 1
            state = State(i, x, v, a)
    return row, now, state.segment, state.x
