"""What the compiled run knows of radius compensation in force, as columns: see ``Compensation``."""

from typing import NamedTuple

from twin.nc.canonical import FloatArray, IntArray

ACTIVE, WAITING, PASSED, OLDEST, SQUARE, LATEST, MOVED = range(7)
"""Places in the counts: compensation is in force; moves along the normal that wait for the end of
the held one; elements that were passed; the place of the oldest; square corners; what came last,
``NOTHING_YET``, ``MOVE`` or ``EVENT``; whether there was a move."""
COUNTS = 7
NOTHING_YET, MOVE, EVENT = range(3)
MOST_WAITING = 16
ROOM = MOST_WAITING + 4
"""Rows that a block may need."""
CONTOUR, ELEMENT = range(2)
"""Rows of the curves."""
CURVE = 8
"""Columns of a curve: whether it is an arc, start, end, centre, sweep."""
HAS_CONTOUR, LINE, BOX = 16, 17, 18
"""Columns of what was passed, behind its element and its contour."""
PASSED_COLUMNS = 22


class Row(NamedTuple):
    """One move, as in ``Rows``.

    Attributes:
        codes: Shape (5,).
        values: Shape (11,).
        positions: Shape (3, k).
    """

    codes: IntArray
    values: FloatArray
    positions: FloatArray


class Contour(NamedTuple):
    """Compensation while a move is held.

    Attributes:
        counts: Shape (``COUNTS``,).
        plane: Columns of abscissa, ordinate and normal, shape (3,).
        aside: The tool's radius, signed as the side of the contour, shape (1,) [mm].
        held: The move that waits for its successor, as programmed.
        latest: The last programmed move of the run.
        curves: The held move and its parallel in the plane, shape (2, ``CURVE``).
        start: Where its compensated path begins in the plane, shape (2,) [mm].
        here: Where the path has come to, shape (k,).
        waiting: The moves that wait, shape (``MOST_WAITING``, ...).
        rows_after: Row behind the held move and behind each that waits, shape (w + 1,).
        passed: Elements that were passed, a ring, shape (n, ``PASSED_COLUMNS``).
    """

    counts: IntArray
    plane: IntArray
    aside: FloatArray
    held: Row
    latest: Row
    curves: FloatArray
    start: FloatArray
    here: FloatArray
    waiting: Row
    rows_after: IntArray
    passed: FloatArray
