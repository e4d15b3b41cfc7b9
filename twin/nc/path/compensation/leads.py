"""How radius compensation begins and ends: the straight moves to and from the contour."""

from twin.compilation.compilable import compilable
from twin.nc.canonical import Shape
from twin.nc.geometry import curves, lead_curves
from twin.nc.geometry.arcs import SAME_POINT, Point, distance
from twin.nc.geometry.curves import Curve
from twin.nc.geometry.planes import aim, point_of, vector_of
from twin.nc.path.compensation.contour import (
    CONTOUR,
    ELEMENT,
    ENDS_ON_ARC,
    FOLLOWING,
    INDIRECT,
    LEAD_IN_CUTS,
    LEAD_OUT_CUTS,
    LEADING_IN,
    LEADING_OUT,
    MAY_CUT,
    MOVED_ROWS,
    NARROW_NECK,
    OFF,
    OLDEST,
    PASSED,
    PLACED,
    SQUARE,
    STAGE,
    STARTED,
    WAITING,
    Contour,
    curve_of,
    plane_of,
    set_curve,
)
from twin.nc.path.compensation.gouge import gouges
from twin.nc.path.compensation.lookahead import (
    flush_lookahead,
    go_around,
    hold_events,
    hold_move,
    level_arc,
    stands,
    take_move,
)
from twin.nc.path.rows import Rows, copy, copy_rows

_ARC = int(Shape.ARC)


@compilable
def begin(contour: Contour, signed_offset: float, square: bool, indirect: bool) -> None:
    """Compensate from the next move on, in the plane that the contour has.

    Args:
        contour: Is made to wait for the move that leads in.
        signed_offset: The tool's radius, positive left of the contour [mm].
        square: Outside corners between lines are extended as far as 90°.
        indirect: Leads go around the contour's first and last point.
    """
    counts = contour.counts
    contour.signed_offset[0] = signed_offset
    counts[STAGE] = STARTED
    counts[WAITING] = counts[PLACED] = counts[PASSED] = counts[OLDEST] = 0
    counts[SQUARE] = 1 if square else 0
    counts[INDIRECT] = 1 if indirect else 0


@compilable
def end(row: int, events: int, contour: Contour, rows: Rows) -> int:
    """Let go of what is held, square to itself, and wait for the line that leads out.

    Args:
        row: The next row.
        events: How many were reported.
        contour: Compensation.
        rows: Where the moves go.

    Returns:
        The row after those, or ``NARROW_NECK`` with the contour untouched.
    """
    counts = contour.counts
    stage = counts[STAGE]
    if stage in (OFF, LEADING_OUT):
        return row
    after = row
    start = (float(contour.start[0]), float(contour.start[1]))
    if stage == LEADING_IN:
        lead = curve_of(contour.curves[CONTOUR])
        after = flush_lookahead(contour, lead, lead, lead[2], rows, row, events)
    elif stage == FOLLOWING:
        element = curve_of(contour.curves[ELEMENT])
        part = curves.cut(element, start, element[2])
        if gouges(contour, part, curves.box_of(part), curve_of(contour.curves[CONTOUR]), True):
            return NARROW_NECK
        after = flush_lookahead(contour, element, part, element[2], rows, row, events)
    counts[STAGE] = LEADING_OUT if stage == FOLLOWING else OFF
    counts[WAITING] = counts[PASSED] = counts[OLDEST] = counts[PLACED] = 0
    return after


@compilable
def _cuts(contour: Contour, lead: Curve, element: Curve) -> bool:
    """Whether a lead cuts into an element of the contour, and may not."""
    depth = lead_curves.depth_of(lead, element, abs(float(contour.signed_offset[0])))
    contour.measured[0] = depth
    return depth > 0.0 and contour.counts[MAY_CUT] == 0


@compilable
def take_lead(
    start: Point, end: Point, row: int, early: int, behind: int, contour: Contour, rows: Rows
) -> int:
    """Hold the straight move that leads in; the row that comes next."""
    take_move(contour, rows, row, early)
    if contour.counts[PLACED] == 0:
        copy(rows.positions[row, 0], contour.here)
    hold_move(contour, (False, start, end, (0.0, 0.0), 0.0), start)
    contour.counts[STAGE], contour.counts[MOVED_ROWS] = LEADING_IN, row
    hold_events(contour, rows, early, behind)
    return row


@compilable
def lead_in(
    curve: Curve,
    element: Curve,
    row: int,
    first_event: int,
    early: int,
    behind: int,
    contour: Contour,
    rows: Rows,
) -> int:
    """Lead in to the contour's first element, and hold that.

    Args:
        curve: The element.
        element: Its parallel.
        row: Its row.
        first_event: The block's first event.
        early: The first that comes behind the move.
        behind: The event after the block's last.
        contour: Holds the move that leads in.
        rows: The element's row is replaced by those that lead to it.

    Returns:
        The row after those, or ``LEAD_IN_CUTS`` with the contour untouched.
    """
    signed_offset = float(contour.signed_offset[0])
    start = (float(contour.start[0]), float(contour.start[1]))
    touch, turns, arc = element[1], False, curve
    if contour.counts[INDIRECT] != 0:
        turns, arc = lead_curves.way_around(start, element[1], curve[1], signed_offset)
        if turns:
            touch = arc[1]
    lead = (False, start, touch, (0.0, 0.0), 0.0)
    if _cuts(contour, lead, curve):
        return LEAD_IN_CUTS
    hold_events(contour, rows, first_event, early)
    take_move(contour, rows, row, early)
    after = flush_lookahead(contour, lead, lead, touch, rows, row, early)
    if turns:
        after = go_around(contour, arc, rows, after)
    hold_move(contour, curve, element[1])
    set_curve(contour.curves[ELEMENT], element)
    contour.counts[STAGE] = FOLLOWING
    hold_events(contour, rows, early, behind)
    return after


@compilable
def lead_out(row: int, early: int, behind: int, contour: Contour, rows: Rows) -> int:
    """The first line in the plane leads out; until then only the normal and other axes move.

    Args:
        row: The move's row, which is replaced.
        early: The first of the block's events that comes behind the move.
        behind: The event after its last.
        contour: Has ended.
        rows: Where the moves go.

    Returns:
        The row after the moves, or why not, with the contour untouched.
    """
    if rows.codes[row, 1] == _ARC:
        return ENDS_ON_ARC
    plane, position = plane_of(contour), rows.positions[row]
    stand = contour.position if row == 0 else rows.positions[row - 1, 1]
    here = point_of(plane, vector_of(stand))
    start, end = point_of(plane, vector_of(position[0])), point_of(plane, vector_of(position[1]))
    leads, turns, last = distance(start, end) >= SAME_POINT, False, row
    contour_end = curve_of(contour.curves[CONTOUR])
    arc = contour_end
    if leads and contour.counts[INDIRECT] != 0:
        side = -float(contour.signed_offset[0])
        turns, arc = lead_curves.way_around(end, here, contour_end[2], side)
    lead = (False, arc[1] if turns else here, end, (0.0, 0.0), 0.0)
    if leads and _cuts(contour, lead, contour_end):
        return LEAD_OUT_CUTS
    take_move(contour, rows, row, early)
    if turns:
        last = row + 1
        copy(rows.codes[row], rows.codes[last])
        copy(rows.values[row], rows.values[last])
        copy_rows(rows.positions[row], rows.positions[last])
        back = (True, here, arc[1], arc[3], -arc[4])
        level_arc(contour.latest, contour, back, stand, rows, row)
        stand = rows.positions[row, 1]
    copy(stand, rows.positions[last, 0])
    if leads:
        contour.counts[STAGE] = OFF
    else:
        level = rows.positions[last, 1]
        aim(plane, here, level)
    after = last if stands(rows.positions[last]) else last + 1
    contour.counts[MOVED_ROWS] = after
    for event in range(early, behind):
        rows.events[event, 0] = after
    return after
