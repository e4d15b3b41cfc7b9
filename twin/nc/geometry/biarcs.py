"""Arcs that follow another curve: two of them along its tangents, and a spiral's."""

import math

from twin.nc.geometry import curves
from twin.nc.geometry.arcs import SAME_POINT, Point, center_tangent, distance, sweep_between, turned
from twin.nc.geometry.curves import Curve

SPIRAL_ERROR = 5e-4
"""How far the arcs of a spiral may leave it [mm]: half the least input increment."""
_MOST = 512
"""Parts of a spiral."""
_LARGEST_PART = 60.0
"""[deg]"""


def biarc(begin: Point, end: Point, first: Point, last: Point) -> list[Curve]:
    """One or two arcs from ``begin`` along ``first`` to ``end`` along ``last``."""
    vx, vy = end[0] - begin[0], end[1] - begin[1]
    tx, ty = first[0] + last[0], first[1] + last[1]
    together, chord = vx * tx + vy * ty, vx * vx + vy * vy
    bend = 2.0 * (1.0 - first[0] * last[0] - first[1] * last[1])
    reach = (math.sqrt(together * together + bend * chord) - together) / bend
    joint = (
        (begin[0] + end[0] + reach * (first[0] - last[0])) / 2.0,
        (begin[1] + end[1] + reach * (first[1] - last[1])) / 2.0,
    )
    left = center_tangent(begin, joint, first)
    right = center_tangent(end, joint, (-last[0], -last[1]))
    pieces = [
        _arc_or_line(begin, joint, left, begin, first),
        _arc_or_line(joint, end, right, end, last),
    ]
    if left is not None and right is not None and distance(left, right) < 1e-7:
        return [curves.arc(begin, end, left, pieces[0][4] + pieces[1][4])]
    return pieces


def _arc_or_line(
    begin: Point, end: Point, center: Point | None, point: Point, along: Point
) -> Curve:
    """The arc about a centre that goes along a direction at one of its ends; without a centre the line."""
    if center is None:
        return curves.line(begin, end)
    arm = (point[0] - center[0], point[1] - center[1])
    clockwise = arm[0] * along[1] - arm[1] * along[0] < 0.0
    return curves.arc(begin, end, center, sweep_between(begin, end, center, clockwise))


def spiral(start: Point, end: Point, center: Point, sweep: float) -> list[Curve]:
    """Arcs along a spiral about a centre, whose radius grows evenly with the angle [deg].

    So a Fanuc control draws an arc whose end is not as far from its centre as its start (manual, spiral
    interpolation). Neighbours have one tangent where they meet.
    """
    near, far = distance(start, center), distance(end, center)
    if abs(near - far) < SAME_POINT:
        return [curves.arc(start, end, center, sweep)]
    growth = (far - near) / math.radians(sweep)
    count = math.ceil(abs(sweep) / _LARGEST_PART)
    while True:
        points = [_turned_out(start, center, sweep, far / near, k / count) for k in range(count)]
        points.append(end)
        tangents = [_along_spiral(point, center, growth, sweep) for point in points]
        made = [
            piece
            for k in range(count)
            for piece in biarc(points[k], points[k + 1], tangents[k], tangents[k + 1])
        ]
        if count >= _MOST or _leaves_by(made, start, center, growth) < SPIRAL_ERROR:
            return made
        count *= 2


def _turned_out(start: Point, center: Point, sweep: float, scale: float, share: float) -> Point:
    """The point of a spiral at a share of its sweep, at whose end it is ``scale`` times as far out."""
    return curves.towards(center, turned(start, center, share * sweep), 1.0 + share * (scale - 1.0))


def _along_spiral(point: Point, center: Point, growth: float, sweep: float) -> Point:
    """The unit direction of travel; ``growth`` is what the radius grows by the angle, signed [mm/rad]."""
    x, y = point[0] - center[0], point[1] - center[1]
    radius = math.hypot(x, y)
    x, y = growth * x / radius - y, growth * y / radius + x
    length = math.copysign(math.hypot(x, y), sweep)
    return (x / length, y / length)


def _leaves_by(pieces: list[Curve], start: Point, center: Point, growth: float) -> float:
    """How far the middles of pieces lie from the spiral [mm]."""
    near, passed, worst, here = distance(start, center), 0.0, 0.0, start
    for piece in pieces:
        for share in (0.5, 1.0):
            point = curves.point_at(piece, share)
            passed += _angle_between(here, point, center)
            worst = max(worst, abs(distance(point, center) - near - growth * passed))
            here = point
    return worst


def _angle_between(one: Point, other: Point, center: Point) -> float:
    """Signed, about a centre [rad]."""
    ax, ay = one[0] - center[0], one[1] - center[1]
    bx, by = other[0] - center[0], other[1] - center[1]
    return math.atan2(ax * by - ay * bx, ax * bx + ay * by)
