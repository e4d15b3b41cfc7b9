"""What steps at the borders of blocks, and what the steps ask for."""

import math

import numpy as np

from twin.compilation.kernel import array_kernel
from twin.motion.blocks.blocks import BoolArray
from twin.nc.canonical import FloatArray

KNEE_NOISE = 1e-9
"""Steps of derivatives below this are rounding of the geometry [1, or 1/mm]."""


@array_kernel
def border_steps(
    drift: FloatArray, cosine: FloatArray, sine: FloatArray, angle: FloatArray, length: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """By how much dq/dx and d²q/dx² step at the border before each block.

    Args:
        drift: Columns of the blocks' ``Geometry``, and so on to ``angle``.
        cosine: See above.
        sine: See above.
        angle: See above.
        length: Of the blocks in x, 0 for dwells, shape (n,).

    Returns:
        Shape (n, k) each; 0 before the first block.
    """
    count, axes = drift.shape
    knee, bend = np.zeros((count, axes)), np.zeros((count, axes))
    for i in range(count):
        scale = 1.0 / length[i] if length[i] > 0.0 else 0.0
        for axis in range(axes):
            slope = drift[i, axis] * scale
            knee[i, axis] += slope
            if i + 1 < count:
                knee[i + 1, axis] -= slope
        if angle[i] != 0.0:
            turn = angle[i] * scale
            c, s = math.cos(angle[i]), math.sin(angle[i])
            for axis in range(3):
                p, q = cosine[i, axis], sine[i, axis]
                knee[i, axis] += turn * q
                bend[i, axis] -= turn * turn * p
                if i + 1 < count:
                    knee[i + 1, axis] -= turn * (q * c - p * s)
                    bend[i + 1, axis] += turn * turn * (p * c + q * s)
        for axis in range(axes):
            if i == 0 or abs(knee[i, axis]) < KNEE_NOISE:
                knee[i, axis] = 0.0
            if i == 0 or abs(bend[i, axis]) < KNEE_NOISE:
                bend[i, axis] = 0.0
    return knee, bend


@array_kernel
def tolerance_shares(
    knee: FloatArray, bend: FloatArray, tolerance: FloatArray, further_tolerance: float
) -> tuple[FloatArray, FloatArray]:
    """Shares of the tolerance that a rounding uses per width by its knee, and per width² by bend.

    Args:
        knee: From ``border_steps``.
        bend: From ``border_steps``.
        tolerance: Of X Y Z at each border, shape (n,) [mm].
        further_tolerance: Of the other axes [mm or deg].

    Returns:
        Shape (n,) each.
    """
    count, axes = knee.shape
    per_width, per_square = np.zeros(count), np.zeros(count)
    for i in range(count):
        knees, bends = 0.0, 0.0
        for axis in range(min(3, axes)):
            knees += knee[i, axis] * knee[i, axis]
            bends += bend[i, axis] * bend[i, axis]
        per_width[i] = math.sqrt(knees) / tolerance[i]
        per_square[i] = math.sqrt(bends) / tolerance[i]
        for axis in range(3, axes):
            per_width[i] = max(per_width[i], abs(knee[i, axis]) / further_tolerance)
    return per_width, per_square


@array_kernel
def border_velocities(
    knee: FloatArray, bend: FloatArray, stops: BoolArray, rounded: BoolArray, width: FloatArray,
    velocity_step: FloatArray, acceleration_step: FloatArray,
) -> FloatArray:  # fmt: skip
    """Highest velocity at each border; infinite where nothing steps.

    Args:
        knee: From ``border_steps``.
        bend: From ``border_steps``.
        stops: Whether the path stops, shape (n,).
        rounded: Whether the border is to be rounded, shape (n,).
        width: Of the rounding; 0 where there is none, shape (n,).
        velocity_step: Largest of each axis, shape (k,).
        acceleration_step: Largest of each axis, shape (k,).

    Returns:
        Shape (n,).
    """
    count, axes = knee.shape
    velocity = np.full(count, math.inf)
    for i in range(count):
        if stops[i] or width[i] > 0.0:
            velocity[i] = 0.0 if stops[i] else math.inf
            continue
        by_knee, by_bend, steps = math.inf, math.inf, False
        for axis in range(axes):
            if knee[i, axis] != 0.0:
                by_knee = min(by_knee, velocity_step[axis] / abs(knee[i, axis]))
                steps = True
            if bend[i, axis] != 0.0:
                by_bend = min(by_bend, acceleration_step[axis] / abs(bend[i, axis]))
                steps = True
        # A continuous path has no steps at all: where there is no room to round them, it stops.
        velocity[i] = 0.0 if rounded[i] and steps else min(by_knee, math.sqrt(by_bend))
    return velocity
