"""Which continuous corners are passed faster by a stop than by a rounding.

A rounding must be driven slowly where it is narrow. At a stop the next move may begin before the
one before it has ended: both are then at most a tolerance away from the corner, so that the sum of
the two is within it too. Each corner is judged as if the path stopped at the other ends of its two
blocks: where these are passed faster, a stop costs more.
"""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import array_arithmetic_kernel
from twin.motion.blocks.blocks import BoolArray
from twin.motion.blocks.corner_kernels import BESIDE_STOP, MAX_NEIGHBOURS, NARROWEST
from twin.motion.limits import MachineLimits
from twin.motion.ramp_kernels import RampLimits, brake_distance, travel_time
from twin.nc.canonical import FloatArray
from twin.toolpath.geometry_kernels import Curves

CURVE_SHARE = 0.5
"""Of the limits of an axis that a rounding may use at constant velocity."""

CERTAINTY = 0.15
"""Share of the time through a rounding by which it must be faster than the stop: the limits along
its parts are a little stricter than those of the whole."""


CERTAINTY_OF_ARCS = 1.0
"""Share where one of the blocks is an arc, whose limits change along it."""


class BlockMotion(NamedTuple):
    """n blocks and what the program asks of them.

    Attributes:
        curves: Their geometry.
        length: In path parameter x, 0 for dwells, shape (n,).
        velocity: Highest v that is asked for, shape (n,).
        acceleration: Highest a, shape (n,).
        deceleration: Highest -a, shape (n,).
        parameter_scale: Path parameter per what the feed counts, shape (n,).
        rotary_alone: Whether only rotary axes move, shape (n,).
    """

    curves: Curves
    length: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    deceleration: FloatArray
    parameter_scale: FloatArray
    rotary_alone: BoolArray


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
def choose_stops(
    blocks: BlockMotion, corners: Corners, machine: MachineLimits
) -> tuple[BoolArray, FloatArray]:
    """Choose the corners at which the path had better stop.

    Args:
        blocks: The blocks.
        corners: The borders before them.
        machine: Limits of the axes and the path.

    Returns:
        Whether to stop, shape (n,); how far from there the moves may overlap, shape (n,).
    """
    count = len(blocks.length)
    stops, overlap = np.zeros(count, np.bool_), np.zeros(count)
    for i in range(1, count):
        if not corners.rounded[i] or blocks.length[i] == 0.0 or blocks.length[i - 1] == 0.0:
            continue
        if not np.any(corners.tangent_step[i]) and not np.any(corners.curvature_step[i]):
            continue
        width, passed = corners.width[i], 0.0
        if width > 0.0:
            passed = _rounding_velocity(corners, i, machine)
            if passed >= min(blocks.velocity[i - 1], blocks.velocity[i]):
                continue
        before = _block_limits(blocks, i - 1, machine)
        after = _block_limits(blocks, i, machine)
        through = min(before.velocity, after.velocity)
        if width > 0.0:
            passed = min(through, passed)
            if passed >= through or _never_faster(blocks, i, width, passed, before, after):
                continue
            through = passed
        away = _overlap_distance(blocks, corners, i, before, after, machine)
        length, next_length = blocks.length[i - 1], blocks.length[i]
        stopping = travel_time(length, 0.0, 0.0, before) - _overlap_time(
            away, length, next_length, before, after
        )
        stopping += travel_time(next_length, 0.0, 0.0, after)
        rounding = math.inf
        if width > 0.0:
            rounding = travel_time(length - width, 0.0, through, before)
            rounding += travel_time(next_length - width, through, 0.0, after)
            bent = blocks.curves.angle[i - 1] != 0.0 or blocks.curves.angle[i] != 0.0
            certainty = CERTAINTY_OF_ARCS if bent else CERTAINTY
            rounding += 2.0 * (1.0 + certainty) * width / through
        if stopping < rounding:
            stops[i], overlap[i] = True, away
    return stops, overlap


@array_arithmetic_kernel
def clip_widths(place: FloatArray, stops: BoolArray, width: FloatArray) -> None:
    """Narrow roundings beside stops, in place; a narrower rounding is also a flatter one.

    Args:
        place: Where each block begins and, last, where the last one ends, shape (n + 1,).
        stops: Whether the path stops after all, shape (n,).
        width: Of the roundings, shape (n,).
    """
    count = len(stops)
    for i in range(count):
        if not stops[i]:
            continue
        width[i] = 0.0
        for sense in (-1, 1):
            other = i + sense
            while 0 <= other < count and abs(other - i) <= MAX_NEIGHBOURS and not stops[other]:
                room = BESIDE_STOP * abs(place[other] - place[i])
                if width[other] > room:
                    width[other] = room if room >= NARROWEST else 0.0
                other += sense


@array_arithmetic_kernel
def _block_limits(blocks: BlockMotion, i: int, machine: MachineLimits) -> RampLimits:
    """What a block allows along the path; of an arc, what its curvature leaves at any place."""
    scale, rotary = blocks.parameter_scale[i], blocks.rotary_alone[i]
    acceleration = scale * (machine.path[2] if rotary else machine.path[0])
    jerk = scale * (machine.path[3] if rotary else machine.path[1])
    velocity = blocks.velocity[i]
    per_length = 1.0 / blocks.length[i]
    turn = abs(blocks.curves.angle[i]) * per_length
    for axis in range(len(machine.jerk)):
        slope = abs(blocks.curves.drift[i, axis]) * per_length
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
    speeding = min(acceleration, scale * blocks.acceleration[i])
    braking = min(acceleration, scale * blocks.deceleration[i])
    return RampLimits(velocity, speeding, braking, jerk)


@array_arithmetic_kernel
def _rounding_velocity(corners: Corners, i: int, machine: MachineLimits) -> float:
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
def _never_faster(
    blocks: BlockMotion, i: int, width: float, passed: float, before: RampLimits, after: RampLimits
) -> bool:
    """Whether a block is too short to be left, or entered, faster than the rounding is passed."""
    room, next_room = blocks.length[i - 1] - width, blocks.length[i] - width
    return (
        brake_distance(passed, 0.0, before.acceleration, before.jerk) >= room
        or brake_distance(passed, 0.0, after.deceleration, after.jerk) >= next_room
    )


@array_arithmetic_kernel
def _overlap_distance(
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
def _overlap_time(
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
