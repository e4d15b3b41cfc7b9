"""How fast pieces may be driven, from the bounds of the path's derivatives along them."""

import math

import numpy as np
import numpy.typing as npt

from twin.compilation.kernel import array_arithmetic_kernel
from twin.motion.blocks.blocks import BoolArray
from twin.motion.pieces.reachable_kernels import reach_velocities
from twin.nc.canonical import FloatArray, IntArray

CENTRIPETAL_SHARE = 0.95
"""Of an axis's acceleration that following a curve may use; the rest is left to change speed."""

CURVE_JERK_SHARE = 0.5
"""Of an axis's jerk that a curve may use at constant speed, and again at constant acceleration."""


@array_arithmetic_kernel
def piece_limits(
    block: tuple[FloatArray, FloatArray, FloatArray, FloatArray, BoolArray],
    owner: IntArray, length: FloatArray, ceilings: FloatArray,
    bounds: FloatArray, bend: FloatArray, against: npt.NDArray[np.bool_],
    path: tuple[float, float, float, float],
    axis_velocity: FloatArray, axis_acceleration: FloatArray, axis_jerk: FloatArray,
) -> FloatArray:  # fmt: skip
    """What any instant of a piece may use.

    Args:
        block: Of the m blocks: highest v that is asked for, highest a and -a, path parameter per
            what the feed counts, whether only rotary axes move; shape (m,) each.
        owner: Block of each of n pieces, shape (n,).
        length: Of the pieces, 0 for dwells, shape (n,).
        ceilings: Highest v at the borders of the pieces, shape (n + 1,).
        bounds: From ``bound_derivatives``, shape (n, 3, k).
        bend: From ``bound_derivatives``, shape (n,).
        against: From ``bound_derivatives``, shape (n, 2, k).
        path: Acceleration and jerk of the path, and of one of rotary axes alone.
        axis_velocity: Shape (k,).
        axis_acceleration: Shape (k,).
        axis_jerk: Shape (k,).

    Returns:
        Rows velocity, acceleration, deceleration, jerk, shape (4, n).
    """
    wanted, highest_a, highest_d, stretch, rotary_alone = block
    count, axes = len(owner), len(axis_jerk)
    out = np.zeros((4, count))
    speeding, braking, readiness = np.zeros(count), np.zeros(count), np.ones(count)
    curved = np.zeros(count, np.bool_)
    for i in range(count):
        row = max(0, owner[i])
        path_a = stretch[row] * (path[2] if rotary_alone[row] else path[0])
        path_j = stretch[row] * (path[3] if rotary_alone[row] else path[1])
        v, a, j = _straight_limits(
            bounds[i], bend[i], wanted[row], path_a, path_j, stretch[row],
            axis_velocity, axis_acceleration, axis_jerk,
        )  # fmt: skip
        out[0, i], out[3, i] = v, j
        out[1, i] = min(a, stretch[row] * highest_a[row])
        out[2, i] = min(a, stretch[row] * highest_d[row])
        speeding[i] = min(path_a, stretch[row] * highest_a[row])
        braking[i] = min(path_a, stretch[row] * highest_d[row])
        for axis in range(axes):
            curved[i] |= bounds[i, 1, axis] > 0.0
        if length[i] > 0.0:
            # A ramp to v takes v / a without a jerk limit and a / j longer with it.
            readiness[i] = 1.0 / (1.0 + a * a / (v * j))
    if np.any(curved):
        reach_velocities(
            bounds, against, curved, length, out, ceilings, axis_acceleration,
            speeding, braking, readiness,
        )  # fmt: skip
        _leave_room_for_curves(bounds, against, curved, out, axis_acceleration, axis_jerk)
    return out


@array_arithmetic_kernel
def _straight_limits(
    bounds: FloatArray, bend: float, wanted: float,
    path_acceleration: float, path_jerk: float, stretch: float,
    axis_velocity: FloatArray, axis_acceleration: FloatArray, axis_jerk: FloatArray,
) -> tuple[float, float, float]:  # fmt: skip
    """What velocity, acceleration and jerk bound each by itself along a piece.

    Args:
        bounds: Of abs(q'), abs(q''), abs(q'''), shape (3, k).
        bend: Of the length of q'' of X Y Z together.
        wanted: Highest v that is asked for.
        path_acceleration: Of the path parameter.
        path_jerk: Of the path parameter.
        stretch: Path parameter per what the feed counts.
        axis_velocity: Shape (k,).
        axis_acceleration: Shape (k,).
        axis_jerk: Shape (k,).

    Returns:
        Highest v, as if a were 0; highest a and j, as if v were 0.
    """
    velocity, acceleration, jerk = wanted, path_acceleration, path_jerk
    # Each division waits for a limit that binds.
    square, cube = wanted * wanted, wanted * wanted * wanted
    if square * stretch * bend > path_acceleration:
        square = path_acceleration / (stretch * bend)
    for axis in range(len(axis_velocity)):
        first, second, third = bounds[0, axis], bounds[1, axis], bounds[2, axis]
        if first == second == 0.0:
            continue
        if velocity * first > axis_velocity[axis]:
            velocity = axis_velocity[axis] / first
        if acceleration * first > axis_acceleration[axis]:
            acceleration = axis_acceleration[axis] / first
        if jerk * first > axis_jerk[axis]:
            jerk = axis_jerk[axis] / first
        if square * second > CENTRIPETAL_SHARE * axis_acceleration[axis]:
            square = CENTRIPETAL_SHARE * axis_acceleration[axis] / second
        if cube * third > CURVE_JERK_SHARE * axis_jerk[axis]:
            cube = CURVE_JERK_SHARE * axis_jerk[axis] / third
    if velocity * velocity > square:
        velocity = math.sqrt(square)
    if velocity * velocity * velocity > cube:
        velocity = np.cbrt(cube)
    return velocity, acceleration, jerk


@array_arithmetic_kernel
def _leave_room_for_curves(
    bounds: FloatArray, against: npt.NDArray[np.bool_], curved: BoolArray, limits: FloatArray,
    axis_acceleration: FloatArray, axis_jerk: FloatArray,
) -> None:  # fmt: skip
    """Leave room in a and j for following the curve at v, in place.

    Args:
        bounds: As in ``piece_limits``.
        against: As in ``piece_limits``.
        curved: Whether any q'' is not 0, shape (n,).
        limits: Rows velocity, acceleration, deceleration, jerk, shape (4, n).
        axis_acceleration: Shape (k,).
        axis_jerk: Shape (k,).
    """
    for i in range(limits.shape[1]):
        if not curved[i]:
            continue
        v, a, d, j = limits[0, i], limits[1, i], limits[2, i], limits[3, i]
        mixed = max(a, d)
        for axis in range(len(axis_jerk)):
            first, second, third = bounds[i, 0, axis], bounds[i, 1, axis], bounds[i, 2, axis]
            centripetal = second * v * v
            left = axis_acceleration[axis] - (centripetal if against[i, 0, axis] else 0.0)
            if a * first > left:
                a = left / first
            left = axis_acceleration[axis] - (centripetal if against[i, 1, axis] else 0.0)
            if d * first > left:
                d = left / first
            left = CURVE_JERK_SHARE * (axis_jerk[axis] - third * v * v * v)
            if mixed * 3.0 * second * v > left:
                mixed = left / (3.0 * second * v)
        a, d = min(a, mixed), min(d, mixed)
        for axis in range(len(axis_jerk)):
            first, second, third = bounds[i, 0, axis], bounds[i, 1, axis], bounds[i, 2, axis]
            left = axis_jerk[axis] - (third * v * v + 3.0 * second * max(a, d)) * v
            if j * first > left:
                j = left / first
        limits[1, i], limits[2, i], limits[3, i] = a, d, j
