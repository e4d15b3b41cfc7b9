"""From which states one can still brake in time, and how fast each border may be passed.

The state on the path is (stretch, x within it, v, a). It is *safe* if from it one can brake to a
later border of stretches, arriving there with a = 0 and no faster than that border's ``reach``, within
all limits on the way. ``reach`` is the highest velocity that is itself safe at the border with
a = 0, so that a safe state has a safe way to the end of the window, where v = 0. It is found
backwards from the end.
"""

import math

import numba
import numpy as np

from twin.motion.brake_kernels import brake_distance, brake_need, brake_state
from twin.nc.canonical import FloatArray

BISECTIONS = 52
"""Halvings of an interval: down to the rounding of a double."""

ROUNDING = 1e-9
"""Relative slack for comparisons of quantities that are equal but for rounding."""

REACH_PRECISION = 1e-9
"""Of velocities at borders, relative: far finer than any loss of time."""

SLOWEST = 1e-6
"""A border that must be passed more slowly than this is passed from a stop [mm/s or deg/s]."""

REACH_GAIN = 1e-5
"""A brake that does not allow this much more than the best so far is not looked into."""

REACH_HALVINGS = 16
"""Where a limit on the way bounds the velocity: what is lost is a hundred thousandth of it."""

FAILED_BRAKES = 4
"""Brakes that fit their distance but break a limit on the way before the search gives up."""


@numba.njit(cache=True)
def holds_on_the_way(
    limits: FloatArray, entry: FloatArray, i: int, x: float, v: float, a: float,
    k: int, w: float, deceleration: float, jerk: float, wide: float,
) -> bool:  # fmt: skip
    """Whether the brake to border k keeps the velocities and accelerations of stretches i to k - 1."""
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
    """The border to which a safe state can brake; -1 if none is found.

    Args:
        limits: Rows length, velocity, acceleration, deceleration, jerk of n stretches, shape
            (5, n).
        entry: Highest v at each border, shape (n + 1,).
        reach: As above; entries up to i are not looked at, shape (n + 1,).
        i: Stretch of the state.
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
    failed = 0
    lowest = math.inf
    for k in range(i + 1, count + 1):
        if k > i + 1:
            last = k - 1
            if limits[0, last] == 0.0 or brake_need(v, a, 0.0, deceleration, jerk) < distance:
                # A stop would come earlier: if even that does not do, nothing further on does.
                return -1
            distance += limits[0, last]
            deceleration = min(deceleration, limits[3, last])
            jerk = min(jerk, limits[4, last])
            ceiling = min(ceiling, limits[1, last], entry[last])
            softest = min(softest, limits[2, last])
        w = reach[k]
        if k >= nearest and w < lowest:
            lift_time = a / jerk
            lift = (v + a * lift_time / 3.0) * lift_time
            top = v + 0.5 * a * lift_time
            need = lift
            if top > w:
                need += brake_distance(top, w, deceleration, jerk)
            if need <= distance * wide + slack * 1e-3:
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
def _fastest_start(distance: float, w: float, deceleration: float, jerk: float) -> float:
    """The highest v from which a brake to w takes no more than ``distance``."""
    # Eased all the way the drop is jerk s², over (2 w + jerk s²) s.
    s = min((distance / jerk) ** (1.0 / 3.0), distance / (2.0 * w) if w > 0.0 else math.inf)
    for _ in range(60):
        step = ((jerk * s * s + 2.0 * w) * s - distance) / (3.0 * jerk * s * s + 2.0 * w)
        s -= step
        if abs(step) <= 1e-15 * s:
            break
    if jerk * s <= deceleration:
        return w + jerk * s * s
    # (v + w) / 2 ((v - w) / deceleration + deceleration / jerk) = distance
    half = 0.5 * deceleration * deceleration / jerk
    return -half + math.sqrt(max(0.0, (w - half) * (w - half) + 2.0 * deceleration * distance))


@numba.njit(cache=True)
def find_reach(limits: FloatArray, entry: FloatArray, known: FloatArray) -> FloatArray:
    """The highest safe velocity at every border with a = 0, and the brake that makes it safe.

    Args:
        limits: As in ``find_brake``.
        entry: As in ``find_brake``; the last must be 0.
        known: The same result of a window that ended earlier, for the first borders of this one,
            shape (3, m <= n + 1).

    Returns:
        Rows reach, border to which to brake, velocity there; shape (3, n + 1).
    """
    count = limits.shape[1]
    out = np.zeros((3, count + 1))
    reach = out[0]
    for i in range(count + 1):
        out[1, i] = min(i + 1, count)
    for i in range(count - 1, -1, -1):
        if entry[i] < SLOWEST or limits[0, i] == 0.0:
            continue
        highest = min(entry[i], limits[1, i])
        if i > 0:
            highest = min(highest, limits[1, i - 1])
        best, to = 0.0, i + 1
        if i < known.shape[1]:
            best, to = known[0, i], int(known[1, i])
        at = known[2, i] if best > 0.0 else reach[to]
        deceleration, jerk, ceiling = math.inf, math.inf, math.inf
        distance, lowest = 0.0, math.inf
        failed = 0
        for k in range(i + 1, count + 1):
            last = k - 1
            if limits[0, last] == 0.0 or best >= highest * (1.0 - REACH_PRECISION):
                break
            if k > i + 1 and brake_distance(highest, 0.0, deceleration, jerk) < distance:
                break
            distance += limits[0, last]
            deceleration = min(deceleration, limits[3, last])
            jerk = min(jerk, limits[4, last])
            ceiling = min(ceiling, limits[1, last])
            if last > i:
                ceiling = min(ceiling, entry[last])
            w = reach[k]
            if w < lowest:
                v = highest
                if w < v and brake_distance(v, w, deceleration, jerk) > distance:
                    v = min(v, _fastest_start(distance, w, deceleration, jerk))
                if v > best:
                    holds = v <= ceiling or holds_on_the_way(
                        limits, entry, i, 0.0, v, 0.0, k, w, deceleration, jerk, 1.0
                    )
                    if not holds:
                        lowest = w
                        failed += 1
                        low, high = best, v
                        v = max(best * (1.0 + REACH_GAIN), SLOWEST)
                        worth = v < high and holds_on_the_way(
                            limits, entry, i, 0.0, v, 0.0, k, min(w, v), deceleration, jerk, 1.0
                        )
                        for _ in range(REACH_HALVINGS if worth else 0):
                            v = 0.5 * (low + high)
                            if holds_on_the_way(
                                limits, entry, i, 0.0, v, 0.0, k, min(w, v), deceleration, jerk, 1.0
                            ):
                                low = v
                            else:
                                high = v
                        v = low
                    if v > best:
                        best, to, at = v, k, min(w, v)
            if entry[k] < SLOWEST or failed >= FAILED_BRAKES:
                break
        if best >= SLOWEST:
            reach[i], out[1, i], out[2, i] = best, to, at
    return out
