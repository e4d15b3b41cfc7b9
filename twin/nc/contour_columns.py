"""Radius compensation as the columns of the compiled run, and back."""

import dataclasses
import math

import numpy as np

from twin.nc.canonical import Corner, Event, Motion, Shape
from twin.nc.compensation import NECK, Followed, Passed
from twin.nc.contour import element_from
from twin.nc.contour_state import (
    ACTIVE,
    BOX,
    CONTOUR,
    COUNTS,
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
    PASSED_COLUMNS,
    SQUARE,
    WAITING,
    Contour,
    Row,
)
from twin.nc.curves import Curve
from twin.nc.move_columns import Segment


def new_contour(axes: int) -> Contour:
    """Columns for a machine with so many axes; no compensation is in force."""
    several = Row(
        np.zeros((MOST_WAITING, 5), np.int64),
        np.zeros((MOST_WAITING, 11)),
        np.zeros((MOST_WAITING, 3, axes)),
    )
    return Contour(
        counts=np.zeros(COUNTS, np.int64),
        plane=np.zeros(3, np.int64),
        aside=np.zeros(1),
        held=_empty_row(axes),
        latest=_empty_row(axes),
        curves=np.zeros((2, CURVE)),
        start=np.zeros(2),
        here=np.zeros(axes),
        waiting=several,
        rows_after=np.zeros(MOST_WAITING + 1, np.int64),
        passed=np.zeros((NECK, PASSED_COLUMNS)),
    )


def _empty_row(axes: int) -> Row:
    return Row(np.zeros(5, np.int64), np.zeros(11), np.zeros((3, axes)))


def fill(contour: Contour, followed: Followed | None, plane: tuple[int, int, int]) -> None:
    """Give the columns how far a contour has come; None: there is none."""
    contour.counts[:] = 0
    if followed is None:
        return
    contour.counts[ACTIVE], contour.counts[SQUARE] = 1, int(followed.square)
    contour.plane[:], contour.aside[0] = plane, followed.aside
    _fill_row(contour.held, followed.move)
    contour.curves[CONTOUR] = _column(followed.contour.curve)
    contour.curves[ELEMENT] = _column(followed.element.curve)
    contour.start[:], contour.here[:] = followed.start, followed.here
    contour.counts[PASSED] = len(followed.passed)
    for row, each in zip(contour.passed, followed.passed, strict=False):
        row[:CURVE] = _column(each.element.curve)
        row[HAS_CONTOUR] = each.contour is not None
        if each.contour is not None:
            row[CURVE : 2 * CURVE] = _column(each.contour.curve)
        row[LINE], row[BOX:] = each.line, each.box


@dataclasses.dataclass(frozen=True, slots=True)
class Gone:
    """What a run has made of a contour.

    Attributes:
        followed: How far it has come.
        waiting: Moves and events at the end of the held move, in order.
        latest: The last programmed move, or None where there was none.
        before: The same, unless an event came behind it.
        came: Something came at all.
    """

    followed: Followed
    waiting: list[Segment | Event]
    latest: Segment | None
    before: Segment | None
    came: bool


def gone(contour: Contour, followed: Followed, held_back: list[Event]) -> Gone:
    """Read the columns; ``held_back``: events whose place is not known yet."""
    counts = contour.counts
    waiting: list[Segment | Event] = []
    for number in range(counts[WAITING] + 1):
        waiting += [
            dataclasses.replace(each, before=0) for each in held_back if each.before == -1 - number
        ]
        if number < counts[WAITING]:
            waiting.append(segment(Row(*(column[number] for column in contour.waiting))))
    passed: list[Passed] = []
    for number in range(counts[PASSED]):
        row = contour.passed[(counts[OLDEST] + number) % NECK]
        around = element_from(_tuple(row[CURVE : 2 * CURVE])) if row[HAS_CONTOUR] else None
        left, low, right, high = row[BOX:].tolist()
        element = element_from(_tuple(row[:CURVE]))
        passed.append(Passed(element, around, int(row[LINE]), (left, low, right, high)))
    latest = segment(contour.latest) if counts[MOVED] else None
    x, y = contour.start.tolist()
    return Gone(
        dataclasses.replace(
            followed,
            move=segment(contour.held),
            contour=element_from(_tuple(contour.curves[CONTOUR])),
            element=element_from(_tuple(contour.curves[ELEMENT])),
            start=(x, y),
            here=contour.here.tolist(),
            passed=passed,
        ),
        waiting,
        latest,
        latest if counts[LATEST] == MOVE else None,
        counts[LATEST] in (MOVE, EVENT),
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
