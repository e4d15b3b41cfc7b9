"""Arcs of plain blocks: ``circular`` for the case that nothing about the arc is doubtful.

What a centre or a radius means, and which fits, ``geometry.arcs`` says.
"""

import numpy as np

from twin.compilation.compilable import inlined
from twin.nc.bytecode.coordinates import turn_arc
from twin.nc.bytecode.registers import (
    CENTER_ABSOLUTE,
    INTERPOLATION,
    PLANE,
    TURNED,
    UNIT,
    BlockTables,
    Constants,
    State,
)
from twin.nc.bytecode.token_kinds import AXIS, CENTER, RADIUS
from twin.nc.compiled.kernels.target import PlainBlock, value_of
from twin.nc.geometry import arcs
from twin.nc.geometry.arcs import ArcWords, Bounds, Sense
from twin.nc.geometry.planes import vector_of
from twin.nc.path.moves import arc_length
from twin.nc.path.rows import Rows

DOUBTFUL = -1.0
"""Length of an arc that is left to the interpreter tier."""


@inlined
def emit_arc(
    block: PlainBlock,
    tables: BlockTables,
    constants: Constants,
    state: State,
    rows: Rows,
    row: int,
) -> float:
    """Write the centre, normal and sweep of a row whose positions stand.

    Args:
        block: Its words.
        tables: What blocks mean.
        constants: What stays as it is.
        state: Where the block begins.
        rows: Where the move is written.
        row: Its row.

    Returns:
        Its length [mm]; ``DOUBTFUL`` where something about the arc is.
    """
    interpolation = int(block.modal[INTERPOLATION])
    plane = constants.planes[int(block.modal[PLANE])]
    first_axis, second_axis, across = int(plane[0]), int(plane[1]), int(plane[2])
    display = rows.positions[row, 2]
    start = (state.programmed[first_axis], state.programmed[second_axis])
    end = (display[first_axis], display[second_axis])
    clear, words = _words_of_arc(block, (first_axis, second_axis, across))
    if not clear:
        return DOUBTFUL
    b = tables.bounds[interpolation]
    bounds = Bounds(float(b[0]), float(b[1]), float(b[2]), float(b[3]))
    sense = Sense(
        tables.clockwise[interpolation],
        tables.signed_radius[interpolation],
        tables.fits_radius[interpolation],
    )
    absolute = block.modal[CENTER_ABSOLUTE] != 0.0
    finding, center = arcs.center_of_words(start, end, words, absolute, sense, bounds)
    if finding != arcs.FITS:
        return DOUBTFUL
    sweep = arcs.sweep_between(start, end, center, tables.clockwise[interpolation])
    value = rows.values[row]
    value[first_axis], value[second_axis] = center
    value[across] = state.programmed[across]
    value[3:6] = 0.0
    value[3 + across] = 1.0
    value[6] = sweep
    if state.registers[TURNED] != 0.0:
        turn_arc(value, state)
    else:
        for axis in range(3):
            value[axis] += state.total[axis]
    turned_center, normal = vector_of(value), vector_of(value[3:])
    position = rows.positions[row]
    return arc_length(position[0], position[1], turned_center, normal, value[6])


@inlined
def _words_of_arc(block: PlainBlock, axes: tuple[int, int, int]) -> tuple[bool, ArcWords]:
    """Whether a block's words give an arc in the plane without a doubt, and these words."""
    first_axis, second_axis, across = axes
    radius = _length_of(RADIUS, block)
    first, second = _length_of(CENTER + first_axis, block), _length_of(CENTER + second_axis, block)
    in_plane = (1 << (AXIS + first_axis)) | (1 << (AXIS + second_axis))
    clear = block.seen & (1 << (CENTER + across)) == 0
    if radius == radius:
        clear = clear and block.seen & in_plane != 0
    elif block.modal[CENTER_ABSOLUTE] != 0.0:
        clear = clear and first == first and second == second
    return clear, ArcWords(radius, first, second)


@inlined
def _length_of(token_kind: int, block: PlainBlock) -> float:
    """Value of a word that counts a length [mm]; NaN where there is none."""
    return (
        value_of(token_kind, block) * block.modal[UNIT]
        if block.seen & (1 << token_kind)
        else np.nan
    )
