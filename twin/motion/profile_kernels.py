"""Velocity profiles along stretches: phases of constant jerk, as fast as the limits allow.

Each phase lasts as long as its end is safe (``reach_kernels``): first the jerk is positive, then
zero; when neither is safe any more, the brake that made the state safe is carried out. For one move
this gives the well-known seven phases of minimum time.
"""

import math

import numba
import numpy as np

from twin.motion.brake_kernels import after_jerk, brake_distance, brake_limits, time_to
from twin.motion.last_chance_kernels import (
    last_chance,
    time_between,
    time_to_border,
)
from twin.motion.phase_kernels import put_brake, put_phase
from twin.motion.reach_kernels import ROUNDING, SLOWEST, find_brake
from twin.nc.canonical import FloatArray, IntArray

STATE_AT_REST = np.array([0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0])
"""Stretch, x within it, v, a, time; the border to which the state can brake, -1: to be found, and
the velocity there."""

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

MOST_PHASES = 256
"""Of one stretch; where rounding asks for more, the brake that is known is carried out."""

SHORTEST_HOLD = 1e-7
"""Of an acceleration that is held: shorter ones only creep up to a limit [s]."""


@numba.njit(cache=True)
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


@numba.njit(cache=True)
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


@numba.njit(cache=True)
def _known_brake(
    limits: FloatArray, entry: FloatArray, ways: FloatArray, i: int, x: float, v: float, a: float
) -> tuple[int, float]:
    """Border to which a state can brake, and the velocity there."""
    k = find_brake(limits, entry, ways[0], i, x, v, a, ROUNDING, 0)
    if k >= 0:
        return k, ways[0, k]
    # At a border that was reached by a brake: as it was found.
    return int(ways[1, i]), ways[2, i]


@numba.njit(cache=True)
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

        highest_v, highest_a, jerk = limits[1, i], limits[2, i], limits[4, i]
        j, duration, latest, at_border, then = 0.0, 0.0, 0.0, False, k
        gap = highest_v - (v + a * a / (2.0 * jerk))
        extend = v <= 0.0 or phases_here < MOST_PHASES
        if extend and a < highest_a * (1.0 - ROUNDING) and gap > ROUNDING * highest_v:
            j = jerk
            latest = (highest_a - a) / jerk
            duration, at_border, then = _longest(limits, entry, reach, i, x, v, a, j, latest, k)
        holds = a == 0.0 or gap > ROUNDING * highest_v
        # With a huge jerk even the whole of a phase may be shorter than any that counts.
        short = duration < SHORTEST_PHASE and not 0.0 < latest <= duration
        if extend and holds and short and v > 0.0:
            j = 0.0
            latest = 2.0 * rest / v
            duration, at_border, then = _longest(limits, entry, reach, i, x, v, a, j, latest, k)
            if a > 0.0 and duration < SHORTEST_HOLD and not at_border:
                duration = 0.0
        whole = at_border or duration >= latest or v <= 0.0
        if duration > 0.0 and (duration >= SHORTEST_PHASE or whole):
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
            # Only down to a = 0, or to the next border: there may be something better to do then.
            duration = a / jerk
            length = (v + a * duration / 3.0) * duration
            at_border = length >= rest
            if at_border:
                duration = time_to(rest, v, a, -jerk, duration)
            put_phase(phases, stretches, used, i, i, now, duration, x, v, a, -jerk)
            used += 1
            now += duration
            v += (a - 0.5 * jerk * duration) * duration
            a -= jerk * duration
            if at_border:
                i, x = i + 1, 0.0
                if i == k or a <= 0.0:
                    a = 0.0
            else:
                x, a = x + length, 0.0
                if v <= highest_v * (1.0 + ROUNDING):
                    # Above the limit by rounding alone, it would never be held.
                    v = min(v, highest_v)
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
