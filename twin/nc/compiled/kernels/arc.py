"""Arcs of plain blocks: ``circular`` for the case that nothing about the arc is doubtful.

What a centre or a radius means, and which fits, ``geometry.arcs`` says.
"""

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
from twin.nc.geometry.arcs import Bounds, Point
from twin.nc.geometry.planes import vector_of
from twin.nc.path.moves import SMALLEST_MOVE, arc_length
from twin.nc.path.rows import Rows


@inlined
def emit_arc(
    block: PlainBlock,
    tables: BlockTables,
    constants: Constants,
    state: State,
    rows: Rows,
    row: int,
) -> bool:
    """Write the centre, normal and sweep of a row whose positions stand.

    Args:
        block: Its words.
        tables: What blocks mean.
        constants: What stays as it is.
        state: Where the block begins.
        rows: Where the move is written.
        row: Its row.

    Returns:
        Whether nothing about the arc is doubtful; if something is, the row is not to be used.
    """
    interpolation = int(block.modal[INTERPOLATION])
    plane = constants.planes[int(block.modal[PLANE])]
    first_axis, second_axis, across = int(plane[0]), int(plane[1]), int(plane[2])
    display = rows.positions[row, 2]
    start = (state.programmed[first_axis], state.programmed[second_axis])
    end = (display[first_axis], display[second_axis])
    clear, fits, center = _center_of(block, (first_axis, second_axis, across), start, end, tables)
    if clear and fits:
        b = tables.bounds[interpolation]
        bounds = Bounds(float(b[0]), float(b[1]), float(b[2]), float(b[3]))
        finding, center = arcs.fitted_center(start, end, center, bounds)
        clear = finding == arcs.FITS
    if not clear:
        return False
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
    length = arc_length(position[0], position[1], turned_center, normal, value[6])
    return length >= SMALLEST_MOVE


@inlined
def _center_of(
    block: PlainBlock, axes: tuple[int, int, int], start: Point, end: Point, tables: BlockTables
) -> tuple[bool, bool, Point]:
    """Whether a block's words give a centre without a doubt, whether it has to fit, and where it is."""
    interpolation, seen, unit = int(block.modal[INTERPOLATION]), block.seen, block.modal[UNIT]
    first_axis, second_axis, across = axes
    has_first = seen & (1 << (CENTER + first_axis)) != 0
    has_second = seen & (1 << (CENTER + second_axis)) != 0
    if seen & (1 << (CENTER + across)):
        return False, False, start
    if seen & (1 << RADIUS):
        in_plane = (1 << (AXIS + first_axis)) | (1 << (AXIS + second_axis))
        if has_first or has_second or not seen & in_plane:
            return False, False, start
        radius, signed = value_of(RADIUS, block) * unit, tables.signed_radius[interpolation]
        clockwise = tables.clockwise[interpolation]
        finding, center = arcs.center_of_radius(start, end, radius, clockwise, signed)
        return finding == arcs.FITS, tables.fits_radius[interpolation], center
    first = value_of(CENTER + first_axis, block) * unit
    second = value_of(CENTER + second_axis, block) * unit
    if block.modal[CENTER_ABSOLUTE] != 0.0:
        return has_first and has_second, True, (first, second)
    return has_first or has_second, True, (start[0] + first, start[1] + second)
