"""Radius compensation: the path that keeps the tool's edge on the contour, one move after the other.

It looks one move ahead. Outside corners are rolled around on an arc about the corner, inside
corners end where the parallel paths meet, the straight lead-in ends square to the first element of
the contour and the straight lead-out starts square to its last; indirect leads go around the
contour's first and last point where the straight path would cut them off. What does not fit is refused: an
inside arc smaller than the tool, an element that its neighbours leave no room for, or a neck of the
contour that is narrower than the tool. A lead that cuts into the contour is driven with a warning.
"""

import enum
from collections.abc import Callable
from typing import NoReturn

from twin.nc.canonical import Corner, Event
from twin.nc.geometry import corners, curves
from twin.nc.geometry.arcs import SAME_POINT, Point, distance
from twin.nc.geometry.curves import Curve
from twin.nc.geometry.matrices import dot
from twin.nc.geometry.planes import (
    Directions,
    Plane,
    aim,
    point_of,
    vector_of,
)
from twin.nc.path.compensation.beside import arc_moves, driven, level_arc
from twin.nc.path.compensation.gouge import KEPT, Passed
from twin.nc.path.move_columns import Segment
from twin.nc.path.segments import IN_PLANE, MoveReport

_NO_CURVE: Curve = (False, (0.0, 0.0), (0.0, 0.0), (0.0, 0.0), 0.0)
_NO_PLANE: Directions = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


class Stage(enum.Enum):
    """What compensation waits for."""

    OFF = "its beginning"
    STARTED = "the straight move that leads in"
    LEADING_IN = "the contour's first element; the move that leads in is held"
    FOLLOWING = "the contour's next element; the last one is held"
    LEADING_OUT = "the straight move that leads out"


OFF, STARTED, LEADING_IN, FOLLOWING, LEADING_OUT = Stage


class SideChange(enum.Enum):
    """How the tool goes over to the other side of the contour."""

    EXTENDED = "where the parallels of both moves cross, else to the beginning of the second one's"
    CROSSING = (
        "where the parallels of both moves cross, else straight from the end of one to the next"
    )
    ALONG = "along the next move"


class Compensation:
    """Radius compensation of a path.

    Attributes:
        plane: In which it acts: abscissa, ordinate and normal in part coordinates.
    """

    def __init__(
        self,
        drive: Callable[[Segment], None],
        happen: Callable[[Event], None],
        report: MoveReport,
    ) -> None:
        self._drive = drive
        self._happen = happen
        self._report = report
        self.stage = OFF
        self.plane = _NO_PLANE
        self._signed_offset = 0.0
        self._next_offset: float | None = None
        self._side_change: SideChange | None = None
        """How the offset that comes next puts the tool on the other side; None: it does not."""
        self._square = self._indirect = self._led = False
        self._look_ahead = KEPT
        self._held: list[Segment] = []
        """The move that waits for its successor, and moves along the normal that wait for its end."""
        self._events: list[list[Event]] = []
        """What happens behind each of them."""
        self._contour, self._parallel = _NO_CURVE, _NO_CURVE
        """The kept move in the plane, and the path beside it; while it leads out, the contour's last element."""
        self._start: Point = (0.0, 0.0)
        """Where the compensated path of the kept move begins in the plane [mm]."""
        self._here: list[float] | None = None
        """Where the compensated path has come to, shape (k,); None: nothing has been driven."""
        self._passed = Passed()

    @property
    def in_force(self) -> bool:
        """It has begun, and not ended."""
        return self.stage not in (OFF, LEADING_OUT)

    @property
    def has_moved(self) -> bool:
        """It is in force, and a move of its contour has come."""
        return self.in_force and self.stage is not STARTED

    @property
    def signed_offset(self) -> float:
        """The radius in force, positive left of the contour [mm]."""
        return self._signed_offset if self._next_offset is None else self._next_offset

    def acts_in(self, plane: Plane) -> bool:
        """Whether it is in force in a plane of the part."""
        return self.in_force and self.plane == plane.directions

    def begin(
        self,
        plane: Directions,
        signed_offset: float,
        *,
        square: bool,
        indirect: bool,
        look_ahead: int = KEPT,
        led: bool = False,
    ) -> None:
        """Compensate from the next move on.

        Args:
            plane: Abscissa, ordinate and normal in part coordinates.
            signed_offset: The tool's radius, positive left of the contour [mm].
            square: Outside corners between lines are extended as far as 90°.
            indirect: Leads go around the contour's first and last point.
            look_ahead: Among so many elements a crossing of the path is refused; one farther apart is driven.
            led: The path has come to the compensated beginning of the contour already.
        """
        self._look_ahead = look_ahead
        self.plane, self._signed_offset = plane, signed_offset
        self._square, self._indirect, self._led = square, indirect, led
        self.stage, self._here = STARTED, None
        self._next_offset = self._side_change = None
        self._passed.clear()

    def change(self, signed_offset: float, side: SideChange | None = None) -> None:
        """Another radius, signed likewise.

        On the same side, and with ``SideChange.ALONG``, the next move leads from the one to the other; the path
        of an arc is a spiral then.
        """
        if self.stage is STARTED:
            self._signed_offset = signed_offset
        else:
            self._next_offset = signed_offset
            self._side_change = None if side is SideChange.ALONG else side

    def event(self, event: Event) -> None:
        """Something that happens where the path has come to."""
        if self.stage in (LEADING_IN, FOLLOWING):
            self._events[-1].append(event)
        else:
            self._happen(event)

    def end(self, *, led: bool = False) -> None:
        """Let go of what is kept, square to itself, and wait for the line that leads out, if nothing else does."""
        before = self._parallel if self.stage is FOLLOWING else self._contour
        if self.stage is LEADING_IN:
            self._let_go(before, before, before[2])
        elif self.stage is FOLLOWING:
            part = curves.cut(before, self._start, before[2])
            self._pass(part, self._contour)
            self._let_go(before, part, before[2])
        leads_out = self.stage in (FOLLOWING, LEADING_OUT) and not led
        self.stage = LEADING_OUT if leads_out else OFF

    def add(self, move: Segment, position: list[float]) -> None:
        """The next move; the path has come to this position, shape (k,)."""
        if self.stage is LEADING_OUT:
            self._lead_out(move, position)
            return
        plane = self.plane
        start, end = point_of(plane, vector_of(move.start)), point_of(plane, vector_of(move.end))
        if move.center is None and distance(start, end) < SAME_POINT:
            self._go_along_normal(move)
            return
        curve = (False, start, end, (0.0, 0.0), 0.0)
        if move.center is not None:
            sense = dot(move.normal, plane[2])
            if not abs(sense) >= IN_PLANE:
                message = "an arc outside the compensated plane cannot be compensated"
                self._report.refuse(move, "compensation-plane", message)
            curve = (True, start, end, point_of(plane, move.center), move.sweep * sense)
        if self.stage is STARTED and not self._led:
            self._take_lead(move, curve)
            return
        if self._side_change is not None and self._next_offset is not None:
            self._change_side(move, curve, self._next_offset, self._side_change)
            return
        element = self._parallel_of(move, curve, self._signed_offset)
        if self.stage is STARTED:
            self._here = position
            self._hold(move, curve, element[1])
            self._parallel, self.stage = element, FOLLOWING
        elif self.stage is LEADING_IN:
            self._lead_in(move, curve, element)
        else:
            self._go_on(move, curve, element)
        if self._next_offset is not None:
            self._take_next_offset(move, curve, self._next_offset)

    def _take_next_offset(self, move: Segment, curve: Curve, offset: float) -> None:
        """The kept move ends beside the contour by another radius than it began with."""
        self._parallel = self._parallel_of(move, curve, offset)
        if offset * self._signed_offset < 0.0:
            self._passed.clear()
        self._signed_offset, self._next_offset = offset, None

    def _change_side(self, move: Segment, curve: Curve, offset: float, change: SideChange) -> None:
        """The contour's next element, along which the tool goes on the other side."""
        if self.stage is not FOLLOWING:
            message = "the side cannot change in the move behind the one that leads in"
            self._report.refuse(move, "compensation-change", message)
        held, before, element = (
            self._contour,
            self._parallel,
            self._parallel_of(move, curve, offset),
        )
        extended = change is SideChange.EXTENDED
        crossing = corners.side_change(
            (held, before, self._start), (curve, element), extended=extended
        )
        at = crossing or (element[1] if extended else before[2])
        around = self._held[0]
        self._let_go(before, curves.cut(before, self._start, at), at)
        if at != element[1] and crossing is None:
            self._go_straight(around, element[1])
        self._passed.clear()
        self._signed_offset, self._next_offset, self._side_change = offset, None, None
        self._hold(move, curve, crossing or element[1])
        self._parallel = element

    def _parallel_of(self, move: Segment, curve: Curve, offset: float) -> Curve:
        if not curves.leaves_room(curve, offset):
            where = f"into the arc of radius {curves.radius_of(curve):.4f}"
            self._refuse_radius(move, "compensation-radius", where)
        return curves.parallel_of(curve, offset)

    # --- from move to move

    def _go_along_normal(self, move: Segment) -> None:
        """A move that does not go in the plane: at once before the lead-in, else behind the kept move."""
        if self.stage is STARTED and self._led:
            message = "the contour must begin behind its approach with a move in the plane"
            self._report.refuse(move, "compensation-start", message)
        if self.stage is STARTED:
            self._here = move.end
            self._drive(move)
            return
        self._held.append(move)
        self._events.append([])
        self._passed.clear()

    def _go_on(self, move: Segment, curve: Curve, element: Curve) -> None:
        """The contour's next element, with its parallel."""
        held, before, offset = self._contour, self._parallel, self._signed_offset
        turn = curves.turn_from(held, curve)
        fits, rolls, at, follows = corners.corner_of(
            (held, before, self._start), (curve, element), turn, offset, self._square
        )
        if not fits:
            self._refuse_radius(
                move,
                "compensation-gouge",
                "into the inside corner: it would cut into the contour before or after",
            )
        part = curves.cut(before, self._start, at)
        self._pass(part, held)
        sweep = abs(turn) if offset < 0.0 else -abs(turn)
        corner = (True, before[2], element[1], curve[1], sweep)
        if rolls:
            self._pass(corner, None)
        around = self._held[0]
        self._let_go(before, part, at)
        if rolls:
            self._go_around(around, corner)
        self._hold(move, curve, follows)
        self._parallel = element

    def _hold(self, move: Segment, curve: Curve, start: Point) -> None:
        """Hold a move until its successor is known; its compensated path begins at a point."""
        self._held, self._events = [move], [[]]
        self._contour, self._start = curve, start

    def _let_go(self, before: Curve, part: Curve, at: Point) -> None:
        """Drive the kept move up to a point on what is left of its parallel, then what waits for its end."""
        plane, here = self.plane, self._here
        for number, (move, events) in enumerate(zip(self._held, self._events, strict=True)):
            start, end = move.start if here is None else here, list(move.end)
            aim(plane, at, end)
            here = end
            if number == 0 and before[0]:
                for piece in arc_moves(move, plane, part, start, end):
                    self._drive(piece)
            elif start != end:
                self._drive(driven(move, start, end, move.center, move.normal, move.sweep))
            for event in events:
                self._happen(event)
        self._here = here
        self._held, self._events = [], []

    def _go_straight(self, move: Segment, at: Point) -> None:
        """Go straight to a point in the plane, as a kept move goes."""
        assert self._here is not None
        end = list(self._here)
        aim(self.plane, at, end)
        self._drive(driven(move, self._here, end, None, move.normal, move.sweep))
        self._here = end

    def _go_around(self, move: Segment, corner: Curve) -> None:
        """Go around a corner where the path has come to, as a kept move goes."""
        assert self._here is not None
        arc = level_arc(move, self.plane, corner, self._here)
        arc.corner = Corner.EXACT_PATH
        self._here = arc.end
        self._drive(arc)

    # --- leads

    def _take_lead(self, move: Segment, curve: Curve) -> None:
        """Hold the straight move that leads in."""
        if curve[0]:
            self._report.refuse(move, "compensation-start", "compensation must start on a line")
        if self._here is None:
            self._here = move.start
        self._hold(move, curve, curve[1])
        self.stage = LEADING_IN

    def _lead_in(self, move: Segment, curve: Curve, element: Curve) -> None:
        """Lead in to the contour's first element, and hold that."""
        touch, turns, arc, held = element[1], False, curve, self._held[0]
        if self._indirect:
            turns, arc = corners.around_corner(
                self._start, element[1], curve[1], self._signed_offset
            )
            if turns:
                touch = arc[1]
        lead = (False, self._start, touch, (0.0, 0.0), 0.0)
        self._warn_of_cut(held, "to", lead, curve)
        self._let_go(lead, lead, touch)
        if turns:
            self._go_around(held, arc)
        self._hold(move, curve, element[1])
        self._parallel, self.stage = element, FOLLOWING

    def _lead_out(self, move: Segment, stand: list[float]) -> None:
        """The first line in the plane leads out; until then only the normal and other axes move."""
        if move.center is not None:
            self._report.refuse(move, "compensation-end", "compensation must end on a line")
        plane, contour = self.plane, self._contour
        here = point_of(plane, vector_of(stand))
        start, end = point_of(plane, vector_of(move.start)), point_of(plane, vector_of(move.end))
        leads, turns, arc = distance(start, end) >= SAME_POINT, False, contour
        if leads and self._indirect:
            turns, arc = corners.around_corner(end, here, contour[2], -self._signed_offset)
        if leads:
            lead = (False, arc[1] if turns else here, end, (0.0, 0.0), 0.0)
            self._warn_of_cut(move, "from", lead, contour)
            self.stage = OFF
        if turns:
            back = level_arc(move, plane, (True, here, arc[1], arc[3], -arc[4]), stand)
            self._drive(back)
            stand = back.end
        there = list(move.end)
        if not leads:
            aim(plane, here, there)
        if stand != there:
            self._drive(driven(move, stand, there, None, move.normal, move.sweep))

    # --- what does not fit

    def _refuse_radius(self, move: Segment, code: str, where: str) -> NoReturn:
        message = f"the tool's radius {abs(self.signed_offset):g} does not fit {where}"
        self._report.refuse(move, code, message)

    def _pass(self, element: Curve, own: Curve | None) -> None:
        """Pass an element of the path; refuse one that crosses another that the control still sees."""
        crossing = self._passed.add(element, own, self._held[0].line)
        if crossing is None:
            return
        where = f"between this element and that of line {crossing.line}: the path crosses itself"
        if crossing.back < self._look_ahead:
            self._refuse_radius(self._held[0], "compensation-gouge", where)
        message = f"the tool's radius {abs(self.signed_offset):g} does not fit {where}; the control does not see so far ahead and cuts into the contour"
        self._report.warn(self._held[0], "compensation-neck", message)

    def _warn_of_cut(self, move: Segment, direction: str, lead: Curve, element: Curve) -> None:
        """Warn of a lead that cuts into an element of the contour."""
        depth = corners.depth_of(lead, element, abs(self._signed_offset))
        if depth > 0.0:
            message = f"on its way {direction} the contour the tool cuts {depth:.3f} mm into it"
            self._report.warn(move, "compensation-lead", message)
