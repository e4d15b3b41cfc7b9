"""From which states one can still brake in time, and how fast each border may be passed.

A state on the path is *safe* if from it one can brake to a later border of segments, arriving there
with a = 0 and no faster than that border's controllable velocity, within all limits on the way. The
controllable velocity is the highest that is itself safe at the border with a = 0, so that a safe
state can go on safely to the end of the window, where v = 0. It is found backwards from the end.
"""

import math

import numpy as np

from twin.compilation.kernel import array_kernel, kernel
from twin.motion.profile.brake_kernels import brake_distance_from
from twin.motion.profile.brake_margin_kernels import (
    MAX_CHORDS,
    MAX_STEPS,
    brake_margin,
    crossing,
    narrowed,
)
from twin.motion.profile.state import Brake, PathAhead, State
from twin.motion.ramp_kernels import brake_distance
from twin.nc.canonical import FloatArray

BISECTIONS = 52
"""Halvings of an interval: down to the rounding of a double."""

ROUNDING = 1e-9
"""Relative slack for comparisons of quantities that are equal but for rounding."""

VELOCITY_PRECISION = 1e-9
"""Of velocities at borders, relative: far finer than any loss of time."""

SLOWEST = 1e-6
"""A border that must be passed more slowly than this is passed from a stop [mm/s or deg/s]."""

LEAST_GAIN = 1e-5
"""A brake that does not allow this much more than the best so far is not looked into; where a limit
on the way bounds the velocity, no more than this share of it is lost."""

LONGEST_BRAKE = math.sqrt(32.0 / 27.0)
"""The distance from v to w is longest for w = v / 3: that much longer than the one to a stop."""

NEARLY = 1e-9
"""Of a root: from here on a step of Newton's leads to the rounding of a double."""

FAILED_BRAKES = 4
"""Brakes that fit their distance but break a limit on the way before the search gives up."""


@kernel
def find_brake(course: PathAhead, state: State, slack: float) -> int:
    """The border to which a safe state can brake; -1 if none is found.

    Args:
        course: The path; controllable velocities up to the state's segment are not looked at.
        slack: Relative slack of all comparisons.
    """
    limits, entry, controllable = course
    i, x, v, a = state
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
            longest = LONGEST_BRAKE * brake_distance_from(v, a, 0.0, deceleration, jerk)
            if limits[0, last] == 0.0 or longest < distance:
                # Any brake would end earlier: if none has done, nothing further on does.
                return -1
            distance += limits[0, last]
            deceleration = min(deceleration, limits[3, last])
            jerk = min(jerk, limits[4, last])
            ceiling = min(ceiling, limits[1, last], entry[last])
            softest = min(softest, limits[2, last])
        w = controllable[k]
        if w < lowest:
            lift_time = a / jerk
            lift = (v + a * lift_time / 3.0) * lift_time
            top = v + 0.5 * a * lift_time
            need = lift
            if top > w:
                need += brake_distance(top, w, deceleration, jerk)
            if need <= distance * wide + slack * 1e-3:
                if top <= ceiling * wide and (lift <= own_distance or a <= softest):
                    return k
                room = brake_margin(course, state, Brake(k, w, deceleration, jerk), wide)
                if room >= -slack * (distance + 1e-3):
                    return k
                lowest = w
                failed += 1
                if failed >= FAILED_BRAKES:
                    return -1
        if entry[k] < SLOWEST:
            return -1
    return -1


@kernel
def _fastest_start(distance: float, w: float, deceleration: float, jerk: float) -> float:
    """The highest v from which a brake to w takes no more than ``distance``."""
    # Eased all the way the drop is jerk s², over (2 w + jerk s²) s.
    s = min((distance / jerk) ** (1.0 / 3.0), distance / (2.0 * w) if w > 0.0 else math.inf)
    step = math.inf
    while step > NEARLY * s:
        # The curve is convex and s beyond the root: each step comes down towards it.
        step = ((jerk * s * s + 2.0 * w) * s - distance) / (3.0 * jerk * s * s + 2.0 * w)
        s -= step
    if jerk * s <= deceleration:
        return w + jerk * s * s
    # (v + w) / 2 ((v - w) / deceleration + deceleration / jerk) = distance
    half = 0.5 * deceleration * deceleration / jerk
    return -half + math.sqrt(max(0.0, (w - half) * (w - half) + 2.0 * deceleration * distance))


@kernel
def _faster_start(
    course: PathAhead, i: int, brake: Brake, distance: float, best: float, highest: float
) -> tuple[float, bool]:
    """The highest v up to ``highest`` from which a brake is possible.

    Args:
        i: Border of the start, where a = 0.
        distance: From border i to that of the brake.
        best: A velocity that is known to be safe.

    Returns:
        The velocity, or ``best`` where it is hardly higher; whether no limit on the way bounds it.
    """
    _, w, deceleration, jerk = brake
    low = max(best * (1.0 + LEAST_GAIN), SLOWEST)
    if low >= highest or (low > w and brake_distance(low, w, deceleration, jerk) > distance):
        return best, True
    high = highest
    if w < high and brake_distance(high, w, deceleration, jerk) > distance:
        high = min(high, _fastest_start(distance, w, deceleration, jerk))
    at_high = _margin_from(course, i, high, brake)
    if at_high >= -ROUNDING * distance:
        return max(best, high), True
    at_low = _margin_from(course, i, low, brake)
    if at_low < 0.0:
        return best, False
    side = 0
    for step in range(MAX_STEPS):
        if high - low <= LEAST_GAIN * high:
            break
        v = crossing(low, high, at_low, at_high) if step < MAX_CHORDS else 0.5 * (low + high)
        room = _margin_from(course, i, v, brake)
        low, high, at_low, at_high, side = narrowed(low, high, at_low, at_high, side, v, room)
    return low, False


@kernel
def _margin_from(course: PathAhead, i: int, v: float, brake: Brake) -> float:
    """``brake_margin`` from border i with a = 0, to the brake's velocity or v if that is lower."""
    k, w, deceleration, jerk = brake
    return brake_margin(course, State(i, 0.0, v, 0.0), Brake(k, min(w, v), deceleration, jerk), 1.0)


@array_kernel
def backward_pass(limits: FloatArray, entry: FloatArray, known: FloatArray) -> FloatArray:
    """The highest safe velocity at every border with a = 0, and the brake that makes it safe.

    Args:
        limits: Of a ``PathAhead``.
        entry: Of a ``PathAhead``; the last must be 0.
        known: The result of a window that ended earlier, for the first borders of this one,
            shape (4, m <= n + 1).

    Returns:
        Rows controllable velocity, border to which to brake, velocity there, last border looked at; shape
        (4, n + 1).
    """
    count = limits.shape[1]
    out = np.zeros((4, count + 1))
    controllable = out[0]
    course = PathAhead(limits, entry, controllable)
    for i in range(count + 1):
        out[1, i] = out[3, i] = min(i + 1, count)
    news = known.shape[1]
    for i in range(count - 1, -1, -1):
        if entry[i] < SLOWEST or limits[0, i] == 0.0:
            continue
        if i < known.shape[1] and known[3, i] < news:
            out[:, i] = known[:, i]
            continue
        highest = min(entry[i], limits[1, i])
        if i > 0:
            highest = min(highest, limits[1, i - 1])
        best, to = 0.0, i + 1
        if i < known.shape[1]:
            best, to = known[0, i], int(known[1, i])
        at = known[2, i] if best > 0.0 else controllable[to]
        deceleration, jerk = math.inf, math.inf
        distance, lowest = 0.0, math.inf
        failed = 0
        for k in range(i + 1, count + 1):
            last, out[3, i] = k - 1, k
            if limits[0, last] == 0.0 or best >= highest * (1.0 - VELOCITY_PRECISION):
                break
            if k > i + 1:
                longest = LONGEST_BRAKE * brake_distance(highest, 0.0, deceleration, jerk)
                if longest < distance:
                    break
            distance += limits[0, last]
            deceleration = min(deceleration, limits[3, last])
            jerk = min(jerk, limits[4, last])
            w = controllable[k]
            if w < lowest:
                brake = Brake(k, w, deceleration, jerk)
                v, free = _faster_start(course, i, brake, distance, best, highest)
                if not free:
                    lowest = w
                    failed += 1
                # Where a brake ends before the last segment, one to a nearer border does better.
                before = distance - limits[0, last]
                creeps = v > w and brake_distance(v, w, deceleration, jerk) < before
                if v > best and not (creeps and last > i):
                    best, to, at = v, k, min(w, v)
            if entry[k] < SLOWEST or failed >= FAILED_BRAKES:
                break
        if best >= SLOWEST:
            controllable[i], out[1, i], out[2, i] = best, to, at
        if i < known.shape[1] and controllable[i] != known[0, i]:
            news = i
    return out
