"""Whether to brake early to the next border, or later and longer across it."""

import math

import numba

from twin.motion.brake_kernels import brake_distance, brake_need, brake_time
from twin.motion.reach_kernels import ROUNDING, find_brake
from twin.motion.last_chance_kernels import last_chance
from twin.nc.canonical import FloatArray


@numba.njit(cache=True)
def better_to_brake(
    limits: FloatArray, entry: FloatArray, reach: FloatArray,
    i: int, x: float, v: float, a: float, j: float, latest: float,
) -> float:  # fmt: skip
    """Whether to end a phase early so as to brake to the next border, rather than later and longer.

    The latest brake may be a long one across pieces that brake badly. Going to the next border at
    its ``reach`` first may then be faster; the two are compared by their times to the border where
    the long brake ends.

    Returns:
        When to end the phase, or ``latest`` [s].
    """
    count = limits.shape[1]
    deceleration, jerk = limits[3, i], limits[4, i]
    w = reach[i + 1]
    rest = limits[0, i] - x
    if i + 2 > count or w <= 0.0 or v <= 0.0 or brake_need(v, a, w, deceleration, jerk) > rest:
        return latest
    low = last_chance(limits, entry, reach, i, x, v, a, j, i + 1, 0.0, latest)
    if low >= latest:
        return latest
    t = latest
    x_then = x + ((j / 6.0 * t + 0.5 * a) * t + v) * t
    v_then, a_then = v + (0.5 * j * t + a) * t, a + j * t
    k = find_brake(limits, entry, reach, i, x_then, v_then, a_then, ROUNDING, i + 2)
    if k < i + 2:
        return latest
    t = low
    x += ((j / 6.0 * t + 0.5 * a) * t + v) * t
    v, a = v + (0.5 * j * t + a) * t, a + j * t
    top = v + 0.5 * a * a / jerk
    if top <= w:
        return latest
    early = a / jerk + brake_time(top, w, deceleration, jerk)
    between, soft, smooth = 0.0, math.inf, math.inf
    for piece in range(i + 1, k):
        between += limits[0, piece]
        soft = min(soft, limits[3, piece])
        smooth = min(smooth, limits[4, piece])
    spare = between
    if w > reach[k]:
        spare -= brake_distance(w, reach[k], soft, smooth)
        early += brake_time(w, reach[k], soft, smooth)
    if spare < 0.0:
        return latest
    early += spare / w
    soft, smooth = min(soft, deceleration), min(smooth, jerk)
    top = v + 0.5 * a * a / smooth
    late = a / smooth + (brake_time(top, reach[k], soft, smooth) if top > reach[k] else 0.0)
    late += max(0.0, limits[0, i] - x + between - brake_need(v, a, reach[k], soft, smooth)) / top
    return low if early < late * (1.0 - ROUNDING) else latest
