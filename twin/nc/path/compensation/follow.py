"""Radius compensation of one move after the other: the path that keeps the tool's edge on the contour.

It looks one move ahead. Outside corners are rolled around on an arc about the corner, inside
corners end where the parallel paths meet, the straight lead-in ends square to the first element of
the contour and the straight lead-out starts square to its last; indirect leads go around the
contour's first and last point where the straight way would cut them off. What does not fit is refused: an
inside arc smaller than the tool, an element that its neighbours leave no room for, or a neck of the
contour that is narrower than the tool. A lead that cuts into the contour is refused as well, unless
the contour says that it may.
"""

from twin.compilation.compilable import compilable
from twin.nc.canonical import Shape
from twin.nc.geometry import curves
from twin.nc.geometry.arcs import SAME_POINT, distance
from twin.nc.geometry.corners import corner_of
from twin.nc.geometry.curves import Curve
from twin.nc.geometry.matrices import dot
from twin.nc.geometry.planes import point_of, vector_of
from twin.nc.path.compensation.contour import (
    BEGINS_ON_ARC,
    CONTOUR,
    ELEMENT,
    LEADING_IN,
    LEADING_OUT,
    MOVED_ROWS,
    NARROW_CORNER,
    NARROW_NECK,
    NO_ROOM_TO_WAIT,
    OLDEST,
    OUTSIDE_PLANE,
    PASSED,
    PLACED,
    SEVERAL_MOVES,
    SMALL_ARC,
    SQUARE,
    STAGE,
    STARTED,
    WAITING,
    Contour,
    curve_of,
    plane_of,
    set_curve,
)
from twin.nc.path.compensation.gouge import gouges, pass_by
from twin.nc.path.compensation.leads import lead_in, lead_out, take_lead
from twin.nc.path.compensation.lookahead import (
    flush_lookahead,
    go_around,
    hold_events,
    hold_move,
    take_move,
)
from twin.nc.path.rows import Rows, copy, copy_rows
from twin.nc.path.segments import IN_PLANE

_ARC = int(Shape.ARC)


@compilable
def follow(row: int, made: int, first_event: int, behind: int, contour: Contour, rows: Rows) -> int:
    """Compensate what a block has made.

    Args:
        row: Its first row.
        made: The row after it.
        first_event: The block's first event.
        behind: The event after its last.
        contour: Compensation, which is not off.
        rows: The block's row is replaced by those that it lets go.

    Returns:
        The row after those, or why not, with the contour untouched.
    """
    if made - row > 1:
        return SEVERAL_MOVES
    if made == row:
        hold_events(contour, rows, first_event, behind)
        return row
    stage, early = contour.counts[STAGE], first_event
    while early < behind and rows.events[early, 0] == row:
        early += 1
    if stage == LEADING_OUT:
        return lead_out(row, early, behind, contour, rows)
    plane, position = plane_of(contour), rows.positions[row]
    start, end = point_of(plane, vector_of(position[0])), point_of(plane, vector_of(position[1]))
    is_arc = rows.codes[row, 1] == _ARC
    if not is_arc and distance(start, end) < SAME_POINT:
        return _along_normal(row, first_event, early, behind, contour, rows)
    curve = (False, start, end, (0.0, 0.0), 0.0)
    if is_arc:
        value = rows.values[row]
        sense = dot(vector_of(value[3:]), plane[2])
        if not abs(sense) >= IN_PLANE:
            return OUTSIDE_PLANE
        curve = (True, start, end, point_of(plane, vector_of(value)), float(value[6]) * sense)
    if stage == STARTED:
        if is_arc:
            return BEGINS_ON_ARC
        return take_lead(start, end, row, early, behind, contour, rows)
    signed_offset = float(contour.signed_offset[0])
    if not curves.leaves_room(curve, signed_offset):
        contour.measured[0] = curves.radius_of(curve)
        return SMALL_ARC
    element = curves.parallel_of(curve, signed_offset)
    if stage == LEADING_IN:
        return lead_in(curve, element, row, first_event, early, behind, contour, rows)
    return _go_on(curve, element, row, first_event, early, behind, contour, rows)


@compilable
def _along_normal(
    row: int, first_event: int, early: int, behind: int, contour: Contour, rows: Rows
) -> int:
    """A move that does not go in the plane: at once before the lead-in, else behind the held move."""
    counts = contour.counts
    waiting = counts[WAITING]
    if counts[STAGE] == STARTED:
        take_move(contour, rows, row, early)
        copy(rows.positions[row, 1], contour.here)
        counts[PLACED], counts[MOVED_ROWS] = 1, row + 1
        return row + 1
    if waiting == len(contour.waiting.codes):
        return NO_ROOM_TO_WAIT
    hold_events(contour, rows, first_event, early)
    take_move(contour, rows, row, early)
    copy(rows.codes[row], contour.waiting.codes[waiting])
    copy(rows.values[row], contour.waiting.values[waiting])
    copy_rows(rows.positions[row], contour.waiting.positions[waiting])
    counts[WAITING], counts[PASSED], counts[OLDEST] = waiting + 1, 0, 0
    counts[MOVED_ROWS] = row
    hold_events(contour, rows, early, behind)
    return row


@compilable
def _go_on(
    curve: Curve,
    element: Curve,
    row: int,
    first_event: int,
    early: int,
    behind: int,
    contour: Contour,
    rows: Rows,
) -> int:
    """The contour's next element, with its parallel: as ``lead_in``."""
    counts, signed_offset = contour.counts, float(contour.signed_offset[0])
    held, before = curve_of(contour.curves[CONTOUR]), curve_of(contour.curves[ELEMENT])
    begin = (float(contour.start[0]), float(contour.start[1]))
    turn = curves.turn_from(held, curve)
    fits, rolls, at, follows = corner_of(
        (held, before, begin), (curve, element), turn, signed_offset, counts[SQUARE] != 0
    )
    if not fits:
        return NARROW_CORNER
    part = curves.cut(before, begin, at)
    box = curves.box_of(part)
    if gouges(contour, part, box, held, True):
        return NARROW_NECK
    passed, oldest = counts[PASSED], counts[OLDEST]
    pass_by(contour, part, box, held, True)
    sweep = abs(turn) if signed_offset < 0.0 else -abs(turn)
    corner = (True, before[2], element[1], curve[1], sweep)
    if rolls:
        box = curves.box_of(corner)
        if gouges(contour, corner, box, held, False):
            counts[PASSED], counts[OLDEST] = passed, oldest
            return NARROW_NECK
        pass_by(contour, corner, box, held, False)
    hold_events(contour, rows, first_event, early)
    take_move(contour, rows, row, early)
    after = flush_lookahead(contour, before, part, at, rows, row, early)
    if rolls:
        after = go_around(contour, corner, rows, after)
    hold_move(contour, curve, follows)
    set_curve(contour.curves[ELEMENT], element)
    hold_events(contour, rows, early, behind)
    return after
