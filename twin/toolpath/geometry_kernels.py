"""The inner loop of ``twin.toolpath.geometry``."""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import array_kernel, kernel
from twin.nc.canonical import FloatArray, IntArray


class Curves(NamedTuple):
    """The columns of a ``Geometry``, for compiled code."""

    base: FloatArray
    drift: FloatArray
    bend: FloatArray
    cosine: FloatArray
    sine: FloatArray
    angle: FloatArray
    end: FloatArray


@kernel
def is_curve(bend: FloatArray, move: int) -> bool:
    """Whether a move's axes go by polynomials."""
    for axis in range(bend.shape[1]):
        for power in range(4):
            if bend[move, axis, power] != 0.0:
                return True
    return False


@kernel
def bend_of(bend: FloatArray, move: int, axis: int, u: float, order: int) -> float:
    """What the polynomial of a curve adds to an axis, or to a derivative by the path fraction.

    Args:
        bend: As in ``Geometry``.
        order: Of the derivative, 0 for the position, 3 at most.
    """
    total = 0.0
    for power in range(5, 1, -1):
        factor = 1.0
        for taken in range(order):
            factor *= power - taken
        if power >= order:
            total += factor * bend[move, axis, power - 2] * u ** (power - order)
    return total


@array_kernel
def evaluate(
    curves: Curves, move: IntArray, fraction: FloatArray, order: int, out: FloatArray
) -> None:
    """Position (order 0) or derivative by path fraction (order 1 to 3) of rows of a geometry.

    Args:
        move: Rows, shape (m,).
        fraction: Path fractions, shape (m,).
        order: 0 to 3.
        out: Result, shape (m, k) [mm or deg].
    """
    base, drift, bend, cosine, sine, angle, end = curves
    for row in range(len(move)):
        i = move[row]
        u = fraction[row]
        if order == 0 and u >= 1.0:
            out[row] = end[i]
            continue
        if order == 0:
            out[row] = base[i] + u * drift[i]
        elif order == 1:
            out[row] = drift[i]
        else:
            out[row] = np.zeros(base.shape[1])
        if angle[i] != 0.0:
            # Each derivative of cos and sin is a quarter turn on and a factor of the angle.
            turned = angle[i] * u + order * (math.pi / 2.0)
            scale = angle[i] ** order
            for axis in range(3):
                out[row, axis] += scale * (
                    cosine[i, axis] * math.cos(turned) + sine[i, axis] * math.sin(turned)
                )
        if is_curve(bend, i):
            for axis in range(base.shape[1]):
                out[row, axis] += bend_of(bend, i, axis, u, order)
