"""The polynomials that roundings add to pieces."""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import array_arithmetic_kernel
from twin.motion.blocks.corner_kernels import MAX_NEIGHBOURS
from twin.nc.canonical import FloatArray, IntArray

CARRIED = 8.0
"""How far a sum of polynomials is carried, in widths of the narrowest rounding in it: a rounding error
of its fourth power grows by 8⁴, to 1e-15 of the tolerance."""

EXACT = 1e-15
"""A piece that begins this close to a rounding's end begins there, relative to the place on the path:
places are sums."""


@array_arithmetic_kernel
def add_rounding(
    coefficients: FloatArray, away: float, width: float, tangent_step: FloatArray, curvature_step: FloatArray,
    share: float = 1.0,
) -> None:  # fmt: skip
    """Add a border's rounding to the polynomials of a piece.

    Args:
        coefficients: Of each axis by powers of x from the piece's begin, shape (k, 6).
        away: From the border to the piece's begin, negative before the border [mm or deg]; the
            piece lies on one side of the border.
        width: Of the rounding [mm or deg].
        tangent_step: Step of dq/dx, shape (k,).
        curvature_step: Step of d²q/dx², shape (k,).
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
    for axis in range(len(tangent_step)):
        rise, turn = tangent_step[axis], curvature_step[axis] * width
        if rise != 0.0 or turn != 0.0:
            c = coefficients[axis]
            c[0] += rise * ramp0 + turn * square0
            c[1] += rise * ramp1 + turn * square1
            c[2] += rise * ramp2 + turn * square2
            c[3] += rise * ramp3 + turn * square3
            c[4] += rise * ramp4 + turn * square4
            c[5] += turn * square5


@array_arithmetic_kernel
def add_at_end(
    coefficients: FloatArray,
    width: float,
    tangent_step: FloatArray,
    curvature_step: FloatArray,
    side: float,
) -> None:
    """Begin or end a border's rounding at the begin of a piece: ``add_rounding`` at t = -1 or 1.

    The rounding meets the path there with two derivatives, so only higher powers change.

    Args:
        coefficients: As in ``add_rounding``.
        width: As in ``add_rounding``.
        tangent_step: As in ``add_rounding``.
        curvature_step: As in ``add_rounding``.
        side: -1 where the rounding begins, 1 where it ends.
    """
    per_width = 1.0 / width
    square = per_width * per_width
    cube = square * per_width
    for axis in range(len(tangent_step)):
        rise, turn = tangent_step[axis], curvature_step[axis] * width
        if rise != 0.0 or turn != 0.0:
            c = coefficients[axis]
            c[3] += square * (0.25 * rise + side * 0.125 * turn)
            c[4] += cube * (side * 0.0625 * rise + 0.15625 * turn)
            c[5] += side * cube * per_width * 0.03125 * turn


class Roundings(NamedTuple):
    """The borders before each of n blocks.

    Attributes:
        place: Where each block begins and, last, where the last one ends, shape (n + 1,).
        width: Of the rounding, shape (n,); 0: none.
        tangent_step: Step of dq/dx, shape (n, k).
        curvature_step: Step of d²q/dx², shape (n, k).
    """

    place: FloatArray
    width: FloatArray
    tangent_step: FloatArray
    curvature_step: FloatArray


@array_arithmetic_kernel
def add_roundings(
    roundings: Roundings, owner: IntArray, offset: FloatArray, extent: FloatArray,
    ends: FloatArray, sources: IntArray, rounding: FloatArray,
) -> None:  # fmt: skip
    """Write the sums of the roundings along each piece.

    Args:
        owner: Block of each piece, shape (m,).
        offset: Its begin, from the block's, shape (m,).
        extent: Its length, shape (m,).
        ends: Where roundings begin and end, in order.
        sources: Borders whose roundings they end.
        rounding: Result, shape (m, k, 6).
    """
    place, width, tangent_step, curvature_step = roundings
    count, axes = tangent_step.shape
    active = np.zeros(count, np.bool_)
    used, passed = 0, 0
    since, narrowest = 0.0, math.inf
    for piece in range(len(owner)):
        i = max(0, owner[piece])
        here = place[i] + offset[piece]
        middle = here + 0.5 * extent[piece]
        total = rounding[piece]
        if used == 0:
            total[:] = 0.0
        else:
            shift_polynomials(rounding[piece - 1], extent[piece - 1], total)
            if offset[piece] == 0.0 and width[i] > 0.0:
                # Over the border: what is added beyond it has lost the kink.
                for axis in range(axes):
                    total[axis, 1] -= tangent_step[i, axis]
                    total[axis, 2] -= 0.5 * curvature_step[i, axis]
        while passed < len(ends) and ends[passed] <= middle:
            other = max(0, sources[passed])
            begins = other > i
            active[other] = begins
            used += 1 if begins else -1
            narrowest = min(narrowest, width[other])
            if abs(here - ends[passed]) <= EXACT * here:
                side = -1.0 if begins else 1.0
                add_at_end(total, width[other], tangent_step[other], curvature_step[other], side)
            else:
                away = place[i] - place[other] + offset[piece]
                if begins:
                    add_rounding(
                        total, away, width[other], tangent_step[other], curvature_step[other]
                    )
                else:
                    away = max(0.0, away)
                    add_rounding(
                        total, away, width[other], tangent_step[other], curvature_step[other], -1.0
                    )
            passed += 1
        if used == 0 or here + extent[piece] - since > CARRIED * narrowest:
            total[:] = 0.0
            since, narrowest = here, math.inf
            for other in range(max(0, i - MAX_NEIGHBOURS), min(count, i + MAX_NEIGHBOURS + 1)):
                if active[other]:
                    away = place[i] - place[other] + offset[piece]
                    if other <= i:
                        away = max(0.0, away)
                    narrowest = min(narrowest, width[other])
                    add_rounding(
                        total, away, width[other], tangent_step[other], curvature_step[other]
                    )


@array_arithmetic_kernel
def shift_polynomials(before: FloatArray, distance: float, after: FloatArray) -> None:
    """Count the x of polynomials from a place further on.

    Args:
        before: By powers of x, shape (k, 6).
        distance: From the old place to the new one.
        after: Result, shape (k, 6).
    """
    for axis in range(len(before)):
        c0, c1, c2, c3, c4, c5 = (
            before[axis, 0], before[axis, 1], before[axis, 2],
            before[axis, 3], before[axis, 4], before[axis, 5],
        )  # fmt: skip
        if c2 != 0.0 or c3 != 0.0 or c4 != 0.0 or c5 != 0.0:
            # Taylor's coefficients at the new place.
            c0 += distance * (
                c1 + distance * (c2 + distance * (c3 + distance * (c4 + distance * c5)))
            )
            c1 += distance * (
                2.0 * c2 + distance * (3.0 * c3 + distance * (4.0 * c4 + distance * 5.0 * c5))
            )
            c2 += distance * (3.0 * c3 + distance * (6.0 * c4 + distance * 10.0 * c5))
            c3 += distance * (4.0 * c4 + distance * 10.0 * c5)
            c4 += distance * 5.0 * c5
        else:
            c0 += distance * c1
        after[axis, 0], after[axis, 1], after[axis, 2] = c0, c1, c2
        after[axis, 3], after[axis, 4], after[axis, 5] = c3, c4, c5
