"""The last moment at which a brake can begin."""

import math

import numba

from twin.motion.brake_kernels import brake_need, brake_time
from twin.motion.reach_kernels import SLOWEST
from twin.motion.way_kernels import MOST_CHORDS, MOST_STEPS, crossing, damped, room_for_brake
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
    deceleration, jerk = limits[3, i], limits[4, i]
    for last in range(i + 1, k):
        deceleration = min(deceleration, limits[3, last])
        jerk = min(jerk, limits[4, last])
    w = reach[k]
    at_low, at_high = math.inf, -math.inf
    side, t = 0, high
    for step in range(MOST_STEPS):
        then_x = x + ((j / 6.0 * t + 0.5 * a) * t + v) * t
        then_v, then_a = v + (0.5 * j * t + a) * t, a + j * t
        room = room_for_brake(
            limits, entry, i, then_x, then_v, then_a, k, w, deceleration, jerk, 1.0
        )
        if room >= 0.0:
            if side > 0:
                at_high = damped(at_high, at_low, room)
            low, at_low, side = t, room, 1
        else:
            if side < 0:
                at_low = damped(at_low, at_high, room)
            high, at_high, side = t, room, -1
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
    deceleration, jerk = limits[3, i], limits[4, i]
    distance = limits[0, i] - x - ((j / 6.0 * t + 0.5 * a) * t + v) * t
    for last in range(i + 1, k):
        deceleration = min(deceleration, limits[3, last])
        jerk = min(jerk, limits[4, last])
        distance += limits[0, last]
    v, a = v + (0.5 * j * t + a) * t, a + j * t
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
