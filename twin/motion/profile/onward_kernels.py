"""The next phase of constant jerk: how long it may last before nothing is left but to brake."""

import math

from twin.compilation.kernel import array_kernel
from twin.motion.profile.brake_kernels import (
    after_jerk,
    brake_limits,
    brake_need,
    brake_time,
    time_to,
)
from twin.motion.profile.reach_kernels import ROUNDING, SLOWEST, find_brake
from twin.motion.profile.way_kernels import (
    MOST_CHORDS,
    MOST_STEPS,
    crossing,
    narrowed,
    room_for_brake,
)
from twin.nc.canonical import FloatArray

SHORTEST_PHASE = 1e-10
"""Phases below this are rounding [s]."""

SAME = 1e-12
"""Relative difference of velocities that rounding makes: the brake between them would be longer
than what is left of the way."""

MOST_BRAKES = 64
"""That are looked at in turn for one phase."""

BRIEF = 1e-11
"""How far beyond the last chance of a brake another is looked for, relative to the time looked at."""

LATER = 1.02
"""Of two brakes the one to the farther border is preferred if it takes no longer, by this factor, than
the nearer one and the way on from there at ``reach``."""

STRIDE = 8.0
"""By which the search goes on where a brake is possible for longer, but for its rounding."""

SHORTEST_HOLD = 1e-7
"""Of an acceleration that is held: shorter ones only creep up to a limit [s]."""


@array_kernel
def _brake_after(
    limits: FloatArray, entry: FloatArray, reach: FloatArray,
    i: int, x: float, v: float, a: float, j: float, t: float, to_border: bool,
) -> int:  # fmt: skip
    """Border to which the state after t of jerk j can brake, -1: none.

    Args:
        limits: As in ``find_brake``, and so on to ``a``.
        entry: See above.
        reach: See above.
        i: See above.
        x: See above.
        v: See above.
        a: See above.
        j: Jerk.
        t: Time [s].
        to_border: Whether t ends at the stretch's end.
    """
    new_x, new_v, new_a = after_jerk(x, v, a, j, t)
    if not to_border:
        return find_brake(limits, entry, reach, i, new_x, new_v, new_a, SAME, 0)
    if new_v > min(limits[1, i], entry[i + 1]) * (1.0 + SAME) or i + 1 >= limits.shape[1]:
        return -1
    if limits[0, i + 1] == 0.0:
        return -1
    return find_brake(limits, entry, reach, i + 1, 0.0, new_v, new_a, SAME, 0)


@array_kernel
def _longest(
    limits: FloatArray, entry: FloatArray, reach: FloatArray,
    i: int, x: float, v: float, a: float, j: float, latest: float, brake: int,
) -> tuple[float, bool, int]:  # fmt: skip
    """How long jerk j may last, at most ``latest`` or to the stretch's end.

    Args:
        limits: As in ``_brake_after``, and so on to ``j``.
        entry: See above.
        reach: See above.
        i: See above.
        x: See above.
        v: See above.
        a: See above.
        j: See above.
        latest: [s]
        brake: Border to which the state can brake.

    Returns:
        Time [s], whether it ends at the border, border to which the state can brake then.
    """
    rest = limits[0, i] - x
    at_border = ((j / 6.0 * latest + 0.5 * a) * latest + v) * latest >= rest
    if at_border:
        latest = time_to(rest, v, a, j, latest)
    found = _brake_after(limits, entry, reach, i, x, v, a, j, latest, at_border)
    if found >= 0:
        return latest, at_border, found
    low, brief = 0.0, BRIEF * latest
    step = brief
    best, to, least = 0.0, brake, math.inf
    for _ in range(MOST_BRAKES):
        if step == brief:
            low = last_chance(limits, entry, reach, i, x, v, a, j, brake, low, latest)
            cost = time_to_border(limits, reach, i, x, v, a, j, low, brake)
            between = time_between(limits, reach, to, brake)
            if cost == math.inf or cost <= least + LATER * between:
                best, to, least = low, brake, cost
        # Another brake may be possible for longer.
        t = low + step
        if t >= latest:
            break
        found = _brake_after(limits, entry, reach, i, x, v, a, j, t, False)
        if found < 0:
            break
        step = STRIDE * step if found == brake else brief
        low, brake = t, found
    return best, False, to


@array_kernel
def go_on(
    limits: FloatArray, entry: FloatArray, reach: FloatArray,
    i: int, x: float, v: float, a: float, brake: int,
) -> tuple[float, float, bool, int]:  # fmt: skip
    """Jerk up, or else hold, for as long as there is a brake.

    Args:
        limits: As in ``_brake_after``, and so on to ``a``.
        entry: See above.
        reach: See above.
        i: See above.
        x: See above.
        v: See above.
        a: See above.
        brake: Border to which the state can brake.

    Returns:
        Jerk, how long it lasts [s], whether it ends at the border, border to which the state can
        brake then; a time of 0 where nothing is left but to brake.
    """
    rest = limits[0, i] - x
    highest_v, highest_a, jerk = limits[1, i], limits[2, i], limits[4, i]
    j, duration, latest, at_border, then = 0.0, 0.0, 0.0, False, brake
    gap = highest_v - (v + a * a / (2.0 * jerk))
    if a < highest_a * (1.0 - ROUNDING) and gap > ROUNDING * highest_v:
        j = jerk
        latest = (highest_a - a) / jerk
        duration, at_border, then = _longest(limits, entry, reach, i, x, v, a, j, latest, brake)
    holds = a == 0.0 or gap > ROUNDING * highest_v
    # With a huge jerk even the whole of a phase may be shorter than any that counts.
    short = duration < SHORTEST_PHASE and not 0.0 < latest <= duration
    if holds and short and v > 0.0:
        j = 0.0
        latest = 2.0 * rest / v
        duration, at_border, then = _longest(limits, entry, reach, i, x, v, a, j, latest, brake)
        if a > 0.0 and duration < SHORTEST_HOLD and not at_border:
            duration = 0.0
    whole = at_border or duration >= latest or v <= 0.0
    if duration < SHORTEST_PHASE and not whole:
        duration = 0.0
    return j, duration, at_border, then


@array_kernel
def ease_off(
    limits: FloatArray, i: int, x: float, v: float, a: float, jerk: float
) -> tuple[float, bool, float, float, float]:
    """Down to a = 0, or to the next border: there may be something better to do then.

    Args:
        limits: As in ``_brake_after``, and so on to ``a``, which is above 0.
        i: See above.
        x: See above.
        v: See above.
        a: See above.
        jerk: Of the brake that begins.

    Returns:
        Time [s], whether it ends at the border, and x, v, a then.
    """
    highest_v, rest = limits[1, i], limits[0, i] - x
    duration = a / jerk
    length = (v + a * duration / 3.0) * duration
    at_border = length >= rest
    if at_border:
        duration = time_to(rest, v, a, -jerk, duration)
    v += (a - 0.5 * jerk * duration) * duration
    if at_border:
        return duration, True, 0.0, v, a - jerk * duration
    if v <= highest_v * (1.0 + ROUNDING):
        # Above the limit by rounding alone, it would never be held.
        v = min(v, highest_v)
    return duration, False, x + length, v, 0.0


TIME_PRECISION = 1e-14
"""Of the end of a phase, relative to the time looked at."""


@array_kernel
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


@array_kernel
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


@array_kernel
def time_between(limits: FloatArray, reach: FloatArray, k: int, other: int) -> float:
    """About how long the way from border k to another takes, negative if that lies before it."""
    time = 0.0
    for stretch in range(min(k, other), max(k, other)):
        mean = 0.5 * (reach[stretch] + reach[stretch + 1])
        time += limits[0, stretch] / max(mean, SLOWEST)
    return time if other >= k else -time
