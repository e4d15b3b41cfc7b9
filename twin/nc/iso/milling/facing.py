"""Faces: a rectangle in strips along one of its sides, level by level."""

import dataclasses
import math

from twin.nc.control.control import Control
from twin.nc.geometry.arcs import Point, turned
from twin.nc.iso.cycle_moves import at_feed, go, go_to_height

MOST_STRIPS = 10_000
"""Strips of one face: more is a slip of the pen."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Face:
    """A face; heights are programmed coordinates.

    Attributes:
        corner: Where it begins, in the plane [mm].
        extent: Of a strip, with its sign [mm].
        across: Of all strips beside each other, with its sign [mm].
        along_ordinate: Strips lie along the ordinate, else along the abscissa.
        angle: Of the face about its corner [deg].
        step: Width of a strip at most [mm].
        beyond: How far the tool's centre goes beyond both ends of a strip [mm].
        one_direction: Every strip goes the same direction; else to and fro.
        levels: Heights of the passes [mm].
        safe: Over which the tool moves rapidly [mm].
        back: Height to which it returns [mm].
    """

    corner: Point
    extent: float
    across: float
    along_ordinate: bool
    angle: float
    step: float
    beyond: float
    one_direction: bool
    levels: tuple[float, ...]
    safe: float
    back: float
    feed: float | None

    @property
    def strips(self) -> int:
        """How many there are beside each other."""
        return max(1, math.ceil(abs(self.across) / self.step - 1e-9))

    def at(self, along: float, sideways: float) -> Point:
        """A point along a strip and across it."""
        x, y = (sideways, along) if self.along_ordinate else (along, sideways)
        return turned((self.corner[0] + x, self.corner[1] + y), self.corner, self.angle)


def mill_face(control: Control, face: Face) -> None:
    """Mill a face."""
    beyond = math.copysign(face.beyond, face.extent)
    ends = (-beyond, face.extent + beyond)
    for level in face.levels:
        height = control.motion.programmed[control.modal.plane.axes[2]]
        go_to_height(control, max(face.safe, height))
        for strip in range(face.strips):
            begin, end = reversed(ends) if strip % 2 and not face.one_direction else ends
            sideways = face.across * (strip + 0.5) / face.strips
            if strip == 0 or face.one_direction:
                if strip:
                    go_to_height(control, face.safe)
                go(control, face.at(begin, sideways), rapid=True)
                go_to_height(control, level)
            with at_feed(control, face.feed or control.motion.feed):
                go(control, face.at(begin, sideways))
                go(control, face.at(end, sideways))
        go_to_height(control, face.back)
