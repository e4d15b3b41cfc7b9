"""Setpoints under an operator's control: feed override, hold, single block, reset.

**How it works.** A program is planned as ``plan`` does it, but only as far as setpoints are asked
for. The overrides are ceilings of the velocity along the path: of the programmed feed, or of what
the axes can do in a rapid. Whatever is changed takes effect from the next setpoint on: the plan is
broken off at the state (place, v, a) that it has there, and made again under the new ceilings.
Where that state is too fast for them, a brake begins at once, with the acceleration and jerk that
the pieces of the path allow, and ends where the new plan can take over; a brake that is under way
is eased off as soon as the new plan allows. A hold is an override of zero.

So the path is never left, no limit can be broken by turning an override, and the machine's
acceleration is as high at 10 % as at 100 %: it is the feed that is overridden, not the machine.
Where the path itself leaves no room for the change (within a brake into a corner), the old plan
goes on for a servo period and the change is tried again. The limits of curved pieces leave room
for ``largest_override``, so that any override up to it can be taken anywhere; with
``largest_override=1`` and nothing touched the setpoints are those of ``plan``, to the last bit, but where
more arcs than ``MOST_SLOW_ARCS`` follow each other. How many setpoints are asked for at a time changes nothing.
"""

import dataclasses
import math
from collections.abc import Iterable

import numpy as np

from twin.columns import join
from twin.motion.corner_candidates import PiecesOfChunks
from twin.motion.limits import MotionLimits
from twin.motion.live.overridden_plan import OverriddenPlan, Overrides
from twin.motion.pieces.pieces import BATCH
from twin.motion.planner import WatchedEnd
from twin.motion.profile.windows import LOOK_AHEAD
from twin.motion.setpoints.sampling import at_end, sample, standing
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Chunk, FloatArray

LARGEST_OVERRIDE = 1.5
"""What the feed override of a panel usually goes up to."""

MOST_SLOW_ARCS = 128
"""For which ``PiecesOfChunks`` tries another passage: of more, the axes would stand while it is planned."""


class LiveMotion:
    """A program's setpoints, pulled in small slices while an operator's panel is turned.

    A training scene with a servo period of 1 ms and 50 slices a second::

        motion = LiveMotion(chunks, limits, period_s=0.001, part_zero=zero, start=home)
        while not motion.finished:
            motion.feed_override = panel.feed_percent / 100.0
            if panel.hold_pressed:
                motion.hold()
            if panel.start_pressed:
                motion.start()
            setpoints = motion.advance(20)

    A change takes effect at the first setpoint of the next slice. While the machine is held, slices
    stand still; once finished, they are empty.

    Args:
        chunks: The program: consecutive moves in part coordinates.
        period_s: Servo period [s].
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        start: Where the axes are before the program, machine coordinates, shape (k,) [mm or deg].
        look_ahead: Blocks that are cut and planned at a time, and seen at least beyond these.

    Raises:
        ValueError: ``largest_override`` is below 1; or, in ``begin`` and ``advance``, a move does not
            begin where the one before it ended.
    """

    def __init__(
        self,
        chunks: Iterable[Chunk],
        limits: MotionLimits,
        *,
        period_s: float,
        part_zero: FloatArray,
        start: FloatArray,
        largest_override: float = LARGEST_OVERRIDE,
        look_ahead: int = LOOK_AHEAD,
    ) -> None:
        if not 1.0 <= largest_override < math.inf:
            raise ValueError(f"largest_override must be 1 or more, not {largest_override}")
        self.largest_override = largest_override
        self._period_s = period_s
        self._part_zero = part_zero
        self._program = WatchedEnd(chunks, start, part_zero)
        self._plan = OverriddenPlan(
            PiecesOfChunks(
                self._program,
                limits,
                start - part_zero,
                largest_override,
                min(BATCH, look_ahead),
                MOST_SLOW_ARCS,
            ),
            limits.arrays(),
            look_ahead,
        )
        self._wanted = self._granted = Overrides()
        self._dropped = False
        self._finished = False
        self._tick = 0
        self._last = standing(start)

    def begin(self) -> None:
        """Plan the beginning; ``advance`` does so by itself.

        What ``chunks`` raise comes through: where they raise that they are not known yet, call it again later.
        """
        self._plan.begin()

    def work(self) -> bool:
        """Plan a little ahead, so that ``begin`` and ``advance`` find it planned.

        What ``chunks`` raise comes through, as from ``begin``.

        Returns:
            Whether there is no more to do until the axes are further.
        """
        return self._plan.work()

    @property
    def feed_override(self) -> float:
        """Factor of programmed feeds, 0 to ``largest_override``; at 0 feed moves stand.

        Raises:
            ValueError: When set to anything else.
        """
        return self._wanted.feed_override

    @feed_override.setter
    def feed_override(self, factor: float) -> None:
        if not 0.0 <= factor <= self.largest_override:
            raise ValueError(f"feed override {factor}: use 0 to {self.largest_override}")
        self._wanted = dataclasses.replace(self._wanted, feed_override=factor)

    @property
    def rapid_override(self) -> float:
        """Factor of the velocity of rapids, 0 to 1; at 0 rapids stand.

        Raises:
            ValueError: When set to anything else.
        """
        return self._wanted.rapid_override

    @rapid_override.setter
    def rapid_override(self, factor: float) -> None:
        if not 0.0 <= factor <= 1.0:
            raise ValueError(f"rapid override {factor}: use 0 to 1")
        self._wanted = dataclasses.replace(self._wanted, rapid_override=factor)

    @property
    def single_block(self) -> bool:
        """Whether to stop at the end of every block until ``start``.

        A block is what one line of the program moves. Switched on too late to stop at the end of
        the present block, the machine stops at the end of the next.
        """
        return self._wanted.single_block

    @single_block.setter
    def single_block(self, on: bool) -> None:
        self._wanted = dataclasses.replace(self._wanted, single_block=on)

    def hold(self) -> None:
        """Stop on the path, as quickly as the limits allow, until ``start``; dwells stop too."""
        self._wanted = dataclasses.replace(self._wanted, held=True)

    def start(self) -> None:
        """Go on after ``hold``, or at the end of a single block."""
        self._wanted = dataclasses.replace(self._wanted, held=self._dropped)

    def reset(self) -> None:
        """Stop as ``hold`` does and drop the rest of the program; cannot be taken back."""
        self.hold()
        self._dropped = True

    @property
    def held(self) -> bool:
        """Whether ``start`` is waited for: after ``hold``, or at the end of a single block."""
        return self._wanted.held

    @property
    def standing(self) -> bool:
        """Whether the axes are at rest and stay so until something is changed."""
        return self._finished or self._plan.standing_since <= (self._tick - 1) * self._period_s

    @property
    def finished(self) -> bool:
        """Whether the program has come to its end, or to rest after ``reset``."""
        return self._finished

    def advance(self, count: int) -> Setpoints:
        """The next setpoints, machine coordinates; fewer than asked for at the program's end.

        Args:
            count: How many servo periods to go on by.
        """
        self.begin()
        parts: list[Setpoints] = []
        wanted = self._tick + count
        while self._tick < wanted and not self._finished:
            now = self._tick * self._period_s
            if self._wanted != self._granted and self._plan.override(self._wanted, now):
                self._granted = self._wanted
            # A change that is not yet possible is tried again at every period.
            every = self._dropped or self._wanted != self._granted
            parts += self._take(1 if every else wanted - self._tick)
            self._last = parts[-1][-1:]
        return join(parts) if parts else self._last[:0]

    def _take(self, count: int) -> list[Setpoints]:
        """Samples of the next ``count`` periods; at the program's end the one at rest."""
        plan, until = self._plan, self._tick + count
        plan.plan_until(until * self._period_s)
        parts: list[Setpoints] = []
        for phases in plan.phases:
            most = until - self._tick
            if most > 0:
                here = sample(phases, self._tick, self._period_s, self._part_zero, most=most)
                part = next(here, None)
                if part is not None:
                    parts.append(part)
                    self._tick += len(part)
        if self._tick < until:
            self._finished = True
            parts.append(self._at_end())
            self._tick += 1
        elif plan.at_block_end and self._wanted.single_block and not self._wanted.held:
            # The panel's start button, not the plan, goes on from here.
            self._wanted = self._granted = dataclasses.replace(self._wanted, held=True)
        if self._dropped:
            self._finished |= self.standing
        plan.forget(self._tick * self._period_s)
        return parts

    def _at_end(self) -> Setpoints:
        """The sample at rest at the program's end."""
        last = at_end(self._plan.phases[-1]) if self._plan.phases else self._last
        time = np.array([self._tick * self._period_s])
        return dataclasses.replace(last, time=time, position=self._program.position[None].copy())
