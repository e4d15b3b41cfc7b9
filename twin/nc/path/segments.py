"""Geometry of single moves in space and in a plane: directions, plane elements, parts of moves."""

import dataclasses
import math
import re
from typing import NoReturn

from twin.nc.geometry import curves
from twin.nc.geometry.arcs import SAME_POINT, Point, distance
from twin.nc.geometry.curves import Curve
from twin.nc.geometry.matrices import applied, dot
from twin.nc.geometry.planes import Plane, Vector, cross
from twin.nc.path.move_columns import Segment
from twin.nc.text.diagnostics.reporter import Reporter

IN_PLANE = 1.0 - 1e-9
"""Cosine between an arc's normal and a plane's from which the arc lies in the plane."""


class MoveReport:
    """Diagnostics of moves: they point at the number of the block that asked for the move."""

    def __init__(self, report: Reporter) -> None:
        self._report = report

    def refuse(self, move: Segment, code: str, message: str) -> NoReturn:
        """Refuse a move."""
        self._report.line = move.line
        self._report.fail(code, message, *self._span_of(move))

    def warn(self, move: Segment, code: str, message: str) -> None:
        """Warn of a move."""
        line, self._report.line = self._report.line, move.line
        self._report.warn(code, message, *self._span_of(move))
        self._report.line = line

    def _span_of(self, move: Segment) -> tuple[int, int]:
        """Column and width of its block's number; without one of the line's first word."""
        text = self._report.text_of(move.line)
        number = rf"(?:N|^)[ \t/]*0*{move.block}(?![0-9])" if move.block >= 0 else r"\S+"
        match = re.search(number, text, re.IGNORECASE)
        return (0, 1) if match is None else (match.start(), len(match[0]))


def direction_of(move: Segment, *, at_end: bool) -> Vector:
    """Where a move is going at its start or its end; not of unit length, zero where X Y Z rest."""
    start, end = move.start, move.end
    x, y, z = (end[i] - start[i] for i in range(3))
    if move.center is None:
        return (x, y, z)
    point, center, normal = end if at_end else start, move.center, move.normal
    advance = x * normal[0] + y * normal[1] + z * normal[2]
    here = advance if at_end else 0.0
    arm = (
        point[0] - center[0] - here * normal[0],
        point[1] - center[1] - here * normal[1],
        point[2] - center[2] - here * normal[2],
    )
    turn, pitch = math.radians(move.sweep), cross(normal, arm)
    return (
        pitch[0] * turn + advance * normal[0],
        pitch[1] * turn + advance * normal[1],
        pitch[2] * turn + advance * normal[2],
    )


def spatial_length(move: Segment) -> float:
    """Length of a move in X, Y, Z [mm]."""
    if move.center is None:
        return math.dist(move.start[:3], move.end[:3])
    advance = sum((move.end[i] - move.start[i]) * move.normal[i] for i in range(3))
    return math.hypot(math.dist(move.start[:3], move.center) * math.radians(move.sweep), advance)


def element_of(move: Segment, plane: Plane) -> Curve | None:
    """A move as a plane sees it; None where it is no line or arc there, or has no length."""
    start, end = plane.point(move.start), plane.point(move.end)
    if move.center is None:
        return curves.line(start, end) if distance(start, end) >= SAME_POINT else None
    sense = dot(move.normal, plane.normal)
    if abs(sense) < IN_PLANE:
        return None
    return curves.arc(start, end, plane.point(move.center), move.sweep * sense)


def part_of(move: Segment, element: Curve, plane: Plane, first: float, last: float) -> Segment:
    """The part of a move between two shares of its element's path, 0 to 1; what else moves goes along."""
    start, end = (
        whole if share == exact else _at(move, plane, curves.point_at(element, share), share)
        for share, exact, whole in ((first, 0.0, move.start), (last, 1.0, move.end))
    )
    is_arc, _, _, center, sweep = element
    return dataclasses.replace(
        move,
        start=start,
        end=end,
        display=shown_at(move, end),
        center=plane.world(*center, plane.local(start).height) if is_arc else move.center,
        normal=plane.normal if is_arc else move.normal,
        sweep=sweep * (last - first),
    )


def _at(move: Segment, plane: Plane, point: Point, share: float) -> list[float]:
    whole = [a + share * (b - a) for a, b in zip(move.start, move.end, strict=True)]
    height = plane.local(move.start).height * (1.0 - share) + plane.local(move.end).height * share
    return [*plane.world(*point, height), *whole[3:]]


def shown_at(move: Segment, here: list[float]) -> list[float]:
    """What the screen shows where the move has not ended: as far from what it shows at its end as the axes are."""
    shown = [a + s - e for a, s, e in zip(here, move.display, move.end, strict=True)]
    if move.screen is not None:
        x, y, z = applied(
            move.screen, (here[0] - move.end[0], here[1] - move.end[1], here[2] - move.end[2])
        )
        shown[:3] = [move.display[0] + x, move.display[1] + y, move.display[2] + z]
    return shown


def line_between(move: Segment, start: list[float], end: list[float]) -> Segment:
    """A straight move with all else of another one."""
    return dataclasses.replace(
        move,
        start=start,
        end=end,
        display=shown_at(move, end),
        center=None,
        normal=(math.nan, math.nan, math.nan),
        sweep=0.0,
    )
