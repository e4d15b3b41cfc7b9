"""Arcs of plain blocks: ``circular`` for the case that nothing about the arc is doubtful.

The geometry is that of ``arcs``, compiled as it stands there.
"""

from twin.compilation.compilable import inlined
from twin.nc.bytecode.registers import (
    CENTER_ABSOLUTE,
    INTERPOLATION,
    PLANE,
    SCALE,
    TURNED,
    UNIT,
    BlockTables,
    Constants,
    State,
)
from twin.nc.bytecode.token_kinds import AXIS, CENTER, RADIUS
from twin.nc.compiled.kernels.frame import turn_arc
from twin.nc.compiled.kernels.plane import SHORTEST
from twin.nc.compiled.kernels.target import PlainBlock, value_of
from twin.nc.geometry import arcs
from twin.nc.geometry.arcs import Point
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
    found, fits, center = _center_of(block, (first_axis, second_axis, across), start, end, tables)
    if not found:
        return False
    if fits:
        fitted, center = _fitted(center, start, end, interpolation, tables)
        if not fitted:
            return False
    sweep = arcs.sweep_between(start, end, center, tables.clockwise[interpolation])
    length = arcs.distance(start, center) * abs(sweep) * state.registers[SCALE]
    if not length > SHORTEST * arcs.TURN:
        return False
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
    return True


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
        radius = value_of(RADIUS, block) * unit
        larger, clockwise = radius < 0.0, tables.clockwise[interpolation]
        if larger and not tables.signed_radius[interpolation]:
            return False, False, start
        if radius == 0.0 or not arcs.reaches(start, end, abs(radius)):
            return False, False, start
        fits = tables.fits_radius[interpolation]
        return True, fits, arcs.center_at_radius(start, end, abs(radius), clockwise, larger)
    first = value_of(CENTER + first_axis, block) * unit
    second = value_of(CENTER + second_axis, block) * unit
    if block.modal[CENTER_ABSOLUTE] != 0.0:
        return has_first and has_second, True, (first, second)
    return has_first or has_second, True, (start[0] + first, start[1] + second)


@inlined
def _fitted(
    given: Point, start: Point, end: Point, interpolation: int, tables: BlockTables
) -> tuple[bool, Point]:
    """Whether a given centre is within the bounds of its interpolation, and the one that fits both ends."""
    near, far = arcs.distance(start, given), arcs.distance(end, given)
    gap, longer = abs(near - far), max(near, far)
    if not (
        min(near, far) >= arcs.SAME_POINT
        and gap <= tables.mismatch[interpolation]
        and gap <= tables.mismatch_share[interpolation] * longer
    ):
        return False, given
    center = arcs.equidistant(start, end, given)
    return arcs.distance(given, center) <= tables.shift[interpolation], center
