"""What happens where one block meets the next: a stop, a knee, or a rounding.

At a border the first derivatives of the axes by the path parameter x step by ``knee`` and the
second ones by ``bend`` (a straight move into a tangent arc has only a bend). A continuous border is
rounded by adding to the path, over a width on both sides, a polynomial that takes away exactly
these two steps; the sum is curvature-continuous, and roundings may overlap, so that a chain of
short blocks becomes one smooth curve.
"""

import dataclasses

import numpy as np

from twin.motion.blocks import Blocks, BoolArray
from twin.motion.corner_kernels import MOST_NEIGHBOURS, find_widths
from twin.motion.limits import MotionLimits
from twin.nc.canonical import Corner, FloatArray

CONTEXT = 5 * MOST_NEIGHBOURS
"""Blocks on either side that the path along a block can depend on: roundings reach that far, their
widths depend on others' widths thrice as far, and those on the tolerances as far again."""

KNEE_NOISE = 1e-9
"""Steps of derivatives below this are rounding of the geometry [1, or 1/mm]."""


@dataclasses.dataclass(frozen=True, slots=True)
class Borders:
    """The borders before each of n blocks.

    Attributes:
        knee: Step of dq/dx of each axis, shape (n, k).
        bend: Step of d²q/dx² of each axis, shape (n, k).
        width: How far a rounding reaches to either side, shape (n,) [mm or deg]; 0: none.
        entry: Highest velocity, shape (n,) [mm/s or deg/s].
    """

    knee: FloatArray
    bend: FloatArray
    width: FloatArray
    entry: FloatArray


def find_borders(blocks: Blocks, limits: MotionLimits) -> Borders:
    """Decide how each border is passed; the first block's border counts as a stop."""
    count = len(blocks)
    rows = np.arange(count)
    scale = np.divide(1.0, blocks.length, out=np.zeros(count), where=blocks.length > 0.0)[:, None]
    zeros, ones = np.zeros(count), np.ones(count)
    shapes = blocks.geometry
    knee, bend = (
        _noise_free(_steps(shapes.derivative(rows, zeros, order) * scale**order,
                           shapes.derivative(rows, ones, order) * scale**order))
        for order in (1, 2)
    )  # fmt: skip
    corner = blocks.corner.copy()
    corner[0] = Corner.EXACT_STOP

    width = np.zeros(count)
    rounded = corner == Corner.CONTINUOUS
    if np.any(rounded):
        per_width, per_square = _strictness(blocks, rounded, knee, bend, limits)
        place = np.append(0.0, np.cumsum(blocks.length))
        width = find_widths(place, rounded, per_width, per_square)

    by_knee = _allowed(limits.junction_velocity_step, knee)
    by_bend = np.sqrt(_allowed(limits.junction_acceleration_step, bend))
    entry = np.minimum(by_knee, by_bend)
    entry[width > 0.0] = np.inf
    # A continuous path has no steps at all: where there is no room to round them, it stops.
    stepping = np.any(knee != 0.0, axis=1) | np.any(bend != 0.0, axis=1)
    entry[rounded & (width == 0.0) & stepping] = 0.0
    entry[corner == Corner.EXACT_STOP] = 0.0
    return Borders(knee, bend, width, entry)


def _steps(at_begin: FloatArray, at_end: FloatArray) -> FloatArray:
    out = np.zeros_like(at_begin)
    out[1:] = at_begin[1:] - at_end[:-1]
    return out


def _noise_free(steps: FloatArray) -> FloatArray:
    return np.where(np.abs(steps) < KNEE_NOISE, 0.0, steps)


def _allowed(largest: FloatArray | float, step: FloatArray) -> FloatArray:
    """By how much the steps may be multiplied; infinite where nothing steps, shape (n,)."""
    size = np.abs(step)
    factors = np.full_like(size, np.inf)
    np.divide(np.broadcast_to(largest, size.shape), size, out=factors, where=size > 0.0)
    return factors.min(axis=1)


def _strictness(
    blocks: Blocks, rounded: BoolArray, knee: FloatArray, bend: FloatArray, limits: MotionLimits
) -> tuple[FloatArray, FloatArray]:
    """Shares of the tolerance that a rounding uses per width by its knee, and per width² by bend.

    Where tolerances differ, the strictest among the borders that roundings can reach counts.
    """
    own = np.where(np.isnan(blocks.tolerance), limits.corner_tolerance, blocks.tolerance)
    own[~rounded] = np.inf
    spatial = own.copy()
    if np.ptp(own[rounded]) > 0.0:
        for shift in range(1, MOST_NEIGHBOURS + 1):
            np.minimum(spatial[shift:], own[:-shift], out=spatial[shift:])
            np.minimum(spatial[:-shift], own[shift:], out=spatial[:-shift])
    knee_share = np.linalg.norm(knee[:, :3], axis=1) / spatial
    bend_share = np.linalg.norm(bend[:, :3], axis=1) / spatial
    others = np.abs(knee[:, 3:]).max(axis=1, initial=0.0) / limits.further_corner_tolerance
    return np.maximum(knee_share, others), bend_share
