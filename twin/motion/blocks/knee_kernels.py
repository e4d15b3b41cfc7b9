"""How fast knees may be passed that follow one another closely, as where a curve is written as chords.

Each knee alone may step an axis's velocity. Together they are a curve, which is to be driven no faster than as an arc:
its acceleration is bounded by ``slow_dense_knees``, its jerk by ``slow_bending_chords``.
"""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import array_kernel, kernel
from twin.motion.blocks.blocks import BoolArray
from twin.motion.blocks.corner_limit_kernels import CURVE_SHARE
from twin.nc.canonical import FloatArray, IntArray

MOST_TOGETHER = 32
"""Borders that are looked at together: of short blocks some milliseconds at the feed."""

NEARLY = 1e-6
"""Relative step of the search for a velocity from which on the next would be rounding."""

MUCH_SLOWER = 0.5
"""A knee passed at less than this share of what the stretch about it allows counts at its own velocity, not at the stretch's."""

NARROWINGS = 12
"""How often the velocity of a stretch with much slower knees is looked for again: each time it falls by less."""


@array_kernel
def slow_dense_knees(
    velocity: FloatArray, tangent_step: FloatArray, length: FloatArray, angle: FloatArray,
    velocity_step: FloatArray, acceleration: FloatArray,
) -> None:  # fmt: skip
    """Lower the velocities of knees that follow one another closely, in place.

    Each knee alone may step an axis's velocity; along a stretch d between two of them, which takes d / v, an axis
    gains by all its knees S v. That is to be no more than one step and what its acceleration gains
    meanwhile: S v <= step + acceleration d / v. So an arc that is written as chords is driven no faster than as an arc.
    A corner that is passed far more slowly than the rest of the stretch adds to S v no more than at its own velocity.

    Args:
        velocity: Highest at each border, shape (n,); infinite where nothing steps.
        tangent_step: From ``border_steps``.
        length: Of the blocks, shape (n,).
        angle: Sweep of the blocks, 0 for lines, shape (n,) [rad].
        velocity_step: Largest of each axis, shape (k,).
        acceleration: Of each axis, shape (k,).
    """
    count, axes = tangent_step.shape
    sums = np.zeros(axes)
    next_rough = _next_rough(velocity, tangent_step, length, velocity_step, acceleration)
    for i in range(1, count):
        if not 0.0 < velocity[i] < math.inf or next_rough[i] > i + MOST_TOGETHER:
            continue
        distance, slowest = 0.0, velocity[i]
        sums[:] = tangent_step[i]
        for j in range(i + 1, min(count, i + MOST_TOGETHER + 1)):
            if angle[j - 1] != 0.0 or velocity[j] == 0.0:
                break
            distance += length[j - 1]
            sums += tangent_step[j]
            if velocity[j] == math.inf:
                continue
            slowest = min(slowest, velocity[j])
            lowest, fastest = math.inf, max(velocity[i], velocity[j])
            per_fastest = 1.0 / fastest
            for axis in range(axes):
                turn, step = abs(sums[axis]), velocity_step[axis]
                gain = acceleration[axis] * distance
                # The root waits for what it lowers.
                if turn > 0.0 and turn * fastest > step + gain * per_fastest:
                    lowest = min(lowest, _highest_together(turn, step, gain))
            if slowest < MUCH_SLOWER * lowest < math.inf:
                knees = velocity[i : j + 1], tangent_step[i : j + 1]
                lowest = _highest_beside_corners(
                    knees, distance, velocity_step, acceleration, fastest
                )
            velocity[i], velocity[j] = min(velocity[i], lowest), min(velocity[j], lowest)


@array_kernel
def _next_rough(
    velocity: FloatArray, tangent_step: FloatArray, length: FloatArray, velocity_step: FloatArray,
    acceleration: FloatArray,
) -> IntArray:  # fmt: skip
    """Up to which border a stretch from each border on gains no more than it may, whatever its velocity, shape (n,).

    It does not where at the highest velocity of all knees the first one is within its step and the acceleration during each
    block makes up for the knee at its end. So most knees of a smooth curve need no look at their stretches.
    """
    count, axes = tangent_step.shape
    highest = 0.0
    for i in range(count):
        if velocity[i] < math.inf:
            highest = max(highest, velocity[i])
    found, rough = np.empty(count, np.int64), 2 * count + MOST_TOGETHER
    for i in range(count - 1, -1, -1):
        corner, steep = False, False
        for axis in range(axes):
            gain = abs(tangent_step[i, axis]) * highest
            corner |= gain > velocity_step[axis]
            steep |= i == 0 or gain * highest > acceleration[axis] * length[i - 1]
        found[i] = i if corner else rough
        if steep:
            rough = i
    return found


@kernel
def _highest_together(turn: float, step: float, gain: float) -> float:
    """The highest v with turn v <= step + gain / v."""
    return 0.5 * (step + math.sqrt(step * step + 4.0 * turn * gain)) / turn


@kernel
def _highest_beside_corners(
    knees: tuple[FloatArray, FloatArray], distance: float, velocity_step: FloatArray,
    acceleration: FloatArray, fastest: float,
) -> float:  # fmt: skip
    """The highest velocity along a stretch where knees that must be passed more slowly count at their own.

    Args:
        knees: The velocities at the stretch's borders, and the steps of their tangents.
        distance: Length of the stretch [mm or deg].
        velocity_step: As in ``slow_dense_knees``.
        acceleration: As in ``slow_dense_knees``.
        fastest: Where the search begins, from above.
    """
    velocity, tangent_step = knees
    for _ in range(NARROWINGS):
        lowest = fastest
        for axis in range(len(velocity_step)):
            gained = 0.0
            for k in range(len(velocity)):
                gained += tangent_step[k, axis] * min(fastest, velocity[k])
            step, gain = velocity_step[axis], acceleration[axis] * distance
            if abs(gained) > (step + gain / fastest) * (1.0 + NEARLY):
                lowest = min(lowest, _highest_together(abs(gained) / fastest, step, gain))
        if lowest == fastest:
            break
        fastest = lowest
    return fastest


SHORTEST_SPAN, SPANS = 0.05, 7
"""A curve's jerk is looked at over three spans of this length, and of twice, four times ... as long [mm or deg]."""

LONGEST_VIEW = 3.0 * SHORTEST_SPAN * 2.0 ** (SPANS - 1)
"""How far along the path the velocity at a knee can depend on other knees [mm or deg]."""


class BlockRun(NamedTuple):
    """n consecutive blocks, and where they lie along the path.

    Attributes:
        place: Where each begins and, last, where the last one ends, shape (n + 1,) [mm or deg].
        point: The axes there, shape (n + 1, k) [mm or deg].
        joined: Whether a block and the one before it are straight and the path goes on from the one to the
            other without a stop or a rounding, shape (n,).
    """

    place: FloatArray
    point: FloatArray
    joined: BoolArray


@array_kernel
def slow_bending_chords(
    velocity: FloatArray, chain: BlockRun, velocity_step: FloatArray, jerk: FloatArray
) -> None:
    """Lower the velocities of knees where the curve that they are chords of bends too quickly, in place.

    The third difference D of four points, each a span s behind the one before, is s³ times the mean of the path's third
    derivative, weighted by the quadratic B-spline over these three spans. At the velocity v, with w = v / s, an axis has
    the mean jerk D w³. Steps of its velocity within a range of S, which are allowed, give no more than
    2 S w², as the second derivative of that weight, times w², has the integral 4. So D w³ is to be no more than
    ``CURVE_SHARE`` of the axis's jerk, as along an arc, and 2 S w². A long span sees little of the steps, a
    short one small curves; the points do not depend on how many chords lie between them.

    Args:
        velocity: Highest at each border, shape (n,); infinite where nothing steps.
        velocity_step: Largest of each axis, shape (k,).
        jerk: Of each axis, shape (k,).
    """
    count = len(velocity)
    alone, slowest = velocity.copy(), np.zeros(count, np.int64)
    first = 0
    while first < count:
        last = first + 1
        while last < count and chain.joined[last]:
            last += 1
        span = SHORTEST_SPAN
        for _ in range(SPANS):
            if last > first + 2 and chain.place[last] - chain.place[first] >= 3.0 * span:
                _slow_run(velocity, alone, chain, (first, last), span, velocity_step, jerk, slowest)
            span *= 2.0
        first = last


@kernel
def _slow_run(
    velocity: FloatArray, alone: FloatArray, chain: BlockRun, run: tuple[int, int], span: float,
    velocity_step: FloatArray, jerk: FloatArray, slowest: IntArray,
) -> None:  # fmt: skip
    """Lower the velocities of knees within a run by one span.

    The points lie about the knee, or as near to it as the ends of the run allow. A knee among them that must be passed
    more slowly keeps the velocity down there.

    Args:
        velocity: As in ``slow_bending_chords``.
        alone: As it was before this bound.
        run: First block and the one after the last.
        span: Distance of the points.
        velocity_step: As in ``slow_bending_chords``.
        jerk: As in ``slow_bending_chords``.
        slowest: Scratch for knees between the points of which each is faster than the one before, shape (n,).
    """
    place, point = chain.place, chain.point
    first, last = run
    nearest, farthest = place[first] + 1.5 * span, place[last] - 1.5 * span
    a = b = c = d = first
    head, tail, seen = 0, 0, first + 1
    for i in range(first + 1, last):
        if velocity[i] == math.inf:
            continue
        begin = min(max(place[i], nearest), farthest) - 1.5 * span
        while seen < last and place[seen] < begin + 3.0 * span:
            while tail > head and alone[slowest[tail - 1]] >= alone[seen]:
                tail -= 1
            slowest[tail], tail, seen = seen, tail + 1, seen + 1
        while head + 1 < tail and place[slowest[head]] <= begin:
            head += 1
        a, along_a = _find(place, begin, a, last)
        b, along_b = _find(place, begin + span, b, last)
        c, along_c = _find(place, begin + 2.0 * span, c, last)
        d, along_d = _find(place, begin + 3.0 * span, d, last)
        rate = min(velocity[i], alone[slowest[head]]) / span
        for axis in range(len(jerk)):
            third = _between(point, d, along_d, axis) - _between(point, a, along_a, axis)
            third -= 3.0 * (_between(point, c, along_c, axis) - _between(point, b, along_b, axis))
            lower = _highest_rate(
                abs(third), CURVE_SHARE * jerk[axis], 2.0 * velocity_step[axis], rate
            )
            if lower < rate:
                rate = lower
                velocity[i] = rate * span


@kernel
def _find(place: FloatArray, x: float, block: int, last: int) -> tuple[int, float]:
    """The block at a place, from another one on, and how much of it lies before that place."""
    while block + 1 < last and place[block + 1] <= x:
        block += 1
    length = place[block + 1] - place[block]
    return block, (x - place[block]) / length if length > 0.0 else 0.0


@kernel
def _between(point: FloatArray, block: int, along: float, axis: int) -> float:
    """Where an axis is within a straight block."""
    begin = point[block, axis]
    return begin + along * (point[block + 1, axis] - begin)


@kernel
def _highest_rate(third: float, jerk: float, steps: float, rate: float) -> float:
    """The highest w up to ``rate`` with third w³ <= jerk + steps w²."""
    while third * rate * rate * rate > (jerk + steps * rate * rate) * (1.0 + NEARLY):
        # Convex beyond its only root: Newton's steps come down towards it.
        over = (third * rate - steps) * rate * rate - jerk
        rate -= over / ((3.0 * third * rate - 2.0 * steps) * rate)
    return rate
