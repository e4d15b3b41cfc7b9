"""The last moment at which a brake can begin."""

import math

import numba

from twin.motion.brake_kernels import after_jerk, brake_limits, brake_need, brake_time
from twin.motion.reach_kernels import SLOWEST
from twin.motion.way_kernels import MOST_CHORDS, MOST_STEPS, crossing, narrowed, room_for_brake
from twin.nc.canonical import FloatArray

TIME_PRECISION = 1e-14
"""Of the end of a phase, relative to the time looked at."""


@numba.njit(cache=True)
def last_chance(
    limits: FloatArray, entry: FloatArray, reach: FloatArray,
    i: int, x: float, v: float, a: float, j: float, k: int,
    low: float, high: float,
) -> float:  # fmt: skip
    """How long jerk j may last, from ``low`` to ``high``, for the brake to border k to be possible.

    Args:
        limits: As in ``find_brake``.
        entry: As in ``find_brake``.
        reach: As in ``find_brake``.
        i: Stretch of the state.
        x: Place within it.
        v: Velocity.
        a: Acceleration.
        j: Jerk.
        k: Border.
        low: The shortest time; it is the answer where the brake is not possible even then [s].
        high: The longest time [s].
    """
    precision = TIME_PRECISION * high
    deceleration, jerk, _ = brake_limits(limits, i, k)
    w = reach[k]
    at_low, at_high = math.inf, -math.inf
    side, t = 0, high
    for step in range(MOST_STEPS):
        then_x, then_v, then_a = after_jerk(x, v, a, j, t)
        room = room_for_brake(
            limits, entry, i, then_x, then_v, then_a, k, w, deceleration, jerk, 1.0
        )
        low, high, at_low, at_high, side = narrowed(low, high, at_low, at_high, side, t, room)
        if high - low <= precision:
            break
        if step == 0:
            t = low
        elif step < MOST_CHORDS:
            t = crossing(low, high, at_low, at_high)
            t = min(max(t, low + 0.25 * precision), high - 0.25 * precision)
        else:
            t = 0.5 * (low + high)
    return low


@numba.njit(cache=True)
def time_to_border(
    limits: FloatArray, reach: FloatArray,
    i: int, x: float, v: float, a: float, j: float, t: float, k: int,
) -> float:  # fmt: skip
    """Time to border k with jerk j for t and then the brake; what is left of the way is crept.

    Args:
        limits: As in ``last_chance``, and so on to ``j``.
        reach: See above.
        i: See above.
        x: See above.
        v: See above.
        a: See above.
        j: See above.
        t: [s]
        k: Border.
    """
    deceleration, jerk, behind = brake_limits(limits, i, k)
    x, v, a = after_jerk(x, v, a, j, t)
    distance = limits[0, i] - x + behind
    top, w = v + 0.5 * a * a / jerk, reach[k]
    if top <= w:
        return math.inf
    spare = distance - brake_need(v, a, w, deceleration, jerk)
    time = t + a / jerk + brake_time(top, w, deceleration, jerk)
    return time + max(0.0, spare) / max(w, SLOWEST)


@numba.njit(cache=True)
def time_between(limits: FloatArray, reach: FloatArray, k: int, other: int) -> float:
    """About how long the way from border k to another takes, negative if that lies before it."""
    time = 0.0
    for stretch in range(min(k, other), max(k, other)):
        mean = 0.5 * (reach[stretch] + reach[stretch + 1])
        time += limits[0, stretch] / max(mean, SLOWEST)
    return time if other >= k else -time
