"""Radius compensation of one block after the other, compiled: ``Compensation`` where all is clear.

Each step is the one of ``Compensation`` between two moves of a contour, with the same functions of
``curves``. Beginnings, ends, warnings and refusals are left to it.
"""

import numpy as np
from numba.extending import register_jitable

from twin.nc import curves
from twin.nc.arcs import SAME_POINT, Point, distance
from twin.nc.canonical import Corner, FloatArray, Shape
from twin.nc.column_kernels import copy, copy_rows
from twin.nc.compensation import LARGEST_SQUARE, STRAIGHT_ON
from twin.nc.contour_state import (
    BOX,
    CONTOUR,
    CURVE,
    ELEMENT,
    EVENT,
    HAS_CONTOUR,
    LATEST,
    LINE,
    MOST_WAITING,
    MOVE,
    MOVED,
    OLDEST,
    PASSED,
    SQUARE,
    WAITING,
    Contour,
    Row,
)
from twin.nc.curves import Box, Curve
from twin.nc.kernel import kernel
from twin.nc.plain_state import Rows
from twin.nc.plane_kernels import along_axis, one, place

for _shared in (
    curves.radius_of,
    curves.length_of,
    curves.unit,
    curves.tangent_of,
    curves.scale_of,
    curves.leaves_room,
    curves.moved,
    curves.towards,
    curves.aside_of,
    curves.along,
    curves.within,
    curves.cut,
    curves.box_of,
    curves.turn_from,
    curves.half_chord,
    curves.line_line,
    curves.line_circle,
    curves.circle_circle,
    curves.meetings,
    curves.inside,
    curves.crossing_of,
):
    register_jitable(_shared)

DOUBTFUL = -1
_ARC = int(Shape.ARC)
_EXACT_PATH = int(Corner.EXACT_PATH)


@kernel
def hold_events(contour: Contour, rows: Rows, first: int, behind: int) -> None:
    """Events of the block, from ``first`` on, wait for the end of the held move."""
    for event in range(first, behind):
        rows.events[event, 0] = -1 - contour.counts[WAITING]
        contour.counts[LATEST] = EVENT


@kernel
def follow(row: int, made: int, first_event: int, behind: int, contour: Contour, rows: Rows) -> int:
    """Compensate what a block has made.

    Args:
        row: Its first row.
        made: The row after it.
        first_event: The block's first event.
        behind: The event after its last.
        contour: Compensation in force.
        rows: The block's row is replaced by those that it lets go.

    Returns:
        The row after those, or ``DOUBTFUL`` with the contour untouched.
    """
    if made - row > 1:
        return DOUBTFUL
    counts = contour.counts
    early = first_event
    while early < behind and rows.events[early, 0] == row:
        early += 1
    if made == row:
        hold_events(contour, rows, first_event, behind)
        return row
    plane, position = contour.plane, rows.positions[row]
    start = (along_axis(position[0], plane[0]), along_axis(position[0], plane[1]))
    end = (along_axis(position[1], plane[0]), along_axis(position[1], plane[1]))
    is_arc = rows.codes[row, 1] == _ARC
    if not is_arc and distance(start, end) < SAME_POINT:
        waiting = counts[WAITING]
        if waiting == MOST_WAITING:
            return DOUBTFUL
        hold_events(contour, rows, first_event, early)
        _keep(rows, row, contour.latest)
        copy(rows.codes[row], contour.waiting.codes[waiting])
        copy(rows.values[row], contour.waiting.values[waiting])
        copy_rows(position, contour.waiting.positions[waiting])
        counts[WAITING], counts[PASSED], counts[OLDEST] = waiting + 1, 0, 0
        counts[LATEST], counts[MOVED] = MOVE, 1
        hold_events(contour, rows, early, behind)
        return row
    value = rows.values[row]
    curve = (False, start, end, (0.0, 0.0), 0.0)
    if is_arc:
        center = (along_axis(value[:3], plane[0]), along_axis(value[:3], plane[1]))
        curve = (True, start, end, center, value[6])
    aside = contour.aside[0]
    if not curves.leaves_room(curve, aside):
        return DOUBTFUL
    element = curves.aside_of(curve, aside)
    held, before = _curve(contour.curves[CONTOUR]), _curve(contour.curves[ELEMENT])
    begin = (contour.start[0], contour.start[1])
    turn = curves.turn_from(held, curve)
    clear, rolls, at, follows = _corner(
        held, before, begin, curve, element, turn, aside, counts[SQUARE] != 0
    )
    if not clear:
        return DOUBTFUL
    part = curves.cut(before, begin, at)
    box = curves.box_of(part)
    corner = (True, before[2], element[1], curve[1], abs(turn) if aside < 0.0 else -abs(turn))
    if _crosses_passed(contour, part, box, 0):
        return DOUBTFUL
    if rolls:
        full = 1 if counts[PASSED] == len(contour.passed) else 0
        if curves.crossing_of(part, corner)[0] or _crosses_passed(
            contour, corner, curves.box_of(corner), full
        ):
            return DOUBTFUL
    hold_events(contour, rows, first_event, early)
    _keep(rows, row, contour.latest)
    after = _let_go(contour, before, part, at, rows, row, early)
    _pass(contour, part, box, held, True)
    if rolls:
        _roll(contour, corner, rows, after)
        after += 1
        _pass(contour, corner, curves.box_of(corner), held, False)
    copy(contour.latest.codes, contour.held.codes)
    copy(contour.latest.values, contour.held.values)
    copy_rows(contour.latest.positions, contour.held.positions)
    _set_curve(contour.curves[CONTOUR], curve)
    _set_curve(contour.curves[ELEMENT], element)
    contour.start[0], contour.start[1] = follows
    counts[WAITING], counts[LATEST], counts[MOVED] = 0, MOVE, 1
    hold_events(contour, rows, early, behind)
    return after


@kernel
def _keep(rows: Rows, row: int, kept: Row) -> None:
    copy(rows.codes[row], kept.codes)
    copy(rows.values[row], kept.values)
    copy_rows(rows.positions[row], kept.positions)


@kernel
def _curve(column: FloatArray) -> Curve:
    return (
        column[0] != 0.0,
        (column[1], column[2]),
        (column[3], column[4]),
        (column[5], column[6]),
        column[7],
    )


@kernel
def _set_curve(column: FloatArray, curve: Curve) -> None:
    column[0] = 1.0 if curve[0] else 0.0
    column[1], column[2] = curve[1]
    column[3], column[4] = curve[2]
    column[5], column[6] = curve[3]
    column[7] = curve[4]


@kernel
def _corner(
    held: Curve,
    before: Curve,
    begin: Point,
    curve: Curve,
    element: Curve,
    turn: float,
    aside: float,
    square: bool,
) -> tuple[bool, bool, Point, Point]:
    """Whether the corner is clear, is rolled around, where the held move ends, and the next begins."""
    if abs(turn) < STRAIGHT_ON:
        return (True, False, element[1], element[1])
    straight = not held[0] and not curve[0]
    if square and straight and turn * aside < 0.0 and abs(turn) <= LARGEST_SQUARE:
        count, meeting, _ = curves.meetings(before, element)
        return (count == 1, False, meeting, meeting)
    if turn * aside < 0.0 or abs(turn) > 180.0 - STRAIGHT_ON:
        return (True, True, before[2], element[1])
    count, first, second = curves.meetings(before, element)
    found, at, least = False, begin, np.inf
    from_start = curves.along(before, begin)
    for number in range(count):
        point = first if number == 0 else second
        share = curves.along(before, point)
        if (
            curves.within(before, share)
            and share >= from_start
            and curves.within(element, curves.along(element, point))
        ):
            far = distance(point, held[2])
            if not found or far < least:
                found, at, least = True, point, far
    return (found, False, at, at)


@kernel
def _crosses_passed(contour: Contour, element: Curve, box: Box, first: int) -> bool:
    """Whether an element crosses one that was passed, from the ``first`` on."""
    passed = contour.passed
    for number in range(first, contour.counts[PASSED]):
        older = passed[(contour.counts[OLDEST] + number) % len(passed)]
        if older[BOX] > box[2] or older[BOX + 2] < box[0]:
            continue
        if older[BOX + 1] > box[3] or older[BOX + 3] < box[1]:
            continue
        if curves.crossing_of(_curve(older[:CURVE]), element)[0]:
            return True
    return False


@kernel
def _pass(contour: Contour, element: Curve, box: Box, held: Curve, has_contour: bool) -> None:
    """Remember an element that was passed."""
    counts, passed = contour.counts, contour.passed
    if counts[PASSED] == len(passed):
        counts[OLDEST] = (counts[OLDEST] + 1) % len(passed)
        counts[PASSED] -= 1
    latest = passed[(counts[OLDEST] + counts[PASSED]) % len(passed)]
    counts[PASSED] += 1
    _set_curve(latest[:CURVE], element)
    _set_curve(latest[CURVE : 2 * CURVE], held)
    latest[HAS_CONTOUR] = 1.0 if has_contour else 0.0
    latest[LINE] = contour.held.codes[2]
    latest[BOX], latest[BOX + 1], latest[BOX + 2], latest[BOX + 3] = box


@kernel
def _let_go(
    contour: Contour, before: Curve, part: Curve, at: Point, rows: Rows, row: int, events: int
) -> int:
    """The held move up to a point, then what waits for its end; the row after them."""
    held, plane, counts = contour.held, contour.plane, contour.counts
    after = row
    for number in range(counts[WAITING] + 1):
        value, position = rows.values[after], rows.positions[after]
        if number == 0:
            copy(held.codes, rows.codes[after])
            copy(held.values, value)
            copy_rows(held.positions, position)
        else:
            waiting = contour.waiting
            copy(waiting.codes[number - 1], rows.codes[after])
            copy(waiting.values[number - 1], value)
            copy_rows(waiting.positions[number - 1], position)
        is_arc = number == 0 and before[0]
        if is_arc:
            place(plane, before[3], along_axis(position[0], plane[2]), value)
            for axis in range(3):
                value[3 + axis] = one(plane[2], axis)
            value[6] = part[4]
        place(plane, at, along_axis(position[1], plane[2]), position[1])
        copy(contour.here, position[0])
        stands = not is_arc
        for axis in range(len(contour.here)):
            stands = stands and position[0, axis] == position[1, axis]
            contour.here[axis] = position[1, axis]
        after += 0 if stands else 1
        contour.rows_after[number] = after
    event = events - 1
    while event >= 0 and rows.events[event, 0] < 0:
        rows.events[event, 0] = contour.rows_after[-1 - rows.events[event, 0]]
        event -= 1
    return after


@kernel
def _roll(contour: Contour, corner: Curve, rows: Rows, row: int) -> None:
    """Go around a corner where the path has come to."""
    held, plane = contour.held, contour.plane
    code, value, position = rows.codes[row], rows.values[row], rows.positions[row]
    copy(held.codes, code)
    code[1], code[4] = _ARC, _EXACT_PATH
    copy(held.values, value)
    height = along_axis(contour.here, plane[2])
    place(plane, corner[3], height, value)
    for axis in range(3):
        value[3 + axis] = one(plane[2], axis)
    value[6] = corner[4]
    copy(contour.here, position[0])
    copy(contour.here, position[1])
    place(plane, corner[2], height, position[1])
    for axis in range(len(contour.here)):
        shown, end = held.positions[2, axis], held.positions[1, axis]
        position[2, axis] = position[1, axis] + shown - end
        contour.here[axis] = position[1, axis]
