"""How radius compensation begins and ends: the straight moves to and from the contour."""

import dataclasses
from collections.abc import Callable
from typing import NoReturn

from twin.nc.geometry import lead_curves
from twin.nc.geometry.arcs import SAME_POINT, Point, distance
from twin.nc.geometry.elements import Element, element_from
from twin.nc.geometry.planes import Plane
from twin.nc.path.compensation_state import CompensationState, Stage
from twin.nc.path.move_columns import Segment
from twin.nc.path.segments import level_arc


@dataclasses.dataclass(frozen=True, slots=True)
class LeadOut:
    """What the straight move after compensation starts beside.

    Attributes:
        plane: Of the compensation.
        contour: Its last element as programmed.
        signed_offset: The tool's radius, signed as the side of the contour [mm].
        indirect: The lead-out goes around the contour's last point.
    """

    plane: Plane
    contour: Element
    signed_offset: float
    indirect: bool

    @property
    def state(self) -> CompensationState:
        """As the stage of compensation that it is."""
        return CompensationState(
            Stage.LEADING_OUT,
            self.plane,
            self.signed_offset,
            square=False,
            indirect=self.indirect,
            move=None,
            contour=self.contour,
            element=None,
            start=(0.0, 0.0),
            here=[],
            gouge_history=[],
        )


def lead_depth(lead: Element, contour: Element, radius: float) -> float:
    """How far a tool on a straight lead cuts into an element of the contour; 0 if little [mm]."""
    return lead_curves.depth_of(lead.curve, contour.curve, radius)


def around(start: Point, end: Point, corner: Point, signed_offset: float) -> Element | None:
    """The arc by which a straight lead-in reaches its end without cutting off the corner.

    The lead touches the tool's circle about the contour's first point and follows it to ``end``.
    For a lead-out, swap ``start`` with its end and negate ``signed_offset``; the arc then runs backwards.

    Args:
        start: Where the lead begins.
        end: Where the compensated contour begins, at the tool's radius from the corner.
        corner: The contour's first point.
        signed_offset: The tool's radius, positive left of the contour [mm].

    Returns:
        The arc, or None where the straight lead is free or no way around exists.
    """
    found, arc = lead_curves.way_around(start, end, corner, signed_offset)
    return element_from(arc) if found else None


def lead_out(
    move: Segment,
    leading: LeadOut,
    position: list[float],
    refuse: Callable[[Segment, str, str], NoReturn],
    warn: Callable[[Segment, str, str], None],
) -> tuple[list[Segment], bool]:
    """The first line in the plane leads out; until then only its normal and other axes move.

    Args:
        move: As programmed.
        leading: What the path stands beside.
        position: Where it stands, shape (k,).
        refuse: Told of an arc.
        warn: Told of a line that cuts into the contour.

    Returns:
        The moves that are driven, and whether they have led out.
    """
    plane = leading.plane
    if move.center is not None:
        refuse(move, "compensation-end", "compensation must end on a line")
    start, end, here = (plane.local(each) for each in (move.start, move.end, position))
    if distance(start[:2], end[:2]) < SAME_POINT:
        level = [*plane.world(here.abscissa, here.ordinate, end.height), *move.end[3:]]
        return [dataclasses.replace(move, start=position, end=level)], False
    moves: list[Segment] = []
    arc = None
    if leading.indirect:
        arc = around(end[:2], here[:2], leading.contour.end, -leading.signed_offset)
    if arc is not None:
        back = Element(here[:2], arc.start, arc.center, -arc.sweep)
        moves.append(level_arc(move, plane, back, position))
        position = moves[-1].end
    lead = Element(plane.local(position)[:2], end[:2])
    depth = lead_depth(lead, leading.contour, abs(leading.signed_offset))
    if depth:
        message = f"on its way from the contour the tool cuts {depth:.3f} mm into it"
        warn(move, "compensation-lead", message)
    return [*moves, dataclasses.replace(move, start=position)], True
