"""Moves beside a contour: what compensation drives for a programmed move."""

from twin.nc.canonical import Corner
from twin.nc.geometry import curves
from twin.nc.geometry.biarcs import spiral
from twin.nc.geometry.curves import Curve
from twin.nc.geometry.planes import (
    Directions,
    Vector,
    aim,
    along,
    point_of,
    put_point,
    vector_of,
    world,
)
from twin.nc.path.move_columns import Segment
from twin.nc.path.segments import shown_at


def arc_moves(
    move: Segment, plane: Directions, part: Curve, start: list[float], end: list[float]
) -> list[Segment]:
    """An arc of the parallel from a position to another, as a move goes; a spiral where these differ in their radius."""
    begin, at = point_of(plane, vector_of(start)), point_of(plane, vector_of(end))
    pieces = spiral(begin, at, part[3], part[4])
    length = sum(map(curves.length_of, pieces))
    made: list[Segment] = []
    passed, here = 0.0, start
    for number, piece in enumerate(pieces, 1):
        passed += curves.length_of(piece)
        there = end
        if number < len(pieces):
            share = passed / length
            there = [a + share * (b - a) for a, b in zip(start, end, strict=True)]
            aim(plane, piece[2], there)
        height = along(vector_of(here), plane[2])
        center = world(plane, piece[3], height) if piece[0] else None
        made.append(driven(move, here, there, center, plane[2], piece[4]))
        if number < len(pieces):
            made[-1].corner = Corner.EXACT_PATH
        here = there
    return made


def level_arc(move: Segment, plane: Directions, arc: Curve, start: list[float]) -> Segment:
    """An arc at one height with all else of a move; further axes stand still."""
    end = list(start)
    height = along(vector_of(start), plane[2])
    put_point(plane, arc[2], height, end)
    return driven(move, start, end, world(plane, arc[3], height), plane[2], arc[4])


def driven(
    move: Segment,
    start: list[float],
    end: list[float],
    center: Vector | None,
    normal: Vector,
    sweep: float,
) -> Segment:
    """A move elsewhere, with all else of another; the screen shows where it ends, which is the tool centre."""
    return Segment(
        move.motion,
        move.line,
        move.block,
        start,
        end,
        shown_at(move, end),
        move.feed,
        move.corner,
        move.corner_tolerance,
        move.acceleration,
        move.deceleration,
        center,
        normal,
        sweep,
        None,
        move.screen,
    )
