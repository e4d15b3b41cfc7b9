"""Rounding polynomials of borders, and how wide they may be.

With t = y / width from -1 to 1, y being the distance from the border, the rounding of a knee is
``knee width (smooth_ramp(t) - max(t, 0))``, the kink of a ramp, smoothed by the parabolic kernel
3/4 (1 - t²)::

    smooth_ramp(t) = (3 + 8 t + 6 t² - t⁴) / 16

It is largest at the border, 3/16, and convex on either side. The rounding of a bend is
``bend width² (smooth_square(t) - max(t, 0)²/2)`` with the quintic that meets 0 and t²/2 with two
derivatives; it is odd::

    smooth_square(t) = (3 t + 8 t² + 6 t³ - t⁵) / 32
"""

import math

import numba
import numpy as np

from twin.nc.canonical import FloatArray

MOST_NEIGHBOURS = 32
"""Borders to either side that a rounding may reach over."""

MOST_STEPS = 50
"""Of the search for a width; some four are usual."""

NEARLY = 1e-6
"""Relative step of Newton's from which on the next would be rounding."""

NARROWEST = 1e-4
"""A rounding narrower than this is none [mm or deg]."""

KNEE_PEAK = 3.0 / 16.0
BEND_PEAK = 0.01074
"""Largest value of ``smooth_square(t) - max(t, 0)²/2`` (0.010736)."""

OVERLAP_POINTS = 16
"""At which roundings from both ends of a block are added up."""


@numba.njit(cache=True)
def _share(away: float, width: float, per_width: float, per_square: float) -> float:
    """Share of the tolerance that a rounding uses ``away`` from its border."""
    t = abs(away) / width
    if t >= 1.0:
        return 0.0
    ramp = (3.0 + t * (-8.0 + t * (6.0 - t * t))) / 16.0
    return width * (per_width * ramp + per_square * width * BEND_PEAK)


@numba.njit(cache=True)
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
        i: The block.
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
                bend = t * (3.0 + t * (-8.0 + t * (6.0 - t * t))) / 32.0
                # Between two points a bend lies within h²/8 of its second derivative, half at most.
                square = bend * width[other] ** 2 + h * h / 16.0
                used += per_width[other] * width[other] * ramp + per_square[other] * square
        most = max(most, used)
    return most


@numba.njit(cache=True)
def _even_width(
    place: FloatArray, per_width: FloatArray, per_square: FloatArray,
    i: int, before: int, after: int, high: float, guess: float,
) -> float:  # fmt: skip
    """The width that uses the tolerance at a border if its neighbours took the same.

    Args:
        place: As in ``find_widths``.
        per_width: As in ``find_widths``.
        per_square: As in ``find_widths``.
        i: The border.
        before: Border before the first that counts.
        after: Border after the last.
        high: The widest that has room.
        guess: Where to begin the search.
    """
    width, below, above = min(guess, high), 0.0, math.inf
    for _ in range(MOST_STEPS):
        # What is used grows with the width, and ever faster: Newton comes down to the root.
        used, slope = 0.0, 0.0
        other, step = i, -1
        while True:
            away = abs(place[other] - place[i])
            if before < other < after and away < width:
                t = away / width
                flat = 1.0 - t * t
                knee, bend = per_width[other], per_square[other] * BEND_PEAK
                used += width * (
                    knee * (3.0 + t * (-8.0 + t * (6.0 - t * t))) / 16.0 + bend * width
                )
                slope += knee * 3.0 / 16.0 * flat * flat + 2.0 * bend * width
                other += step
            elif step < 0:
                other, step = i + 1, 1
            else:
                break
        if used > 1.0:
            above = width
        elif width == high:
            return high
        else:
            below = width
        new = min(high, width - (used - 1.0) / slope)
        if abs(new - width) <= NEARLY * width or below >= (1.0 - NEARLY) * above:
            return max(below, new) if new < above else below
        # Where a bend comes within reach its share is there at once: Newton cannot see that.
        width = new if below < new < above else 0.5 * (below + above)
    return below


@numba.njit(cache=True)
def find_widths(
    place: FloatArray, rounded: FloatArray, per_width: FloatArray, per_square: FloatArray
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
    first = np.zeros(count)
    before = np.zeros(count, np.int64)
    after = np.zeros(count, np.int64)
    wall = 0
    for i in range(count):
        if not rounded[i]:
            wall = i
        before[i] = max(wall, i - MOST_NEIGHBOURS)
    wall = count
    for i in range(count - 1, -1, -1):
        if not rounded[i]:
            wall = i
        after[i] = min(wall, i + MOST_NEIGHBOURS)
    guess = math.inf
    for i in range(count):
        if not rounded[i] or (per_width[i] == 0.0 and per_square[i] == 0.0):
            continue
        high = min(place[i] - place[before[i]], place[after[i]] - place[i])
        guess = _even_width(place, per_width, per_square, i, before[i], after[i], high, guess)
        first[i] = guess
    excess = np.ones(count)
    for i in range(count):
        # What each rounding takes at the borders that it reaches.
        if first[i] == 0.0:
            continue
        other = i
        while other > before[i] and place[i] - place[other] < first[i]:
            excess[other] += _share(place[i] - place[other], first[i], per_width[i], per_square[i])
            other -= 1
        other = i + 1
        while other < after[i] and place[other] - place[i] < first[i]:
            excess[other] += _share(place[other] - place[i], first[i], per_width[i], per_square[i])
            other += 1
    for i in range(count):
        excess[i] = max(1.0, excess[i] - 1.0)
    within = np.ones(count)
    if np.any(per_square > 0.0):
        for i in range(count):
            if i + 1 < count and (rounded[i] or rounded[i + 1]):
                low = before[i] if rounded[i] else i
                high = after[i + 1] if rounded[i + 1] else i + 1
                within[i] = max(1.0, _between(place, first, per_width, per_square, i, low, high))
    width = np.zeros(count)
    for i in range(count):
        if first[i] == 0.0:
            continue
        most = max(1.0, within[i - 1], within[i])
        other = i
        while other > before[i] and place[i] - place[other] < first[i]:
            most = max(most, excess[other], within[other - 1], within[other])
            other -= 1
        other = i + 1
        while other < after[i] and place[other] - place[i] < first[i]:
            most = max(most, excess[other], within[other - 1], within[other])
            other += 1
        if first[i] / most >= NARROWEST:
            width[i] = first[i] / most
    return width


@numba.njit(cache=True)
def add_rounding(
    coefficients: FloatArray, away: float, width: float, knee: FloatArray, bend: FloatArray,
    share: float = 1.0,
) -> None:  # fmt: skip
    """Add a border's rounding to the polynomials of a piece.

    Args:
        coefficients: Of each axis by powers of x from the piece's begin, shape (k, 6).
        away: From the border to the piece's begin, negative before the border [mm or deg]; the
            piece lies on one side of the border.
        width: Of the rounding [mm or deg].
        knee: Step of dq/dx, shape (k,).
        bend: Step of d²q/dx², shape (k,).
        share: -1 to take the rounding away.
    """
    t = away / width
    squared = t * t
    beyond = 1.0 if away >= 0.0 else 0.0
    # Taylor's coefficients about the piece's begin, in t.
    ramp = (
        (3.0 + t * (8.0 + t * (6.0 - squared))) / 16.0 - beyond * t,
        (2.0 + t * (3.0 - squared)) / 4.0 - beyond,
        3.0 * (1.0 - squared) / 8.0,
        -t / 4.0,
        -1.0 / 16.0,
        0.0,
    )
    square = (
        t * (3.0 + t * (8.0 + t * (6.0 - squared))) / 32.0 - 0.5 * beyond * squared,
        (3.0 + t * (16.0 + t * (18.0 - 5.0 * squared))) / 32.0 - beyond * t,
        (4.0 + t * (9.0 - 5.0 * squared)) / 16.0 - 0.5 * beyond,
        (3.0 - 5.0 * squared) / 16.0,
        -5.0 * t / 32.0,
        -1.0 / 32.0,
    )
    scale = share * width
    for power in range(6):
        for axis in range(len(knee)):
            coefficients[axis, power] += scale * (
                knee[axis] * ramp[power] + bend[axis] * width * square[power]
            )
        scale /= width
