"""APPR and DEP: what leads to a contour and away from it, as the tool's centre goes.

The way to a contour is made when its first element is known: LT goes on along it, LN comes square to it, CT and
LCT come on an arc that touches it. R is the radius of the centre's path; positive it turns RL counter-clockwise
and RR clockwise (manual). The auxiliary point is reached in the working plane first, then in the tool axis, and
at the feed that was in force before the block, FMAX included, except that of LCT (manual).
"""

import dataclasses
import math

from twin.nc.control.codes import Interpolation, StatementAction
from twin.nc.control.compensation import compensate
from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.memory import memory_of
from twin.nc.dialects.heidenhain.paths import (
    LINE,
    circle_plane,
    polar_target,
)
from twin.nc.dialects.heidenhain.sides import SIDES
from twin.nc.dialects.heidenhain.tools import compensation_radius
from twin.nc.geometry.arcs import SAME_POINT, Point, distance, sweep_between, turned
from twin.nc.path.move_columns import Segment
from twin.nc.path.segments import direction_of
from twin.nc.text.blocks import Block, Statement, Word


@dataclasses.dataclass(frozen=True, slots=True)
class Lead:
    """A lead as it is programmed.

    Attributes:
        kind: LT, LN, CT or LCT.
        size: LEN or R [mm].
        angle: CCA [deg].
        feeds: F in force before the block and in it.
        rapid: FMAX was in force before it.
    """

    kind: str
    size: float
    angle: float
    feeds: tuple[float | None, float | None]
    rapid: bool


@dataclasses.dataclass(frozen=True, slots=True)
class Touch:
    """Where a compensated contour begins or ends, in the plane.

    Attributes:
        point: Of the tool's centre.
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


def lead_keyword(kind: str) -> StatementAction:
    """APPR or DEP with its kind, such as ``APPR PLCT``."""
    way, shape = kind.split()
    polar, shape = shape.startswith("P"), shape.removeprefix("P")

    def action(control: Control, statement: Statement) -> None:
        memory, before = memory_of(control), control.motion.feed
        perform = _approach if way == "APPR" else _depart

        def move(control: Control) -> None:
            perform(control, statement, shape, before, polar)

        words = control.block.words
        sides = [SIDES[word.address] for word in words if word.address in SIDES]
        if way == "APPR" and memory.side == 0.0:
            memory.side = sides[0] if sides else 0.0
        others = tuple(word for word in words if word.address not in SIDES)
        control.modal.interpolation = Interpolation(move)
        control.run(control.block._replace(statement=None, words=(*others, _MOVES)))
        control.modal.interpolation = LINE
        memory.rapid = False

    return action


_MOVES = Word("DR+", math.nan, 0, 1)
"""Makes a block move that has no words which do, such as DEP LT LEN10."""


def _lead(control: Control, statement: Statement, kind: str, before: float | None) -> Lead:
    """Take LEN, R and CCA.

    Raises:
        ProgramError: One is missing or wrong.
    """
    control.take("DR+")
    address = "LEN" if kind in ("LT", "LN") else "R"
    word, angle = control.take(address), control.take("CCA")
    size = control.length(word)
    if size == 0.0 or (size < 0.0 and kind == "LCT"):
        message = f"{statement.keyword} needs {address}" + (" above 0" if kind == "LCT" else "")
        control.fail("contour-lead", message, statement, f"{statement.keyword} .. {address}10")
    turn = 0.0 if angle is None else control.number(angle)
    if kind == "CT" and not 0.0 < turn <= 360.0:
        control.fail("contour-lead", "the angle CCA of the arc is above 0 and up to 360", statement)
    memory = memory_of(control)
    return Lead(kind, size, turn, (before, control.motion.feed), memory.was_rapid)


def _take_target(control: Control, polar: bool) -> list[float]:
    if not polar:
        return control.target()
    with circle_plane(control) as pole:
        return polar_target(control, pole)


# --- to the contour


def _approach(
    control: Control, statement: Statement, kind: str, before: float | None, polar: bool
) -> None:
    """The next move begins at the block's point; before it the tool comes there."""
    lead, memory, block = _lead(control, statement, kind, before), memory_of(control), control.block
    side = memory.side
    start = list(control.motion.programmed)
    radius = compensation_radius(control) if side else 0.0
    if control.path.compensation.in_force or control.path.leads is not None:
        message = f"{statement.keyword} begins a contour, and one has begun already"
        control.fail("contour-lead", message, statement, "end it by DEP or R0 before")
    contour = _take_target(control, polar)

    control.path.leads = _Approach(control, block, start, contour, lead, side, radius)
    control.motion.programmed, control.motion.part = contour, control.frame.to_part(contour)


@dataclasses.dataclass(slots=True)
class _Approach:
    """Waits for the first move of the contour; a control that is copied takes it along, as it could no closure."""

    control: Control
    block: Block
    start: list[float]
    contour: list[float]
    lead: Lead
    side: float
    radius: float

    def __call__(self, move: Segment) -> None:
        _come(
            self.control, self.block, self.start, self.contour, self.lead, move, self.side, self.radius
        )  # fmt: skip


def _come(
    control: Control,
    block: Block,
    start: list[float],
    contour: list[float],
    lead: Lead,
    move: Segment,
    side: float,
    radius: float,
) -> None:
    """Make the approach, now that the first move of the contour is known."""
    plane, feed, here = control.modal.plane, control.motion.feed, control.block
    ahead = plane.point(control.frame.unturn(direction_of(move, at_end=False)))
    if ahead == (0.0, 0.0):
        control.fail("contour-lead", "the contour must begin with a move in the working plane")
    touch = _touch(plane.point(contour), ahead, side, radius / memory_of(control).scale)
    control.block = block
    _stand(control, start)
    control.report.line = block.line
    arc_center, begin = _auxiliary(control, touch, lead, side, plane.point(start), arrives=True)
    rapid = lead.rapid and lead.kind != "LCT"
    control.motion.feed = lead.feeds[0] if lead.kind != "LCT" else lead.feeds[1]
    target = list(start)
    plane.aim(target, begin)
    control.line_to(target, rapid=rapid)
    target = list(contour)
    plane.aim(target, begin)
    control.line_to(target, rapid=rapid)
    control.motion.feed = lead.feeds[1]
    _go(control, touch.point, arc_center, _clockwise(lead, side), whole=lead.kind == "CT")
    if side:
        compensate(control, side, radius, led=True)
    control.motion.feed, control.block, control.report.line = feed, here, here.line
    control.motion.programmed, control.motion.part = contour, control.frame.to_part(contour)


def _touch(point: Point, ahead: Point, side: float, radius: float) -> Touch:
    size = math.hypot(*ahead)
    along = (ahead[0] / size, ahead[1] / size)
    sense = side or 1.0
    aside = (-along[1] * sense, along[0] * sense)
    center = (point[0] + radius * aside[0], point[1] + radius * aside[1])
    return Touch(center, along, aside)


def _clockwise(lead: Lead, side: float) -> bool:
    """Which way an arc turns; without compensation as with RL."""
    return (lead.size < 0.0) is (side >= 0.0)


def _auxiliary(
    control: Control, touch: Touch, lead: Lead, side: float, other: Point, *, arrives: bool
) -> tuple[Point | None, Point]:
    """Centre of the lead's arc, if it has one, and its auxiliary point.

    Args:
        control: The control.
        touch: Where the contour begins or ends.
        lead: What is programmed.
        side: Of compensation.
        other: Where a lead LCT comes from or goes to.
        arrives: It leads to the contour.
    """
    outwards = -1.0 if arrives else 1.0
    if lead.kind == "LT":
        return None, touch.at(outwards * lead.size, 0.0)
    if lead.kind == "LN":
        return None, touch.at(0.0, lead.size)
    center = touch.at(0.0, lead.size)
    turn = -1.0 if _clockwise(lead, side) else 1.0
    if lead.kind == "CT":
        return center, turned(touch.point, center, outwards * turn * lead.angle)
    far = distance(other, center)
    if far <= lead.size:
        message = f"the point {far:.3f} mm from the centre of the arc lies within its radius R"
        control.fail("contour-lead", message, hint="write a smaller R")
    base = math.atan2(other[1] - center[1], other[0] - center[0])
    angle = base - outwards * turn * math.acos(lead.size / far)
    x, y = lead.size * math.cos(angle), lead.size * math.sin(angle)
    return center, (center[0] + x, center[1] + y)


def _go(
    control: Control, point: Point, center: Point | None, clockwise: bool, *, whole: bool = False
) -> None:
    """Go to a point of the plane, straight or about a centre; ``whole``: all around to where it stands."""
    plane, target = control.modal.plane, list(control.motion.programmed)
    start = plane.point(target)
    plane.aim(target, point)
    if center is None:
        control.line_to(target, rapid=False)
    elif whole or distance(start, point) > SAME_POINT:
        sweep = sweep_between(start, point, center, clockwise)
        control.arc_to(target, center, sweep)


def _stand(control: Control, programmed: list[float]) -> None:
    control.motion.programmed, control.motion.part = programmed, control.frame.to_part(programmed)


# --- from the contour


def _depart(
    control: Control, statement: Statement, kind: str, before: float | None, polar: bool
) -> None:
    """The contour ends where the tool stands; it leaves, and compensation has ended."""
    memory, plane = memory_of(control), control.modal.plane
    lead, side = _lead(control, statement, kind, before), memory.side
    behind = control.motion.direction
    ahead = (0.0, 0.0) if behind is None else plane.point(behind)
    if ahead == (0.0, 0.0) or control.path.leads is not None:
        message = f"{statement.keyword} leaves a contour, and no move in the plane has ended it"
        control.fail("contour-lead", message, statement)
    end = list(control.motion.programmed)
    target = _take_target(control, polar)
    control.path.end_compensation(led=True)
    memory.side = 0.0
    control.motion.part = list(control.path.position) if side else control.motion.part
    control.motion.reframed()
    radius = compensation_radius(control) / memory.scale if side else 0.0
    touch = _touch(plane.point(end), ahead, side, radius)
    touch = dataclasses.replace(touch, point=plane.point(control.motion.programmed))
    center, auxiliary = _auxiliary(control, touch, lead, side, plane.point(target), arrives=False)
    _go(control, auxiliary, center, _clockwise(lead, side), whole=kind == "CT")
    if kind == "LCT":
        _go(control, plane.point(target), None, clockwise=False)
    there = list(control.motion.programmed)
    there[2:] = target[2:] if plane.axes[2] == 2 else there[2:]
    control.line_to(there, rapid=False)
