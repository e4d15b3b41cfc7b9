"""What radius compensation works on, as columns of one tuple that both tiers share."""

import enum
from typing import NamedTuple

import numpy as np

from twin.compilation.compilable import compilable
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.geometry.curves import Curve
from twin.nc.geometry.matrices import Matrix
from twin.nc.path.rows import Row


class Stage(enum.IntEnum):
    """What compensation waits for."""

    OFF = 0
    """For its beginning."""
    STARTED = 1
    """For the straight move that leads in."""
    LEADING_IN = 2
    """For the contour's first element; the move that leads in is held."""
    FOLLOWING = 3
    """For the contour's next element; the last one is held."""
    LEADING_OUT = 4
    """It has ended, and waits for the straight move that leads out."""


OFF, STARTED, LEADING_IN, FOLLOWING, LEADING_OUT = (int(stage) for stage in Stage)

(
    STAGE,
    WAITING,
    PASSED,
    OLDEST,
    SQUARE,
    INDIRECT,
    PLACED,
    MAY_CUT,
    MOVED,
    MOVED_ROWS,
    MOVED_EVENTS,
) = range(11)
"""Places in the counts: a ``Stage``; moves along the normal that wait for the end of the held one;
elements that were passed; the place of the oldest; square corners; indirect leads; it is known where
the path has come to; the next lead may cut into the contour; whether compensation was given a move in
this run, the rows that were there behind it, and the events before it."""
COUNTS = 11
WAITING_AT_FIRST = 16
"""Moves along the normal that may wait before more room is needed."""
MOST_LET_GO = 4
"""Rows that a block may need besides those that wait."""
NECK = 50
"""Elements of the contour that a new one is checked against: beyond them a neck goes unnoticed."""
_SPARE = 2
"""Elements that a block passes, which replace no other before it is known that they fit."""
CONTOUR, ELEMENT = range(2)
"""Rows of the curves."""
CURVE = 8
"""Columns of a curve: whether it is an arc, start, end, centre, sweep."""
HAS_CONTOUR, LINE, BOX = 16, 17, 18
"""Columns of what was passed, behind its element and its contour."""
PASSED_COLUMNS = 22

(
    SEVERAL_MOVES,
    NO_ROOM_TO_WAIT,
    BEGINS_ON_ARC,
    ENDS_ON_ARC,
    OUTSIDE_PLANE,
    SMALL_ARC,
    NARROW_CORNER,
    NARROW_NECK,
    LEAD_IN_CUTS,
    LEAD_OUT_CUTS,
) = range(-11, -21, -1)
"""Why a move is not followed, with the contour as it was before it."""


class Contour(NamedTuple):
    """Radius compensation between two blocks.

    Attributes:
        counts: Shape (``COUNTS``,).
        plane: Abscissa, ordinate and normal in part coordinates, shape (3, 3).
        signed_offset: The tool's radius, positive left of the contour, shape (1,) [mm].
        measured: What a refusal tells, shape (1,): the radius of a small arc, by how much a lead cuts
            into the contour [mm], the line of the element that leaves no room.
        lookahead: The move that waits for its successor, as programmed.
        latest: The last move that compensation was given in this run, as programmed.
        curves: The held move and its parallel in the plane, shape (2, ``CURVE``); while it leads out,
            the contour's last element.
        start: Where its compensated path begins in the plane, shape (2,) [mm].
        here: Where the compensated path has come to, shape (k,).
        position: Where all of the path had come to when the run began, shape (k,).
        waiting: The moves that wait, shape (w, ...).
        rows_after: Row behind the held move and behind each that waits, shape (w + 1,).
        gouge_history: Elements that were passed, a ring, shape (``NECK`` + 2, ``PASSED_COLUMNS``).
    """

    counts: IntArray
    plane: FloatArray
    signed_offset: FloatArray
    measured: FloatArray
    lookahead: Row
    latest: Row
    curves: FloatArray
    start: FloatArray
    here: FloatArray
    position: FloatArray
    waiting: Row
    rows_after: IntArray
    gouge_history: FloatArray


def new_contour(axes: int) -> Contour:
    """Columns for a machine with so many axes; no compensation is in force."""
    return Contour(
        counts=np.zeros(COUNTS, np.int64),
        plane=np.zeros((3, 3)),
        signed_offset=np.zeros(1),
        measured=np.zeros(1),
        lookahead=_row(axes),
        latest=_row(axes),
        curves=np.zeros((2, CURVE)),
        start=np.zeros(2),
        here=np.zeros(axes),
        position=np.zeros(axes),
        waiting=waiting_rows(WAITING_AT_FIRST, axes),
        rows_after=np.zeros(WAITING_AT_FIRST + 1, np.int64),
        gouge_history=np.zeros((NECK + _SPARE, PASSED_COLUMNS)),
    )


def waiting_rows(count: int, axes: int) -> Row:
    """Room for so many moves."""
    return Row(np.zeros((count, 5), np.int64), np.zeros((count, 11)), np.zeros((count, 3, axes)))


def with_more_room(contour: Contour) -> Contour:
    """A contour's copy with room for twice as many moves that wait."""
    count = len(contour.waiting.codes)
    waiting = waiting_rows(2 * count, len(contour.here))
    for small, large in zip(contour.waiting, waiting, strict=True):
        large[:count] = small
    return contour._replace(waiting=waiting, rows_after=np.zeros(2 * count + 1, np.int64))


def _row(axes: int) -> Row:
    return Row(np.zeros(5, np.int64), np.zeros(11), np.zeros((3, axes)))


@compilable
def plane_of(contour: Contour) -> Matrix:
    """Abscissa, ordinate and normal."""
    p = contour.plane
    return (
        (float(p[0, 0]), float(p[0, 1]), float(p[0, 2])),
        (float(p[1, 0]), float(p[1, 1]), float(p[1, 2])),
        (float(p[2, 0]), float(p[2, 1]), float(p[2, 2])),
    )


@compilable
def curve_of(column: FloatArray) -> Curve:
    """A curve that is kept as a column."""
    return (
        column[0] != 0.0,
        (float(column[1]), float(column[2])),
        (float(column[3]), float(column[4])),
        (float(column[5]), float(column[6])),
        float(column[7]),
    )


@compilable
def set_curve(column: FloatArray, curve: Curve) -> None:
    """Keep a curve."""
    column[0] = 1.0 if curve[0] else 0.0
    column[1], column[2] = curve[1]
    column[3], column[4] = curve[2]
    column[5], column[6] = curve[3]
    column[7] = curve[4]
