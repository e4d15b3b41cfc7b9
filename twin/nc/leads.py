"""How radius compensation begins and ends: the straight moves to and from the contour."""

import dataclasses
import math

from twin.nc.arcs import Point, distance, sweep_between, turned
from twin.nc.contour import Element, clearance
from twin.nc.planes import Plane

ALLOWED_DEPTH = 0.01
"""How far a lead may cut into the contour without a warning [mm]."""


@dataclasses.dataclass(frozen=True, slots=True)
class LeadOut:
    """What the straight move after compensation starts beside.

    Attributes:
        plane: Of the compensation.
        contour: Its last element as programmed.
        aside: The tool's radius, signed as the side of the contour [mm].
        indirect: The lead-out goes around the contour's last point.
    """

    plane: Plane
    contour: Element
    aside: float
    indirect: bool


def lead_depth(lead: Element, contour: Element, radius: float) -> float:
    """How far a tool on a straight lead cuts into an element of the contour; 0 if little [mm]."""
    depth = radius - clearance(lead, contour)
    return depth if depth > ALLOWED_DEPTH else 0.0


def around(start: Point, end: Point, corner: Point, aside: float) -> Element | None:
    """The arc by which a straight lead-in reaches its end without cutting off the corner.

    The lead touches the tool's circle about the contour's first point and follows it to ``end``.
    For a lead-out, swap ``start`` with its end and negate ``aside``; the arc then runs backwards.

    Args:
        start: Where the lead begins.
        end: Where the compensated contour begins, at the tool's radius from the corner.
        corner: The contour's first point.
        aside: The tool's radius, positive left of the contour [mm].

    Returns:
        The arc, or None where the straight lead is free or no way around exists.
    """
    radius, far = abs(aside), distance(start, corner)
    lead = (end[0] - start[0], end[1] - start[1])
    arm = (corner[0] - end[0], corner[1] - end[1])
    if lead[0] * arm[0] + lead[1] * arm[1] >= 0.0 or far <= radius:
        return None
    opening = math.degrees(math.acos(radius / far))
    towards = (
        corner[0] + (start[0] - corner[0]) * radius / far,
        corner[1] + (start[1] - corner[1]) * radius / far,
    )
    touch = turned(towards, corner, -opening if aside > 0.0 else opening)
    sweep = sweep_between(touch, end, corner, clockwise=aside > 0.0)
    return Element(touch, end, corner, sweep) if abs(sweep) < 180.0 else None
