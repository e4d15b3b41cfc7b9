"""The velocities at which curved pieces can be reached and left."""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import array_arithmetic_kernel
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
        derivatives: Of the pieces.
        curved: Whether any q'' is not 0, shape (n,).
        along_path: Of the pieces.
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
    ramped = np.full(count, math.inf)
    for direction in range(2):
        along = speeding if direction == 0 else braking
        # From the last border with a ceiling, where a = 0, the jerk alone bounds what is gained.
        slow, gone = math.inf, 0.0
        for step in range(count):
            i = step if direction == 0 else count - 1 - step
            known, wanted = (i, i + 1) if direction == 0 else (i + 1, i)
            start = border[known]
            if ceilings[known] < math.inf:
                slow, gone = ceilings[known], 0.0
            gone += length[i]
            ramp = math.inf
            if slow < math.inf and curved[i]:
                ramp = slow + 0.5 * np.cbrt(36.0 * limits[3, i] * gone * gone)
                ramp *= 0.5 * ramp
                ramped[i] = min(ramped[i], ramp)
            if start >= border[wanted]:
                continue
            distance = length[i] * readiness[i]
            highest = start + distance * along[i]
            for axis in range(axes):
                slope = bounds[i, 0, axis]
                if slope > 0.0:
                    curve = bounds[i, 1, axis] if against[i, direction, axis] else 0.0
                    # The division does not wait for the piece before.
                    share = 1.0 / (slope + 2.0 * distance * curve)
                    top = (slope * start + distance * axis_acceleration[axis]) * share
                    highest = min(highest, top)
            border[wanted] = min(border[wanted], max(min(highest, ramp), start))
    for i in range(count):
        # Along a straight piece velocity and acceleration do not compete.
        if curved[i]:
            top = max(border[i], border[i + 1])
            gain = length[i] * min(limits[1, i], limits[2, i])
            if top < 0.5 * gain:
                # So slow at both ends that the piece's own peak counts.
                top = min(0.5 * (border[i] + border[i + 1] + gain), ramped[i])
            velocity[i] = min(velocity[i], math.sqrt(2.0 * top))
