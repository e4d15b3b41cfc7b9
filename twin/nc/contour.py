"""Plane elements of a contour: lines and arcs that can be shifted aside, crossed and cut.

Compensation and rounding both rest on it. An element runs from ``start`` to ``end``; ``side`` +1 is
left of the direction of travel, -1 right of it.
"""

import dataclasses
import math

from twin.nc.arcs import Point, distance, turned

Box = tuple[float, float, float, float]
"""Least abscissa and ordinate, largest abscissa and ordinate [mm]."""

_NEAR = 1e-7
"""Slack of comparisons along an element [mm]."""
_BOX_SLACK = 1e-3
"""By which the box of an element is larger than it [mm]: far above any rounding."""


@dataclasses.dataclass(frozen=True, slots=True)
class Element:
    """A line, or an arc where ``center`` is given.

    Attributes:
        start: First point [mm].
        end: Last point [mm].
        center: Centre of an arc, or None [mm].
        sweep: Signed angle of an arc [deg].
    """

    start: Point
    end: Point
    center: Point | None = None
    sweep: float = 0.0

    @property
    def radius(self) -> float:
        """Of an arc [mm]."""
        assert self.center is not None
        return distance(self.start, self.center)

    @property
    def length(self) -> float:
        """Along the element [mm]."""
        if self.center is None:
            return distance(self.start, self.end)
        return math.radians(abs(self.sweep)) * self.radius

    @property
    def box(self) -> Box:
        """Where the element lies, with a little slack; of an arc all of its circle."""
        if self.center is not None:
            (x, y), reach = self.center, self.radius + _BOX_SLACK
            return (x - reach, y - reach, x + reach, y + reach)
        (x, y), (u, v), slack = self.start, self.end, _BOX_SLACK
        return (min(x, u) - slack, min(y, v) - slack, max(x, u) + slack, max(y, v) + slack)

    def point(self, fraction: float) -> Point:
        """The point at a fraction of its length from the start."""
        if self.center is not None:
            return turned(self.start, self.center, self.sweep * fraction)
        return (
            self.start[0] + fraction * (self.end[0] - self.start[0]),
            self.start[1] + fraction * (self.end[1] - self.start[1]),
        )

    def tangent(self, *, at_end: bool) -> Point:
        """Unit direction of travel at the start or the end."""
        if self.center is None:
            return _unit(self.end[0] - self.start[0], self.end[1] - self.start[1])
        point = self.end if at_end else self.start
        x, y = _unit(point[0] - self.center[0], point[1] - self.center[1])
        return (-y, x) if self.sweep > 0.0 else (y, -x)

    def aside(self, by: float) -> "Element | None":
        """The parallel element, ``by`` to the left [mm]; None where an arc would vanish."""
        if self.center is None:
            x, y = self.tangent(at_end=False)
            dx, dy = -y * by, x * by
            return Element(_moved(self.start, dx, dy), _moved(self.end, dx, dy))
        radius = self.radius
        scale = (radius - math.copysign(by, by * self.sweep)) / radius
        if scale <= _NEAR:
            return None
        start = _towards(self.center, self.start, scale)
        end = _towards(self.center, self.end, scale)
        return Element(start, end, self.center, self.sweep)

    def along(self, point: Point) -> float:
        """How far along the element's own curve a point of it lies: 0 at its start, 1 at its end.

        Beyond the ends of an arc the nearer end counts: below 0 or above 1.
        """
        if self.center is None:
            dx, dy = self.end[0] - self.start[0], self.end[1] - self.start[1]
            length = dx * dx + dy * dy
            if length == 0.0:
                return 0.0
            return ((point[0] - self.start[0]) * dx + (point[1] - self.start[1]) * dy) / length
        angle = _angle_from(self.start, point, self.center)
        if self.sweep < 0.0:
            angle = -angle
        angle %= 360.0
        size = abs(self.sweep)
        over = 360.0 - size % 360.0 if size < 360.0 else 0.0
        if size < 360.0 and angle > size + over / 2.0:
            angle -= 360.0
        return angle / size

    def last_along(self, point: Point) -> float:
        """As ``along``; on an arc of several turns in its last one."""
        fraction = self.along(point)
        if self.center is None or abs(self.sweep) < 360.0:
            return fraction
        turn = 360.0 / abs(self.sweep)
        return fraction + turn * math.floor((1.0 - fraction) / turn + _NEAR)

    def tangent_at(self, fraction: float) -> Point:
        """Unit direction of travel at a fraction of its length."""
        if self.center is None:
            return self.tangent(at_end=False)
        x, y = _unit(*(a - b for a, b in zip(self.point(fraction), self.center, strict=True)))
        return (-y, x) if self.sweep > 0.0 else (y, -x)

    def within(self, fraction: float) -> bool:
        """Whether a place along the element lies on it, with a little slack."""
        slack = _NEAR / max(self.length, _NEAR)
        return -slack <= fraction <= 1.0 + slack

    def cut(self, start: Point, end: Point) -> "Element":
        """The part between two points of it; on an arc of several turns those nearest its ends."""
        if self.center is None:
            return Element(start, end)
        before, after = self.along(start), self.along(end)
        if abs(self.sweep) >= 360.0:
            turn = 360.0 / abs(self.sweep)
            before -= turn * round(before / turn)
            after += turn * round((1.0 - after) / turn)
        return Element(start, end, self.center, self.sweep * (after - before))

    def cut_share(self, last: float) -> "Element":
        """The part from its start to a share of its way."""
        return Element(self.start, self.point(last), self.center, self.sweep * last)


def clearance(line: Element, element: Element) -> float:
    """Smallest distance between a line and a line or an arc; 0 where they cross [mm]."""
    for point in crossings(line, element):
        if line.within(line.along(point)) and element.within(element.along(point)):
            return 0.0
    near = [distance_to(element, line.start), distance_to(element, line.end)]
    near += [distance_to(line, element.start), distance_to(line, element.end)]
    if element.center is not None:
        share = line.along(element.center)
        foot = line.point(share)
        if line.within(share):
            near.append(distance_to(element, foot))
    return min(near)


def distance_to(element: Element, point: Point) -> float:
    """From a point to the nearest point of an element [mm]."""
    share = element.along(point)
    if 0.0 <= share <= 1.0:
        if element.center is not None:
            return abs(distance(point, element.center) - element.radius)
        return distance(point, element.point(share))
    return min(distance(point, element.start), distance(point, element.end))


def crossings(first: Element, second: Element) -> list[Point]:
    """Where the unlimited curves of two elements meet; at most two points."""
    if first.center is None and second.center is None:
        return _line_line(first, second)
    if first.center is None:
        return _line_circle(first, second)
    if second.center is None:
        return _line_circle(second, first)
    return _circle_circle(first, second)


def turn_between(first: Element, second: Element) -> float:
    """Signed angle from the end of one element to the start of the next, ±180 [deg]."""
    ax, ay = first.tangent(at_end=True)
    bx, by = second.tangent(at_end=False)
    return math.degrees(math.atan2(ax * by - ay * bx, ax * bx + ay * by))


def _line_line(first: Element, second: Element) -> list[Point]:
    ax, ay = first.tangent(at_end=False)
    bx, by = second.tangent(at_end=False)
    area = ax * by - ay * bx
    if abs(area) < 1e-12:
        return []
    dx, dy = second.start[0] - first.start[0], second.start[1] - first.start[1]
    along = (dx * by - dy * bx) / area
    return [_moved(first.start, ax * along, ay * along)]


def _line_circle(line: Element, arc: Element) -> list[Point]:
    assert arc.center is not None
    ux, uy = line.tangent(at_end=False)
    dx, dy = arc.center[0] - line.start[0], arc.center[1] - line.start[1]
    along, aside = dx * ux + dy * uy, dy * ux - dx * uy
    foot = _moved(line.start, ux * along, uy * along)
    return [_moved(foot, ux * s, uy * s) for s in _halves(arc.radius, abs(aside))]


def _circle_circle(first: Element, second: Element) -> list[Point]:
    assert first.center is not None
    assert second.center is not None
    apart = distance(first.center, second.center)
    if apart < _NEAR:
        return []
    ux, uy = (
        (second.center[0] - first.center[0]) / apart,
        (second.center[1] - first.center[1]) / apart,
    )
    along = (apart * apart + first.radius**2 - second.radius**2) / (2.0 * apart)
    foot = _moved(first.center, ux * along, uy * along)
    return [_moved(foot, -uy * s, ux * s) for s in _halves(first.radius, abs(along))]


def _halves(radius: float, aside: float) -> list[float]:
    """Plus and minus half the chord that lies ``aside`` from a circle's centre."""
    if aside > radius + _NEAR:
        return []
    half = math.sqrt(max(0.0, radius * radius - aside * aside))
    return [half, -half]


def _unit(x: float, y: float) -> Point:
    """The direction of a vector; none, 0 0, where a slot as wide as the tool leaves no way."""
    length = math.hypot(x, y)
    return (x / length, y / length) if length > 0.0 else (0.0, 0.0)


def _moved(point: Point, dx: float, dy: float) -> Point:
    return (point[0] + dx, point[1] + dy)


def _towards(center: Point, point: Point, scale: float) -> Point:
    return (
        center[0] + (point[0] - center[0]) * scale,
        center[1] + (point[1] - center[1]) * scale,
    )


def _angle_from(start: Point, point: Point, center: Point) -> float:
    ax, ay = start[0] - center[0], start[1] - center[1]
    bx, by = point[0] - center[0], point[1] - center[1]
    return math.degrees(math.atan2(ax * by - ay * bx, ax * bx + ay * by))
