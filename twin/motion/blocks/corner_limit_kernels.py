"""What blocks allow at their borders: their own limits, those of a rounding, and how far two moves may overlap."""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import array_arithmetic_kernel
from twin.motion.blocks.blocks import BlockLimits, BoolArray
from twin.motion.limits import MachineLimits
from twin.motion.ramp_kernels import RampLimits
from twin.nc.canonical import FloatArray, IntArray
from twin.toolpath.geometry_kernels import Curves, bend_of, is_curve

CURVE_SHARE = 0.5
"""Of the limits of an axis that a rounding may use at constant velocity."""


class BlockMotion(NamedTuple):
    """n blocks and what the program asks of them.

    Attributes:
        move: Number of the move in the whole program, shape (n,).
        length: In path parameter x, 0 for dwells, shape (n,).
    """

    move: IntArray
    curves: Curves
    length: FloatArray
    limits: BlockLimits


class Corners(NamedTuple):
    """The borders before each of n blocks.

    Attributes:
        tangent_step: Step of dq/dx, shape (n, k).
        curvature_step: Step of d²q/dx², shape (n, k).
        rounded: Whether the path goes on without a stop, shape (n,).
        width: Of the rounding, shape (n,); 0: there is no room for one.
        tolerance: Of X Y Z, shape (n,) [mm].
        further_tolerance: Of the other axes [mm or deg].
    """

    tangent_step: FloatArray
    curvature_step: FloatArray
    rounded: BoolArray
    width: FloatArray
    tolerance: FloatArray
    further_tolerance: float


@array_arithmetic_kernel
def block_limits(blocks: BlockMotion, i: int, machine: MachineLimits) -> RampLimits:
    """What a block allows along the path; of an arc, what its curvature leaves at any place."""
    asked = blocks.limits
    scale, rotary = asked.parameter_scale[i], asked.rotary_alone[i]
    acceleration = scale * (machine.path[2] if rotary else machine.path[0])
    jerk = scale * (machine.path[3] if rotary else machine.path[1])
    velocity = asked.velocity[i]
    per_length = 1.0 / blocks.length[i]
    turn = abs(blocks.curves.angle[i]) * per_length
    curve, bends = is_curve(blocks.curves.bend, i), blocks.curves.bend
    for axis in range(len(machine.jerk)):
        slope = abs(blocks.curves.drift[i, axis]) * per_length
        if curve:
            end = blocks.curves.drift[i, axis] + bend_of(bends, i, axis, 1.0, 1)
            slope = max(slope, abs(end) * per_length)
            bend = abs(bend_of(bends, i, axis, 0.0, 2))
            bend = max(bend, abs(bend_of(bends, i, axis, 1.0, 2)))
            if bend > 0.0:
                bend *= per_length * per_length
                velocity = min(velocity, math.sqrt(machine.acceleration[axis] / bend))
        if turn > 0.0 and axis < 3:
            radius = math.hypot(blocks.curves.cosine[i, axis], blocks.curves.sine[i, axis])
            slope += turn * radius
            bend = turn * turn * radius
            if bend > 0.0:
                velocity = min(velocity, math.sqrt(machine.acceleration[axis] / bend))
                velocity = min(velocity, np.cbrt(CURVE_SHARE * machine.jerk[axis] / (turn * bend)))
        if slope > 0.0:
            velocity = min(velocity, machine.velocity[axis] / slope)
            acceleration = min(acceleration, machine.acceleration[axis] / slope)
            jerk = min(jerk, machine.jerk[axis] / slope)
    if turn > 0.0:
        jerk *= CURVE_SHARE
    speeding = min(acceleration, scale * asked.acceleration[i])
    braking = min(acceleration, scale * asked.deceleration[i])
    return RampLimits(velocity, speeding, braking, jerk)


@array_arithmetic_kernel
def unevenness(blocks: BlockMotion, i: int, machine: MachineLimits) -> float:
    """How often the smallest jerk limit of an arc's axes goes into the largest; 1 for lines."""
    least, most = math.inf, 0.0
    for axis in range(3):
        if blocks.curves.cosine[i, axis] != 0.0 or blocks.curves.sine[i, axis] != 0.0:
            least, most = min(least, machine.jerk[axis]), max(most, machine.jerk[axis])
    return most / least if most > 0.0 else 1.0


@array_arithmetic_kernel
def rounding_velocity(corners: Corners, i: int, machine: MachineLimits) -> float:
    """How fast a rounding may be passed, as if it were alone on straight blocks."""
    per_width = 1.0 / corners.width[i]
    velocity, bends = math.inf, 0.0
    for axis in range(len(machine.jerk)):
        tangent = abs(corners.tangent_step[i, axis]) * per_width
        curvature = abs(corners.curvature_step[i, axis])
        # The largest values of the polynomials' second and third derivatives.
        second = 0.75 * tangent + curvature
        third = (1.5 * tangent + 1.125 * curvature) * per_width
        if second > 0.0:
            velocity = min(velocity, math.sqrt(machine.acceleration[axis] / second))
            velocity = min(velocity, np.cbrt(CURVE_SHARE * machine.jerk[axis] / third))
        if axis < 3:
            bends += second * second
    if bends > 0.0:
        velocity = min(velocity, math.sqrt(machine.path[0] / math.sqrt(bends)))
    return velocity


@array_arithmetic_kernel
def overlap_distance(
    blocks: BlockMotion, corners: Corners, i: int, before: RampLimits, after: RampLimits,
    machine: MachineLimits,
) -> float:  # fmt: skip
    """How far from the corner both moves may be while they overlap; 0 where they must not.

    Both begin or end with their full jerk, so the sum of the two must be within the axes' limits.
    The sum of the accelerations goes evenly from that of the one to that of the other.
    """
    curves = blocks.curves
    if curves.angle[i - 1] != 0.0 or curves.angle[i] != 0.0:
        return 0.0
    if is_curve(curves.bend, i - 1) or is_curve(curves.bend, i):
        return 0.0
    per_length, next_per_length = 1.0 / blocks.length[i - 1], 1.0 / blocks.length[i]
    squares, next_squares, away = 0.0, 0.0, math.inf
    for axis in range(len(machine.jerk)):
        slope = curves.drift[i - 1, axis] * per_length
        next_slope = curves.drift[i, axis] * next_per_length
        if abs(slope * before.jerk + next_slope * after.jerk) > machine.jerk[axis]:
            return 0.0
        if axis < 3:
            squares += slope * slope
            next_squares += next_slope * next_slope
        else:
            largest = max(abs(slope), abs(next_slope))
            if largest > 0.0:
                away = min(away, corners.further_tolerance / largest)
    largest = math.sqrt(max(squares, next_squares))
    return min(away, corners.tolerance[i] / largest) if largest > 0.0 else away


@array_arithmetic_kernel
def overlap_time(
    away: float, length: float, next_length: float, before: RampLimits, after: RampLimits
) -> float:
    """How long two moves overlap that may both be so far from the corner."""
    if away <= 0.0:
        return 0.0
    time = np.cbrt(6.0 * away / before.jerk) + np.cbrt(6.0 * away / after.jerk)
    # The last phase of the one and the first of the other; of a short block, a quarter of its time.
    for distance, limits, hardest in (
        (length, before, before.deceleration),
        (next_length, after, after.acceleration),
    ):
        time = min(time, math.sqrt(limits.velocity / limits.jerk), hardest / limits.jerk)
        time = min(time, np.cbrt(0.5 * distance / limits.jerk))
    return time
