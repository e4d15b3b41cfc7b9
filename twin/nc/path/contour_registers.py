"""What the compiled run knows of radius compensation in force, as columns: see ``Compensation``."""

from typing import NamedTuple

from twin.nc.canonical import FloatArray, IntArray
from twin.nc.path.compensation_state import Stage

(
    STAGE,
    WAITING,
    PASSED,
    OLDEST,
    SQUARE,
    INDIRECT,
    PLACED,
    MOVED,
    MOVED_ROWS,
    MOVED_EVENTS,
    PLANE_NUMBER,
) = range(11)
"""Places in the counts: a ``compensation_state.Stage``; moves along the normal that wait for the end of the
held one; elements that were passed; the place of the oldest; square corners; indirect leads; it is
known where the path has come to; whether compensation was given a move in this run, the rows that
were there behind it, and the events before it; the number of the working plane."""
COUNTS = 11
OFF = int(Stage.OFF)
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
    """Radius compensation between two blocks.

    Attributes:
        counts: Shape (``COUNTS``,).
        plane: Abscissa, ordinate and normal in part coordinates, shape (3, 3).
        signed_offset: The tool's radius, signed as the side of the contour, shape (1,) [mm].
        lookahead: The move that waits for its successor, as programmed.
        latest: The last move that compensation was given in this run, as programmed.
        curves: The held move and its parallel in the plane, shape (2, ``CURVE``).
        start: Where its compensated path begins in the plane, shape (2,) [mm].
        here: Where the compensated path has come to, shape (k,).
        position: Where all of the path had come to when the run began, shape (k,).
        waiting: The moves that wait, shape (``MOST_WAITING``, ...).
        rows_after: Row behind the held move and behind each that waits, shape (w + 1,).
        gouge_history: Elements that were passed, a ring, shape (n, ``PASSED_COLUMNS``).
    """

    counts: IntArray
    plane: FloatArray
    signed_offset: FloatArray
    lookahead: Row
    latest: Row
    curves: FloatArray
    start: FloatArray
    here: FloatArray
    position: FloatArray
    waiting: Row
    rows_after: IntArray
    gouge_history: FloatArray
