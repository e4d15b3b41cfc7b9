"""The motion of a control: where it is, how fast it goes, and what becomes of programmed targets."""

import functools
import math
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from twin.nc.control.modal import Modal
from twin.nc.control.settings import ControlSettings
from twin.nc.geometry.arcs import Point
from twin.nc.geometry.frame import Arc, Frame, arc_about, moved_shift
from twin.nc.geometry.planes import Plane, Vector
from twin.nc.path.feed_rates import (
    KNOWN_FEED,
    PATH_COUNTS,
    Displacement,
    FeedRule,
    arc_displacement,
    feed_by_rule,
    feed_per_minute,
    finding_of_feed,
    rapid_feed,
)
from twin.nc.path.move_columns import FEED, NAN, RAPID, Segment
from twin.nc.path.moves import (
    RAPIDS_END,
    SMALLEST_MOVE,
    arc_length,
    arc_radius,
    line_length,
    only_turns,
)
from twin.nc.path.path import Path
from twin.nc.path.segments import direction_of
from twin.nc.path.tool_center.tool_center import ToolCenter
from twin.nc.text.blocks import Block
from twin.nc.text.diagnostics.reporter import Reporter

_STRAIGHT = (None, (NAN, NAN, NAN), 0.0)
"""Centre, normal and sweep of a line."""


class MotionState:
    """Where a control is and how fast it goes.

    Attributes:
        frame: From programmed to part coordinates.
        programmed: Where it is, as its screen shows it, shape (k,) [mm or deg].
        part: Where it is in part coordinates, shape (k,) [mm or deg].
        last: The last move, as it was programmed; None before one.
        feed: F as programmed, or None.
        spindle: S as programmed, or None [1/min].
        spindle_turns: M3 or M4 of the program is in force; what a cycle does at a hole ends with the hole.
        acceleration: [mm/s²]; NaN: the machine's.
        deceleration: [mm/s²]; NaN: the machine's.
        rapid_feed: Feed per second of rapids [mm/s]; 0: they follow F; NaN: they have the machine's velocity.
        rapid_acceleration: Acceleration of rapids where the program sets their own [mm/s²]; NaN:
            that of the path.
        rapid_deceleration: Deceleration of rapids, likewise [mm/s²].
        axis_limits: Largest velocity of single axes, by column [mm/min or deg/min].
        axis_accelerations: Their largest acceleration [mm/s² or deg/s²].
        axis_decelerations: Their largest deceleration [mm/s² or deg/s²].
        in_plane: As ``Segment.in_plane`` of the moves that follow.
        before_move: Given the length of each move of the block before it goes to the path.
        on_screen: What the screen shows of part coordinates while the words count otherwise: from machine zero; None:
            what the words count.
    """

    def __init__(
        self,
        settings: ControlSettings,
        modal: Modal,
        report: Reporter,
        refuse_feed: Callable[[int], None],
        feed_rule: FeedRule,
    ) -> None:
        """Stand where the program begins."""
        self.modal = modal
        self._report, self._refuse_feed = report, refuse_feed
        self._default_feeds = (settings.default_feed, settings.default_rotary_feed)
        self.linear = tuple(kind == "linear" for kind in settings.axes.kinds)
        self.programmed = [settings.start.get(name, 0.0) for name in settings.axes.names]
        self.part = list(self.programmed)
        self.frame = Frame(len(self.part))
        self.path = Path(settings.axes, self.part, report)
        self.last: Segment | None = None
        self.feed: float | None = None
        self.feed_rule = feed_rule
        self.spindle: float | None = None
        self.spindle_turns = False
        self.acceleration = self.deceleration = self.rapid_feed = NAN
        self.rapid_acceleration = self.rapid_deceleration = NAN
        self.axis_limits: dict[int, float] = {}
        self.axis_accelerations: dict[int, float] = {}
        self.axis_decelerations: dict[int, float] = {}
        self.in_plane = False
        self.before_move: Callable[[float], None] | None = None
        self.on_screen: Callable[[list[float]], list[float]] | None = None

    # --- moves

    def arc(self, center: Point, sweep: float) -> Arc:
        """An arc about the plane's normal, as the part sees it.

        Args:
            center: Abscissa and ordinate of its programmed centre [mm].
            sweep: Signed angle with all turns [deg].
        """
        return self.frame.arc(
            arc_about(self.modal.plane.directions, self.programmed, center, sweep)
        )

    def spline_to(self, target: list[float], block: Block, *, flat: bool) -> None:
        """Move on a spline through a programmed position; ``flat``: its height goes linearly.

        The same position twice ends the spline and begins another.
        """
        if target == self.programmed:
            self.path.end_spline()
        self.move_to(target, block, add=functools.partial(self.path.add_point, flat=flat))

    def move_to(
        self,
        target: list[float],
        block: Block,
        *,
        rapid: bool = False,
        arc: Arc | None = None,
        add: Callable[[Segment], None] | None = None,
    ) -> None:
        """Move to a programmed position; nothing when it is there already.

        Args:
            target: The position, shape (k,).
            rapid: At the machine's own speed.
            arc: On which, as the part sees it; None: straight.
            add: What takes the move; None: the path, as it is.
        """
        end = self.frame.to_part(target)
        led = self.path.tool_center
        if led is not None and self.in_plane:
            end = self._reached(led, end)
            target = self.frame.to_programmed(end)
        center, normal, sweep = _STRAIGHT if arc is None else arc
        if center is None:
            length = line_length(self.part, end)
        else:
            length = arc_length(self.part, end, center, normal, sweep)
        if length < SMALLEST_MOVE:
            self.programmed = target
            return
        if self.before_move is not None:
            self.before_move(length)
        feed, acceleration, deceleration = self._rates(end, length, arc, rapid=rapid)
        move = Segment(  # by place: names would cost a block twice what it takes to make one
            RAPID if rapid else FEED,
            block.line,
            block.number,
            self.part,
            end,
            target if self.on_screen is None else self.on_screen(end),
            feed,
            RAPIDS_END if rapid else self.modal.corner,
            self.modal.corner_tolerance,
            acceleration,
            deceleration,
            center,
            normal,
            sweep,
            None,
            self.frame.screen,
            self.in_plane,
        )
        if add is None:
            self.path.add(move)
        else:
            add(move)
        self.last = move
        self.programmed = target
        self.part = end

    def _reached(self, center: ToolCenter, end: list[float]) -> list[float]:
        """Where the axes come to that turn the tool in a plane."""
        try:
            return center.reached(self.part, end)
        except ValueError as error:
            self._report.fail("tool-center", str(error))

    def take_rows(self, rows: Iterable[Any], programmed: list[float], part: list[float]) -> None:
        """Moves that were made elsewhere, rows as ``Path.add_rows`` takes them, lead to these positions, shape (k,)."""
        last = self.path.add_rows(*rows, screen=self.frame.screen)
        self.programmed, self.part = programmed, part
        if last is not None:
            self.last = last

    @property
    def direction(self) -> Vector | None:
        """Where the last move was going when it ended, programmed coordinates; None before one."""
        move = self.last
        return None if move is None else self.frame.unturn(direction_of(move, at_end=True))

    # --- feeds

    def _rates(
        self, end: list[float], length: float, arc: Arc | None, *, rapid: bool
    ) -> tuple[float, float, float]:
        """Feed, acceleration and deceleration of a move along its path."""
        acceleration, deceleration = self.acceleration, self.deceleration
        if rapid:
            feed = rapid_feed(self.rapid_feed, NAN if self.feed is None else self.feed)
            acceleration = _either(self.rapid_acceleration, acceleration)
            deceleration = _either(self.rapid_deceleration, deceleration)
        else:
            feed = self._feed_per_minute(end, length, arc is not None)
            by_rule = self.feed_rule is not PATH_COUNTS and self.path.tool_center is None
            if by_rule and (arc is not None or self.feed_rule.degree):
                feed = self._feed_by_rule(feed, end, length, arc)
        if not (self.axis_limits or self.axis_accelerations or self.axis_decelerations):
            return feed, acceleration, deceleration
        share = self._axis_shares(end, length, arc is not None)
        return (
            _limited(feed, self.axis_limits, share),
            _limited(acceleration, self.axis_accelerations, share),
            _limited(deceleration, self.axis_decelerations, share),
        )

    def _axis_shares(self, end: list[float], length: float, is_arc: bool) -> list[float]:
        """How much of the path's speed each axis takes at most."""
        shares = [abs(new - old) / length for new, old in zip(end, self.part, strict=True)]
        return [1.0, 1.0, 1.0, *shares[3:]] if is_arc else shares

    def _feed_per_minute(self, end: list[float], length: float, is_arc: bool) -> float:
        modal = self.modal
        feed = NAN if self.feed is None else self.feed
        speed = NAN if self.spindle is None else self.spindle
        finding = finding_of_feed(feed, modal.feed_mode, speed, float(self.spindle_turns))
        if finding != KNOWN_FEED:
            self._refuse_feed(finding)
        turning = not is_arc and only_turns(self.part, end, self.linear)
        return feed_per_minute(
            feed, modal.feed_mode, length, turning, modal.unit, speed, self._default_feeds
        )

    def _feed_by_rule(self, rate: float, end: list[float], length: float, arc: Arc | None) -> float:
        """The feed rate of a move whose F counts another length than that of its path [mm/min or deg/min]."""
        travel = (new - old for new, old in zip(end, self.part, strict=True))
        turned = math.hypot(
            *(distance for distance, line in zip(travel, self.linear, strict=True) if not line)
        )
        if arc is None:
            move = Displacement(length, turned, only_turns(self.part, end, self.linear))
        else:
            radius = arc_radius(self.part, arc.center)
            move = arc_displacement(length, turned, radius, arc.sweep)
        return feed_by_rule(self.feed_rule, rate, move, self.modal.feed_mode, self.modal.unit)

    # --- coordinates

    @property
    def part_plane(self) -> Plane:
        """The working plane as the part sees it."""
        return self.frame.plane(self.modal.plane)

    def unit_of(self, axis: int) -> float:
        """What 1 of the axis of a column is in the program's unit [mm or deg]."""
        return self.modal.unit if self.linear[axis] else 1.0

    def begin_at(self, programmed: list[float]) -> None:
        """Let the path, which has not begun, begin at a programmed position."""
        self.programmed = programmed
        self.part = self.path.position = self.frame.to_part(programmed)

    def set_position(self, programmed: list[float], shift: str) -> None:
        """Give the place where it is other programmed coordinates; nothing moves."""
        here = self.frame.to_part(programmed)
        values = self.frame.shift(shift)
        self.frame.set_shift(shift, list(map(moved_shift, values, self.part, here)))
        self.programmed = programmed

    def lead_tip(self, center: ToolCenter | None) -> None:
        """From now on positions are those of a tip that is led; None: of the axes. Nothing moves."""
        self.path.flush()
        before = self.path.tool_center
        axes = self.part if before is None else before.axes(self.part)
        self.part = self.path.position = axes if center is None else center.tip(axes)
        self.path.tool_center = center
        self.last = None
        self.programmed = self.frame.to_programmed(self.part)

    def reframed(self) -> None:
        """The frame has changed: see where it is now."""
        center = self.path.tool_center
        if center is not None:
            self.lead_tip(center.with_zero(self.frame.zero()))
            return
        self.programmed = self.frame.to_programmed(self.part)


def _limited(value: float, limits: Mapping[int, float], shares: list[float]) -> float:
    """A value along the path so that no axis exceeds its own limit; NaN is no limit."""
    bounds = [limit / shares[index] for index, limit in limits.items() if shares[index] > 0.0]
    return min([value, *bounds]) if value == value else min(bounds, default=value)


def _either(value: float, default: float) -> float:
    """A value, or where it is NaN another one."""
    return default if math.isnan(value) else value
