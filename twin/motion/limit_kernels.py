"""How fast pieces may be driven, from the bounds of the path's derivatives along them."""

import math

import numba
import numpy as np

from twin.nc.canonical import FloatArray

CENTRIPETAL_SHARE = 0.95
"""Of an axis's acceleration that following a curve may use; the rest is left to change speed."""

CURVE_JERK_SHARE = 0.5
"""Of an axis's jerk that a curve may use at constant speed, and again at constant acceleration."""


@numba.njit(cache=True)
def straight_limits(
    bounds: FloatArray, bend: FloatArray, wanted: FloatArray,
    path_acceleration: FloatArray, path_jerk: FloatArray, stretch: FloatArray,
    axis_velocity: FloatArray, axis_acceleration: FloatArray, axis_jerk: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:  # fmt: skip
    """What velocity, acceleration and jerk bound each by itself.

    Args:
        bounds: Of abs(q'), abs(q''), abs(q''') along n pieces, shape (n, 3, k).
        bend: Of the length of q'' of X Y Z together, shape (n,).
        wanted: Highest v that is asked for, shape (n,).
        path_acceleration: Of the path parameter, shape (n,).
        path_jerk: Of the path parameter, shape (n,).
        stretch: Path parameter per what the feed counts, shape (n,).
        axis_velocity: Shape (k,).
        axis_acceleration: Shape (k,).
        axis_jerk: Shape (k,).

    Returns:
        Highest v, as if a were 0; highest a and j, as if v were 0; shape (n,) each.
    """
    count, axes = len(wanted), len(axis_velocity)
    velocity, acceleration, jerk = wanted.copy(), path_acceleration.copy(), path_jerk.copy()
    for i in range(count):
        square, cube = math.inf, math.inf
        if bend[i] > 0.0:
            square = path_acceleration[i] / (stretch[i] * bend[i])
        for axis in range(axes):
            first, second, third = bounds[i, 0, axis], bounds[i, 1, axis], bounds[i, 2, axis]
            if first > 0.0:
                velocity[i] = min(velocity[i], axis_velocity[axis] / first)
                acceleration[i] = min(acceleration[i], axis_acceleration[axis] / first)
                jerk[i] = min(jerk[i], axis_jerk[axis] / first)
            if second > 0.0:
                square = min(square, CENTRIPETAL_SHARE * axis_acceleration[axis] / second)
            if third > 0.0:
                cube = min(cube, CURVE_JERK_SHARE * axis_jerk[axis] / third)
        if velocity[i] * velocity[i] > square:
            velocity[i] = math.sqrt(square)
        if velocity[i] ** 3 > cube:
            velocity[i] = np.cbrt(cube)
    return velocity, acceleration, jerk


@numba.njit(cache=True)
def curve_limits(
    bounds: FloatArray, against: FloatArray, velocity: FloatArray,
    acceleration: FloatArray, deceleration: FloatArray, jerk: FloatArray,
    axis_acceleration: FloatArray, axis_jerk: FloatArray,
) -> None:  # fmt: skip
    """Leave room in a and j for following the curve at v, in place.

    Args:
        bounds: As in ``straight_limits``.
        against: Bounds of abs(q'') where it adds to a > 0, and to a < 0, shape (n, 2, k).
        velocity: Highest v, shape (n,).
        acceleration: Highest a, shape (n,).
        deceleration: Highest -a, shape (n,).
        jerk: Highest abs(j), shape (n,).
        axis_acceleration: Shape (k,).
        axis_jerk: Shape (k,).
    """
    for i in range(len(velocity)):
        v = velocity[i]
        mixed = math.inf
        for axis in range(len(axis_jerk)):
            first, second, third = bounds[i, 0, axis], bounds[i, 1, axis], bounds[i, 2, axis]
            if first > 0.0:
                left = axis_acceleration[axis] - against[i, 0, axis] * v * v
                acceleration[i] = min(acceleration[i], left / first)
                left = axis_acceleration[axis] - against[i, 1, axis] * v * v
                deceleration[i] = min(deceleration[i], left / first)
            if second * v > 0.0:
                left = axis_jerk[axis] - third * v**3
                mixed = min(mixed, CURVE_JERK_SHARE * left / (3.0 * second * v))
        acceleration[i] = min(acceleration[i], mixed)
        deceleration[i] = min(deceleration[i], mixed)
        hardest = max(acceleration[i], deceleration[i])
        for axis in range(len(axis_jerk)):
            first, second, third = bounds[i, 0, axis], bounds[i, 1, axis], bounds[i, 2, axis]
            if first > 0.0:
                left = axis_jerk[axis] - third * v**3 - 3.0 * second * v * hardest
                jerk[i] = min(jerk[i], left / first)
