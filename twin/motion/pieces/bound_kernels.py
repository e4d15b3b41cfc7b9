"""How far the path's derivatives go along each piece.

Along a piece the path is an arc of a few degrees or a straight line, with a polynomial of the fifth
degree added by roundings. The ranges of either are known in closed form and are added.
"""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.compilation.kernel import arithmetic_kernel, array_arithmetic_kernel, kernel
from twin.nc.canonical import FloatArray, IntArray
from twin.toolpath.geometry_kernels import Curves

FLAT = 1e-9
"""Of the largest q' or q'': what is smaller is rounding and has no sign."""


class DerivativeBounds(NamedTuple):
    """Bounds of the path's derivatives by x along n pieces.

    Attributes:
        axes: Of abs(q'), abs(q''), abs(q''') of each axis, shape (n, 3, k).
        curvature: Of the length of q'' of X Y Z together, shape (n,).
        against: Whether q' q'' can be positive, and whether it can be negative, of each axis, shape
            (n, 2, k).
    """

    axes: FloatArray
    curvature: FloatArray
    against: npt.NDArray[np.bool_]


@array_arithmetic_kernel
def bound_derivatives(
    curves: Curves, owner: IntArray, begin: FloatArray, fraction_per_length: FloatArray,
    length: FloatArray, rounding: FloatArray,
) -> DerivativeBounds:  # fmt: skip
    """Bounds of the path's derivatives by x along pieces.

    Args:
        curves: Of the moves; an arc turns by less than a quarter along a piece.
        owner: Move of each piece, shape (n,).
        begin: Path fraction of each piece's begin, shape (n,).
        fraction_per_length: Shape (n,).
        length: Shape (n,).
        rounding: Shape (n, k, 6).
    """
    drift, cosine, sine, angle = curves.drift, curves.cosine, curves.sine, curves.angle
    count, axes = len(owner), drift.shape[1]
    bounds = np.empty((count, 3, axes))
    curvature = np.empty(count)
    against = np.empty((count, 2, axes), np.bool_)
    c, s, c_end, s_end = 1.0, 0.0, 1.0, 0.0
    for i in range(count):
        move = max(0, owner[i])
        turn = angle[move] * fraction_per_length[i]
        squares, radius = 0.0, 0.0
        if turn != 0.0:
            at = angle[move] * begin[i]
            # A piece begins where the one before it on the same arc has ended.
            c, s = c_end, s_end
            if i == 0 or owner[i] != owner[i - 1]:
                c, s = math.cos(at), math.sin(at)
            at += turn * length[i]
            c_end, s_end = math.cos(at), math.sin(at)
        for axis in range(axes):
            slope = drift[move, axis] * fraction_per_length[i]
            added = rounding[i, axis]
            bent = turn != 0.0 and axis < 3
            low1 = high1 = slope + added[1]
            low2 = high2 = low3 = high3 = 0.0
            if not (added[2] == added[3] == added[4] == added[5] == 0.0):
                low1, high1, low2, high2, low3, high3 = _polynomial_ranges(added, slope, length[i])
            elif not bent:
                bounds[i, 0, axis] = abs(low1)
                bounds[i, 1, axis] = bounds[i, 2, axis] = 0.0
                against[i, 0, axis] = against[i, 1, axis] = False
                continue
            if bent:
                p, q = cosine[move, axis], sine[move, axis]
                sense = math.copysign(1.0, turn)
                x, x_end = p * c + q * s, p * c_end + q * s_end
                y, y_end = q * c - p * s, q * c_end - p * s_end
                across = _wave_range(x, x_end, sense * y, sense * y_end, p, q)
                along = _wave_range(y, y_end, -sense * x, -sense * x_end, p, q)
                radius += p * p
                square = turn * turn
                low1 += min(turn * along[0], turn * along[1])
                high1 += max(turn * along[0], turn * along[1])
                low2 -= square * across[1]
                high2 -= square * across[0]
                cube = turn * square
                low3 -= max(cube * along[0], cube * along[1])
                high3 -= min(cube * along[0], cube * along[1])
            first, second = max(abs(low1), abs(high1)), max(abs(low2), abs(high2))
            bounds[i, 0, axis] = first
            bounds[i, 1, axis] = second
            bounds[i, 2, axis] = max(abs(low3), abs(high3))
            if axis < 3:
                squares += second * second
            still, flat = FLAT * first, FLAT * second
            # Bits, not branches: which of them hold changes too often to be foreseen.
            rises, falls = high1 > still, low1 < -still
            left, right = high2 > flat, low2 < -flat
            against[i, 0, axis] = (rises & left) | (falls & right)
            against[i, 1, axis] = (rises & right) | (falls & left)
        curvature[i] = math.sqrt(squares)
        if turn != 0.0 and not np.any(rounding[i]):
            curvature[i] = turn * turn * math.sqrt(radius)
    return DerivativeBounds(bounds, curvature, against)


@arithmetic_kernel
def _wave_range(
    at_begin: float, at_end: float, slope_begin: float, slope_end: float, p: float, q: float
) -> tuple[float, float]:
    """Range of ``p cos + q sin`` over less than a quarter of its period."""
    low, high = min(at_begin, at_end), max(at_begin, at_end)
    if slope_begin > 0.0 > slope_end:
        high = math.hypot(p, q)
    elif slope_begin < 0.0 < slope_end:
        low = -math.hypot(p, q)
    return low, high


@arithmetic_kernel
def _polynomial_ranges(
    c: FloatArray, slope: float, length: float
) -> tuple[float, float, float, float, float, float]:
    """Ranges of the first three derivatives of ``slope x`` plus a polynomial, from 0 to ``length``.

    Args:
        c: Coefficients by powers of x, shape (6,).
        slope: What is added to the first derivative.
        length: The end of x.
    """
    first, c2, c3, c4, c5, x = slope + c[1], c[2], c[3], c[4], c[5], length
    # q''' is a parabola, its ends and its vertex tell its range.
    third, third_end = 6.0 * c3, 6.0 * c3 + (24.0 * c4 + 60.0 * c5 * x) * x
    low3, high3 = min(third, third_end), max(third, third_end)
    if c5 != 0.0 and 0.0 < -c4 / (5.0 * c5) < x:
        vertex = 6.0 * c3 - 2.4 * c4 * c4 / c5
        low3, high3 = min(low3, vertex), max(high3, vertex)
    # q'' has its extremes at its ends and where q''' vanishes.
    second_end = _second(c2, c3, c4, c5, x)
    low2, high2 = min(2.0 * c2, second_end), max(2.0 * c2, second_end)
    if low3 < 0.0 < high3:
        at, other = -0.25 * c3 / c4 if c4 != 0.0 else 0.0, 0.0
        if c5 != 0.0:
            # The roots of c3 + 4 c4 x + 10 c5 x², neither as a small difference of large numbers.
            square = 4.0 * c4 * c4 - 10.0 * c5 * c3
            root = -2.0 * c4 - math.copysign(math.sqrt(max(0.0, square)), c4)
            at, other = c3 / root if root != 0.0 else 0.0, root / (10.0 * c5)
        if 0.0 < at < x:
            value = _second(c2, c3, c4, c5, at)
            low2, high2 = min(low2, value), max(high2, value)
        if 0.0 < other < x:
            value = _second(c2, c3, c4, c5, other)
            low2, high2 = min(low2, value), max(high2, value)
    # q' lies within x²/8 max(abs(q''')) of its chord, and between its ends if q'' has one sign.
    first_end = first + (2.0 * c2 + (3.0 * c3 + (4.0 * c4 + 5.0 * c5 * x) * x) * x) * x
    low1, high1 = min(first, first_end), max(first, first_end)
    if min(-low2, high2) > FLAT * max(-low2, high2):
        sag = 0.125 * x * x * max(-low3, high3)
        low1, high1 = low1 - sag, high1 + sag
    return low1, high1, low2, high2, low3, high3


@kernel
def _second(c2: float, c3: float, c4: float, c5: float, x: float) -> float:
    """The second derivative of a polynomial at x."""
    return 2.0 * c2 + (6.0 * c3 + (12.0 * c4 + 20.0 * c5 * x) * x) * x
