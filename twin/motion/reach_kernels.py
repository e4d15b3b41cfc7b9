"""From which states one can still brake in time, and how fast each border may be passed.

The state on the path is (piece, x within it, v, a). It is *safe* if from it one can brake to a
later border of pieces, arriving there with a = 0 and no faster than that border's ``reach``, within
all limits on the way. ``reach`` is the highest velocity that is itself safe at the border with
a = 0, so that a safe state has a safe way to the end of the window, where v = 0. It is found
backwards from the end.
"""

import math

import numba
import numpy as np

from twin.motion.brake_kernels import brake_distance, brake_state
from twin.nc.canonical import FloatArray

BISECTIONS = 52
"""Halvings of an interval: down to the rounding of a double."""

ROUNDING = 1e-9
"""Relative slack for comparisons of quantities that are equal but for rounding."""

REACH_PRECISION = 1e-9
"""Of velocities at borders, relative: far finer than any loss of time."""

SLOWEST = 1e-6
"""A border that must be passed more slowly than this is passed from a stop [mm/s or deg/s]."""

FAILED_BRAKES = 4
"""Brakes that fit their distance but break a limit on the way before the search gives up."""


@numba.njit(cache=True)
def holds_on_the_way(
    limits: FloatArray, entry: FloatArray, i: int, x: float, v: float, a: float,
    k: int, w: float, deceleration: float, jerk: float, wide: float,
) -> bool:  # fmt: skip
    """Whether the brake to border k keeps the velocities and accelerations of pieces i to k - 1."""
    top = v + a * a / (2.0 * jerk)
    distance = limits[0, i] - x
    now_v, now_a = brake_state(distance, v, a, w, deceleration, jerk)
    highest = v if a < 0.0 else now_v if now_a > 0.0 else top
    if highest > limits[1, i] * wide:
        return False
    for border in range(i + 1, k):
        if now_v > min(entry[border], limits[1, border]) * wide:
            return False
        if now_a > limits[2, border] * wide:
            return False
        was_a = now_a
        distance += limits[0, border]
        now_v, now_a = brake_state(distance, v, a, w, deceleration, jerk)
        if was_a > 0.0 and (now_v if now_a > 0.0 else top) > limits[1, border] * wide:
            return False
    return True


@numba.njit(cache=True)
def find_brake(
    limits: FloatArray, entry: FloatArray, reach: FloatArray,
    i: int, x: float, v: float, a: float, slack: float, nearest: int,
) -> int:  # fmt: skip
    """The border to which a safe state can brake; -1 if the state is not safe.

    Args:
        limits: Rows length, velocity, acceleration, deceleration, jerk of n pieces, shape (5, n).
        entry: Highest v at each border, shape (n + 1,).
        reach: As above; entries up to i are not looked at, shape (n + 1,).
        i: Piece of the state.
        x: Place within it.
        v: Velocity.
        a: Acceleration, not negative.
        slack: Relative slack of all comparisons.
        nearest: Borders before this one are not tried.
    """
    count = limits.shape[1]
    wide = 1.0 + slack
    if v > limits[1, i] * wide or a > limits[2, i] * wide:
        return -1
    deceleration, jerk = limits[3, i], limits[4, i]
    ceiling = limits[1, i]
    softest = math.inf
    distance = limits[0, i] - x
    own_distance = distance
    nearer = 0.0
    failed = 0
    lowest = math.inf
    for k in range(i + 1, count + 1):
        if k > i + 1:
            piece = k - 1
            if limits[0, piece] == 0.0:
                return -1
            nearer = distance
            distance += limits[0, piece]
            deceleration = min(deceleration, limits[3, piece])
            jerk = min(jerk, limits[4, piece])
            ceiling = min(ceiling, limits[1, piece], entry[piece])
            softest = min(softest, limits[2, piece])
        if k < nearest:
            continue
        w = reach[k]
        lift_time = a / jerk
        lift = (v + a * lift_time / 3.0) * lift_time
        top = v + 0.5 * a * lift_time
        need = lift
        if top > w:
            need += brake_distance(top, w, deceleration, jerk)
            if need * wide < nearer:
                # It would end before the last border but one, lower than that border asks for.
                continue
        if need <= distance * wide + slack * 1e-3 and w < lowest:
            if top <= ceiling * wide and (lift <= own_distance or a <= softest):
                return k
            if holds_on_the_way(limits, entry, i, x, v, a, k, w, deceleration, jerk, wide):
                return k
            lowest = w
            failed += 1
            if failed >= FAILED_BRAKES:
                return -1
        if entry[k] < SLOWEST:
            return -1
    return -1


@numba.njit(cache=True)
def find_reach(limits: FloatArray, entry: FloatArray, known: FloatArray) -> FloatArray:
    """The highest safe velocity at every border, a = 0.

    Args:
        limits: As in ``find_brake``.
        entry: As in ``find_brake``; the last must be 0.
        known: Velocities that are known to be safe from a shorter window, shape (m <= n + 1,).
    """
    count = limits.shape[1]
    reach = np.zeros(count + 1)
    nearest = 0
    for i in range(count - 1, -1, -1):
        if entry[i] < SLOWEST or limits[0, i] == 0.0:
            nearest = 0
            continue
        highest = min(entry[i], limits[1, i])
        if i > 0:
            highest = min(highest, limits[1, i - 1])
        if find_brake(limits, entry, reach, i, 0.0, highest, 0.0, 0.0, 0) >= 0:
            reach[i] = highest
            nearest = 0
            continue
        # The border after this one says where to look: a little above what is safe there.
        low, step = 0.0, highest
        if i < len(known):
            low = known[i]
        if i + 2 <= count and reach[i + 1] > 0.0:
            step = max(abs(reach[i + 1] - reach[i + 2]), 1e-6 * highest)
            guess = min(reach[i + 1], highest)
            found = find_brake(limits, entry, reach, i, 0.0, guess, 0.0, 0.0, nearest - 3)
            if guess > low and found >= 0:
                low = guess
        high = min(highest, low + step)
        while high < highest:
            if find_brake(limits, entry, reach, i, 0.0, high, 0.0, 0.0, nearest - 3) < 0:
                break
            low = high
            step *= 4.0
            high = min(highest, low + step)
        for _ in range(BISECTIONS):
            if high - low <= REACH_PRECISION * high:
                break
            middle = 0.5 * (low + high)
            found = find_brake(limits, entry, reach, i, 0.0, middle, 0.0, 0.0, nearest - 3)
            if found >= 0:
                low, nearest = middle, found
            else:
                high = middle
        reach[i] = low if low >= SLOWEST else 0.0
    return reach
