"""Approach to a contour and retraction from it: straight or on an arc, as the tool's centre goes.

The approach to a contour is made when its first element is known. Its auxiliary point is reached in the working plane first,
then in the axis across it.
"""

import dataclasses
import enum
import math

from twin.nc.control.compensation import compensate
from twin.nc.control.control import Control
from twin.nc.geometry.arcs import SAME_POINT, Point, distance, sweep_between, turned
from twin.nc.geometry.matrices import applied
from twin.nc.iso.cycle_moves import go, go_to_height, turn
from twin.nc.path.move_columns import Segment
from twin.nc.path.segments import direction_of
from twin.nc.text.blocks import Block


class LeadKind(enum.Enum):
    """How a lead goes."""

    TANGENT = enum.auto()
    """Straight, along the first element of the contour or on behind its last one."""
    NORMAL = enum.auto()
    """Straight, square to it."""
    ARC = enum.auto()
    """On an arc that touches it, of an angle."""
    LINE_AND_ARC = enum.auto()
    """On a line and an arc that touch each other and it."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Lead:
    """A lead as it is programmed.

    Attributes:
        size: Length, or radius of the centre's path [mm]; an arc of a radius below 0 lies on the contour's other side.
        angle: Of an arc [deg].
        side: Of the tool beside the contour: 1 left, -1 right, 0 on it.
        offset: How far beside it the tool's centre goes, part coordinates [mm].
        feed_before: Feed to the auxiliary point, or from it.
        rapid: The move to the auxiliary point, or from it, is as fast as the machine can.
        above: How far the auxiliary point lies above the contour [mm].
        spatial: The lead itself falls or rises by that; else the tool does so over the auxiliary point.
        feed_down: Feed of that fall or rise; None: the lead's.
    """

    kind: LeadKind
    size: float
    angle: float = 0.0
    side: float
    offset: float
    feed_before: float | None
    feed: float | None
    rapid: bool = False
    above: float = 0.0
    spatial: bool = False
    feed_down: float | None = None

    @property
    def clockwise(self) -> bool:
        """Whether the arc turns clockwise; on the contour as left of it."""
        return (self.size < 0.0) is (self.side >= 0.0)


@dataclasses.dataclass(frozen=True, slots=True)
class ContourEnd:
    """Where the tool's centre begins or ends a contour, in the plane.

    Attributes:
        along: Unit vector in which the contour goes there.
        aside: Unit vector to the side of the tool, left of the contour without compensation.
    """

    point: Point
    along: Point
    aside: Point

    def at(self, along: float, aside: float) -> Point:
        """A point beside it [mm]."""
        (x, y), (u, v), (m, n) = self.point, self.along, self.aside
        return (x + along * u + aside * m, y + along * v + aside * n)


def touch_of(control: Control, point: Point, ahead: Point, lead: Lead) -> ContourEnd:
    """Where the centre touches a contour that goes through a point in a direction."""
    size = math.hypot(*ahead)
    along = (ahead[0] / size, ahead[1] / size)
    sense = lead.side or 1.0
    aside = (-along[1] * sense, along[0] * sense)
    offset = lead.offset / math.hypot(*applied(control.frame.matrix, (1.0, 0.0, 0.0)))
    return ContourEnd((point[0] + offset * aside[0], point[1] + offset * aside[1]), along, aside)


def auxiliary_point(
    control: Control, touch: ContourEnd, lead: Lead, other: Point, *, arrives: bool
) -> tuple[Point | None, Point]:
    """Centre of a lead's arc, if it has one, and its auxiliary point.

    Args:
        touch: Where the contour begins or ends.
        other: Where a lead of line and arc comes from or goes to.
    """
    outwards = -1.0 if arrives else 1.0
    if lead.kind is LeadKind.TANGENT:
        return None, touch.at(outwards * lead.size, 0.0)
    if lead.kind is LeadKind.NORMAL:
        return None, touch.at(0.0, lead.size)
    center, sense = touch.at(0.0, lead.size), -1.0 if lead.clockwise else 1.0
    if lead.kind is LeadKind.ARC:
        return center, turned(touch.point, center, outwards * sense * lead.angle)
    far = distance(other, center)
    if far <= lead.size:
        message = f"the point {far:.3f} mm from the centre of the arc lies within its radius R"
        control.fail("contour-lead", message, hint="write a smaller R")
    base = math.atan2(other[1] - center[1], other[0] - center[0])
    angle = base - outwards * sense * math.acos(lead.size / far)
    return center, (
        center[0] + lead.size * math.cos(angle),
        center[1] + lead.size * math.sin(angle),
    )


@dataclasses.dataclass(slots=True)
class Approach:
    """Waits for the first move of the contour; a control that is copied takes it along, as it could no closure.

    Attributes:
        start: Where the tool comes from, programmed position, shape (k,).
        contour: Where the contour begins; None: where the next move goes, which is not made.
    """

    control: Control
    block: Block
    lead: Lead
    start: list[float]
    contour: list[float] | None

    def __call__(self, move: Segment) -> bool:
        """Lead to a move; whether it is to be made."""
        if self.contour is None:
            if any(math.isnan(value) for value in move.display) or move.center is not None:
                message = "the contour's first block says where it begins: a line to both axes of the plane"
                self.control.fail("contour-lead", message)
            self.contour = list(move.display)
            self.control.path.leads = self
            return False
        self._come(move, self.contour)
        return True

    def _come(self, move: Segment, contour: list[float]) -> None:
        control, lead = self.control, self.lead
        plane, motion, here = control.modal.plane, control.motion, control.block
        feed, across = motion.feed, plane.axes[2]
        ahead = plane.point(control.frame.unturn(direction_of(move, at_end=False)))
        if ahead == (0.0, 0.0):
            message = "the contour must begin with a move in the working plane"
            control.fail("contour-lead", message)
        touch = touch_of(control, plane.point(contour), ahead, lead)
        control.block, control.report.line = self.block, self.block.line
        _stand(control, self.start)
        other = plane.point(self.start)
        center, begin = auxiliary_point(control, touch, lead, other, arrives=True)
        motion.feed = lead.feed_before
        go(control, begin, rapid=lead.rapid)
        target = list(contour)
        plane.aim(target, begin)
        target[across] += lead.above
        control.line_to(target, rapid=lead.rapid)
        if not lead.spatial:
            motion.feed = lead.feed_down or lead.feed
            go_to_height(control, contour[across], rapid=False)
        motion.feed = lead.feed
        _go_on_lead(control, lead, touch.point, center, contour[across])
        if lead.side:
            compensate(control, lead.side, lead.offset, led=True)
        motion.feed, control.block, control.report.line = feed, here, here.line
        _stand(control, contour)


def approach(control: Control, lead: Lead, contour: list[float] | None) -> None:
    """Let the next move of the contour be led to; arguments as for ``Approach``."""
    if control.path.compensation.in_force or control.path.leads is not None:
        message = "a lead begins a contour, and one has begun already"
        control.fail("contour-lead", message, hint="end it before")
    start = list(control.motion.programmed)
    control.path.leads = Approach(control, control.block, lead, start, contour)
    if contour is not None:
        _stand(control, contour)


def stand_at_height(control: Control, height: float, *, nowhere: bool = False) -> None:
    """Let the next move, which tells where the contour begins, end at a height [mm].

    Args:
        nowhere: The tool is nowhere in the plane, so that the move must tell both coordinates.
    """
    target, (first, second, across) = list(control.motion.programmed), control.modal.plane.axes
    target[across] = height
    if nowhere:
        target[first] = target[second] = math.nan
    _stand(control, target)


def depart(control: Control, lead: Lead, target: list[float] | None) -> None:
    """The contour ends where the tool is; it leaves, and compensation has ended.

    Args:
        target: Where it goes; a lead of line and arc in the plane too, others across it alone. None: no farther
            than the lead does.
    """
    plane, motion = control.modal.plane, control.motion
    behind = motion.direction
    ahead = (0.0, 0.0) if behind is None else plane.point(behind)
    if ahead == (0.0, 0.0) or control.path.leads is not None:
        message = "a lead leaves a contour, and no move in the plane has ended it"
        control.fail("contour-lead", message)
    end, across = list(motion.programmed), plane.axes[2]
    control.path.end_compensation(led=True)
    if lead.side:
        motion.part = list(control.path.position)
    motion.reframed()
    touch = touch_of(control, plane.point(end), ahead, lead)
    touch = dataclasses.replace(touch, point=plane.point(motion.programmed))
    away = plane.point(end if target is None else target)
    center, auxiliary = auxiliary_point(control, touch, lead, away, arrives=False)
    rise = lead.above if lead.spatial else 0.0
    _go_on_lead(control, lead, auxiliary, center, end[across] + rise)
    if lead.above and not lead.spatial:
        motion.feed = lead.feed_down or motion.feed
        go_to_height(control, end[across] + lead.above, rapid=False)
    if target is None:
        return
    if lead.kind is LeadKind.LINE_AND_ARC:
        go(control, away)
    there = list(motion.programmed)
    there[2:] = target[2:] if across == 2 else there[2:]
    control.line_to(there, rapid=lead.rapid)


def _go_on_lead(
    control: Control, lead: Lead, point: Point, center: Point | None, height: float
) -> None:
    """Go to a point of the plane, straight or about a centre; an arc that ends where it begins goes all around."""
    start = control.modal.plane.point(control.motion.programmed)
    if center is None:
        target = list(control.motion.programmed)
        control.modal.plane.aim(target, point)
        target[control.modal.plane.axes[2]] = height
        control.line_to(target, rapid=False)
    elif lead.kind is LeadKind.ARC or distance(start, point) > SAME_POINT:
        turn(control, center, point, sweep_between(start, point, center, lead.clockwise), height)


def _stand(control: Control, programmed: list[float]) -> None:
    control.motion.programmed = programmed
    control.motion.part = control.frame.to_part(programmed)
