"""The way of a tool through a part, in steps that are short beside the tool."""

from collections.abc import Sequence

import numpy as np

from twin.cutting.tridexel.moving_solid import Poses
from twin.cutting.tridexel.solids import Solid
from twin.nc.canonical import FloatArray, IntArray

STEP_SHARE = 0.1
"""Longest step as a share of a solid's radius: what rims leave between their places is of that size squared."""
STEP_DEGREES = 2.0
"""Largest turn of the axis in a step [deg]."""
FINEST_STEP_MM = 0.05
"""Steps need not be shorter than this [mm]: of a pointed tool its whole radius counts, of a stub nothing."""


def longest_step(solids: Sequence[Solid]) -> float:
    """How far what moves may go in a step [mm]."""
    radius = max(max(solid.low_radius, solid.high_radius) + solid.rounding for solid in solids)
    return max(STEP_SHARE * radius, FINEST_STEP_MM)


def in_short_steps(poses: Poses, solids: Sequence[Solid]) -> tuple[Poses, IntArray]:
    """Put poses between those that are far from each other.

    Args:
        poses: Ends of n steps.
        solids: What moves.

    Returns:
        Poses of m short steps, and which of the n steps each of them is part of, shape (m,).
    """
    tip, axis = poses
    longest = longest_step(solids)
    way = np.zeros(len(tip) - 1)
    for height in (solids[0].low, max(solid.high for solid in solids)):
        way = np.maximum(way, np.linalg.norm(np.diff(tip + height * axis, axis=0), axis=1))
    turn = np.linalg.norm(np.diff(axis, axis=0), axis=1) / np.deg2rad(STEP_DEGREES)
    parts = np.maximum(np.ceil(np.maximum(way / longest, turn)), 1.0).astype(np.int64)
    if (parts == 1).all():
        return poses, np.arange(len(parts))
    step = np.repeat(np.arange(len(parts)), parts)
    place = np.arange(len(step)) - np.repeat(np.cumsum(parts) - parts, parts)
    share = ((place + 1.0) / parts[step])[:, None]
    between = [
        np.concatenate([ends[:1], (1.0 - share) * ends[step] + share * ends[step + 1]])
        for ends in (tip, axis)
    ]
    direction: FloatArray = between[1] / np.linalg.norm(between[1], axis=1, keepdims=True)
    return Poses(between[0], direction), step
