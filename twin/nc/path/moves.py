"""How far moves go, by the convention of ``canonical``."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from twin.compilation.compilable import inlined
from twin.nc.canonical import Corner, FloatArray
from twin.nc.geometry.planes import Vector, along

Position = list[float] | FloatArray

RAPIDS_END = Corner.EXACT_STOP
"""How the end of a rapid is passed."""
SMALLEST_MOVE = 1e-9
"""A move that goes less far than this goes nowhere [mm or deg]: far below any resolution."""


@inlined
def axis_target(value: float, unit: float, linear: bool, incremental: bool, here: float) -> float:
    """Where a word wants an axis, programmed coordinates [mm or deg]."""
    target = value * unit if linear else value
    return target + here if incremental else target


@inlined
def line_length(start: Position, end: Position) -> float:
    """How far a straight move goes: in X, Y and Z, or where these rest in the other axes [mm or deg].

    Args:
        start: Shape (k,).
        end: Shape (k,); what goes less far than ``SMALLEST_MOVE`` ends where it starts, since what a
            frame has rounded is no distance.

    Returns:
        0 where nothing moves.
    """
    x, y, z = end[0] - start[0], end[1] - start[1], end[2] - start[2]
    distance = math.sqrt(x * x + y * y + z * z)
    if distance < SMALLEST_MOVE:
        end[0], end[1], end[2] = start[0], start[1], start[2]
        distance = 0.0
        for axis in range(3, len(start)):
            other = end[axis] - start[axis]
            distance += other * other
        distance = math.sqrt(distance)
        if distance < SMALLEST_MOVE:
            for axis in range(3, len(start)):
                end[axis] = start[axis]
            distance = 0.0
    return distance


@inlined
def arc_radius(start: Position, center: Vector) -> float:
    """Radius of an arc whose centre lies at the height of its start [mm]."""
    x, y, z = start[0] - center[0], start[1] - center[1], start[2] - center[2]
    return math.sqrt(x * x + y * y + z * z)


@inlined
def arc_length(
    start: Position, end: Position, center: Vector, normal: Vector, sweep: float
) -> float:
    """What the feed counts of an arc or a helix in X, Y and Z [mm]; the sweep in degrees."""
    around = arc_radius(start, center) * math.radians(sweep)
    advance = along((end[0] - start[0], end[1] - start[1], end[2] - start[2]), normal)
    return math.sqrt(around * around + advance * advance)


@inlined
def only_turns(start: Position, end: Position, linear: Sequence[bool] | NDArray[np.bool_]) -> bool:
    """Whether a straight move moves no linear axis: then F counts degrees."""
    axis, axes = 0, len(start)
    while axis < axes and (end[axis] == start[axis] or not linear[axis]):
        axis += 1
    return axis == axes
