"""What a control offers to the codes and words of a dialect: words, targets, lines, arcs, feeds."""

import abc
import math
from collections.abc import Iterable, Mapping
from typing import Any

from twin.nc.canonical import Dwell, Function
from twin.nc.control.program_counter import Call
from twin.nc.control.words import ControlWords
from twin.nc.geometry.arcs import Point
from twin.nc.geometry.frame import arc_about, moved_shift
from twin.nc.geometry.planes import Plane, Vector
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
from twin.nc.text.blocks import Block, Location, Statement, Word

MOST_CALLS = 64
"""Parts of a program within each other: more than any control allows."""


class Control(ControlWords):
    """One control, as the actions of codes see it; positions are programmed ones."""

    def target(self) -> list[float]:
        """Take the axis words; the programmed position that they ask for, shape (k,)."""
        target, linear = list(self.programmed), self.linear
        unit, relative = self.modal.unit, self.modal.incremental
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
        modal, is_arc = self.modal, center is not None
        if self.series:
            self.place_switches(length)
        if rapid:
            feed = rapid_feed(self.rapid_feed, NAN if self.feed is None else self.feed)
        else:
            feed = self._feed_per_minute(end, is_arc, length)
            if self.feed_rule is not PATH_COUNTS:
                feed = self._pace_by_rule(feed, end, length, center, sweep)
        acceleration, deceleration = self.acceleration, self.deceleration
        if rapid:
            acceleration = _either(self.rapid_acceleration, acceleration)
            deceleration = _either(self.rapid_deceleration, deceleration)
        if self.axis_limits or self.axis_accelerations or self.axis_decelerations:
            share = self._axis_shares(end, length, is_arc)
            feed = _limited(feed, self.axis_limits, share)
            acceleration = _limited(acceleration, self.axis_accelerations, share)
            deceleration = _limited(deceleration, self.axis_decelerations, share)
        move = Segment(  # by place: names would cost a block twice what it takes to make one
            RAPID if rapid else FEED,
            self.block.line,
            self.block.number,
            self.part,
            end,
            target,
            feed,
            RAPIDS_END if rapid else modal.corner,
            modal.corner_tolerance,
            acceleration,
            deceleration,
            center,
            normal,
            sweep,
        )
        if spline is None:
            self.path.add(move)
        else:
            self.path.add_point(move, flat=spline[0])
        self._last = move
        self.programmed = target
        self.part = end

    def take_rows(self, rows: Iterable[Any], programmed: list[float], part: list[float]) -> None:
        """Moves that were made elsewhere lead to these positions, shape (k,).

        Args:
            rows: As ``Path.add_rows`` takes them.
            programmed: Programmed position [mm or deg].
            part: Part position [mm or deg].
        """
        last = self.path.add_rows(*rows)
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
        modal, settings = self.modal, self.settings
        feed = NAN if self.feed is None else self.feed
        speed = NAN if self.spindle is None else self.spindle
        finding = finding_of_feed(feed, modal.feed_mode, speed, float(self.spindle_turns))
        if finding != PACED:
            self._blame_feed(finding)
        turning = not is_arc and only_turns(self.part, end, self.linear)
        otherwise = (settings.default_feed, settings.default_rotary_feed)
        return feed_per_minute(feed, modal.feed_mode, length, turning, modal.unit, speed, otherwise)

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
        return pace_by_rule(self.feed_rule, pace, move, self.modal.feed_mode, self.modal.unit)

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
            *self.span_of(None),
            hint="write F in the first block that needs it",
        )

    def dwell(self, seconds: float) -> None:
        """Wait."""
        self.path.event(Dwell(0, self.block.line, seconds))

    def function(self, word: str, arguments: Mapping[str, float], at: float = 0.0) -> None:
        """Report a function at this place of the path."""
        self.path.event(Function(0, self.block.line, word, dict(arguments), at))

    # --- flow

    def jump(self, location: Location) -> None:
        """Let the program go on at a location."""
        self.program_counter.go(location)
        self._end_forgotten_cycle()

    def _end_forgotten_cycle(self) -> None:
        if self.modal.cycle is None:
            self.forget_cycle()

    def call(
        self,
        first: Location,
        deepest: int,
        blamed: Word | Statement,
        values: Iterable[tuple[str, float]] | None = None,
        *,
        restores: bool = False,
        times: float = 1.0,
    ) -> None:
        """Run the part that begins at a location and ends by a word.

        Args:
            first: Where it begins.
            deepest: Parts that may call each other.
            blamed: What asks for it.
            values: Of its own variables by name; None: it has the caller's.
            restores: Its end puts back into force what is in force now.
            times: How often it runs.

        Raises:
            ProgramError: Too many parts call each other, or the number of runs is none.
        """
        call = self._begin_call(first, deepest, blamed, times)
        if restores:
            call.restores = self.modal.fork()
        if values is not None:
            call.owns_variables = True
            self.variables.enter()
            for name, value in values:
                self.variables.write(name, value)

    def repeat(
        self, first: Location, last: Location, deepest: int, blamed: Statement, times: float
    ) -> None:
        """Run a range of blocks so often; as ``call``."""
        self._begin_call(first, deepest, blamed, times).last = last

    def _begin_call(
        self, first: Location, deepest: int, blamed: Word | Statement, times: float
    ) -> Call:
        counter = self.program_counter
        if counter.depth >= min(deepest, MOST_CALLS):
            self.fail("call-depth", f"more than {deepest} calls within calls", blamed)
        if not times >= 1.0 or times != math.floor(times):
            self.fail("repeat-range", "the range or the number of runs is none", blamed)
        call = Call(counter.location, first, int(times) - 1)
        counter.calls.append(call)
        self.jump(first)
        return call

    def require_caller(self, blamed: Word | Statement | None = None) -> None:
        """A part must be being run that a word ends.

        Raises:
            ProgramError: None is.
        """
        if all(call.last is not None for call in self.program_counter.calls):
            self.fail("return-outside", "there is no subroutine to return from", blamed)

    def go_back(self, blamed: Word | Statement | None = None) -> None:
        """The end of a subroutine: back behind its call, or to its beginning again.

        Raises:
            ProgramError: There is no subroutine.
        """
        self.require_caller(blamed)
        ended = self.program_counter.end_call()
        if ended is not None:
            if ended.owns_variables:
                self.variables.leave()
            if ended.restores is not None:
                self.modal.restore(ended.restores)
        self._end_forgotten_cycle()

    # --- coordinates

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
    def place_switches(self, length: float) -> None:
        """Report the block's switch points, told the length of its move."""


def _limited(value: float, limits: Mapping[int, float], shares: list[float]) -> float:
    """A value along the path so that no axis exceeds its own limit; NaN is no limit."""
    bounds = [limit / shares[index] for index, limit in limits.items() if shares[index] > 0.0]
    return min([value, *bounds]) if value == value else min(bounds, default=value)


def _either(value: float, default: float) -> float:
    """A value, or where it is NaN another one."""
    return default if math.isnan(value) else value
