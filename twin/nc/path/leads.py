"""How radius compensation begins and ends: the straight moves to and from the contour."""

import dataclasses

from twin.nc.geometry import lead_curves
from twin.nc.geometry.arcs import Point
from twin.nc.geometry.elements import Element, element_from
from twin.nc.geometry.planes import Plane
from twin.nc.path.compensation_state import Followed, Stage


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

    @property
    def followed(self) -> Followed:
        """As the stage of compensation that it is."""
        return Followed(
            Stage.LEADING_OUT,
            self.plane,
            self.aside,
            square=False,
            indirect=self.indirect,
            move=None,
            contour=self.contour,
            element=None,
            start=(0.0, 0.0),
            here=[],
            passed=[],
        )


def lead_depth(lead: Element, contour: Element, radius: float) -> float:
    """How far a tool on a straight lead cuts into an element of the contour; 0 if little [mm]."""
    return lead_curves.depth_of(lead.curve, contour.curve, radius)


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
    found, arc = lead_curves.way_around(start, end, corner, aside)
    return element_from(arc) if found else None
