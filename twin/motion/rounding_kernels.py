"""The polynomials that roundings add to pieces."""

import math

import numba
import numpy as np

from twin.motion.corner_kernels import MOST_NEIGHBOURS
from twin.nc.canonical import FloatArray, IntArray

CARRIED = 2.0
"""How far a sum of polynomials is carried, in widths of the narrowest rounding in it."""


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
    t, per_width = away / width, 1.0 / width
    squared = t * t
    beyond = 1.0 if away >= 0.0 else 0.0
    # Taylor's coefficients about the piece's begin: of the ramp and of the square, by powers of t,
    # with the powers of the width that make them ones of x.
    scale = share * width
    ramp0 = scale * ((3.0 + t * (8.0 + t * (6.0 - squared))) / 16.0 - beyond * t)
    square0 = scale * (t * (3.0 + t * (8.0 + t * (6.0 - squared))) / 32.0 - 0.5 * beyond * squared)
    ramp1 = share * ((2.0 + t * (3.0 - squared)) / 4.0 - beyond)
    square1 = share * ((3.0 + t * (16.0 + t * (18.0 - 5.0 * squared))) / 32.0 - beyond * t)
    scale = share * per_width
    ramp2 = scale * (3.0 * (1.0 - squared) / 8.0)
    square2 = scale * ((4.0 + t * (9.0 - 5.0 * squared)) / 16.0 - 0.5 * beyond)
    scale *= per_width
    ramp3 = scale * (-t / 4.0)
    square3 = scale * ((3.0 - 5.0 * squared) / 16.0)
    scale *= per_width
    ramp4 = scale * (-1.0 / 16.0)
    square4 = scale * (-5.0 * t / 32.0)
    square5 = scale * per_width * (-1.0 / 32.0)
    for axis in range(len(knee)):
        rise, turn = knee[axis], bend[axis] * width
        if rise != 0.0 or turn != 0.0:
            c = coefficients[axis]
            c[0] += rise * ramp0 + turn * square0
            c[1] += rise * ramp1 + turn * square1
            c[2] += rise * ramp2 + turn * square2
            c[3] += rise * ramp3 + turn * square3
            c[4] += rise * ramp4 + turn * square4
            c[5] += turn * square5


@numba.njit(cache=True)
def add_roundings(
    place: FloatArray, owner: IntArray, offset: FloatArray, extent: FloatArray,
    ends: FloatArray, sources: IntArray,
    width: FloatArray, knee: FloatArray, bend: FloatArray, rounding: FloatArray,
) -> None:  # fmt: skip
    """Write the sums of the roundings along each piece.

    Args:
        place: As in ``_ends_by_block``.
        owner: Block of each piece, shape (m,).
        offset: Its begin, from the block's, shape (m,).
        extent: Its length, shape (m,).
        ends: From ``_ends_by_block``.
        sources: From ``_ends_by_block``.
        width: As in ``cut_blocks``, and so on to ``bend``.
        knee: See above.
        bend: See above.
        rounding: Result, shape (m, k, 6).
    """
    axes = knee.shape[1]
    active = np.zeros(2 * MOST_NEIGHBOURS + 2, np.int64)
    used, passed = 0, 0
    total = np.zeros((axes, 6))
    since, narrowest = 0.0, math.inf
    for piece in range(len(owner)):
        i = owner[piece]
        here = place[i] + offset[piece]
        middle = here + 0.5 * extent[piece]
        if used > 0:
            shift_polynomials(total, extent[piece - 1])
            if offset[piece] == 0.0 and width[i] > 0.0:
                # Over the border: what is added beyond it has lost the kink.
                for axis in range(axes):
                    total[axis, 1] -= knee[i, axis]
                    total[axis, 2] -= 0.5 * bend[i, axis]
        while passed < len(ends) and ends[passed] <= middle:
            other = int(sources[passed])
            passed += 1
            narrowest = min(narrowest, width[other])
            away = place[i] - place[other] + offset[piece]
            if other > i:
                active[used] = other
                used += 1
                add_rounding(total, away, width[other], knee[other], bend[other])
            else:
                row = 0
                while active[row] != other:
                    row += 1
                used -= 1
                active[row] = active[used]
                add_rounding(total, max(0.0, away), width[other], knee[other], bend[other], -1.0)
        if used == 0 or here + extent[piece] - since > CARRIED * narrowest:
            total[:] = 0.0
            since, narrowest = here, math.inf
            for row in range(used):
                other = int(active[row])
                away = place[i] - place[other] + offset[piece]
                if other <= i:
                    away = max(0.0, away)
                narrowest = min(narrowest, width[other])
                add_rounding(total, away, width[other], knee[other], bend[other])
        for axis in range(axes):
            for power in range(6):
                rounding[piece, axis, power] = total[axis, power]


@numba.njit(cache=True)
def shift_polynomials(coefficients: FloatArray, way: float) -> None:
    """Count the x of polynomials from a place further on, in place (Horner's scheme).

    Args:
        coefficients: By powers of x, shape (k, 6).
        way: From the old place to the new one.
    """
    for axis in range(len(coefficients)):
        c = coefficients[axis]
        c0, c1, c2, c3, c4, c5 = c[0], c[1], c[2], c[3], c[4], c[5]
        if c2 == 0.0 and c3 == 0.0 and c4 == 0.0 and c5 == 0.0:
            c[0] = c0 + way * c1
            continue
        for last in range(5):
            c4 += way * c5
            if last <= 3:
                c3 += way * c4
            if last <= 2:
                c2 += way * c3
            if last <= 1:
                c1 += way * c2
            if last == 0:
                c0 += way * c1
        c[0], c[1], c[2], c[3], c[4] = c0, c1, c2, c3, c4
