"""The velocities at which curved pieces can be reached and left."""

import math

import numba
import numpy as np
import numpy.typing as npt

from twin.motion.blocks import BoolArray
from twin.nc.canonical import FloatArray


@numba.njit(cache=True, error_model="numpy")
def reach_velocities(
    bounds: FloatArray, against: npt.NDArray[np.bool_],
    curved: BoolArray, length: FloatArray, velocity: FloatArray,
    ceilings: FloatArray, axis_acceleration: FloatArray, speeding: FloatArray, braking: FloatArray,
    readiness: FloatArray,
) -> None:  # fmt: skip
    """Lower the velocity of curved pieces, in place, to what they see if only v and a count.

    With b = v²/2, so that db/dx = a, an axis's acceleration is 2 q'' b + q' a: a pass forwards and
    one backwards over b give the well-known bound. What is left of the acceleration beside this
    velocity may then be used for changing it.

    Args:
        bounds: Of abs(q'), abs(q''), abs(q'''), shape (n, 3, k).
        against: Whether the part of q'' in the acceleration can add to that of a > 0, and of a < 0,
            shape (n, 2, k).
        curved: Whether any q'' is not 0, shape (n,).
        length: Shape (n,).
        velocity: Ceilings, lowered along curved pieces, shape (n,).
        ceilings: The same at the pieces' borders, shape (n + 1,).
        axis_acceleration: Shape (k,).
        speeding: Highest a of the path, shape (n,).
        braking: Highest -a of the path, shape (n,).
        readiness: Share of the acceleration that the jerk leaves on average, shape (n,).
    """
    count = len(length)
    border = np.zeros(count + 1)
    for i in range(count + 1):
        highest = ceilings[i]
        if i < count:
            highest = min(highest, velocity[i])
        if i > 0:
            highest = min(highest, velocity[i - 1])
        border[i] = 0.5 * highest * highest
    for direction in range(2):
        for step in range(count):
            i = step if direction == 0 else count - 1 - step
            known, wanted = (i, i + 1) if direction == 0 else (i + 1, i)
            if border[known] >= border[wanted]:
                continue
            along = speeding[i] if direction == 0 else braking[i]
            highest = border[known] + length[i] * along * readiness[i]
            for axis in range(len(axis_acceleration)):
                slope = bounds[i, 0, axis]
                if slope > 0.0:
                    usable = axis_acceleration[axis] * readiness[i]
                    curve = bounds[i, 1, axis] if against[i, direction, axis] else 0.0
                    top = (slope * border[known] + length[i] * usable) / (
                        slope + 2.0 * length[i] * curve * readiness[i]
                    )
                    highest = min(highest, top)
            border[wanted] = min(border[wanted], max(highest, border[known]))
    for i in range(count):
        # Along a straight piece velocity and acceleration do not compete.
        if curved[i]:
            top = max(border[i], border[i + 1])
            gain = length[i] * min(speeding[i], braking[i])
            for axis in range(len(axis_acceleration)):
                if bounds[i, 0, axis] > 0.0:
                    gain = min(gain, length[i] * axis_acceleration[axis] / bounds[i, 0, axis])
            if top < 0.5 * gain:
                # So slow at both ends that the piece's own peak counts.
                top = 0.5 * (border[i] + border[i + 1] + gain)
            velocity[i] = min(velocity[i], math.sqrt(2.0 * top))
