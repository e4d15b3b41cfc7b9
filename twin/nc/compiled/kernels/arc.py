"""Arcs of plain blocks: ``circular`` for the case that nothing about the arc is doubtful.

What a centre or a radius means, and which fits, ``geometry.arcs`` says.
"""

import numpy as np

from twin.compilation.compilable import inlined
from twin.nc.bytecode.coordinates import directions, matrix_of, put
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
from twin.nc.bytecode.token_kinds import CENTER, RADIUS
from twin.nc.compiled.kernels.target import PlainBlock, value_of
from twin.nc.geometry import arcs
from twin.nc.geometry.arcs import ArcWords, Bounds, Sense
from twin.nc.geometry.frame import arc_about, arc_of_part
from twin.nc.geometry.planes import point_of, vector_of
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
    clockwise = tables.clockwise[interpolation]
    clear, words = _words_of_arc(block, constants)
    if not clear:
        return DOUBTFUL
    plane = directions(constants, block.modal)
    position, value = rows.positions[row], rows.values[row]
    start = point_of(plane, vector_of(state.programmed))
    end = point_of(plane, vector_of(position[2]))
    b = tables.bounds[interpolation]
    bounds = Bounds(float(b[0]), float(b[1]), float(b[2]), float(b[3]))
    fits = tables.fits_radius[interpolation]
    sense = Sense(clockwise, tables.signed_radius[interpolation], fits)
    absolute = block.modal[CENTER_ABSOLUTE] != 0.0
    finding, found = arcs.center_of_words(start, end, words, absolute, sense, bounds)
    if finding != arcs.FITS:
        return DOUBTFUL
    sweep = arcs.sweep_between(start, end, found, clockwise)
    programmed = arc_about(plane, state.programmed, found, sweep)
    turned = state.registers[TURNED] != 0.0
    arc = arc_of_part(programmed, matrix_of(state), state.total, turned)
    put(arc.center, value)
    put(arc.normal, value[3:])
    value[6] = arc.sweep
    return arc_length(position[0], position[1], arc.center, arc.normal, arc.sweep)


@inlined
def _words_of_arc(block: PlainBlock, constants: Constants) -> tuple[bool, ArcWords]:
    """Whether nothing about the words of an arc in the plane is doubtful, and these words."""
    plane = constants.planes[int(block.modal[PLANE])]
    first, second = _length_of(CENTER + plane[0], block), _length_of(CENTER + plane[1], block)
    words = ArcWords(_length_of(RADIUS, block), first, second)
    clear = block.seen & (1 << (CENTER + plane[2])) == 0
    if block.modal[CENTER_ABSOLUTE] != 0.0 and words.radius != words.radius:
        clear = clear and first == first and second == second
    return clear, words


@inlined
def _length_of(token_kind: int, block: PlainBlock) -> float:
    """Value of a word that counts a length [mm]; NaN where there is none."""
    return (
        value_of(token_kind, block) * block.modal[UNIT]
        if block.seen & (1 << token_kind)
        else np.nan
    )
