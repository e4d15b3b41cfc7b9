"""What a control offers to the codes and words of a dialect: words, targets, lines, arcs, feeds."""

import abc
import math
from collections.abc import Callable, Mapping

from twin.nc.bytecode.assembler import Assembler
from twin.nc.bytecode.effects import Affected
from twin.nc.bytecode.registers import (
    ACCELERATION,
    CORNER,
    CORNER_TOLERANCE,
    DECELERATION,
    FEED_MODE,
    INCREMENTAL,
    PROGRAMMED_FEED,
    RAPID_FEED,
    SPINDLE,
    SPINDLE_TURNS,
    UNIT,
)
from twin.nc.canonical import Dwell, Function
from twin.nc.control.modal import CORNERS
from twin.nc.control.words import ControlWords
from twin.nc.geometry.arcs import Point
from twin.nc.geometry.frame import arc_about, moved_shift
from twin.nc.geometry.planes import Plane, Vector
from twin.nc.path.event_columns import EventRows
from twin.nc.path.move_columns import FEED, NAN, RAPID, Segment
from twin.nc.path.moves import (
    LARGEST_COORDINATE,
    RAPIDS_END,
    SMALLEST_MOVE,
    arc_length,
    arc_radius,
    axis_target,
    line_length,
    only_turns,
)
from twin.nc.path.paces import (
    PACED,
    PATH_COUNTS,
    STANDING,
    WITHOUT_SPEED,
    Displacement,
    feed_per_minute,
    finding_of_feed,
    pace_by_rule,
    rapid_feed,
)
from twin.nc.path.segments import direction_of
from twin.nc.text.blocks import Block


class Control(ControlWords):
    """One control, as the actions of codes see it; positions are programmed ones."""

    def target(self) -> list[float]:
        """Take the axis words; the programmed position that they ask for, shape (k,)."""
        target, cells, linear = list(self.programmed), self.modal.cells, self.linear
        unit, relative = cells[UNIT], cells[INCREMENTAL] != 0.0
        for index, word in self.take_axis_words():
            incremental = relative or word.incremental
            here = target[index]
            written = word.value
            assert isinstance(written, float)
            value = axis_target(written, unit, linear[index], incremental, here)
            if not -LARGEST_COORDINATE <= value <= LARGEST_COORDINATE:
                self.fail("number-range", f"{word.text} is farther than any machine reaches", word)
            target[index] = value
        return target

    def line_to(self, target: list[float], *, rapid: bool) -> None:
        """Move straight to a programmed position; nothing when it stands there already."""
        self._add(target, rapid=rapid)

    def spline_to(self, target: list[float], *, flat: bool) -> None:
        """Move on a spline through a programmed position; ``flat``: its height goes linearly.

        The same position twice ends the spline and begins another.
        """
        if target == self.programmed:
            self.path.end_spline()
        self._add(target, rapid=False, spline=(flat,))

    def arc_to(self, target: list[float], center: Point, sweep: float) -> None:
        """Move on an arc about the plane's normal.

        Args:
            target: Programmed position of its end, shape (k,).
            center: Abscissa and ordinate of its programmed centre [mm].
            sweep: Signed angle with all turns [deg].
        """
        arc = self.frame.arc(arc_about(self.modal.plane.directions, self.programmed, center, sweep))
        self._add(target, rapid=False, center=arc.center, normal=arc.normal, sweep=arc.sweep)

    def _add(
        self,
        target: list[float],
        *,
        rapid: bool,
        center: Vector | None = None,
        normal: Vector = (NAN, NAN, NAN),
        sweep: float = 0.0,
        spline: tuple[bool] | None = None,
    ) -> None:
        end = self.frame.to_part(target)
        if center is None:
            length = line_length(self.part, end)
        else:
            length = arc_length(self.part, end, center, normal, sweep)
        if length < SMALLEST_MOVE:
            self.programmed = target
            return
        cells, registers = self.modal.cells, self.registers
        is_arc = center is not None
        if self.series:
            self.place_switches(length)
        if rapid:
            feed = rapid_feed(registers[RAPID_FEED], registers[PROGRAMMED_FEED])
        else:
            feed = self._feed_per_minute(end, is_arc, length)
            if self.feed_rule is not PATH_COUNTS:
                feed = self._pace_by_rule(feed, end, length, center, sweep)
        acceleration, deceleration = registers[ACCELERATION], registers[DECELERATION]
        if rapid:
            acceleration = _either(self.rapid_acceleration, acceleration)
            deceleration = _either(self.rapid_deceleration, deceleration)
        if self.axis_limits or self.axis_accelerations or self.axis_decelerations:
            share = self._axis_shares(end, length, is_arc)
            feed = _limited(feed, self.axis_limits, share)
            acceleration = _limited(acceleration, self.axis_accelerations, share)
            deceleration = _limited(deceleration, self.axis_decelerations, share)
        self._last = Segment(  # by place: names would cost a block twice what it takes to make one
            RAPID if rapid else FEED,
            self.block.line,
            self.block.number,
            self.part,
            end,
            target,
            feed,
            RAPIDS_END if rapid else CORNERS[cells[CORNER]],
            cells[CORNER_TOLERANCE],
            acceleration,
            deceleration,
            center,
            normal,
            sweep,
        )
        if spline is None:
            self.path.add(self._last)
        else:
            self.path.add_point(self._last, flat=spline[0])
        self.programmed = target
        self.part = end

    def resume_at(self, programmed: list[float], part: list[float], last: Segment | None) -> None:
        """Blocks that went past the control have ended here; ``last`` is their last move, if any."""
        self.programmed, self.part = programmed, part
        if last is not None:
            self._last = last

    @property
    def direction(self) -> Vector | None:
        """Where the last move was going when it ended, programmed coordinates; None before one."""
        move = self._last
        return None if move is None else self.frame.unturn(direction_of(move, at_end=True))

    def _axis_shares(self, end: list[float], length: float, is_arc: bool) -> list[float]:
        """How much of the path's speed each axis takes at most."""
        shares = [abs(new - old) / length for new, old in zip(end, self.part, strict=True)]
        return [1.0, 1.0, 1.0, *shares[3:]] if is_arc else shares

    def _feed_per_minute(self, end: list[float], is_arc: bool, length: float) -> float:
        registers, cells, settings = self.registers, self.modal.cells, self.settings
        feed, mode, speed = registers[PROGRAMMED_FEED], int(cells[FEED_MODE]), registers[SPINDLE]
        finding = finding_of_feed(feed, mode, speed, registers[SPINDLE_TURNS])
        if finding != PACED:
            self._blame_feed(finding)
        turning = not is_arc and only_turns(self.part, end, self.linear)
        otherwise = (settings.default_feed, settings.default_rotary_feed)
        return feed_per_minute(feed, mode, length, turning, cells[UNIT], speed, otherwise)

    def _pace_by_rule(
        self, pace: float, end: list[float], length: float, center: Vector | None, sweep: float
    ) -> float:
        """The pace of a move whose F counts another length than that of its path [mm/min or deg/min]."""
        ways = (new - old for new, old in zip(end, self.part, strict=True))
        turned = math.hypot(*(way for way, line in zip(ways, self.linear, strict=True) if not line))
        turning = center is None and only_turns(self.part, end, self.linear)
        move = Displacement(length, turned, turning)
        if center is not None:
            radius = arc_radius(self.part, center)
            move = move._replace(radius=radius, around=radius * math.radians(abs(sweep)))
        cells = self.modal.cells
        return pace_by_rule(self.feed_rule, pace, move, int(cells[FEED_MODE]), cells[UNIT])

    def _blame_feed(self, finding: int) -> None:
        """Say what is wrong with the pace of a move.

        Raises:
            ProgramError: It has none.
        """
        if finding == WITHOUT_SPEED:
            self.fail("feed-per-revolution", "a feed per revolution needs a spindle speed S")
        if finding == STANDING:
            message = "a feed per revolution never moves while the spindle stands"
            self.fail("feed-per-revolution", message, hint="start it by M3 or M4 before")
        self.report.warn_once(
            "no-feed",
            "no feed is programmed: the machine's default is used",
            *self._blamed(None),
            hint="write F in the first block that needs it",
        )

    def dwell(self, seconds: float) -> None:
        """Wait."""
        self.path.event(Dwell(0, self.block.line, seconds))

    def function(self, word: str, arguments: Mapping[str, float], at: float = 0.0) -> None:
        """Report a function at this place of the path."""
        self.path.event(Function(0, self.block.line, word, dict(arguments), at))

    def begin_effect(self) -> Affected:
        """Let the columns show where the control stands, for an instruction."""
        state = self.state
        state.event_count[0] = 0
        state.programmed[:], state.part[:] = self.programmed, self.part
        return self.affected

    @property
    def affected(self) -> Affected:
        """What instructions change; only the registers are up to date between two of them."""
        return Affected(self.constants, self.state, self._event_room)

    def end_effect(self) -> None:
        """Take back what an instruction has changed, and report what happened."""
        state, room = self.state, self._event_room
        self.programmed = state.programmed.tolist()
        self.frame.refresh()
        for event in EventRows(room.events, room.event_values).part(0, int(state.event_count[0])):
            if isinstance(event, Dwell):
                self.dwell(event.seconds)
            elif isinstance(event, Function):
                self.function(event.word, event.arguments)

    def part_plane(self) -> Plane:
        """The working plane as the part sees it."""
        return self.frame.plane(self.modal.plane)

    @property
    def has_moved(self) -> bool:
        """The path has begun."""
        return self._last is not None

    def stand_at(self, programmed: list[float]) -> None:
        """Let the path, which has not begun, begin at a programmed position."""
        self.programmed = programmed
        self.part = self.path.position = self.frame.to_part(programmed)

    def set_position(self, programmed: list[float], shift: str) -> None:
        """Give the place where it stands other programmed coordinates; nothing moves."""
        here = self.frame.to_part(programmed)
        values = self.frame.shift(shift)
        self.frame.set_shift(shift, list(map(moved_shift, values, self.part, here)))
        self.programmed = programmed

    def reframed(self) -> None:
        """The frame has changed: see where it stands now."""
        self.programmed = self.frame.to_programmed(self.part)

    @abc.abstractmethod
    def run(self, block: Block) -> None:
        """Run one block, also one that stands within a statement."""

    @abc.abstractmethod
    def perform(
        self, write: Callable[[Assembler], None], span: tuple[int, int] | None = None
    ) -> None:
        """Do at once what is said as instructions.

        Args:
            write: Says it.
            span: Column and width of what is blamed; None: the block's last code or first word.
        """

    @abc.abstractmethod
    def place_switches(self, length: float) -> None:
        """Report the block's switch points, told the length of its move."""


def _limited(value: float, limits: Mapping[int, float], shares: list[float]) -> float:
    """A value along the path so that no axis exceeds its own limit; NaN is no limit."""
    bounds = [limit / shares[index] for index, limit in limits.items() if shares[index] > 0.0]
    return min([value, *bounds]) if value == value else min(bounds, default=value)


def _either(value: float, default: float) -> float:
    """A value, or where it is NaN another one."""
    return default if math.isnan(value) else value
