"""Elements of a contour, lines and arcs in a plane: a view of ``curves`` for people and tests."""

import dataclasses
import math

from twin.nc.geometry import curves
from twin.nc.geometry.arcs import Point, turned
from twin.nc.geometry.curves import Box, Curve


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
    def curve(self) -> Curve:
        """Itself as the functions of ``curves`` take it."""
        if self.center is None:
            return curves.line(self.start, self.end)
        return curves.arc(self.start, self.end, self.center, self.sweep)

    @property
    def radius(self) -> float:
        """Of an arc [mm]."""
        return curves.radius_of(self.curve)

    @property
    def length(self) -> float:
        """Along the element [mm]."""
        return curves.length_of(self.curve)

    @property
    def box(self) -> Box:
        """Where the element lies, with a little slack; of an arc all of its circle."""
        return curves.box_of(self.curve)

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
        return curves.tangent_of(self.curve, at_end)

    def parallel(self, by: float) -> "Element | None":
        """The parallel element, ``by`` to the left [mm]; None where an arc would vanish."""
        if not curves.leaves_room(self.curve, by):
            return None
        return element_from(curves.parallel_of(self.curve, by))

    def along(self, point: Point) -> float:
        """How far along the element's own curve a point of it lies: 0 at its start, 1 at its end.

        Beyond the ends of an arc the nearer end counts: below 0 or above 1.
        """
        return curves.along(self.curve, point)

    def last_along(self, point: Point) -> float:
        """As ``along``; on an arc of several turns in its last one."""
        fraction = self.along(point)
        if self.center is None or abs(self.sweep) < 360.0:
            return fraction
        turn = 360.0 / abs(self.sweep)
        return fraction + turn * math.floor((1.0 - fraction) / turn + curves.NEAR)

    def tangent_at(self, fraction: float) -> Point:
        """Unit direction of travel at a fraction of its length."""
        if self.center is None:
            return self.tangent(at_end=False)
        x, y = curves.unit(*(a - b for a, b in zip(self.point(fraction), self.center, strict=True)))
        return (-y, x) if self.sweep > 0.0 else (y, -x)

    def within(self, fraction: float) -> bool:
        """Whether a place along the element lies on it, with a little slack."""
        return curves.within(self.curve, fraction)

    def cut(self, start: Point, end: Point) -> "Element":
        """The part between two points of it; on an arc of several turns those nearest its ends."""
        return element_from(curves.cut(self.curve, start, end))

    def cut_share(self, last: float) -> "Element":
        """The part from its start to a share of its way."""
        return Element(self.start, self.point(last), self.center, self.sweep * last)


def crossings(first: Element, second: Element) -> list[Point]:
    """Where the unlimited curves of two elements meet; at most two points."""
    count, *points = curves.meetings(first.curve, second.curve)
    return points[:count]


def crossing(older: Element, younger: Element) -> tuple[float, float] | None:
    """Where two elements cross, as shares of their ways: the first place on the older one."""
    found, left, right = curves.crossing_of(older.curve, younger.curve)
    return (left, right) if found else None


def turn_between(first: Element, second: Element) -> float:
    """Signed angle from the end of one element to the start of the next, ±180 [deg]."""
    return curves.turn_from(first.curve, second.curve)


def element_from(curve: Curve) -> Element:
    """A curve as an element."""
    is_arc, start, end, center, sweep = curve
    return Element(start, end, center, sweep) if is_arc else Element(start, end)
