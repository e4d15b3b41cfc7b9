"""What happens where one block meets the next: a stop, a tangent_step, or a rounding.

At a border the first derivatives of the axes by the path parameter x step by ``tangent_step`` and the
second ones by ``curvature_step`` (a straight move into a tangent arc has only a curvature_step). A continuous border is
rounded by adding to the path, over a width on both sides, a polynomial that takes away exactly
these two steps; the sum is curvature-continuous, and roundings may overlap, so that a chain of
short blocks becomes one smooth curve.
"""

import dataclasses

import numpy as np

from twin.motion.blocks.blocks import Blocks, BoolArray
from twin.motion.blocks.border_kernels import (
    border_steps,
    border_velocities,
    tolerance_shares,
)
from twin.motion.blocks.corner_choice_kernels import choose_stops, clip_widths
from twin.motion.blocks.corner_kernels import MAX_NEIGHBOURS, find_widths
from twin.motion.blocks.corner_limit_kernels import BlockMotion, Corners
from twin.motion.blocks.knee_kernels import (
    LONGEST_VIEW,
    BlockRun,
    slow_bending_chords,
    slow_dense_knees,
)
from twin.motion.limits import MotionLimits
from twin.nc.canonical import Corner, FloatArray

CONTEXT = 7 * MAX_NEIGHBOURS
"""Blocks on either side that the path along a block can depend on: roundings reach that far, stops
narrow them from as far again and are chosen by what is as far beyond, their widths depend on others'
widths thrice as far, and those on the tolerances as far again."""

VIEW = 2.0 * LONGEST_VIEW
"""Length of path on either side that the path along a block can depend on where chords are short [mm or deg]: the
velocities at knees, and what those beyond them allow."""


@dataclasses.dataclass(frozen=True, slots=True)
class Borders:
    """The borders before each of n blocks.

    Attributes:
        tangent_step: Step of dq/dx of each axis, shape (n, k).
        curvature_step: Step of d²q/dx² of each axis, shape (n, k).
        width: How far a rounding reaches to either side, shape (n,) [mm or deg]; 0: none.
        entry: Highest velocity, shape (n,) [mm/s or deg/s].
        overlap: How far from a stop the moves on both sides may overlap, shape (n,) [mm or deg]; 0:
            not at all.
    """

    tangent_step: FloatArray
    curvature_step: FloatArray
    width: FloatArray
    entry: FloatArray
    overlap: FloatArray


def find_borders(blocks: Blocks, limits: MotionLimits, largest_override: float = 1.0) -> Borders:
    """Decide how each border is passed; the first block's border counts as a stop."""
    shapes, axes = blocks.geometry, len(limits)
    asked = blocks.limits(largest_override)
    tangent_step, curvature_step = border_steps(shapes.curves(), blocks.length)
    corner = blocks.corner.copy()
    corner[0] = Corner.EXACT_STOP
    rounded = corner == Corner.CONTINUOUS
    width, overlap = np.zeros(len(blocks)), np.zeros(len(blocks))
    if np.any(rounded):
        tolerance = _tolerances(blocks, rounded, limits)
        further = limits.further_corner_tolerance
        shares = tolerance_shares(tangent_step, curvature_step, tolerance, further)
        place = np.append(0.0, np.cumsum(blocks.length))
        width = find_widths(place, rounded, *shares)
        stops, overlap = choose_stops(
            BlockMotion(blocks.move, shapes.curves(), blocks.length, asked),
            Corners(tangent_step, curvature_step, rounded, width, tolerance, further),
            limits.arrays(),
        )  # fmt: skip
        if np.any(stops):
            corner[stops] = Corner.EXACT_STOP
            rounded &= ~stops
            clip_widths(place, stops, width)
    entry = border_velocities(
        tangent_step, curvature_step, corner == Corner.EXACT_STOP, rounded, width,
        np.broadcast_to(limits.junction_velocity_step, axes),
        np.broadcast_to(limits.junction_acceleration_step, axes),
    )  # fmt: skip
    if np.any(corner == Corner.EXACT_PATH):
        # What is asked for bounds the velocity beside a knee in any case.
        slower = np.minimum(asked.velocity[:-1], asked.velocity[1:])
        entry[1:] = np.where(entry[1:] < np.inf, np.minimum(entry[1:], slower), np.inf)
        _slow_close_knees(blocks, entry, tangent_step, width, limits)
    return Borders(tangent_step, curvature_step, width, entry, overlap)


def _slow_close_knees(
    blocks: Blocks, entry: FloatArray, tangent_step: FloatArray, width: FloatArray, limits: MotionLimits
) -> None:  # fmt: skip
    """Lower the velocities of knees that follow one another closely, in place."""
    shapes, axes = blocks.geometry, len(limits)
    acceleration = limits.acceleration.copy()
    acceleration[:3] = np.minimum(acceleration[:3], limits.path_acceleration)
    step = np.broadcast_to(limits.junction_velocity_step, axes)
    slow_dense_knees(entry, tangent_step, blocks.length, shapes.angle, step, acceleration)
    straight = (shapes.angle == 0.0) & ~shapes.bend.any(axis=(1, 2))
    joined = straight & (entry > 0.0) & (width == 0.0)
    joined[1:] &= straight[:-1]
    place = np.append(0.0, np.cumsum(blocks.length))
    chain = BlockRun(place, np.vstack([shapes.base, shapes.end[-1:]]), joined)
    slow_bending_chords(entry, chain, step, limits.jerk)


def _tolerances(blocks: Blocks, rounded: BoolArray, limits: MotionLimits) -> FloatArray:
    """Of X Y Z at each border, shape (n,) [mm]; infinite where nothing is rounded.

    Where tolerances differ, the strictest among the borders that roundings can reach counts.
    """
    own = np.where(np.isnan(blocks.tolerance), limits.corner_tolerance, blocks.tolerance)
    own[~rounded] = np.inf
    strictest = own.copy()
    if np.ptp(own[rounded]) > 0.0:
        for shift in range(1, MAX_NEIGHBOURS + 1):
            np.minimum(strictest[shift:], own[:-shift], out=strictest[shift:])
            np.minimum(strictest[:-shift], own[shift:], out=strictest[:-shift])
    return strictest
