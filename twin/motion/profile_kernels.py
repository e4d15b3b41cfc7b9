"""Velocity profiles along pieces: phases of constant jerk, as fast as the limits allow.

Each phase lasts as long as its end is safe (``reach_kernels``): first the jerk is positive, then
zero; when neither is safe any more, the brake that made the state safe is carried out. For one move
this gives the well-known seven phases of minimum time.
"""

import numba
import numpy as np

from twin.motion.brake_kernels import brake_distance, time_to
from twin.motion.early_brake_kernels import better_to_brake
from twin.motion.phase_kernels import put_brake, put_phase
from twin.motion.reach_kernels import BISECTIONS, ROUNDING, SLOWEST, find_brake
from twin.nc.canonical import FloatArray, IntArray

STATE_AT_REST = np.array([0.0, 0.0, 0.0, 0.0, 0.0, -1.0, -1.0])
"""Piece, x within it, v, a, time; the piece in which an early brake was chosen, and that in which
one was weighed, -1: none."""

SHORTEST_PHASE = 1e-10
"""Phases below this are rounding [s]."""

MOST_PHASES = 4096
"""Of one piece; more would mean that rounding keeps the path from going on."""

SHORTEST_HOLD = 1e-7
"""Of an acceleration that is held: shorter ones only creep up to a limit [s]."""


@numba.njit(cache=True)
def _can_last(
    limits: FloatArray, entry: FloatArray, reach: FloatArray,
    i: int, x: float, v: float, a: float, j: float, t: float, to_border: bool,
) -> bool:  # fmt: skip
    """Whether the state after t of jerk j is safe; ``to_border``: t ends at the piece's end."""
    new_x = x + ((j / 6.0 * t + 0.5 * a) * t + v) * t
    new_v = v + (0.5 * j * t + a) * t
    new_a = a + j * t
    if not to_border:
        return find_brake(limits, entry, reach, i, new_x, new_v, new_a, 0.0, 0) >= 0
    if new_v > min(limits[1, i], entry[i + 1]) or i + 1 >= limits.shape[1]:
        return False
    if limits[0, i + 1] == 0.0:
        return False
    return find_brake(limits, entry, reach, i + 1, 0.0, new_v, new_a, 0.0, 0) >= 0


@numba.njit(cache=True)
def _longest(
    limits: FloatArray, entry: FloatArray, reach: FloatArray,
    i: int, x: float, v: float, a: float, j: float, latest: float,
) -> tuple[float, bool]:  # fmt: skip
    """How long jerk j may last, at most ``latest`` or to the piece's end; whether it gets there."""
    rest = limits[0, i] - x
    if ((j / 6.0 * latest + 0.5 * a) * latest + v) * latest >= rest:
        latest = time_to(rest, v, a, j, latest)
        if _can_last(limits, entry, reach, i, x, v, a, j, latest, True):
            return latest, True
    elif _can_last(limits, entry, reach, i, x, v, a, j, latest, False):
        return latest, False
    low, high = 0.0, latest
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if _can_last(limits, entry, reach, i, x, v, a, j, middle, False):
            low = middle
        else:
            high = middle
    return low, False


@numba.njit(cache=True)
def find_phases(
    limits: FloatArray, entry: FloatArray, reach: FloatArray, pause: FloatArray,
    stop: int, until: float, state: FloatArray,
) -> tuple[FloatArray, IntArray]:  # fmt: skip
    """Drive from ``state`` to a piece or a time, on to the end of a phase or brake.

    However often the drive is broken off and gone on with, the phases are the same.

    Args:
        limits: As in ``find_brake``.
        entry: As in ``find_brake``.
        reach: From ``find_reach``.
        pause: How long each piece waits, shape (n,) [s].
        stop: Piece at which to end.
        until: Time at which to end [s].
        state: As ``STATE_AT_REST``; overwritten by the state at the end, shape (7,).

    Returns:
        Rows begin [s], duration [s], x, v, a, j, and the first and last piece of each phase.
    """
    count = limits.shape[1]
    phases = np.zeros((256, 6))
    pieces = np.zeros((256, 2), np.int64)
    used = 0
    i, x, v, a, now = int(state[0]), state[1], state[2], state[3], state[4]
    phases_here = 0
    brake_in, compared_in = int(state[5]), int(state[6])
    last_i = i
    while i < stop and i < count and now < until:
        phases_here = phases_here + 1 if i == last_i else 0
        last_i = i
        if phases_here > MOST_PHASES:
            raise RuntimeError("motion: the path does not go on")
        if used + 8 > len(pieces):
            phases = np.concatenate((phases, np.zeros_like(phases)))
            pieces = np.concatenate((pieces, np.zeros_like(pieces)))
        if limits[0, i] == 0.0:
            put_phase(phases, pieces, used, i, i, now, pause[i], 0.0, 0.0, 0.0, 0.0)
            used += 1
            now += pause[i]
            i += 1
            continue

        if v < SLOWEST and limits[0, i] - x <= ROUNDING * limits[0, i]:
            # All but arrived; what is left is too little to speed up for.
            i, x, v, a = i + 1, 0.0, min(v, reach[i + 1]), 0.0
            continue

        highest_v, highest_a, jerk = limits[1, i], limits[2, i], limits[4, i]
        j, duration, latest, at_border = 0.0, 0.0, 0.0, False
        gap = highest_v - (v + a * a / (2.0 * jerk))
        extend = brake_in != i or v <= 0.0
        if extend and a < highest_a * (1.0 - ROUNDING) and gap > ROUNDING * highest_v:
            j = jerk
            latest = (highest_a - a) / jerk
            duration, at_border = _longest(limits, entry, reach, i, x, v, a, j, latest)
        holds = a == 0.0 or gap > ROUNDING * highest_v
        if extend and holds and duration < SHORTEST_PHASE and v > 0.0:
            j = 0.0
            latest = 2.0 * (limits[0, i] - x) / v
            duration, at_border = _longest(limits, entry, reach, i, x, v, a, j, latest)
            if a > 0.0 and duration < SHORTEST_HOLD and not at_border:
                duration = 0.0
        if SHORTEST_PHASE <= duration < latest and not at_border and compared_in != i:
            sooner = better_to_brake(limits, entry, reach, i, x, v, a, j, duration)
            if sooner < duration:
                duration, brake_in = sooner, i
                # Once per piece: what rounding leaves over must not be weighed again.
                compared_in = i
        if duration > 0.0 and (duration >= SHORTEST_PHASE or at_border):
            put_phase(phases, pieces, used, i, i, now, duration, x, v, a, j)
            used += 1
            now += duration
            x += ((j / 6.0 * duration + 0.5 * a) * duration + v) * duration
            v += (0.5 * j * duration + a) * duration
            a += j * duration
            if at_border:
                i, x = i + 1, 0.0
            continue

        k = find_brake(limits, entry, reach, i, x, v, a, ROUNDING, 0)
        if k < 0:
            raise RuntimeError("motion: no way to brake from a state that was safe")
        deceleration = limits[3, i]
        distance = limits[0, i] - x
        for piece in range(i + 1, k):
            deceleration = min(deceleration, limits[3, piece])
            jerk = min(jerk, limits[4, piece])
            distance += limits[0, piece]
        if a > 0.0:
            # Only down to a = 0, or to the next piece: there may be something better to do then.
            duration = a / jerk
            rest = limits[0, i] - x
            length = (v + a * duration / 3.0) * duration
            at_border = length >= rest
            if at_border:
                duration = time_to(rest, v, a, -jerk, duration)
            put_phase(phases, pieces, used, i, i, now, duration, x, v, a, -jerk)
            used += 1
            now += duration
            v += (a - 0.5 * jerk * duration) * duration
            a -= jerk * duration
            if at_border:
                i, x, a = i + 1, 0.0, max(0.0, a)
            else:
                x, a = x + length, 0.0
                if v <= highest_v * (1.0 + ROUNDING):
                    # Above the limit by rounding alone, it would never be held.
                    v = min(v, highest_v)
            continue

        w = reach[k]
        if v <= w and brake_in == i:
            brake_in = -1
            continue
        if v <= w:
            # Only rounding has kept the state from going on as it is.
            duration = (limits[0, i] - x) / v
            put_phase(phases, pieces, used, i, i, now, duration, x, v, 0.0, 0.0)
            used += 1
            now += duration
            i, x, v = i + 1, 0.0, min(v, entry[i + 1])
            continue
        spare = distance - brake_distance(v, w, deceleration, jerk)
        to_border = spare <= ROUNDING * distance
        if to_border and spare > 0.0:
            duration = spare / v
            put_phase(phases, pieces, used, i, k - 1, now, duration, x, v, 0.0, 0.0)
            used += 1
            now += duration
            x += v * duration
            while x >= limits[0, i] and i < k - 1:
                x -= limits[0, i]
                i += 1
        used, i, now, x = put_brake(
            phases, pieces, used, limits[0], i, k - 1, now, x, v, 0.0, w, deceleration, jerk
        )
        v, a = w, 0.0
        brake_in = -1
        if to_border:
            i, x = k, 0.0
    state[0], state[1], state[2], state[3], state[4] = i, x, v, a, now
    state[5], state[6] = brake_in, compared_in
    return phases[:used], pieces[:used]
