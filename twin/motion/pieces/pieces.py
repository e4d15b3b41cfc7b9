"""Blocks cut into pieces along which the limits of the path may be taken as constant.

Along a piece the path parameter x counts what the feed counts (mm, or degrees where only rotary
axes move). With v, a, j its time derivatives and q', q'', q''' those of an axis by x, the axis has

    velocity      q' v
    acceleration  q'' v² + q' a
    jerk          q''' v³ + 3 q'' v a + q' j

A piece is short enough for bounds of abs(q'), abs(q''), abs(q''') to say nearly all there is.
"""

import dataclasses
import math
from collections.abc import Iterable, Iterator

import numpy as np

from twin.columns import Columns, Picked
from twin.motion.blocks.blocks import (
    BlocksOfChunks,
    BoolArray,
    Surroundings,
    WithNeighbours,
)
from twin.motion.blocks.corners import CONTEXT, VIEW, Borders
from twin.motion.limits import MotionLimits
from twin.motion.pieces.bound_kernels import bound_derivatives
from twin.motion.pieces.cut_kernels import cut_blocks, place_pieces
from twin.motion.pieces.limit_kernels import curve_shares, piece_limits
from twin.nc.canonical import Chunk, FloatArray, IntArray
from twin.toolpath.geometry import Geometry

BATCH = 4000
"""Blocks that are cut into pieces at a time: many more than their neighbours that are cut with them."""
MAX_ANGLE = 1024.0 * math.pi
"""What their arcs turn together, but for the last [rad]: of helices with many turns each, a few."""


@dataclasses.dataclass(frozen=True, slots=True)
class Pieces(Columns):
    """A run of n pieces over k axes, as columns. A dwell is a piece without length.

    Attributes:
        move: Number of the move in the whole program, -1 before the first, shape (n,).
        line: Source line, shape (n,).
        begin: Path fraction of the move at which the piece begins, shape (n,).
        fraction_per_length: Path fraction per x, shape (n,) [1/mm or 1/deg].
        length: In x, shape (n,) [mm or deg]; 0 for dwells.
        rapid: Whether the move is a rapid, shape (n,).
        feed: What the program asks for, infinite for rapids without, shape (n,) [mm/s or deg/s].
        velocity: Highest v, shape (n,) [mm/s or deg/s].
        acceleration: Highest a, shape (n,) [mm/s² or deg/s²].
        deceleration: Highest -a, shape (n,) [mm/s² or deg/s²].
        jerk: Highest abs(j), shape (n,) [mm/s³ or deg/s³].
        entry: Highest v at the begin, shape (n,) [mm/s or deg/s].
        overlap: How far from a stop at the begin the moves on both sides may overlap, shape (n,)
            [mm or deg]; 0: not at all.
        pause: How long a dwell waits, shape (n,) [s].
        rounding: What is added to each axis, coefficients by powers of x from the piece's begin,
            shape (n, k, 6) [mm or deg].
        path_acceleration: Highest abs(a) but for the curve, shape (n,) [mm/s² or deg/s²].
        path_jerk: Highest abs(j) but for the curve, shape (n,) [mm/s³ or deg/s³].
        geometry: Of each piece's whole move, n rows of a table of moves.
    """

    move: IntArray
    line: IntArray
    begin: FloatArray
    fraction_per_length: FloatArray
    length: FloatArray
    rapid: BoolArray
    feed: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    deceleration: FloatArray
    jerk: FloatArray
    entry: FloatArray
    overlap: FloatArray
    pause: FloatArray
    rounding: FloatArray
    path_acceleration: FloatArray
    path_jerk: FloatArray
    geometry: Picked[Geometry]


def blocks_to_cut(
    chunks: Iterable[Chunk], start: FloatArray, batch: int = BATCH
) -> Iterator[Surroundings]:
    """A program's blocks, as many at a time as are cut together.

    Args:
        start: Where the axes are before, part coordinates, shape (k,) [mm or deg].

    Raises:
        ValueError: A move does not begin where the one before it ended.
    """
    return WithNeighbours(BlocksOfChunks(chunks, start), batch, CONTEXT, MAX_ANGLE, VIEW)


def cut(
    surroundings: Surroundings, borders: Borders, limits: MotionLimits, largest_override: float = 1.0
) -> Pieces:  # fmt: skip
    """Cut blocks into pieces, dwells included, in order.

    Args:
        borders: Before each of them and of their neighbours.
        largest_override: Of the feed that the limits of a piece must leave room for.
    """
    blocks, shapes = surroundings.blocks, surroundings.blocks.geometry
    # The neighbours are cut as well: they tell how fast a piece can be reached and left.
    owner, offset, length, rounding = cut_blocks(
        blocks.length, shapes.angle, shapes.bend,
        borders.width, borders.tangent_step, borders.curvature_step,
    )  # fmt: skip
    scale, begin, entry, overlap = place_pieces(
        blocks.length, blocks.move, borders.entry, borders.overlap, owner, offset
    )
    velocity, acceleration, deceleration, jerk = piece_limits(
        blocks.limits(largest_override), owner, length, _ceilings(surroundings, entry),
        bound_derivatives(shapes.curves(), owner, begin, scale, length, rounding),
        limits.arrays(), curve_shares(borders.tangent_step, borders.curvature_step, borders.entry, shapes.angle),
    )  # fmt: skip
    first, last = np.searchsorted(owner, [surroundings.first, surroundings.last])
    due = slice(first, last)
    owner = owner[due]
    path_acceleration = blocks.parameter_scale * np.minimum(
        np.minimum(blocks.acceleration, blocks.deceleration), limits.path_acceleration
    )
    path_jerk = blocks.parameter_scale * limits.path_jerk
    return Pieces(
        move=blocks.move.take(owner),
        line=blocks.line.take(owner),
        begin=begin[due],
        fraction_per_length=scale[due],
        length=length[due],
        rapid=blocks.rapid.take(owner),
        feed=(blocks.feed * blocks.parameter_scale).take(owner),
        velocity=velocity[due],
        acceleration=acceleration[due],
        deceleration=deceleration[due],
        jerk=jerk[due],
        entry=entry[due],
        overlap=overlap[due],
        pause=blocks.pause.take(owner),
        rounding=rounding[due],
        path_acceleration=path_acceleration.take(owner),
        path_jerk=path_jerk.take(owner),
        geometry=Picked(owner, shapes),
    )


def _ceilings(surroundings: Surroundings, entry: FloatArray) -> FloatArray:
    """Highest velocities at the borders of pieces; any where the program goes on unseen."""
    ceilings = np.append(entry, 0.0 if surroundings.to_the_end else np.inf)
    if surroundings.first > 0:
        ceilings[0] = np.inf
    return ceilings
