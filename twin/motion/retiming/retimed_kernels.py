"""Phases of a run under its new time law, and whether they keep the limits."""

import math

import numpy as np

from twin.compilation.kernel import arithmetic_kernel, array_arithmetic_kernel
from twin.motion.limits import MachineLimits
from twin.motion.retiming.run_kernels import RunPieces
from twin.motion.retiming.spline_kernels import spline_at
from twin.motion.retiming.table_kernels import RunNodes, derivatives_at
from twin.nc.canonical import FloatArray, IntArray

MISSED = 0.02
"""Share of the rise between two instants that a cubic through their values and rates may miss.

An oscillation of angular frequency w is missed by (w h)²/12 of its rise over a step h at most. A step turns by
3 degrees at most, and the rate changes along it too.
"""


@array_arithmetic_kernel
def retimed_phases(
    nodes: RunNodes, pieces: RunPieces, coefficients: FloatArray, begin: float
) -> tuple[FloatArray, IntArray]:
    """Two phases for each interval of a run, which meet its nodes with x, v and a.

    Args:
        coefficients: Of the squared rate, shape (n + 2,).
        begin: Of the run [s].

    Returns:
        Phases, and the first and last piece of each.
    """
    count = len(nodes.step)
    phases, phase_pieces = np.zeros((2 * count, 6)), np.zeros((2 * count, 2), np.int64)
    now = begin
    used = 0
    v0, a0 = _state(nodes, coefficients, 0, 0)
    for i in range(count):
        v1, a1 = _state(nodes, coefficients, i, 1)
        distance, gain = nodes.distance[i], a1 - a0
        # With both halves as long, distance = (v0 + v1) t / 2 - (a1 - a0) t² / 12.
        mean = 0.5 * (v0 + v1)
        square = mean * mean - gain * distance / 3.0
        # Where no time serves both its ends, the phases are not a number, as uses_of_limits finds.
        t = 2.0 * distance / (mean + math.sqrt(square)) if square >= 0.0 else math.nan
        both = 2.0 * gain / t
        first = 4.0 * (v1 - v0 - a0 * t) / (t * t) - 0.5 * both
        half = 0.5 * t
        x, piece = nodes.path[i, 0], nodes.piece[i]
        v, a = v0, a0
        for part in range(2):
            j = first if part == 0 else both - first
            row = phases[used]
            row[0], row[1], row[2], row[3], row[4], row[5] = now, half, x, v, a, j
            phase_pieces[used, 0] = piece
            x += ((j / 6.0 * half + 0.5 * a) * half + v) * half
            v += (0.5 * j * half + a) * half
            a += j * half
            while piece < nodes.piece[i + 1] and x >= pieces.length[piece]:
                x -= pieces.length[piece]
                piece += 1
            phase_pieces[used, 1] = piece if part == 0 else nodes.piece[i + 1]
            now += half
            used += 1
        v0, a0 = v1, a1
    return phases, phase_pieces


@arithmetic_kernel
def _state(nodes: RunNodes, coefficients: FloatArray, i: int, end: int) -> tuple[float, float]:
    """V and a of the path at one end of an interval."""
    value, slope, _ = spline_at(nodes.step, coefficients, i, end)
    v, a = nodes.path[i + end, 1], nodes.path[i + end, 2]
    return math.sqrt(value) * v, value * a + 0.5 * slope * v


@array_arithmetic_kernel
def uses_of_limits(
    phases: FloatArray, phase_pieces: IntArray, pieces: RunPieces, machine: MachineLimits, override: float
) -> FloatArray:  # fmt: skip
    """What intervals use of the limits of velocity, acceleration and jerk.

    Args:
        phases: From ``retimed_phases``.
        phase_pieces: From ``retimed_phases``.

    Returns:
        Shares of the three limits, the largest along each of n intervals, shape (n, 3); infinite where
        the solver went astray.
    """
    uses = np.zeros((len(phases) // 2, 3))
    before = np.zeros((len(machine.jerk), 3))
    for row in range(len(phases)):
        _, duration, begin, v0, a0, j = phases[row]
        fast, hard, sudden = uses[row >> 1]
        piece, step = phase_pieces[row, 0], 0.5 * duration
        feed = pieces.feed[piece] * override
        # No comparison holds of what is not a number.
        if not (v0 >= -1e-9 and abs(begin) < math.inf and abs(a0) < math.inf and abs(j) < math.inf):
            uses[row >> 1] = math.inf
            continue
        a1, v1 = a0 + j * duration, v0 + (a0 + 0.5 * j * duration) * duration
        fast = max(fast, _highest(v0, a0, v1, a1, duration) / feed)
        sudden = max(sudden, abs(j) / pieces.path_jerk[piece])
        for part in range(3):
            t = part * step
            x = begin + ((j / 6.0 * t + 0.5 * a0) * t + v0) * t
            v, a = v0 + (0.5 * j * t + a0) * t, a0 + j * t
            hard = max(hard, abs(a) / pieces.path_acceleration[piece])
            squares = 0.0
            for axis in range(len(machine.jerk)):
                q1, q2, q3 = derivatives_at(pieces, piece, x, axis)
                squares += q2 * q2 if axis < 3 else 0.0
                velocity, acceleration = q1 * v, q2 * v * v + q1 * a
                jerk = (q3 * v * v + 3.0 * q2 * a) * v + q1 * j
                if part > 0:
                    v_before, a_before, j_before = before[axis]
                    highest = _highest(v_before, a_before, velocity, acceleration, step)
                    hardest = _highest(a_before, j_before, acceleration, jerk, step)
                    fast = max(fast, highest / machine.velocity[axis])
                    hard = max(hard, hardest / machine.acceleration[axis])
                before[axis, 0], before[axis, 1], before[axis, 2] = velocity, acceleration, jerk
                sudden = max(sudden, abs(jerk) / machine.jerk[axis])
            hard = max(hard, v * v * math.sqrt(squares) / machine.path[0])
        uses[row >> 1, 0], uses[row >> 1, 1], uses[row >> 1, 2] = fast, hard, sudden
    return uses


@arithmetic_kernel
def _highest(v0: float, a0: float, v1: float, a1: float, step: float) -> float:
    """Highest absolute value along a step, as a cubic tells it from its ends.

    Args:
        v0: Value at the begin, such as a velocity.
        a0: Its rate of change there, such as an acceleration.
        a1: Its rate of change there.
        step: Duration [s].
    """
    sign = math.copysign(1.0, v0 + v1)
    rise, fall = sign * a0, -sign * a1
    highest = max(abs(v0), abs(v1))
    if rise > 0.0 and fall > 0.0:
        # Where the cubic's rate of change, rise + b s + c s², comes down to zero: once, as it changes sign.
        mean = sign * (v1 - v0) / step
        b, c = 6.0 * mean - 4.0 * rise + 2.0 * fall, 3.0 * (rise - fall - 2.0 * mean)
        s = 2.0 * rise / (math.sqrt(max(0.0, b * b - 4.0 * c * rise)) - b)
        r = 1.0 - s
        ends = v0 * r * r * (1.0 + 2.0 * s) + v1 * s * s * (1.0 + 2.0 * r)
        between = sign * ends + (rise * r + fall * s) * r * s * step
        highest += (1.0 + MISSED) * max(0.0, between - highest)
    return highest
