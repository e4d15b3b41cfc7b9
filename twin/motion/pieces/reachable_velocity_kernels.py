"""The velocities at which curved pieces can be reached and left."""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import arithmetic_kernel, array_arithmetic_kernel
from twin.motion.blocks.blocks import BoolArray
from twin.motion.pieces.bound_kernels import DerivativeBounds
from twin.nc.canonical import FloatArray


class Along(NamedTuple):
    """What n pieces allow along the path.

    Attributes:
        length: Shape (n,).
        speeding: Highest a of the path, shape (n,).
        braking: Highest -a of the path, shape (n,).
        readiness: Share of the acceleration that the jerk leaves on average, shape (n,).
    """

    length: FloatArray
    speeding: FloatArray
    braking: FloatArray
    readiness: FloatArray


@array_arithmetic_kernel
def lower_to_reachable(
    derivatives: DerivativeBounds, curved: BoolArray, along_path: Along, limits: FloatArray,
    ceilings: FloatArray, axis_acceleration: FloatArray,
) -> None:  # fmt: skip
    """Lower the velocity of curved pieces, in place, to what they see if only v and a count.

    With b = v²/2, so that db/dx = a, an axis's acceleration is 2 q'' b + q' a: a pass forwards and
    one backwards over b give the well-known bound. What is left of the acceleration beside this
    velocity may then be used for changing it.

    Args:
        curved: Whether any q'' is not 0, shape (n,).
        limits: Rows velocity, lowered along curved pieces, acceleration and deceleration without
            what a curve takes, jerk; shape (4, n).
        ceilings: Highest velocities at the pieces' borders, shape (n + 1,).
        axis_acceleration: Shape (k,).
    """
    bounds, against = derivatives.axes, derivatives.against
    length, speeding, braking, readiness = along_path
    count, axes = len(length), len(axis_acceleration)
    velocity = limits[0]
    border = np.zeros(count + 1)
    before = math.inf
    for i in range(count):
        highest = min(ceilings[i], velocity[i], before)
        border[i] = 0.5 * highest * highest
        before = velocity[i]
    highest = min(ceilings[count], before)
    border[count] = 0.5 * highest * highest
    # From the last border with a ceiling, where a = 0, the jerk alone bounds what is gained: the velocity
    # there and the distance from there, forwards and backwards.
    slow, gone = np.full((2, count), math.inf), np.zeros((2, count))
    for direction in range(2):
        along = speeding if direction == 0 else braking
        ceiling, distance = math.inf, 0.0
        for step in range(count):
            i = step if direction == 0 else count - 1 - step
            known, wanted = (i, i + 1) if direction == 0 else (i + 1, i)
            start = border[known]
            if ceilings[known] < math.inf:
                ceiling, distance = ceilings[known], 0.0
            distance += length[i]
            if curved[i]:
                slow[direction, i], gone[direction, i] = ceiling, distance
            if start >= border[wanted]:
                continue
            travel = length[i] * readiness[i]
            highest = start + travel * along[i]
            for axis in range(axes):
                slope = bounds[i, 0, axis]
                if slope > 0.0:
                    curve = bounds[i, 1, axis] if against[i, direction, axis] else 0.0
                    # The division does not wait for the piece before.
                    share = 1.0 / (slope + 2.0 * travel * curve)
                    top = (slope * start + travel * axis_acceleration[axis]) * share
                    highest = min(highest, top)
            highest = _ramped(slow[direction, i], gone[direction, i], limits[3, i], highest)
            border[wanted] = min(border[wanted], max(highest, start))
    for i in range(count):
        # Along a straight piece velocity and acceleration do not compete.
        if curved[i]:
            top = max(border[i], border[i + 1])
            gain = length[i] * min(limits[1, i], limits[2, i])
            if top < 0.5 * gain:
                # So slow at both ends that the piece's own peak counts.
                top = 0.5 * (border[i] + border[i + 1] + gain)
                for direction in range(2):
                    top = _ramped(slow[direction, i], gone[direction, i], limits[3, i], top)
            velocity[i] = min(velocity[i], math.sqrt(2.0 * top))


@arithmetic_kernel
def _ramped(slow: float, gone: float, jerk: float, highest: float) -> float:
    """A bound of v²/2, lowered to what the jerk alone lets a ramp reach.

    Args:
        slow: Velocity at the ramp's begin, where a = 0; infinite: it begins nowhere.
        jerk: Highest j.
        highest: The bound of v²/2.
    """
    if slow == math.inf:
        return highest
    # With constant jerk x = j t³/6 + slow t: v is no more than slow + (36 j x²)^(1/3) / 2.
    gain, cube = 2.0 * (math.sqrt(2.0 * highest) - slow), 36.0 * jerk * gone * gone
    if gain <= 0.0 or gain * gain * gain <= cube:
        return highest
    ramp = slow + 0.5 * np.cbrt(cube)
    return 0.5 * ramp * ramp
