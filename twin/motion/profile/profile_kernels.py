"""Velocity profiles along stretches: phases of constant jerk, as fast as the limits allow.

Each phase lasts as long as its end is safe (``reach_kernels``): first the jerk is positive, then
zero; when neither is safe any more, the brake that made the state safe is carried out. For one move
this gives the well-known seven phases of minimum time.
"""

import numpy as np

from twin.compilation.kernel import array_kernel
from twin.motion.profile.brake_kernels import after_jerk, brake_distance, brake_limits
from twin.motion.profile.onward_kernels import SAME, ease_off, go_on
from twin.motion.profile.phase_kernels import put_brake, put_phase
from twin.motion.profile.reach_kernels import ROUNDING, SLOWEST, find_brake
from twin.nc.canonical import FloatArray, IntArray

STATE_AT_REST = np.array([0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0])
"""Stretch, x within it, v, a, time; the border to which the state can brake, -1: to be found, and
the velocity there."""

MOST_PHASES = 256
"""Of one stretch; where rounding asks for more, the brake that is known is carried out."""


@array_kernel
def _known_brake(
    limits: FloatArray, entry: FloatArray, ways: FloatArray, i: int, x: float, v: float, a: float
) -> tuple[int, float]:
    """Border to which a state can brake, and the velocity there."""
    k = find_brake(limits, entry, ways[0], i, x, v, a, ROUNDING, 0)
    if k >= 0:
        return k, ways[0, k]
    # At a border that was reached by a brake: as it was found.
    return int(ways[1, i]), ways[2, i]


@array_kernel
def find_phases(
    limits: FloatArray, entry: FloatArray, ways: FloatArray, pause: FloatArray,
    stop: int, until: float, state: FloatArray,
) -> tuple[FloatArray, IntArray]:  # fmt: skip
    """Drive from ``state`` to a stretch or a time, on to the end of a phase or brake.

    However often the drive is broken off and gone on with, the phases are the same. With every
    state goes the brake that makes it safe, so that there is always a way on.

    Args:
        limits: As in ``find_brake``.
        entry: As in ``find_brake``.
        ways: From ``find_reach``.
        pause: How long each stretch waits, shape (n,) [s].
        stop: Stretch at which to end.
        until: Time at which to end [s].
        state: As ``STATE_AT_REST``; overwritten by the state at the end, shape (7,).

    Returns:
        Rows begin [s], duration [s], x, v, a, j, and the first and last stretch of each phase.
    """
    count = limits.shape[1]
    reach = ways[0]
    phases = np.zeros((256, 6))
    stretches = np.zeros((256, 2), np.int64)
    used = 0
    i, x, v, a, now = int(state[0]), state[1], state[2], state[3], state[4]
    k, w = int(state[5]), state[6]
    phases_here, last_i = 0, i
    while i < stop and i < count and now < until:
        phases_here = phases_here + 1 if i == last_i else 0
        last_i = i
        if used + 8 > len(stretches):
            phases = np.concatenate((phases, np.zeros_like(phases)))
            stretches = np.concatenate((stretches, np.zeros_like(stretches)))
        if limits[0, i] == 0.0:
            put_phase(phases, stretches, used, i, i, now, pause[i], 0.0, 0.0, 0.0, 0.0)
            used += 1
            now += pause[i]
            i, x, v, a, k = i + 1, 0.0, 0.0, 0.0, -1
            continue
        rest = limits[0, i] - x
        if v < SLOWEST and rest <= ROUNDING * limits[0, i]:
            # All but arrived; what is left is too little to speed up for.
            i, x, v, a, k = i + 1, 0.0, min(v, reach[i + 1]), 0.0, -1
            continue
        if k <= i:
            k, w = _known_brake(limits, entry, ways, i, x, v, a)

        extend = v <= 0.0 or phases_here < MOST_PHASES
        j, duration, at_border, then = 0.0, 0.0, False, k
        if extend:
            j, duration, at_border, then = go_on(limits, entry, reach, i, x, v, a, k)
        if duration > 0.0:
            put_phase(phases, stretches, used, i, i, now, duration, x, v, a, j)
            used += 1
            now += duration
            x, v, a = after_jerk(x, v, a, j, duration)
            k = then
            if at_border:
                i, x = i + 1, 0.0
            if k >= 0:
                w = reach[k]
            continue

        deceleration, jerk, behind = brake_limits(limits, i, k)
        distance = rest + behind
        if a > 0.0:
            duration, at_border, x_then, v_then, a_then = ease_off(limits, i, x, v, a, jerk)
            put_phase(phases, stretches, used, i, i, now, duration, x, v, a, -jerk)
            used += 1
            now += duration
            x, v, a = x_then, v_then, a_then
            if at_border:
                i += 1
                if i == k or a <= 0.0:
                    a = 0.0
            continue
        if v <= w * (1.0 + SAME):
            # Only rounding has kept the state from going on as it is.
            duration = rest / v
            put_phase(phases, stretches, used, i, i, now, duration, x, v, 0.0, 0.0)
            used += 1
            now += duration
            i, x, v = i + 1, 0.0, min(v, w)
            continue
        spare = distance - brake_distance(v, w, deceleration, jerk)
        to_border = spare <= ROUNDING * distance
        if to_border and spare > 0.0:
            duration = spare / v
            put_phase(phases, stretches, used, i, k - 1, now, duration, x, v, 0.0, 0.0)
            used += 1
            now += duration
            x += v * duration
            while x >= limits[0, i] and i < k - 1:
                x -= limits[0, i]
                i += 1
        used, i, now, x = put_brake(
            phases, stretches, used, limits[0], i, k - 1, now, x, v, 0.0, w, deceleration, jerk
        )
        v, a = w, 0.0
        if to_border:
            i, x, k = k, 0.0, -1
    state[0], state[1], state[2], state[3], state[4] = i, x, v, a, now
    state[5], state[6] = k, w
    return phases[:used], stretches[:used]
