"""How the parallel of a contour passes its corners, and the paths to and from it: plain functions over tuples."""

import math

from twin.nc.geometry import arcs, curves
from twin.nc.geometry.arcs import Point, distance
from twin.nc.geometry.curves import Curve

LARGEST_SQUARE = 90.0 + 1e-9
"""Square corners are extended up to this turn, beyond it rolled around [deg]."""

STRAIGHT_ON = 1e-4
"""Corners that turn by less pass as straight on [deg]."""

Before = tuple[Curve, Curve, Point]
"""An element of the contour, its parallel, and where the path on that parallel begins."""
Behind = tuple[Curve, Curve]
"""The contour's next element and its parallel."""
Passage = tuple[bool, bool, Point, Point]
"""Whether the tool fits, whether it rolls around the corner, where the path on the first parallel
ends, and where that on the next begins."""


def corner_of(
    before: Before, behind: Behind, turn: float, signed_offset: float, square: bool
) -> Passage:
    """How a tool passes the corner between two elements of a contour; turn and offset are positive to the left [deg, mm]."""
    contour, parallel, _begin = before
    following, beside = behind
    if abs(turn) < STRAIGHT_ON:
        return (True, False, beside[1], beside[1])
    outside, straight = turn * signed_offset < 0.0, not contour[0] and not following[0]
    if square and straight and outside and abs(turn) <= LARGEST_SQUARE:
        count, meeting, _ = curves.meetings(parallel, beside)
        return (count == 1, False, meeting, meeting)
    if outside or abs(turn) > 180.0 - STRAIGHT_ON:
        return (True, True, parallel[2], beside[1])
    return _inside_corner(before, behind)


def _inside_corner(before: Before, behind: Behind) -> Passage:
    """The parallels meet; where they do so twice, at the place nearest to the contour's corner."""
    contour, parallel, begin = before
    beside = behind[1]
    count, first, second = curves.meetings(parallel, beside)
    fits, at, least = False, begin, math.inf
    from_begin = curves.along(parallel, begin)
    for number in range(count):
        point = first if number == 0 else second
        share = curves.along(parallel, point)
        if (
            curves.within(parallel, share)
            and share >= from_begin
            and curves.within(beside, curves.along(beside, point))
        ):
            far = distance(point, contour[2])
            if not fits or far < least:
                fits, at, least = True, point, far
    return (fits, False, at, at)


def side_change(before: Before, behind: Behind, *, extended: bool) -> Point | None:
    """Where a tool goes over from the parallel of one element to that of the next, which lies on the other side.

    Args:
        before: As ``corner_of`` has it.
        behind: The next element and its parallel on the new side.
        extended: The parallels go on beyond the corner.

    Returns:
        Where they cross, nearest to the corner, the first of two that are as near; None: on no part of both.
    """
    contour, parallel, begin = before
    beside = behind[1]
    count, *places = curves.meetings(parallel, beside)
    from_begin = curves.along(parallel, begin)
    crossings = [
        place
        for place in places[:count]
        if curves.along(parallel, place) >= from_begin
        and curves.along(beside, place) < 1.0
        and (extended or _on_both(parallel, beside, place))
    ]

    def nearest_first(place: Point) -> tuple[float, float]:
        return (round(distance(place, contour[2]), 6), curves.along(parallel, place))

    return min(crossings, key=nearest_first, default=None)


def _on_both(first: Curve, second: Curve, place: Point) -> bool:
    return curves.within(first, curves.along(first, place)) and curves.within(
        second, curves.along(second, place)
    )


ALLOWED_DEPTH = 0.01
"""How far a lead may cut into the contour without a warning [mm]."""


def depth_of(lead: Curve, contour: Curve, radius: float) -> float:
    """How far a tool on a straight lead cuts into an element of the contour; 0 if little [mm]."""
    depth = radius - clearance(lead, contour)
    return depth if depth > ALLOWED_DEPTH else 0.0


def clearance(line: Curve, curve: Curve) -> float:
    """Smallest distance between a line and a line or an arc; 0 where they cross [mm]."""
    if line[1] == line[2]:
        return distance_to(curve, line[1])
    count, first, second = curves.meetings(line, curve)
    for number in range(count):
        point = first if number == 0 else second
        on_line = curves.within(line, curves.along(line, point))
        if on_line and curves.within(curve, curves.along(curve, point)):
            return 0.0
    near = min(
        distance_to(curve, line[1]),
        distance_to(curve, line[2]),
        distance_to(line, curve[1]),
        distance_to(line, curve[2]),
    )
    if curve[0]:
        share = curves.along(line, curve[3])
        if curves.within(line, share):
            near = min(near, distance_to(curve, curves.point_of(line, share)))
    return near


def distance_to(curve: Curve, point: Point) -> float:
    """From a point to the nearest point of a curve [mm]."""
    is_arc, start, end, center, _ = curve
    share = curves.along(curve, point)
    if 0.0 <= share <= 1.0:
        if is_arc:
            return abs(distance(point, center) - curves.radius_of(curve))
        return distance(point, curves.point_of(curve, share))
    return min(distance(point, start), distance(point, end))


def around_corner(
    start: Point, end: Point, corner: Point, signed_offset: float
) -> tuple[bool, Curve]:
    """Whether there is an arc as ``leads.around`` has it, and that arc."""
    none = (False, start, end, corner, 0.0)
    radius, far = abs(signed_offset), distance(start, corner)
    lead = (end[0] - start[0], end[1] - start[1])
    arm = (corner[0] - end[0], corner[1] - end[1])
    if lead[0] * arm[0] + lead[1] * arm[1] >= 0.0 or far <= radius:
        return (False, none)
    opening = math.degrees(math.acos(radius / far))
    towards = (
        corner[0] + (start[0] - corner[0]) * radius / far,
        corner[1] + (start[1] - corner[1]) * radius / far,
    )
    touch = arcs.turned(towards, corner, -opening if signed_offset > 0.0 else opening)
    sweep = arcs.sweep_between(touch, end, corner, signed_offset > 0.0)
    return (abs(sweep) < 180.0, (True, touch, end, corner, sweep))
