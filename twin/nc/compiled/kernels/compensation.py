"""Radius compensation of one block after the other, compiled: ``Compensation`` where all is clear.

Each step is the one of ``Compensation`` between two moves of a contour, with the same functions of
``curves``. Warnings and refusals are left to it.
"""

from twin.compilation.compilable import compilable
from twin.nc.bytecode.registers import BAILOUT, Rows
from twin.nc.canonical import Shape
from twin.nc.compiled.kernels.columns import copy, copy_rows
from twin.nc.compiled.kernels.gouge import crosses_passed, gouges, pass_by
from twin.nc.compiled.kernels.leads import lead_in, lead_out, take_lead
from twin.nc.compiled.kernels.lookahead import (
    curve_of,
    flush_lookahead,
    go_around,
    hold_events,
    hold_move,
    set_curve,
    take_move,
)
from twin.nc.compiled.kernels.plane import along_axis
from twin.nc.geometry import curves
from twin.nc.geometry.arcs import SAME_POINT, distance
from twin.nc.geometry.corners import corner_of
from twin.nc.geometry.curves import Curve
from twin.nc.geometry.matrices import dot
from twin.nc.path.compensation_state import Stage
from twin.nc.path.contour_registers import (
    CONTOUR,
    ELEMENT,
    MOST_WAITING,
    MOVED_ROWS,
    OLDEST,
    PASSED,
    PLACED,
    SQUARE,
    STAGE,
    WAITING,
    Contour,
)
from twin.nc.path.segments import IN_PLANE

_STARTED, _LEADING_IN, _LEADING_OUT = (
    int(Stage.STARTED),
    int(Stage.LEADING_IN),
    int(Stage.LEADING_OUT),
)
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
        The row after those, or ``BAILOUT`` with the contour untouched.
    """
    if made - row > 1:
        return BAILOUT
    if made == row:
        hold_events(contour, rows, first_event, behind)
        return row
    stage, early = contour.counts[STAGE], first_event
    while early < behind and rows.events[early, 0] == row:
        early += 1
    if stage == _LEADING_OUT:
        return lead_out(row, early, behind, contour, rows)
    plane, position = contour.plane, rows.positions[row]
    start = (along_axis(position[0], plane[0]), along_axis(position[0], plane[1]))
    end = (along_axis(position[1], plane[0]), along_axis(position[1], plane[1]))
    is_arc = rows.codes[row, 1] == _ARC
    if not is_arc and distance(start, end) < SAME_POINT:
        return _along_normal(row, first_event, early, behind, contour, rows)
    if stage == _STARTED:
        if is_arc:
            return BAILOUT
        return take_lead(start, end, row, early, behind, contour, rows)
    curve = (False, start, end, (0.0, 0.0), 0.0)
    if is_arc:
        value = rows.values[row]
        center = (along_axis(value[:3], plane[0]), along_axis(value[:3], plane[1]))
        sense = dot((value[3], value[4], value[5]), (plane[2, 0], plane[2, 1], plane[2, 2]))
        if sense < IN_PLANE:
            return BAILOUT
        curve = (True, start, end, center, value[6] * sense)
    signed_offset = contour.signed_offset[0]
    if not curves.leaves_room(curve, signed_offset):
        return BAILOUT
    element = curves.parallel_of(curve, signed_offset)
    if stage == _LEADING_IN:
        return lead_in(curve, element, row, first_event, early, behind, contour, rows)
    return _go_on(curve, element, row, first_event, early, behind, contour, rows)


@compilable
def _along_normal(
    row: int, first_event: int, early: int, behind: int, contour: Contour, rows: Rows
) -> int:
    """A move that does not go in the plane: at once before the lead-in, else behind the held move."""
    counts = contour.counts
    waiting = counts[WAITING]
    if counts[STAGE] == _STARTED:
        take_move(contour, rows, row, early)
        copy(rows.positions[row, 1], contour.here)
        counts[PLACED], counts[MOVED_ROWS] = 1, row + 1
        return row + 1
    if waiting == MOST_WAITING:
        return BAILOUT
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
    counts, signed_offset = contour.counts, contour.signed_offset[0]
    held, before = curve_of(contour.curves[CONTOUR]), curve_of(contour.curves[ELEMENT])
    begin = (contour.start[0], contour.start[1])
    turn = curves.turn_from(held, curve)
    clear, rolls, at, follows = corner_of(
        (held, before, begin), (curve, element), turn, signed_offset, counts[SQUARE] != 0
    )
    if not clear:
        return BAILOUT
    part = curves.cut(before, begin, at)
    box = curves.box_of(part)
    corner = (
        True,
        before[2],
        element[1],
        curve[1],
        abs(turn) if signed_offset < 0.0 else -abs(turn),
    )
    if gouges(contour, part, box, held):
        return BAILOUT
    if rolls:
        full = 1 if counts[PASSED] == len(contour.gouge_history) else 0
        if curves.crossing_of(part, corner)[0] or crosses_passed(
            contour, corner, curves.box_of(corner), full
        ):
            return BAILOUT
    hold_events(contour, rows, first_event, early)
    take_move(contour, rows, row, early)
    after = flush_lookahead(contour, before, part, at, rows, row, early)
    pass_by(contour, part, box, held, True)
    if rolls:
        after = go_around(contour, corner, rows, after)
        pass_by(contour, corner, curves.box_of(corner), held, False)
    hold_move(contour, curve, follows)
    set_curve(contour.curves[ELEMENT], element)
    hold_events(contour, rows, early, behind)
    return after
