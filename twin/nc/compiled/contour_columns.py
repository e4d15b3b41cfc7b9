"""Radius compensation as the columns of the compiled run, and back."""

import dataclasses
import math

import numpy as np

from twin.nc.canonical import Corner, Event, Motion, Shape
from twin.nc.geometry.curves import Curve
from twin.nc.geometry.elements import element_from
from twin.nc.geometry.planes import PLANE_NAMES, Plane
from twin.nc.path.compensation_state import (
    NECK,
    CompensationResult,
    CompensationState,
    PassedElement,
    Stage,
)
from twin.nc.path.contour_registers import (
    BOX,
    CONTOUR,
    COUNTS,
    CURVE,
    ELEMENT,
    HAS_CONTOUR,
    INDIRECT,
    LINE,
    MOST_WAITING,
    MOVED,
    MOVED_EVENTS,
    MOVED_ROWS,
    OLDEST,
    PASSED,
    PASSED_COLUMNS,
    PLACED,
    PLANE_NUMBER,
    SQUARE,
    STAGE,
    WAITING,
    Contour,
    Row,
)
from twin.nc.path.event_columns import EventRows
from twin.nc.path.move_columns import Segment


def new_contour(axes: int) -> Contour:
    """Columns for a machine with so many axes; no compensation is in force."""
    several = Row(
        np.zeros((MOST_WAITING, 5), np.int64),
        np.zeros((MOST_WAITING, 11)),
        np.zeros((MOST_WAITING, 3, axes)),
    )
    return Contour(
        counts=np.zeros(COUNTS, np.int64),
        plane=np.zeros((3, 3)),
        signed_offset=np.zeros(1),
        lookahead=_empty_row(axes),
        latest=_empty_row(axes),
        curves=np.zeros((2, CURVE)),
        start=np.zeros(2),
        here=np.zeros(axes),
        position=np.zeros(axes),
        waiting=several,
        rows_after=np.zeros(MOST_WAITING + 1, np.int64),
        gouge_history=np.zeros((NECK, PASSED_COLUMNS)),
    )


def _empty_row(axes: int) -> Row:
    return Row(np.zeros(5, np.int64), np.zeros(11), np.zeros((3, axes)))


def fill(contour: Contour, state: CompensationState | None, position: list[float]) -> None:
    """Give the columns how far compensation has come, and where the path has come to."""
    counts = contour.counts
    counts[:] = 0
    contour.position[:] = position
    if state is None:
        return
    counts[STAGE], counts[SQUARE] = state.stage, state.square
    counts[INDIRECT], counts[PLACED] = state.indirect, bool(state.here)
    counts[PLANE_NUMBER] = PLANE_NAMES.index(state.plane.name)
    contour.plane[:], contour.signed_offset[0] = state.plane.directions, state.signed_offset
    if state.move is not None:
        _fill_row(contour.lookahead, state.move)
        contour.here[:] = state.move.start
    if state.here:
        contour.here[:] = state.here
    for place, element in ((CONTOUR, state.contour), (ELEMENT, state.element)):
        if element is not None:
            contour.curves[place] = _column(element.curve)
    contour.start[:] = state.start
    counts[PASSED] = len(state.gouge_history)
    for row, each in zip(contour.gouge_history, state.gouge_history, strict=False):
        row[:CURVE] = _column(each.element.curve)
        row[HAS_CONTOUR] = each.contour is not None
        if each.contour is not None:
            row[CURVE : 2 * CURVE] = _column(each.contour.curve)
        row[LINE], row[BOX:] = each.line, each.box


def result_of(
    contour: Contour, moves: Row, events: EventRows
) -> tuple[CompensationResult, EventRows]:
    """Read the columns.

    Args:
        contour: The columns.
        moves: Those that were emitted, as columns.
        events: All that were reported.

    Returns:
        What was made, and the events whose place is known.
    """
    counts = contour.counts
    made, event_count = len(moves.codes), len(events)
    placed = int((events.before >= 0).sum())
    latest = segment(contour.latest) if counts[MOVED] else None
    event_behind = event_count > counts[MOVED_EVENTS]
    if made > counts[MOVED_ROWS]:
        latest = segment(Row(*(column[-1] for column in moves)))
        event_behind = placed > 0 and events.before[placed - 1] == made
    before = None if event_behind else latest
    held_back = list(events.part(placed, event_count))
    waiting = _waiting(contour, held_back)
    came = latest is not None or event_count > 0
    return CompensationResult(_state_of(contour), waiting, latest, before, came), events.part(
        0, placed
    )


def _waiting(contour: Contour, held_back: list[Event]) -> list[Segment | Event]:
    waiting: list[Segment | Event] = []
    for number in range(contour.counts[WAITING] + 1):
        waiting += [
            dataclasses.replace(each, before=0) for each in held_back if each.before == -1 - number
        ]
        if number < contour.counts[WAITING]:
            waiting.append(segment(Row(*(column[number] for column in contour.waiting))))
    return waiting


def _state_of(contour: Contour) -> CompensationState | None:
    counts = contour.counts
    stage = Stage(int(counts[STAGE]))
    if stage is Stage.OFF:
        return None
    held = stage in (Stage.LEADING_IN, Stage.FOLLOWING)
    x, y = contour.start.tolist()
    abscissa, ordinate, normal = contour.plane.tolist()
    name = PLANE_NAMES[counts[PLANE_NUMBER]]
    return CompensationState(
        stage,
        Plane(name, (*abscissa,), (*ordinate,), (*normal,)),
        float(contour.signed_offset[0]),
        bool(counts[SQUARE]),
        bool(counts[INDIRECT]),
        segment(contour.lookahead) if held else None,
        None if stage is Stage.STARTED else element_from(_tuple(contour.curves[CONTOUR])),
        element_from(_tuple(contour.curves[ELEMENT])) if stage is Stage.FOLLOWING else None,
        (x, y),
        contour.here.tolist() if counts[PLACED] else [],
        [_passed(contour, number) for number in range(counts[PASSED])],
    )


def _passed(contour: Contour, number: int) -> PassedElement:
    row = contour.gouge_history[(contour.counts[OLDEST] + number) % NECK]
    around = element_from(_tuple(row[CURVE : 2 * CURVE])) if row[HAS_CONTOUR] else None
    left, low, right, high = row[BOX:].tolist()
    return PassedElement(
        element_from(_tuple(row[:CURVE])), around, int(row[LINE]), (left, low, right, high)
    )


def segment(row: Row) -> Segment:
    """A row of the run as the control keeps it."""
    motion, _, line, block, corner = row.codes.tolist()
    *center_and_normal, sweep, feed, tolerance, acceleration, deceleration = row.values.tolist()
    start, end, display = row.positions.tolist()
    a, b, c, i, j, k = center_and_normal
    return Segment(
        motion=Motion(motion),
        line=line,
        block=block,
        start=start,
        end=end,
        display=display,
        feed=feed,
        corner=Corner(corner),
        corner_tolerance=tolerance,
        acceleration=acceleration,
        deceleration=deceleration,
        center=None if math.isnan(a) else (a, b, c),
        normal=(i, j, k),
        sweep=sweep,
    )


def _fill_row(row: Row, move: Segment) -> None:
    shape = Shape.LINE if move.center is None else Shape.ARC
    row.codes[:] = (move.motion, shape, move.line, move.block, move.corner)
    row.values[:3] = math.nan if move.center is None else move.center
    row.values[3:6] = move.normal
    row.values[6:] = (
        move.sweep,
        move.feed,
        move.corner_tolerance,
        move.acceleration,
        move.deceleration,
    )
    row.positions[:] = (move.start, move.end, move.display)


def _column(curve: Curve) -> list[float]:
    is_arc, start, end, center, sweep = curve
    return [float(is_arc), *start, *end, *center, sweep]


def _tuple(column: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> Curve:
    is_arc, a, b, c, d, e, f, sweep = column.tolist()
    return (bool(is_arc), (a, b), (c, d), (e, f), sweep)
