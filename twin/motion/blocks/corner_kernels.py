"""Rounding polynomials of borders, and how wide they may be.

With t = y / width from -1 to 1, y being the distance from the border, the rounding of a tangent_step is
``tangent_step width (smooth_ramp(t) - max(t, 0))``, the kink of a ramp, smoothed by the parabolic kernel
3/4 (1 - t²)::

    smooth_ramp(t) = (3 + 8 t + 6 t² - t⁴) / 16

It is largest at the border, 3/16, and convex on either side. The rounding of a curvature_step is
``curvature_step width² (smooth_square(t) - max(t, 0)²/2)`` with the quintic that meets 0 and t²/2 with two
derivatives; it is odd::

    smooth_square(t) = (3 t + 8 t² + 6 t³ - t⁵) / 32
"""

import math

import numpy as np

from twin.compilation.kernel import array_kernel, summing_kernel
from twin.motion.blocks.blocks import BoolArray
from twin.nc.canonical import FloatArray, IntArray

MAX_NEIGHBOURS = 32
"""Borders to either side that a rounding may reach over."""

MAX_STEPS = 50
"""Of the search for a width; some four are usual."""

NEARLY = 1e-6
"""Relative step of the search from which on the next would be rounding."""

NARROWEST = 1e-4
"""A rounding narrower than this is none [mm or deg]."""

CURVATURE_PEAK = 0.01074
"""Largest value of ``smooth_square(t) - max(t, 0)²/2`` (0.010736)."""

BESIDE_STOP = 0.5
"""Share of the distance to a stop that a rounding may reach: the rest is left for speeding up, which
a rounding leaves little room for."""

OVERLAP_POINTS = 16
"""At which roundings from both ends of a block are added up."""


@array_kernel
def _between(
    place: FloatArray, width: FloatArray, per_width: FloatArray, per_square: FloatArray,
    i: int, before: int, after: int,
) -> float:  # fmt: skip
    """Share of the tolerance that roundings use within block i where those of both ends meet.

    Elsewhere along the block they use no more than at its borders, where the peak of each counts.

    Args:
        place: As in ``find_widths``.
        width: Of the roundings, shape (n,).
        per_width: As in ``find_widths``.
        per_square: As in ``find_widths``.
        before: Border before the first that may reach into the block.
        after: Border after the last.
    """
    begin, end = place[i + 1], place[i]
    for other in range(before + 1, after):
        if other <= i:
            end = max(end, place[other] + width[other])
        else:
            begin = min(begin, place[other] - width[other])
    begin, end = max(begin, place[i]), min(end, place[i + 1])
    if begin >= end:
        return 0.0
    h = (end - begin) / (OVERLAP_POINTS - 1)
    most = 0.0
    for point in range(OVERLAP_POINTS):
        used = 0.0
        for other in range(before + 1, after):
            t = abs(begin + h * point - place[other]) / width[other] if width[other] > 0.0 else 1.0
            if t < 1.0:
                ramp = (3.0 + t * (-8.0 + t * (6.0 - t * t))) / 16.0
                curvature_step = t * (3.0 + t * (-8.0 + t * (6.0 - t * t))) / 32.0
                # Between two points a curvature_step lies within h²/8 of its second derivative, half at most.
                square = curvature_step * width[other] ** 2 + h * h / 16.0
                used += per_width[other] * width[other] * ramp + per_square[other] * square
        most = max(most, used)
    return most


@summing_kernel
def _used(
    place: FloatArray, per_width: FloatArray, per_square: FloatArray,
    i: int, reached: tuple[int, int], width: float,
) -> tuple[float, float]:  # fmt: skip
    """Share of the tolerance used at a border by roundings of one width, and its slope by width.

    Args:
        place: As in ``find_widths``.
        per_width: As in ``find_widths``.
        per_square: As in ``find_widths``.
        reached: The first border that reaches there and the one after the last.
    """
    ramps, slopes, curvature_steps = 0.0, 0.0, 0.0
    at, per_reach = place[i], 1.0 / width
    # To see that no index is negative helps the compiler; a slice would cost as much as the sum.
    first = max(0, reached[0])
    for row in range(reached[1] - first):
        other = first + row
        t = abs(place[other] - at) * per_reach
        squared = t * t
        flat = 1.0 - squared
        ramps += per_width[other] * (3.0 + t * (-8.0 + t * (6.0 - squared)))
        slopes += per_width[other] * (flat * flat)
        curvature_steps += per_square[other]
    curvature_steps *= CURVATURE_PEAK * width
    return width * (ramps / 16.0 + curvature_steps), slopes * 3.0 / 16.0 + 2.0 * curvature_steps


@array_kernel
def _reached(
    place: FloatArray, i: int, walls: tuple[int, int], width: float, near: tuple[int, int]
) -> tuple[int, int]:
    """The first border nearer than ``width`` to border i and the one after the last.

    Args:
        place: As in ``find_widths``.
        walls: Border before the first that counts, and after the last.
        width: [mm or deg]
        near: Where to begin the search: a result for another width or border.
    """
    first, last = min(max(near[0], walls[0] + 1), i), max(min(near[1], walls[1]), i + 1)
    while first < i and place[i] - place[first] >= width:
        first += 1
    while first > walls[0] + 1 and place[i] - place[first - 1] < width:
        first -= 1
    while last > i + 1 and place[last - 1] - place[i] >= width:
        last -= 1
    while last < walls[1] and place[last] - place[i] < width:
        last += 1
    return first, last


@array_kernel
def _even_width(
    place: FloatArray, per_width: FloatArray, per_square: FloatArray,
    i: int, walls: tuple[int, int], high: float, guess: float, near: tuple[int, int],
) -> tuple[float, tuple[int, int]]:  # fmt: skip
    """The width that uses the tolerance at a border if its neighbours took the same.

    Args:
        place: As in ``find_widths``.
        per_width: As in ``find_widths``.
        per_square: As in ``find_widths``.
        walls: Border before the first that counts, and after the last.
        high: The largest width.
        guess: Where to begin the search.
        near: The borders reached by that width, or about these.

    Returns:
        The width; the borders reached by it, or about these.
    """
    width, below, above = min(guess, high), 0.0, math.inf
    for _ in range(MAX_STEPS):
        near = _reached(place, i, walls, width, near)
        used, slope = _used(place, per_width, per_square, i, near, width)
        if used > 1.0:
            above = width
        elif width == high:
            return high, near
        else:
            below = width
        # What is used grows like a power of the width: the first for a tangent_step alone, the second for
        # many. Newton's step for such a power, with ``used ** -flatness`` by Padé.
        flatness = used / (slope * width)
        new = width * (2.0 + (1.0 - flatness) * (used - 1.0))
        new = min(high, new / (2.0 + (1.0 + flatness) * (used - 1.0)))
        if abs(new - width) <= NEARLY * width or below >= (1.0 - NEARLY) * above:
            return max(below, new) if new < above else below, near
        # Where a curvature step comes within reach its share is there at once: no slope tells.
        width = new if below < new < above else 0.5 * (below + above)
    return below, near


@summing_kernel
def _add_shares(
    excess: FloatArray, place: FloatArray, i: int, reached: tuple[int, int], width: float,
    per_width: float, per_square: float,
) -> None:  # fmt: skip
    """Add what one rounding uses of the tolerance at the borders that it reaches, in place."""
    at, per_reach = place[i], 1.0 / width
    tangent_step, curvature_step = (
        width * per_width / 16.0,
        width * width * per_square * CURVATURE_PEAK,
    )
    first = max(0, reached[0])
    for row in range(reached[1] - first):
        other = first + row
        t = abs(place[other] - at) * per_reach
        excess[other] += tangent_step * (3.0 + t * (-8.0 + t * (6.0 - t * t))) + curvature_step


@summing_kernel
def _largest(values: FloatArray, first: int, last: int) -> float:
    """The largest of some of them, 1 at least."""
    most = 1.0
    first = max(0, first)
    for row in range(last - first):
        most = max(most, values[first + row])
    return most


@array_kernel
def _find_walls(rounded: BoolArray) -> tuple[IntArray, IntArray]:
    """The nearest borders on either side that no rounding reaches or crosses, shape (n,) each."""
    count = len(rounded)
    before, after = np.zeros(count, np.int64), np.zeros(count, np.int64)
    wall = 0
    for i in range(count):
        if not rounded[i]:
            wall = i
        before[i] = max(wall, i - MAX_NEIGHBOURS)
    wall = count
    for i in range(count - 1, -1, -1):
        if not rounded[i]:
            wall = i
        after[i] = min(wall, i + MAX_NEIGHBOURS)
    return before, after


@array_kernel
def find_widths(
    place: FloatArray, rounded: BoolArray, per_width: FloatArray, per_square: FloatArray
) -> FloatArray:
    """How far the rounding of each border reaches.

    Each border first takes the width that would use the tolerance if all its neighbours took the
    same. Where the sum of what they then take passes the tolerance, at a border or where roundings
    meet between two, those that reach there are narrowed by that factor, which is enough because a
    narrower rounding is also a flatter one.

    Args:
        place: Where each block begins and, last, where the last one ends, shape (n + 1,).
        rounded: Whether the border before each block is rounded, shape (n,).
        per_width: Share of the tolerance per width, shape (n,).
        per_square: Share of the tolerance per width², shape (n,).

    Returns:
        Shape (n,) [mm or deg]; 0 where there is nothing to round or no room.
    """
    count = len(rounded)
    before, after = _find_walls(rounded)
    width = np.zeros(count)
    reached = np.zeros((count, 2), np.int64)
    excess = np.zeros(count)
    guess, near = math.inf, (0, 0)
    for i in range(count):
        if not rounded[i] or (per_width[i] == 0.0 and per_square[i] == 0.0):
            continue
        walls = before[i], after[i]
        high = min(
            (place[i] - place[walls[0]]) * (1.0 if rounded[walls[0]] else BESIDE_STOP),
            (place[walls[1]] - place[i])
            * (1.0 if walls[1] < count and rounded[walls[1]] else BESIDE_STOP),
        )
        guess, near = _even_width(place, per_width, per_square, i, walls, high, guess, near)
        if guess > 0.0:
            width[i] = guess
            near = _reached(place, i, walls, guess, near)
            reached[i, 0], reached[i, 1] = near
            _add_shares(excess, place, i, near, guess, per_width[i], per_square[i])
    if np.any(per_square > 0.0):
        within = np.ones(count)
        for i in range(count - 1):
            if rounded[i] or rounded[i + 1]:
                low = before[i] if rounded[i] else i
                high = after[i + 1] if rounded[i + 1] else i + 1
                within[i] = _between(place, width, per_width, per_square, i, low, high)
        for i in range(1, count):
            excess[i] = max(excess[i], within[i - 1], within[i])
    out = np.zeros(count)
    for i in range(count):
        if width[i] > 0.0:
            narrowed = width[i] / _largest(excess, reached[i, 0], reached[i, 1])
            out[i] = narrowed if narrowed >= NARROWEST else 0.0
    return out
