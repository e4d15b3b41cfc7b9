"""Where the paths of the tool's centre beside two moves of a contour meet, as ``rs274`` computes it."""

import math
from typing import NamedTuple

from twin.nc.geometry.arcs import Point, distance, sweep_between

QUARTER = math.pi / 2.0
"""A quarter of a turn [rad]."""


class OffsetArc(NamedTuple):
    """The path of the tool's centre beside an arc.

    Attributes:
        center: Of both [mm].
        radius: Of the tool's path [mm].
        inside: The tool runs on the inner side of the arc.
    """

    center: Point
    radius: float
    inside: bool
    counter_clockwise: bool


def arc_meets_line(arc: OffsetArc, tool: float, start: Point, heading: float) -> Point:
    """Where a line begins beside the one that leaves the arc's end.

    Args:
        arc: That comes first.
        tool: Its radius [mm].
        start: Where the contour's line begins [mm].
        heading: Its direction [rad].

    Raises:
        ValueError: The tool does not fit into their corner.
    """
    across = heading + (QUARTER if arc.counter_clockwise else -QUARTER)
    inward = math.atan2(arc.center[1] - start[1], arc.center[0] - start[0])
    uncompensated = arc.radius + tool if arc.inside else arc.radius - tool
    away = uncompensated * math.cos(across - inward)
    share = (away - tool if arc.inside else away + tool) / arc.radius
    if abs(share) > 1.0:
        raise ValueError("arc and line make a corner that the tool does not fit into")
    angle = math.acos(share) * (-1.0 if arc.counter_clockwise == arc.inside else 1.0)
    return along(arc.center, angle + across + math.pi, arc.radius)


def line_meets_arc(
    before: float, turn: float, arc: OffsetArc, tool: float, contour_radius: float
) -> Point:
    """Where an arc begins beside the one that a line leads to.

    Args:
        before: Direction of the line [rad].
        turn: How far the contour turns at their corner [rad].
        tool: Its radius [mm].
        contour_radius: Of the contour's arc [mm].

    Raises:
        ValueError: The tool does not fit into their corner.
    """
    nominal = contour_radius * math.sin(turn - QUARTER)
    share = (nominal + tool if arc.inside else nominal - tool) / arc.radius
    if abs(share) > 1.0:
        raise ValueError("line and arc make a corner that the tool does not fit into")
    angle = math.asin(share)
    if arc.inside:
        turned = before + (angle if arc.counter_clockwise else -angle)
    else:
        turned = before + math.pi + (-angle if arc.counter_clockwise else angle)
    return along(arc.center, turned, arc.radius)


def arc_meets_arc(first: OffsetArc, second: OffsetArc) -> Point:
    """Where the second of two arcs begins.

    Raises:
        ValueError: They have one centre, or the tool does not fit into their corner.
    """
    old, apart = first.radius, distance(first.center, second.center)
    if old == 0.0 or apart == 0.0:
        raise ValueError("two arcs with the same centre follow each other")
    share = (old * old + apart * apart - second.radius * second.radius) / (2.0 * old * apart)
    if abs(share) > 1.0:
        raise ValueError("two arcs make a corner that the tool does not fit into")
    x, y = second.center
    towards = math.atan2(y - first.center[1], x - first.center[0])
    back = math.acos(share)
    if first.inside != second.counter_clockwise:
        back = -back
    return along(first.center, towards + back, old)


def along(point: Point, angle: float, length: float) -> Point:
    """A point further on in a direction [rad]."""
    return point[0] + length * math.cos(angle), point[1] + length * math.sin(angle)


def swept_angle(start: Point, end: Point, center: Point, turns: int) -> float:
    """How far an arc goes around, all turns counted; ``turns`` below 0: clockwise [rad]."""
    angle = math.radians(sweep_between(start, end, center, clockwise=turns < 0))
    return angle + 2.0 * math.pi * (turns + 1 if turns < 0 else turns - 1)
