"""Tool radius compensation: the path that keeps the tool's edge on the programmed contour.

It looks one move ahead. Outside corners are rolled around on an arc about the corner, inside
corners end where the parallel paths meet, the straight lead-in ends square to the first element of
the contour and the straight lead-out starts square to its last; indirect leads go around the
contour's first and last point where the straight way would cut them off. What does not fit is refused: an
inside arc smaller than the tool, an element that its neighbours leave no room for, or a neck of the
contour that is narrower than the tool. A lead-in or lead-out that cuts into the contour is driven,
as controls do, with a warning.
"""

import collections
import dataclasses
from collections.abc import Callable
from typing import NoReturn

from twin.nc.canonical import Corner
from twin.nc.geometry.arcs import SAME_POINT, Point, distance
from twin.nc.geometry.corners import corner_of
from twin.nc.geometry.elements import Element, crossing, turn_between
from twin.nc.geometry.planes import Plane
from twin.nc.path.compensation_state import NECK, CompensationState, PassedElement, Stage
from twin.nc.path.leads import LeadOut, around, lead_depth
from twin.nc.path.move_columns import NAN, Segment
from twin.nc.path.segments import element_of, level_arc

Emit = Callable[[Segment], None]
Refuse = Callable[[Segment, str, str], NoReturn]
"""Told the segment, the code and the message; raises."""
Warn = Callable[[Segment, str, str], None]
"""Told of the segment, the code and the message of a warning."""


@dataclasses.dataclass(slots=True)
class _WaitingMove:
    """A move that waits for its successor.

    Attributes:
        move: As programmed.
        element: Its parallel in the plane; None for the lead-in, whose end is not known yet.
        contour: Itself in the plane.
        start: Where the compensated path has come to in the plane.
        waiting: What happens at its end: events, and moves along the plane's normal.
    """

    move: Segment
    contour: Element
    element: Element | None
    start: Point
    waiting: list[Callable[[], None] | Segment]


class Compensation:
    """Compensation in force, from G41 or G42 to G40.

    Attributes:
        plane: In part coordinates.
    """

    def __init__(
        self,
        plane: Plane,
        side: float,
        radius: float,
        emit: Emit,
        refuse: Refuse,
        warn: Warn,
        *,
        square: bool = False,
        indirect: bool = False,
    ) -> None:
        self._square = square
        self._indirect = indirect
        self._warn = warn
        self._gouge_history: collections.deque[PassedElement] = collections.deque(maxlen=NECK)
        self.plane = plane
        self._signed_offset = side * radius
        self._emit = emit
        self._refuse = refuse
        self._lookahead: _WaitingMove | None = None
        self._here: list[float] = []

    def add(self, move: Segment) -> None:
        """The next move of the contour."""
        start, end = self.plane.local(move.start), self.plane.local(move.end)
        if move.center is None and distance(start[:2], end[:2]) < SAME_POINT:
            self._pass(move)
            return
        contour = self._element(move)
        if self._lookahead is None:
            if move.center is not None:
                self._refuse(move, "compensation-start", "compensation must start on a line")
            self._lookahead = _WaitingMove(move, contour, None, start[:2], [])
            return
        element = self._parallel(move, contour)
        at = self._join(self._lookahead, contour, element, move)
        self._lookahead = _WaitingMove(move, contour, element, at, [])

    def event(self, event: Callable[[], None]) -> None:
        """Something that happens where the path has come to."""
        if self._lookahead is None:
            event()
        else:
            self._lookahead.waiting.append(event)

    @property
    def waits(self) -> bool:
        """Something waits for the end of the held move."""
        return self._lookahead is not None and bool(self._lookahead.waiting)

    @property
    def begun(self) -> bool:
        """A move of the contour has come."""
        return self._lookahead is not None

    @property
    def state(self) -> CompensationState:
        """How far it has come, where nothing waits."""
        held, stage = self._lookahead, Stage.STARTED
        if held is not None:
            stage = Stage.LEADING_IN if held.element is None else Stage.FOLLOWING
        return CompensationState(
            stage,
            self.plane,
            self._signed_offset,
            self._square,
            self._indirect,
            None if held is None else held.move,
            None if held is None else held.contour,
            None if held is None else held.element,
            (0.0, 0.0) if held is None else held.start,
            self._here,
            list(self._gouge_history),
        )

    def resume(self, state: CompensationState) -> None:
        """Go on as if it had come as far as this."""
        self._here = state.here
        self._gouge_history.extend(state.gouge_history)
        if state.move is not None and state.contour is not None:
            self._lookahead = _WaitingMove(
                state.move, state.contour, state.element, state.start, []
            )

    def wait(self, move: Segment) -> None:
        """A move along the plane's normal at the end of the held one."""
        assert self._lookahead is not None
        self._lookahead.waiting.append(move)

    def finish(self) -> LeadOut | None:
        """G40: what is held ends square to itself.

        Returns:
            What the path now stands beside, so that a line must lead out; None on the contour.
        """
        held, self._lookahead = self._lookahead, None
        if held is None:
            return None
        self._end(held, held.contour.end if held.element is None else held.element.end)
        return (
            LeadOut(self.plane, held.contour, self._signed_offset, self._indirect)
            if held.element
            else None
        )

    def _out(self, move: Segment) -> None:
        self._here = move.end
        self._emit(move)

    def _pass(self, move: Segment) -> None:
        self._gouge_history.clear()
        if self._lookahead is None:
            self._out(move)
        else:
            self._lookahead.waiting.append(move)

    def _element(self, move: Segment) -> Element:
        element = element_of(move, self.plane)
        if element is None:
            message = "an arc outside the compensated plane cannot be compensated"
            self._refuse(move, "compensation-plane", message)
        return element

    def _parallel(self, move: Segment, contour: Element) -> Element:
        element = contour.parallel(self._signed_offset)
        if element is None:
            self._refuse(
                move,
                "compensation-radius",
                f"the tool's radius {abs(self._signed_offset):g} does not fit into the arc of radius "
                f"{contour.radius:.4f}",
            )
        return element

    def _join(self, held: _WaitingMove, contour: Element, element: Element, move: Segment) -> Point:
        """End the held move, go around the corner; return where the next one starts."""
        if held.element is None:
            self._lead_in(held, contour, element)
            return element.start
        turn = turn_between(held.contour, contour)
        fits, rolls, at, begin = corner_of(
            (held.contour.curve, held.element.curve, held.start),
            (contour.curve, element.curve),
            turn,
            self._signed_offset,
            self._square,
        )
        if not fits:
            self._refuse(
                move,
                "compensation-gouge",
                f"the tool's radius {abs(self._signed_offset):g} does not fit into the inside corner: "
                "it would cut into the contour before or after",
            )
        self._end(held, at)
        if rolls:
            self._roll(held, contour.start, element.start, turn)
        return begin

    def _lead_in(self, held: _WaitingMove, contour: Element, element: Element) -> None:
        arc = None
        if self._indirect:
            arc = around(held.start, element.start, contour.start, self._signed_offset)
        touch = element.start if arc is None else arc.start
        depth = lead_depth(Element(held.start, touch), contour, abs(self._signed_offset))
        if depth:
            message = f"on its way to the contour the tool cuts {depth:.3f} mm into it"
            self._warn(held.move, "compensation-lead", message)
        self._end(held, touch)
        if arc is not None:
            self._turn(held.move, arc)

    def _roll(self, held: _WaitingMove, corner: Point, end: Point, turn: float) -> None:
        sweep = abs(turn) if self._signed_offset < 0.0 else -abs(turn)
        assert held.element is not None
        arc = Element(held.element.end, end, corner, sweep)
        self._pass_by(arc, None, held.move)
        self._turn(held.move, arc)

    def _turn(self, move: Segment, arc: Element) -> None:
        """Go around a corner where the path has come to."""
        arc_move = level_arc(move, self.plane, arc, self._here)
        self._out(dataclasses.replace(arc_move, corner=Corner.EXACT_PATH))

    def _end(self, held: _WaitingMove, at: Point) -> None:
        """Emit the held move up to a point in the plane, then what waits for its end."""
        move, plane = held.move, self.plane
        end = plane.world(*at, plane.local(move.end).height)
        sweep, center, normal = move.sweep, move.center, move.normal
        if held.element is not None:
            self._pass_by(held.element.cut(held.start, at), held.contour, move)
        if held.element is not None and held.element.center is not None:
            sweep = held.element.cut(held.start, at).sweep
            normal = plane.normal
            center = plane.world(*held.element.center, plane.local(move.start).height)
        self._out(
            dataclasses.replace(
                move,
                start=self._here or move.start,
                end=[*end, *move.end[3:]],
                center=center,
                normal=normal if center is not None else (NAN, NAN, NAN),
                sweep=sweep,
            )
        )
        for each in held.waiting:
            if isinstance(each, Segment):
                last = plane.local(each.end).height
                self._out(
                    dataclasses.replace(
                        each,
                        start=self._here,
                        end=[*plane.world(*at, last), *each.end[3:]],
                    )
                )
            else:
                each()

    def _pass_by(self, element: Element, contour: Element | None, move: Segment) -> None:
        """Refuse an element that crosses an earlier one, unless the contour crosses itself there."""
        passed, box = self._gouge_history, element.box
        left, low, right, high = box
        for index, older in enumerate(passed):
            from_x, from_y, to_x, to_y = older.box
            if from_x > right or to_x < left or from_y > high or to_y < low:
                continue
            if crossing(older.element, element) is None:
                continue
            near = list(passed)[max(0, index - 2) : index + 3]
            here = [contour, *(each.contour for each in list(passed)[-2:])]
            if any(
                _cross(each.contour, other) for each in near for other in here if other is not None
            ):
                continue
            self._refuse(
                move,
                "compensation-gouge",
                f"the tool's radius {abs(self._signed_offset):g} does not fit between this element and "
                f"that of line {older.line}: the path crosses itself",
            )
        passed.append(PassedElement(element, contour, move.line, box))


def _cross(first: Element | None, second: Element) -> bool:
    return first is not None and crossing(first, second) is not None
