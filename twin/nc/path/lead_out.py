"""What moves become between the end of radius compensation and the line that leads out of it."""

import dataclasses
from collections.abc import Callable
from typing import NoReturn

from twin.nc.geometry.arcs import SAME_POINT, distance
from twin.nc.geometry.elements import Element
from twin.nc.path.leads import LeadOut, around, lead_depth
from twin.nc.path.move_columns import Segment
from twin.nc.path.segments import level_arc


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
        arc = around(end[:2], here[:2], leading.contour.end, -leading.aside)
    if arc is not None:
        back = Element(here[:2], arc.start, arc.center, -arc.sweep)
        moves.append(level_arc(move, plane, back, position))
        position = moves[-1].end
    lead = Element(plane.local(position)[:2], end[:2])
    depth = lead_depth(lead, leading.contour, abs(leading.aside))
    if depth:
        message = f"on its way from the contour the tool cuts {depth:.3f} mm into it"
        warn(move, "compensation-lead", message)
    return [*moves, dataclasses.replace(move, start=position)], True
