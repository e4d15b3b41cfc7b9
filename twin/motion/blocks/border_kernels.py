"""What steps at the borders of blocks, and what the steps ask for."""

import math

import numpy as np

from twin.compilation.kernel import array_kernel
from twin.motion.blocks.blocks import BoolArray
from twin.nc.canonical import FloatArray
from twin.toolpath.geometry_kernels import Curves, bend_of, is_curve

STEP_NOISE = 1e-9
"""Steps of derivatives below this are rounding of the geometry [1, or 1/mm]."""


@array_kernel
def border_steps(curves: Curves, length: FloatArray) -> tuple[FloatArray, FloatArray]:
    """By how much dq/dx and d²q/dx² step at the border before each block.

    Args:
        length: Of the blocks in x, 0 for dwells, shape (n,).

    Returns:
        Shape (n, k) each; 0 before the first block.
    """
    drift, cosine, sine, angle = curves.drift, curves.cosine, curves.sine, curves.angle
    count, axes = drift.shape
    tangent_step, curvature_step = np.zeros((count, axes)), np.zeros((count, axes))
    for i in range(count):
        scale = 1.0 / length[i] if length[i] > 0.0 else 0.0
        for axis in range(axes):
            slope = drift[i, axis] * scale
            tangent_step[i, axis] += slope
            if i + 1 < count:
                tangent_step[i + 1, axis] -= slope
        if angle[i] != 0.0:
            turn = angle[i] * scale
            c, s = math.cos(angle[i]), math.sin(angle[i])
            for axis in range(3):
                p, q = cosine[i, axis], sine[i, axis]
                tangent_step[i, axis] += turn * q
                curvature_step[i, axis] -= turn * turn * p
                if i + 1 < count:
                    tangent_step[i + 1, axis] -= turn * (q * c - p * s)
                    curvature_step[i + 1, axis] += turn * turn * (p * c + q * s)
        if is_curve(curves.bend, i):
            for axis in range(axes):
                curvature_step[i, axis] += bend_of(curves.bend, i, axis, 0.0, 2) * scale * scale
                if i + 1 < count:
                    tangent_step[i + 1, axis] -= bend_of(curves.bend, i, axis, 1.0, 1) * scale
                    bent = bend_of(curves.bend, i, axis, 1.0, 2) * scale * scale
                    curvature_step[i + 1, axis] -= bent
        for axis in range(axes):
            if i == 0 or abs(tangent_step[i, axis]) < STEP_NOISE:
                tangent_step[i, axis] = 0.0
            if i == 0 or abs(curvature_step[i, axis]) < STEP_NOISE:
                curvature_step[i, axis] = 0.0
    return tangent_step, curvature_step


@array_kernel
def tolerance_shares(
    tangent_step: FloatArray,
    curvature_step: FloatArray,
    tolerance: FloatArray,
    further_tolerance: float,
) -> tuple[FloatArray, FloatArray]:
    """Shares of the tolerance that a rounding uses per width by its tangent_step, and per width² by curvature_step.

    Args:
        tangent_step: From ``border_steps``.
        curvature_step: From ``border_steps``.
        tolerance: Of X Y Z at each border, shape (n,) [mm].
        further_tolerance: Of the other axes [mm or deg].

    Returns:
        Shape (n,) each.
    """
    count, axes = tangent_step.shape
    per_width, per_square = np.zeros(count), np.zeros(count)
    for i in range(count):
        tangent_steps, curvature_steps = 0.0, 0.0
        for axis in range(min(3, axes)):
            tangent_steps += tangent_step[i, axis] * tangent_step[i, axis]
            curvature_steps += curvature_step[i, axis] * curvature_step[i, axis]
        per_width[i] = math.sqrt(tangent_steps) / tolerance[i]
        per_square[i] = math.sqrt(curvature_steps) / tolerance[i]
        for axis in range(3, axes):
            per_width[i] = max(per_width[i], abs(tangent_step[i, axis]) / further_tolerance)
    return per_width, per_square


@array_kernel
def border_velocities(
    tangent_step: FloatArray, curvature_step: FloatArray, stops: BoolArray, rounded: BoolArray, width: FloatArray,
    velocity_step: FloatArray, acceleration_step: FloatArray,
) -> FloatArray:  # fmt: skip
    """Highest velocity at each border; infinite where nothing steps.

    Args:
        tangent_step: From ``border_steps``.
        curvature_step: From ``border_steps``.
        stops: Whether the path stops, shape (n,).
        rounded: Whether the border is to be rounded, shape (n,).
        width: Of the rounding; 0 where there is none, shape (n,).
        velocity_step: Largest of each axis, shape (k,).
        acceleration_step: Largest of each axis, shape (k,).

    Returns:
        Shape (n,).
    """
    count, axes = tangent_step.shape
    velocity = np.full(count, math.inf)
    for i in range(count):
        if stops[i] or width[i] > 0.0:
            velocity[i] = 0.0 if stops[i] else math.inf
            continue
        by_tangent, by_curvature, steps = math.inf, math.inf, False
        for axis in range(axes):
            if tangent_step[i, axis] != 0.0:
                by_tangent = min(by_tangent, velocity_step[axis] / abs(tangent_step[i, axis]))
                steps = True
            if curvature_step[i, axis] != 0.0:
                by_curvature = min(
                    by_curvature, acceleration_step[axis] / abs(curvature_step[i, axis])
                )
                steps = True
        # A continuous path has no steps at all: where there is no room to round them, it stops.
        velocity[i] = 0.0 if rounded[i] and steps else min(by_tangent, math.sqrt(by_curvature))
    return velocity
