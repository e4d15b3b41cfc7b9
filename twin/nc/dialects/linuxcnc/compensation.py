"""Tool radius compensation of LinuxCNC: its own leads and corners.

The entry ends beside the programmed point, square to the entry itself. At a convex corner the tool
turns around the contour's point; at a concave one the move before ends where the two offset paths meet,
for which it is kept until its successor is known. Behind G40 a straight move leads out of where it is.
"""

import dataclasses
import math
from collections.abc import Callable
from typing import NoReturn

from twin.nc.canonical import Event
from twin.nc.control.codes import Action
from twin.nc.control.compensation import tool_numbered
from twin.nc.control.control import Control
from twin.nc.dialects.linuxcnc import offset_paths
from twin.nc.dialects.linuxcnc.memory import memory_of
from twin.nc.dialects.linuxcnc.offset_paths import QUARTER, OffsetArc, along, swept_angle
from twin.nc.geometry.arcs import Point, distance, sweep_between
from twin.nc.geometry.planes import YZ
from twin.nc.path.path import holds_none
from twin.nc.text.blocks import Block

CORNER = 0.05
"""Angle [rad] from which a corner counts as one (``rs274``)."""
_SAME = 1e-4
_TURNED_BACK, _TURNED_BACK_INCH = 0.0254, 0.001
"""How much further an arc may sweep when its end is moved [rad]: with G20 less (``rs274``)."""
_MISMATCH = 0.01
"""How far a moved end may lie beside its arc [mm]."""


@dataclasses.dataclass(slots=True)
class Held:
    """A move that waits for its successor.

    Attributes:
        goal: Programmed position of its end, shape (k,); its place in the plane is ``end``.
        end: Where it ends in the plane, compensated [mm].
        direction: Where it was going as programmed [mm]; of a line.
        center: Of an arc [mm], or None.
        turns: Of an arc, below 0 clockwise.
        sweep: How far the arc went as programmed [rad]; 0: its end is not moved.
        feed: F when it was given.
    """

    goal: list[float]
    end: Point
    rapid: bool
    direction: Point
    center: Point | None
    turns: int
    sweep: float
    block: Block
    feed: float | None


class ActiveCompensation:
    """Compensation in force.

    Attributes:
        side: 1 left of the contour, -1 right.
        radius: Of the tool [mm].
        entered: The first move has been made.
    """

    def __init__(self, control: Control, side: float, radius: float) -> None:
        self._control = control
        self.side = side
        self.radius = radius
        self.entered = False
        self.plane = control.modal.plane
        self._queue: list[Held | Event] = []
        self._here: Point = (0.0, 0.0)
        self._endpoint: Point | None = None

    # --- moves that the program asks for

    def line(self, goal: list[float], *, rapid: bool) -> None:
        """A straight move to a programmed position."""
        plane = self._control.modal.plane
        start, end = plane.point(self._control.motion.programmed), plane.point(goal)
        if not self.entered:
            self._enter_by_line(start, end, goal, rapid=rapid)
        elif start == end:
            self._hold(goal, self._here, rapid=rapid)
        else:
            self._line_behind(start, end, goal, rapid=rapid)
        self._control.motion.programmed = goal

    def arc(self, goal: list[float], center: Point, turns: int) -> None:
        """An arc to a programmed position; ``turns`` below 0: clockwise."""
        plane = self._control.modal.plane
        start, end = plane.point(self._control.motion.programmed), plane.point(goal)
        radius = distance(center, end)
        inside = self._is_inside(turns)
        if inside and radius <= self.radius:
            self._refuse("the arc's radius must exceed the tool's, which runs inside it")
        outward = math.atan2(end[1] - center[1], end[0] - center[0])
        beside = along(end, outward + math.pi if inside else outward, self.radius)
        if self.entered:
            self._arc_behind((start, end, beside), goal, center, turns)
        else:
            self._enter_by_arc((start, end, beside), goal, center, turns)
        self._here = beside
        self._control.motion.programmed = goal

    def take_event(self, event: Event) -> bool:
        """Keep what happens behind a move that waits; False where none does."""
        if self._queue:
            self._queue.append(event)
        return bool(self._queue)

    def end(self) -> None:
        """G40, or the program's end: what waits ends beside the contour's last point."""
        if self.entered:
            self._move_ends(self._here)
        self._let_go()

    # --- the first move

    def _enter_by_line(self, start: Point, end: Point, goal: list[float], *, rapid: bool) -> None:
        if distance(start, end) <= self.radius:
            self._refuse("the entry must be longer than the tool's radius")
        aside = math.atan2(end[1] - start[1], end[0] - start[0]) + self.side * QUARTER
        self._endpoint = start
        beside = along(end, aside, self.radius)
        self._hold(goal, beside, direction=(math.cos(aside), math.sin(aside)), rapid=rapid)
        self.entered = True

    def _enter_by_arc(
        self, points: tuple[Point, Point, Point], goal: list[float], center: Point, turns: int
    ) -> None:
        """An arc from the uncompensated start that ends beside the programmed end, as the contour goes."""
        start, end, beside = points
        if distance(start, end) <= self.radius:
            self._refuse("the entry must be longer than the tool's radius")
        inward = math.atan2(center[1] - beside[1], center[0] - beside[0])
        corner = math.atan2(start[1] - beside[1], start[0] - beside[0]) - inward
        if abs(math.cos(corner)) < _SAME:
            self._refuse("no arc leads from here beside its end")
        away = distance(start, beside) / 2.0 / math.cos(corner)
        moved = along(beside, inward, away)
        self._hold(goal, beside, arc=(moved, turns, swept_angle(start, beside, moved, turns)))
        self.entered = True

    # --- moves behind others

    def _line_behind(self, start: Point, end: Point, goal: list[float], *, rapid: bool) -> None:
        radius, side = self.radius, self.side
        before = math.atan2(self._here[1] - start[1], self._here[0] - start[0])
        heading = math.atan2(end[1] - start[1], end[0] - start[0])
        turn = (before - heading) if side > 0.0 else (heading - before)
        turn = turn % (2.0 * math.pi) - QUARTER
        aside = heading + side * QUARTER
        beside, middle = along(end, aside, radius), along(start, aside, radius)
        held = self._held
        held_arc = held.center is not None
        concave = turn < -CORNER or turn > math.pi + CORNER
        if turn > math.pi - CORNER and held_arc and not self._is_inside(held.turns):
            concave = True
        if concave and held_arc:
            self._meet(
                lambda: offset_paths.arc_meets_line(self._path_of(held), radius, start, heading)
            )
        elif concave:
            half = (turn + math.pi) / 2.0
            if math.tan(half) == 0.0:
                self._refuse("the contour turns back on itself")
            back = radius / math.tan(half)
            self._move_ends(along(self._here, before + side * QUARTER, back))
        elif turn > CORNER:
            self._move_ends(self._here)
            self._turn_around(start, middle, rapid=rapid)
        else:
            self._let_go()
            self._endpoint = self._here
        direction = (end[0] - start[0], end[1] - start[1])
        self._hold(goal, beside, direction=direction, rapid=rapid)

    def _arc_behind(
        self, points: tuple[Point, Point, Point], goal: list[float], center: Point, turns: int
    ) -> None:
        start, end, beside = points
        inside = self._is_inside(turns)
        before = math.atan2(self._here[1] - start[1], self._here[0] - start[0])
        before -= self.side * QUARTER
        inward = math.atan2(center[1] - start[1], center[0] - start[0])
        heading = inward - QUARTER if turns > 0 else inward + QUARTER
        turn = (before - heading) if self.side > 0.0 else (heading - before)
        turn = (turn + QUARTER) % (2.0 * math.pi) - QUARTER
        concave = turn < -CORNER or turn > math.pi + CORNER
        if abs(turn - math.pi) < CORNER and not inside:
            concave = True
        if concave:
            held, radius = self._held, distance(center, end)
            new = radius - self.radius if inside else radius + self.radius
            arc = OffsetArc(center, new, inside, turns > 0)
            if held.center is None:
                self._meet(
                    lambda: offset_paths.line_meets_arc(before, turn, arc, self.radius, radius)
                )
            else:
                self._meet(lambda: offset_paths.arc_meets_arc(self._path_of(held), arc))
        elif turn > CORNER:
            aside = inward if inside else inward + math.pi
            self._let_go()  # before an arc nothing asks whether the moves went back (``rs274``)
            self._turn_around(start, along(start, aside, self.radius), rapid=False)
        else:
            self._let_go()
            self._endpoint = self._here
        self._hold(goal, beside, arc=(center, turns, swept_angle(start, end, center, turns)))

    def _turn_around(self, point: Point, middle: Point, *, rapid: bool) -> None:
        """Turn around a convex corner of the contour."""
        control = self._control
        goal = self._place(control.motion.programmed, middle)
        if rapid:
            self._hold(goal, middle, rapid=True)
        else:
            self._hold(goal, middle, arc=(point, -1 if self.side > 0.0 else 1, 0.0))
        self._let_go()
        self._endpoint = middle

    # --- the moves that wait

    def _path_of(self, held: Held) -> OffsetArc:
        """The tool's path on an arc that waits."""
        assert held.center is not None
        radius = distance(held.center, held.end)
        return OffsetArc(held.center, radius, self._is_inside(held.turns), held.turns > 0)

    def _meet(self, place: Callable[[], Point]) -> None:
        """All moves that wait end where the next one's path begins, which says why it cannot."""
        try:
            meeting = place()
        except ValueError as error:
            self._refuse(str(error))
        self._move_ends(meeting)

    @property
    def _held(self) -> Held:
        """The move that waits for its successor."""
        return next(each for each in self._queue if isinstance(each, Held))

    def _is_inside(self, turns: int) -> bool:
        """The tool runs on the inner side of an arc."""
        return (self.side > 0.0) == (turns > 0)

    def _hold(
        self,
        goal: list[float],
        end: Point,
        *,
        rapid: bool = False,
        direction: Point = (0.0, 0.0),
        arc: tuple[Point | None, int, float] = (None, 0, 0.0),
    ) -> None:
        """Keep a move until its successor is known: a line, or an arc by its centre, turns and sweep."""
        control = self._control
        held = Held(goal, end, rapid, direction, *arc, control.block, control.motion.feed)
        self._queue.append(held)
        self._here = end

    def _move_ends(self, end: Point) -> None:
        """All moves that wait end there; they are let go."""
        for held in self._queue:
            if isinstance(held, Held):
                if not self._may_end(held, end):
                    self._refuse("the tool does not reach into this concave corner", held)
                held.end = end
        self._let_go()
        self._endpoint = end

    def _may_end(self, held: Held, end: Point) -> bool:
        start = self._endpoint
        if held.center is None:
            x, y = held.direction
            return start is None or x * (end[0] - start[0]) + y * (end[1] - start[1]) >= 0.0
        if abs(distance(held.center, held.end) - distance(held.center, end)) > _MISMATCH:
            return False
        if not held.sweep or start is None:
            return True
        more = _TURNED_BACK if self._control.modal.unit == 1.0 else _TURNED_BACK_INCH
        return abs(swept_angle(start, end, held.center, held.turns)) <= abs(held.sweep) + more

    def _let_go(self) -> None:
        """Make the moves that wait."""
        queue, self._queue = self._queue, []
        self._endpoint = None
        control = self._control
        block, feed, programmed = control.block, control.motion.feed, control.motion.programmed
        for each in queue:
            if isinstance(each, Held):
                control.block, control.motion.feed = each.block, each.feed
                self._make(each)
            else:
                control.path.event(each)
        control.block, control.motion.feed, control.motion.programmed = block, feed, programmed

    def _make(self, held: Held) -> None:
        control = self._control
        goal = self._place(held.goal, held.end)
        if held.center is None:
            control.line_to(goal, rapid=held.rapid)
            return
        control.motion.programmed = control.frame.to_programmed(control.motion.part)
        here = control.modal.plane.local(control.motion.programmed)
        clockwise = held.turns < 0
        sweep = sweep_between(here[:2], held.end, held.center, clockwise=clockwise)
        sweep += 360.0 * (held.turns + 1 if clockwise else held.turns - 1)
        control.arc_to(goal, held.center, sweep)

    def _place(self, goal: list[float], end: Point) -> list[float]:
        """A programmed position moved to another place in the plane."""
        plane, moved = self._control.modal.plane, list(goal)
        moved[:3] = plane.world(*end, plane.local(goal).height)
        return moved

    def _refuse(self, message: str, held: Held | None = None) -> NoReturn:
        hint = f"the tool's radius is {self.radius:g} mm: a smaller one fits, or a longer move"
        if held is not None:
            self._control.report.line = held.block.line
            word = held.block.words[0] if held.block.words else None
            span = (0, 1) if word is None else (word.column, word.width)
            self._control.report.fail("compensation-gouge", message, *span, hint)
        self._control.fail("compensation-gouge", message, hint=hint)


def in_force(control: Control) -> ActiveCompensation | None:
    """Compensation, where it is in force."""
    compensation = memory_of(control).compensation
    assert compensation is None or isinstance(compensation, ActiveCompensation)
    return compensation


def begin_by_table(side: float) -> Action:
    """G41, G42: the radius of tool D, else of the tool in the spindle."""

    def action(control: Control) -> None:
        word = control.take("D")
        _begin_allowed(control)
        if word is not None and control.number(word) != 0.0:
            data = control.tools.data(tool_numbered(control, word))
        else:
            data = None if word is not None else control.tools.data(control.tools.spindle)
        _begin(control, side, 0.0 if data is None else data.radius)

    return action


def begin_by_diameter(side: float) -> Action:
    """G41.1, G42.1: D is the tool's diameter."""

    def action(control: Control) -> None:
        word, orientation = control.take("D"), control.take("L")
        _begin_allowed(control)
        if word is None:
            control.fail("code-words", "the code needs D, the diameter of the tool")
        if orientation is not None and control.number(orientation) != 0.0:
            control.fail("code-words", "an orientation L belongs to lathe tools", orientation)
        _begin(control, side, control.length(word) / 2.0)

    return action


def _begin_allowed(control: Control) -> None:
    if in_force(control) is not None:
        hint = "end it by G40 before it starts on another side or with another radius"
        control.fail("compensation-change", "compensation is in force already", hint=hint)
    if control.modal.plane is YZ:
        message = "the control compensates in the planes X Y and Z X only"
        control.fail("compensation-plane", message, hint="write G17 before")


def _begin(control: Control, side: float, radius: float) -> None:
    """Decision: with a radius of 0 the contour itself is driven."""
    if radius < 0.0:
        side, radius = -side, -radius
    memory = memory_of(control)
    memory.leading_out = False
    compensation = ActiveCompensation(control, side, radius)
    memory.compensation = compensation
    control.path.defer = compensation.take_event


def end(control: Control) -> None:
    """G40, or the end of the program."""
    compensation = in_force(control)
    if compensation is not None:
        memory = memory_of(control)
        compensation.end()
        memory.leading_out = compensation.entered
        memory.compensation = None
        control.path.defer = holds_none
