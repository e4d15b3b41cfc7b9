"""Arcs of plain blocks: ``circular`` for the case that nothing about the arc is doubtful.

The geometry is that of ``arcs``, compiled as it stands there.
"""

from twin.compilation.compilable import compilable, inlined
from twin.nc.bytecode.registers import (
    CENTER_ABSOLUTE,
    INTERPOLATION,
    PLANE,
    SCALE,
    TURNED,
    UNIT,
    BlockTables,
    Constants,
    Rows,
    State,
)
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.compiled.kernels.frame import turn_arc
from twin.nc.compiled.kernels.plane import SHORTEST
from twin.nc.compiled.kernels.tokenizer import AXIS, CENTER, RADIUS
from twin.nc.geometry import arcs
from twin.nc.geometry.arcs import Point


@compilable
def value_of(token_kind: int, token_kinds: IntArray, values: FloatArray) -> float:
    """Value of the word with a token_kind; 0 where there is none."""
    for word in range(len(token_kinds)):
        if token_kinds[word] == token_kind:
            return values[word]
    return 0.0


@inlined
def emit_arc(
    token_kinds: IntArray,
    values: FloatArray,
    seen: int,
    tables: BlockTables,
    constants: Constants,
    state: State,
    modal: FloatArray,
    rows: Rows,
    row: int,
) -> bool:
    """Write the centre, normal and sweep of a row whose positions stand.

    Args:
        token_kinds: What each word's letter is, shape (w,).
        values: The words' values, shape (w,).
        seen: Which token_kinds there are, as bits.
        tables: What blocks mean.
        constants: What stays as it is.
        state: Where the block begins.
        modal: The modal state with this block's codes.
        rows: Where the move is written.
        row: Its row.

    Returns:
        Whether nothing about the arc is doubtful; if something is, the row is not to be used.
    """
    interpolation = int(modal[INTERPOLATION])
    plane = constants.planes[int(modal[PLANE])]
    first_axis, second_axis, across = int(plane[0]), int(plane[1]), int(plane[2])
    display = rows.positions[row, 2]
    start = (state.programmed[first_axis], state.programmed[second_axis])
    end = (display[first_axis], display[second_axis])
    clockwise = tables.clockwise[interpolation]
    has_first = seen & (1 << (CENTER + first_axis)) != 0
    has_second = seen & (1 << (CENTER + second_axis)) != 0
    if seen & (1 << (CENTER + across)):
        return False
    if seen & (1 << RADIUS):
        in_plane = (1 << (AXIS + first_axis)) | (1 << (AXIS + second_axis))
        if has_first or has_second or not seen & in_plane:
            return False
        radius = value_of(RADIUS, token_kinds, values) * modal[UNIT]
        larger = radius < 0.0
        if larger and not tables.signed_radius[interpolation]:
            return False
        if radius == 0.0 or not arcs.reaches(start, end, abs(radius)):
            return False
        fits = tables.fits_radius[interpolation]
        center = arcs.center_at_radius(start, end, abs(radius), clockwise, larger)
    else:
        fits = True
        if not (has_first or has_second):
            return False
        first = value_of(CENTER + first_axis, token_kinds, values) * modal[UNIT]
        second = value_of(CENTER + second_axis, token_kinds, values) * modal[UNIT]
        if modal[CENTER_ABSOLUTE] != 0.0:
            if not (has_first and has_second):
                return False
            center = (first, second)
        else:
            center = (start[0] + first, start[1] + second)
    if fits:
        fitted, center = _fitted(center, start, end, interpolation, tables)
        if not fitted:
            return False
    sweep = arcs.sweep_between(start, end, center, clockwise)
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
