"""How fast pieces may be driven, from the bounds of the path's derivatives along them."""

import math

import numpy as np

from twin.compilation.kernel import arithmetic_kernel, array_arithmetic_kernel, array_kernel, kernel
from twin.motion.blocks.blocks import BlockLimits, BoolArray
from twin.motion.limits import MachineLimits
from twin.motion.pieces.bound_kernels import DerivativeBounds
from twin.motion.pieces.reachable_velocity_kernels import Along, lower_to_reachable
from twin.nc.canonical import FloatArray, IntArray

CENTRIPETAL_SHARE = 0.95
"""Of an axis's acceleration that following a curve may use; the rest is left to change speed."""

CURVE_JERK_SHARE = 0.5
"""Of an axis's jerk that a curve may use at constant speed, and of what is then left again at constant
acceleration."""


CURVE_JERK_SHARES = ((1.0, CURVE_JERK_SHARE), (3.0, 0.8), (10.0, 0.9))
"""By turns that the path goes round without a step: what of an axis's jerk a curve may use."""


@array_kernel
def curve_shares(
    tangent_step: FloatArray, curvature_step: FloatArray, entry: FloatArray, angle: FloatArray
) -> FloatArray:
    """Share of an axis's jerk that blocks may use at constant velocity.

    The rest changes the velocity: the longer the path goes round, the less often that is.

    Args:
        tangent_step: At the border before each of n blocks, shape (n, k).
        curvature_step: At the border before each, shape (n, k).
        entry: Highest v there, shape (n,).
        angle: Sweep of the blocks, 0 for lines, shape (n,) [rad].

    Returns:
        Shape (n,).
    """
    count = len(angle)
    shares = np.full(count, CURVE_JERK_SHARE)
    first, turned = 0, 0.0
    for i in range(count + 1):
        steps = i == count or entry[i] < math.inf
        if not steps:
            for axis in range(tangent_step.shape[1]):
                steps |= tangent_step[i, axis] != 0.0 or curvature_step[i, axis] != 0.0
        if steps:
            if turned > 0.0:
                share = _share_of_turns(turned / (2.0 * math.pi))
                for other in range(first, i):
                    if angle[other] != 0.0:
                        shares[other] = share
            first, turned = i, 0.0
        if i < count:
            turned += abs(angle[i])
    return shares


@kernel
def _share_of_turns(turns: float) -> float:
    """The entry of ``CURVE_JERK_SHARES``, straight between two."""
    before, share = CURVE_JERK_SHARES[0]
    for at, to in CURVE_JERK_SHARES:
        if turns <= at:
            fraction = (turns - before) / (at - before) if turns > before else 0.0
            return share + (to - share) * fraction
        before, share = at, to
    return share


@array_arithmetic_kernel
def piece_limits(
    block: BlockLimits, owner: IntArray, length: FloatArray, ceilings: FloatArray,
    bounds: DerivativeBounds, machine: MachineLimits, share: FloatArray,
) -> FloatArray:  # fmt: skip
    """What any instant of a piece may use.

    Args:
        owner: Block of each of n pieces, shape (n,).
        length: Of the pieces, 0 for dwells, shape (n,).
        ceilings: Highest v at the borders of the pieces, shape (n + 1,).
        share: Of an axis's jerk that each block may use at constant velocity, shape (m,).

    Returns:
        Rows velocity, acceleration, deceleration, jerk, shape (4, n).
    """
    wanted, highest_a, highest_d, scale, rotary_alone = block
    path = machine.path
    count, axes = len(owner), len(machine.jerk)
    out = np.zeros((4, count))
    speeding, braking, readiness = np.zeros(count), np.zeros(count), np.ones(count)
    curved = np.zeros(count, np.bool_)
    for i in range(count):
        row = max(0, owner[i])
        path_a = scale[row] * (path[2] if rotary_alone[row] else path[0])
        path_j = scale[row] * (path[3] if rotary_alone[row] else path[1])
        v, a, j = _straight_limits(
            bounds.axes[i],
            scale[row] * bounds.curvature[i],
            wanted[row],
            path_a,
            path_j,
            machine,
            share[row],
        )
        out[0, i], out[3, i] = v, j
        out[1, i] = min(a, scale[row] * highest_a[row])
        out[2, i] = min(a, scale[row] * highest_d[row])
        speeding[i] = min(path_a, scale[row] * highest_a[row])
        braking[i] = min(path_a, scale[row] * highest_d[row])
        for axis in range(axes):
            curved[i] |= bounds.axes[i, 1, axis] > 0.0
        if length[i] > 0.0:
            # A ramp to v takes v / a without a jerk limit and a / j longer with it.
            readiness[i] = 1.0 / (1.0 + a * a / (v * j))
    if np.any(curved):
        along = Along(length, speeding, braking, readiness)
        lower_to_reachable(bounds, curved, along, out, ceilings, machine.acceleration)
        _leave_room_for_curves(bounds, curved, out, machine)
    return out


@arithmetic_kernel
def _straight_limits(
    bounds: FloatArray, curvature: float, wanted: float,
    path_acceleration: float, path_jerk: float, machine: MachineLimits, share: float,
) -> tuple[float, float, float]:  # fmt: skip
    """What velocity, acceleration and jerk bound each by itself along a piece.

    Args:
        bounds: Of abs(q'), abs(q''), abs(q'''), shape (3, k).
        curvature: Of the length of q'' of X Y Z together, by what the feed counts.
        wanted: Highest v that is asked for.
        share: Of an axis's jerk that a curve may use at constant velocity.

    Returns:
        Highest v, as if a were 0; highest a and j, as if v were 0.
    """
    axis_velocity, axis_acceleration, axis_jerk = (
        machine.velocity, machine.acceleration, machine.jerk
    )  # fmt: skip
    velocity, acceleration, jerk = wanted, path_acceleration, path_jerk
    # Each division waits for a limit that binds.
    square, cube = wanted * wanted, wanted * wanted * wanted
    if square * curvature > path_acceleration:
        square = path_acceleration / curvature
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
        if cube * third > share * axis_jerk[axis]:
            cube = share * axis_jerk[axis] / third
    if velocity * velocity > square:
        velocity = math.sqrt(square)
    if velocity * velocity * velocity > cube:
        velocity = np.cbrt(cube)
    return velocity, acceleration, jerk


@arithmetic_kernel
def _leave_room_for_curves(
    derivatives: DerivativeBounds, curved: BoolArray, limits: FloatArray, machine: MachineLimits
) -> None:
    """Leave room in a and j for following the curve at v, in place.

    Args:
        curved: Whether any q'' is not 0, shape (n,).
        limits: Rows velocity, acceleration, deceleration, jerk, shape (4, n).
    """
    bounds, against = derivatives.axes, derivatives.against
    axis_acceleration, axis_jerk = machine.acceleration, machine.jerk
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
