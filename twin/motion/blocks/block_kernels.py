"""How far the axes go in moves."""

import numpy as np

from twin.compilation.kernel import array_kernel
from twin.nc.canonical import FloatArray


@array_kernel
def largest_travels(
    start: FloatArray, end: FloatArray, rotary: np.ndarray[tuple[int], np.dtype[np.bool_]]
) -> tuple[FloatArray, FloatArray]:
    """How far the axis goes that goes farthest.

    Args:
        start: Of the moves, shape (n, k) [mm or deg].
        end: Shape (n, k) [mm or deg].
        rotary: Whether an axis is one, shape (k,).

    Returns:
        Of all axes, and of the linear ones, shape (n,) each [mm or deg].
    """
    count, axes = start.shape
    farthest, linear = np.zeros(count), np.zeros(count)
    for i in range(count):
        for axis in range(axes):
            travel = abs(end[i, axis] - start[i, axis])
            farthest[i] = max(farthest[i], travel)
            if not rotary[axis]:
                linear[i] = max(linear[i], travel)
    return farthest, linear
