"""How radius compensation begins and ends, compiled: ``Compensation`` and ``lead_out`` where all is clear.

Warnings and refusals are left to them.
"""

from twin.compilation.compilable import compilable
from twin.nc.bytecode.registers import BAILOUT, PLANE, Constants, Rows, State
from twin.nc.canonical import Shape
from twin.nc.compiled.kernels.columns import copy, copy_rows
from twin.nc.compiled.kernels.frame import put_part_plane, transfer
from twin.nc.compiled.kernels.gouge import gouges
from twin.nc.compiled.kernels.lookahead import (
    curve_of,
    flush_lookahead,
    go_around,
    hold_events,
    hold_move,
    level_arc,
    set_curve,
    stands,
    take_move,
)
from twin.nc.compiled.kernels.plane import along_axis, place
from twin.nc.geometry import curves, lead_curves
from twin.nc.geometry.arcs import SAME_POINT, Point, distance
from twin.nc.geometry.curves import Curve
from twin.nc.path.compensation_state import Stage
from twin.nc.path.contour_registers import (
    CONTOUR,
    ELEMENT,
    INDIRECT,
    MOVED_ROWS,
    OLDEST,
    PASSED,
    PLACED,
    PLANE_NUMBER,
    SQUARE,
    STAGE,
    WAITING,
    Contour,
)

_OFF, _STARTED, _LEADING_IN = int(Stage.OFF), int(Stage.STARTED), int(Stage.LEADING_IN)
_FOLLOWING, _LEADING_OUT = int(Stage.FOLLOWING), int(Stage.LEADING_OUT)
_ARC = int(Shape.ARC)


@compilable
def begin_compensation(
    side: int, radius: float, constants: Constants, state: State, contour: Contour
) -> bool:
    """Compensate from the next move on: ``tool_compensation.compensate``; False where that refuses.

    Args:
        side: +1 left of the contour, -1 right of it.
        radius: Of the tool [mm].
        constants: What stays.
        state: Its plane, as the part sees it, is compensated.
        contour: Is made to wait for the move that leads in.
    """
    counts = contour.counts
    if counts[STAGE] != _OFF or not radius >= 0.0:
        return False
    if radius == 0.0:
        return True
    counts[PLANE_NUMBER] = int(state.modal[PLANE])
    put_part_plane(constants.planes[counts[PLANE_NUMBER]], state, contour.plane)
    contour.signed_offset[0] = side * transfer(state) * radius
    counts[STAGE], counts[PLACED], counts[PASSED], counts[OLDEST] = _STARTED, 0, 0, 0
    counts[SQUARE] = 1 if constants.square_corners else 0
    counts[INDIRECT] = 1 if constants.indirect_leads else 0
    return True


@compilable
def end_compensation(row: int, events: int, contour: Contour, rows: Rows) -> int:
    """Let go of what is held, square to itself, and wait for the line that leads out.

    Args:
        row: The next row.
        events: How many were reported.
        contour: Compensation.
        rows: Where the moves go.

    Returns:
        The row after those, or ``BAILOUT`` with the contour untouched.
    """
    counts = contour.counts
    stage = counts[STAGE]
    if stage in (_OFF, _LEADING_OUT):
        return row
    after = row
    begin = (contour.start[0], contour.start[1])
    if stage == _LEADING_IN:
        lead = curve_of(contour.curves[CONTOUR])
        after = flush_lookahead(contour, lead, lead, lead[2], rows, row, events)
    elif stage == _FOLLOWING:
        element = curve_of(contour.curves[ELEMENT])
        part = curves.cut(element, begin, element[2])
        if gouges(contour, part, curves.box_of(part), curve_of(contour.curves[CONTOUR])):
            return BAILOUT
        after = flush_lookahead(contour, element, part, element[2], rows, row, events)
    counts[STAGE] = _LEADING_OUT if stage == _FOLLOWING else _OFF
    counts[WAITING] = counts[PASSED] = counts[OLDEST] = counts[PLACED] = 0
    return after


@compilable
def take_lead(
    start: Point, end: Point, row: int, early: int, behind: int, contour: Contour, rows: Rows
) -> int:
    """Hold the straight move that leads in; the row that comes next."""
    take_move(contour, rows, row, early)
    if contour.counts[PLACED] == 0:
        copy(rows.positions[row, 0], contour.here)
    hold_move(contour, (False, start, end, (0.0, 0.0), 0.0), start)
    contour.counts[STAGE], contour.counts[MOVED_ROWS] = _LEADING_IN, row
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
        The row after those, or ``BAILOUT`` with the contour untouched.
    """
    signed_offset = contour.signed_offset[0]
    begin, touch, turns, arc = (contour.start[0], contour.start[1]), element[1], False, curve
    if contour.counts[INDIRECT] != 0:
        turns, arc = lead_curves.way_around(begin, element[1], curve[1], signed_offset)
        if turns:
            touch = arc[1]
    lead = (False, begin, touch, (0.0, 0.0), 0.0)
    if lead_curves.depth_of(lead, curve, abs(signed_offset)) > 0.0:
        return BAILOUT
    hold_events(contour, rows, first_event, early)
    take_move(contour, rows, row, early)
    after = flush_lookahead(contour, lead, lead, touch, rows, row, early)
    if turns:
        after = go_around(contour, arc, rows, after)
    hold_move(contour, curve, element[1])
    set_curve(contour.curves[ELEMENT], element)
    contour.counts[STAGE] = _FOLLOWING
    hold_events(contour, rows, early, behind)
    return after


@compilable
def lead_out(row: int, early: int, behind: int, contour: Contour, rows: Rows) -> int:
    """``lead_out.lead_out``, which waits for the first line in the plane.

    Args:
        row: The move's row, which is replaced.
        early: The first of the block's events that comes behind the move.
        behind: The event after its last.
        contour: Has ended.
        rows: Where the moves go.

    Returns:
        The row after the moves, or ``BAILOUT`` with the contour untouched.
    """
    if rows.codes[row, 1] == _ARC:
        return BAILOUT
    plane, position = contour.plane, rows.positions[row]
    stand = contour.position if row == 0 else rows.positions[row - 1, 1]
    here = (along_axis(stand, plane[0]), along_axis(stand, plane[1]))
    start = (along_axis(position[0], plane[0]), along_axis(position[0], plane[1]))
    end = (along_axis(position[1], plane[0]), along_axis(position[1], plane[1]))
    leads, turns, last = distance(start, end) >= SAME_POINT, False, row
    contour_end = curve_of(contour.curves[CONTOUR])
    arc = contour_end
    if leads and contour.counts[INDIRECT] != 0:
        turns, arc = lead_curves.way_around(end, here, contour_end[2], -contour.signed_offset[0])
    begin = arc[1] if turns else here
    lead = (False, begin, end, (0.0, 0.0), 0.0)
    if leads and lead_curves.depth_of(lead, contour_end, abs(contour.signed_offset[0])) > 0.0:
        return BAILOUT
    take_move(contour, rows, row, early)
    if turns:
        last = row + 1
        copy(rows.codes[row], rows.codes[last])
        copy(rows.values[row], rows.values[last])
        copy_rows(rows.positions[row], rows.positions[last])
        back = (True, here, arc[1], arc[3], -arc[4])
        level_arc(contour.latest, plane, back, stand, rows, row)
        stand = rows.positions[row, 1]
    copy(stand, rows.positions[last, 0])
    if leads:
        contour.counts[STAGE] = _OFF
    else:
        height = along_axis(rows.positions[last, 1], plane[2])
        place(plane, here, height, rows.positions[last, 1])
    after = last if stands(rows.positions[last]) else last + 1
    contour.counts[MOVED_ROWS] = after
    for event in range(early, behind):
        rows.events[event, 0] = after
    return after
