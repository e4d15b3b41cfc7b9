"""The move that compensation holds: kept until its successor is known, let go, gone around."""

from twin.compilation.compilable import compilable
from twin.nc.canonical import Corner, FloatArray, Shape
from twin.nc.geometry.arcs import Point
from twin.nc.geometry.curves import Curve
from twin.nc.geometry.planes import aim, along, put_point, vector_of
from twin.nc.path.compensation.contour import (
    CONTOUR,
    FOLLOWING,
    LEADING_IN,
    MOVED,
    MOVED_EVENTS,
    MOVED_ROWS,
    PLACED,
    STAGE,
    WAITING,
    Contour,
    plane_of,
    set_curve,
)
from twin.nc.path.rows import Row, Rows, copy, copy_rows

_ARC = int(Shape.ARC)
_EXACT_PATH = int(Corner.EXACT_PATH)


@compilable
def hold_events(contour: Contour, rows: Rows, first: int, behind: int) -> None:
    """Events of the block, from ``first`` on, wait for the end of the held move, if there is one."""
    if contour.counts[STAGE] not in (LEADING_IN, FOLLOWING):
        return
    for event in range(first, behind):
        rows.events[event, 0] = -1 - contour.counts[WAITING]


@compilable
def take_move(contour: Contour, rows: Rows, row: int, events: int) -> None:
    """A row is the last move that compensation was given; so many events came before."""
    copy(rows.codes[row], contour.latest.codes)
    copy(rows.values[row], contour.latest.values)
    copy_rows(rows.positions[row], contour.latest.positions)
    contour.counts[MOVED], contour.counts[MOVED_EVENTS] = 1, events


@compilable
def hold_move(contour: Contour, curve: Curve, start: Point) -> None:
    """Hold the last move until its successor is known; its compensated path begins at a point."""
    copy(contour.latest.codes, contour.lookahead.codes)
    copy(contour.latest.values, contour.lookahead.values)
    copy_rows(contour.latest.positions, contour.lookahead.positions)
    set_curve(contour.curves[CONTOUR], curve)
    contour.start[0], contour.start[1] = start
    contour.counts[WAITING] = 0


@compilable
def flush_lookahead(
    contour: Contour, before: Curve, part: Curve, at: Point, rows: Rows, row: int, events: int
) -> int:
    """The held move up to a point, then what waits for its end; the row after them."""
    held, plane, counts = contour.lookahead, plane_of(contour), contour.counts
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
            put_point(plane, before[3], along(vector_of(position[0]), plane[2]), value)
            value[3], value[4], value[5] = plane[2]
            value[6] = part[4]
        aim(plane, at, position[1])
        copy(contour.here, position[0])
        copy(position[1], contour.here)
        after += 0 if not is_arc and stands(position) else 1
        contour.rows_after[number] = after
    event = events - 1
    while event >= 0 and rows.events[event, 0] < 0:
        rows.events[event, 0] = contour.rows_after[-1 - rows.events[event, 0]]
        event -= 1
    counts[PLACED], counts[MOVED_ROWS] = 1, after
    return after


@compilable
def stands(position: FloatArray) -> bool:
    """Whether a straight move with these positions goes nowhere."""
    still = True
    for axis in range(position.shape[1]):
        still = still and position[0, axis] == position[1, axis]
    return still


@compilable
def level_arc(
    move: Row, contour: Contour, arc: Curve, start: FloatArray, rows: Rows, row: int
) -> None:
    """Write an arc at one height with all else of a move; further axes stand still.

    Args:
        move: Whose line, feed and the like it takes.
        contour: Its plane is that of the arc.
        arc: In the plane.
        start: Where it begins, shape (k,).
        rows: Where it is written.
        row: Its row.
    """
    code, value, position = rows.codes[row], rows.values[row], rows.positions[row]
    copy(move.codes, code)
    copy(move.values, value)
    code[1] = _ARC
    plane = plane_of(contour)
    height = along(vector_of(start), plane[2])
    put_point(plane, arc[3], height, value)
    value[3], value[4], value[5] = plane[2]
    value[6] = arc[4]
    copy(start, position[0])
    copy(start, position[1])
    put_point(plane, arc[2], height, position[1])
    for axis in range(len(start)):
        shown, end = move.positions[2, axis], move.positions[1, axis]
        position[2, axis] = position[1, axis] + shown - end


@compilable
def go_around(contour: Contour, corner: Curve, rows: Rows, row: int) -> int:
    """Go around a corner where the path has come to; the row after it."""
    level_arc(contour.lookahead, contour, corner, contour.here, rows, row)
    rows.codes[row, 4] = _EXACT_PATH
    copy(rows.positions[row, 1], contour.here)
    contour.counts[MOVED_ROWS] = row + 1
    return row + 1
