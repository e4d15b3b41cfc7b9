"""How the parallel of a contour passes a corner of the contour, as plain functions over tuples."""

import math

from twin.nc.geometry import curves
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
