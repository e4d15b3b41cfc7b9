"""Outlines of pockets, slots and studs, and the paths around them."""

import dataclasses
import enum
import math
from typing import Protocol

from twin.nc.control.control import Control
from twin.nc.geometry.arcs import Point, turned
from twin.nc.iso.cycle_moves import go, turn


class Outline(Protocol):
    """What is milled around, as the tool's centre goes along its wall."""

    @property
    def entry(self) -> Point:
        """Where a pocket is entered, in the plane, programmed coordinates [mm]."""
        ...

    @property
    def room(self) -> float:
        """From there to the wall, less the tool's radius, where it is nearest [mm]."""
        ...

    def go_around(self, control: Control, inset: float) -> None:
        """Go once around, so far inside the path along the wall; outside it below 0 [mm]."""
        ...


class CornerKind(enum.IntEnum):
    """What the corners of a rectangle are: M of Fagor's G87."""

    SQUARE = 0
    ROUNDED = 1
    CHAMFERED = 2


@dataclasses.dataclass(frozen=True, slots=True)
class RectangleCorner:
    """The corners of a rectangle.

    Attributes:
        size: Radius, or distance of the chamfer's ends from the corner, at the wall [mm].
        radius: Of the tool; below 0 around a stud [mm].
    """

    kind: CornerKind = CornerKind.SQUARE
    size: float = 0.0
    radius: float = 0.0

    def at(self, inset: float) -> float:
        """Size on a ring that lies so far from the tool's path along the wall [mm].

        A parallel at the distance d shortens a radius by d, and the legs of a chamfer of 45 degrees
        by d (2 - root of 2).
        """
        share = 1.0 if self.kind is CornerKind.ROUNDED else 2.0 - math.sqrt(2.0)
        return max(0.0, self.size - share * (self.radius + inset))


@dataclasses.dataclass(frozen=True, slots=True)
class Circle:
    """A circle about its entry.

    Attributes:
        room: Radius of the tool's path along the wall [mm].
        angle: At which a ring begins [deg].
    """

    entry: Point
    room: float
    clockwise: bool
    angle: float = 0.0

    def go_around(self, control: Control, inset: float) -> None:
        """A full circle."""
        radius = self.room - inset
        begin = turned((self.entry[0] + radius, self.entry[1]), self.entry, self.angle)
        go(control, begin)
        if radius > 0.0:
            turn(control, self.entry, begin, -360.0 if self.clockwise else 360.0)


@dataclasses.dataclass(frozen=True, slots=True)
class Rectangle:
    """A rectangle about its entry.

    Attributes:
        length: Half of it along its angle, less the tool's radius [mm].
        width: Half of it across [mm].
        angle: Of its length against the abscissa [deg].
    """

    entry: Point
    length: float
    width: float
    angle: float
    clockwise: bool
    corner: RectangleCorner

    @property
    def room(self) -> float:
        """Half of its shorter side."""
        return min(self.length, self.width)

    def go_around(self, control: Control, inset: float) -> None:
        """From the middle of a side, corners cut or rounded."""
        sign = -1.0 if self.clockwise else 1.0
        length, width = self.length - inset, self.width - inset
        size = min(self.corner.at(inset), length, width)

        def at(along: float, across: float) -> Point:
            point = (self.entry[0] + along, self.entry[1] + sign * across)
            return turned(point, self.entry, self.angle)

        go(control, at(length, 0.0))
        for along, across in ((1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)):
            ends = [
                at(along * length, across * (width - size)),
                at(along * (length - size), across * width),
            ]
            if along != across:
                ends.reverse()
            go(control, ends[0])
            if size > 0.0 and self.corner.kind is CornerKind.ROUNDED:
                center = at(along * (length - size), across * (width - size))
                turn(control, center, ends[1], sign * 90.0)
            elif size > 0.0:
                go(control, ends[1])
        go(control, at(length, 0.0))


@dataclasses.dataclass(frozen=True, slots=True)
class CurvedSlot:
    """A slot with round ends along a circle, entered at its first end.

    Attributes:
        center: Of the circle that its middle line lies on [mm].
        radius: Of that circle [mm].
        begin: Where the centre of its first end lies [deg].
        opening: From there to that of its last one, with its sign [deg].
        room: Half its width less the tool's radius [mm].
    """

    center: Point
    radius: float
    begin: float
    opening: float
    room: float
    clockwise: bool

    @property
    def entry(self) -> Point:
        """The centre of its first end."""
        return self._at(self.radius, self.begin)

    def go_around(self, control: Control, inset: float) -> None:
        """Along one side, around the end, back along the other, around the beginning."""
        turns = -180.0 if self.clockwise else 180.0
        side = (
            self.room - inset if (self.opening > 0.0) is not self.clockwise else inset - self.room
        )
        last = self.begin + self.opening
        go(control, self._at(self.radius + side, self.begin))
        turn(control, self.center, self._at(self.radius + side, last), self.opening)
        if side != 0.0:
            turn(control, self._at(self.radius, last), self._at(self.radius - side, last), turns)
        turn(control, self.center, self._at(self.radius - side, self.begin), -self.opening)
        if side != 0.0:
            turn(control, self.entry, self._at(self.radius + side, self.begin), turns)
        go(control, self.entry)

    def _at(self, radius: float, angle: float) -> Point:
        return turned((self.center[0] + radius, self.center[1]), self.center, angle)
