"""What happens at the hole of a drilling cycle, in every dialect."""

import enum
import math
from typing import NamedTuple

from twin.nc.control.control import Control
from twin.nc.iso.cycle_moves import at_feed, go_to_height

CHIP_CLEARANCE = 0.5
"""Deep drilling stops its rapid return this far above where it was [mm]."""
MOST_PECKS = 10_000
"""Pecks of one hole: more is a slip of the pen."""
_LEAST_REST = 1e-6
"""What a peck leaves of the path to the bottom at least: less is rounding [mm]."""


class Retract(enum.Enum):
    """How a cycle leaves the hole."""

    RAPID = enum.auto()
    FEED = enum.auto()
    REVERSED = enum.auto()
    """With the feed, the spindle reversed."""
    STOPPED = enum.auto()
    """Rapidly, the spindle stopped."""
    REVERSED_LEFT = enum.auto()
    """As ``REVERSED``, of a spindle that turned counter-clockwise."""
    FEED_ALL = enum.auto()
    """With the feed, as far as it goes back."""


class Hole(NamedTuple):
    """What a cycle in force does at every hole.

    Attributes:
        reference: Height at which the feed begins, programmed coordinates [mm].
        bottom: Height of the hole's bottom [mm].
        back: Height to which the tool returns [mm].
        dwell: At the bottom [s].
        surface: Height at which the first peck begins [mm].
        stops: How often it withdraws to break or clear chips.
        passes: It does so as a tap, with the feed.
        peck: Depth of the first peck [mm].
        factor: By which each is deeper than the one before.
        reduction: By how much each is less deep than that [mm].
        least: No peck is less deep, except the last [mm].
        lift: How far it withdraws [mm].
        full_every: After how many stops it withdraws to the reference plane; 0: after none.
        clearance: It returns with rapid to this far above where it was [mm].
        faster: How many times as fast as it went down a tap comes back.
        rest: Above the hole, where it withdraws to the reference plane [s].
    """

    reference: float
    bottom: float
    back: float
    dwell: float
    surface: float
    stops: int = 0
    passes: bool = False
    peck: float = 0.0
    factor: float = 1.0
    reduction: float = 0.0
    least: float = 0.0
    lift: float = 0.0
    full_every: int = 1
    clearance: float = CHIP_CLEARANCE
    retract: Retract = Retract.RAPID
    faster: float = 1.0
    rest: float = 0.0

    @property
    def is_drilled(self) -> bool:
        """Whether it is made by a drill.

        Reamers, taps and boring bars go back by feed or with a stopped spindle; counterbores dwell.
        """
        return self.retract is Retract.RAPID and (self.stops > 0 or not self.dwell)

    @property
    def is_tapped(self) -> bool:
        """Whether the spindle turns back at its bottom."""
        return self.retract in (Retract.REVERSED, Retract.REVERSED_LEFT)

    def next_peck(self, peck: float) -> float:
        """Depth of the peck behind one [mm]."""
        return max(peck * self.factor - self.reduction, self.least)

    def with_stops(self) -> "Hole":
        """The same with its ``stops`` counted, at most one more than ``MOST_PECKS``."""
        depth, peck, stops = self.surface, self.peck, 0
        while depth - peck > self.bottom + _LEAST_REST and stops <= MOST_PECKS:
            depth -= peck
            peck = self.next_peck(peck)
            stops += 1
        return self._replace(stops=stops)


def count_passes(surface: float, bottom: float, depth: float) -> int:
    """How many passes of a depth lead to the bottom; more than ``MOST_PECKS`` are not counted."""
    return math.ceil(max(min((surface - bottom) / depth, MOST_PECKS + 1.0) - 1e-9, 1.0))


def turn_spindle(control: Control, function: str) -> None:
    """Report that M3 or M4 turns the spindle, with the speed in force."""
    control.function(
        function, {} if control.motion.spindle is None else {"S": control.motion.spindle}
    )


def drill(control: Control, hole: Hole, target: list[float] | None = None) -> None:
    """Go over the hole, drill it, return; without a target, whose height is not used, the tool is over it."""
    control.tools.drills |= hole.is_drilled
    axis = control.modal.plane.axes[2]
    over = max(control.motion.programmed[axis], hole.reference)
    go_to_height(control, over)
    if target is not None:
        control.line_to([*target[:axis], over, *target[axis + 1 :]], rapid=True)
    go_to_height(control, hole.reference)
    starts = hole.is_tapped and control.tools.rigid and not control.motion.spindle_turns
    if starts:
        turn_spindle(control, "M4" if hole.retract is Retract.REVERSED_LEFT else "M3")
        control.motion.spindle_turns = True
    depth, peck = hole.surface, hole.peck
    for number in range(1, hole.stops + 1):
        depth = hole.surface - number * peck if hole.passes else depth - peck
        full = hole.full_every > 0 and number % hole.full_every == 0
        up = hole.reference if full else min(depth + hole.lift, hole.reference)
        go_to_height(control, depth, rapid=False)
        if hole.passes:
            _come_back_reversed(control, hole, up)
            continue
        peck = hole.next_peck(peck)
        go_to_height(control, up)
        if full and hole.rest > 0.0:
            control.dwell(hole.rest)
        go_to_height(control, min(depth + hole.clearance, up))
    go_to_height(control, hole.bottom, rapid=False)
    if hole.dwell > 0.0:
        control.dwell(hole.dwell)
    _leave(control, hole)
    if starts:
        control.function("M5", {})
        control.motion.spindle_turns = False


def _leave(control: Control, hole: Hole) -> None:
    """From the bottom to where the tool returns."""
    if hole.is_tapped:
        _come_back_reversed(control, hole, hole.reference)
    elif hole.retract is Retract.STOPPED:
        control.function("M5", {})
    elif hole.retract is not Retract.RAPID:
        fed_back = hole.retract is Retract.FEED_ALL
        _come_back(control, hole, hole.back if fed_back else hole.reference)
    go_to_height(control, hole.back)
    if hole.retract is Retract.STOPPED:
        turn_spindle(control, "M3")


def _come_back_reversed(control: Control, hole: Hole, height: float) -> None:
    left = hole.retract is Retract.REVERSED_LEFT
    turn_spindle(control, "M3" if left else "M4")
    _come_back(control, hole, height)
    turn_spindle(control, "M4" if left else "M3")


def _come_back(control: Control, hole: Hole, height: float) -> None:
    """Go to a height with the feed, as many times as fast as the hole says."""
    feed = control.motion.feed
    with at_feed(control, None if feed is None else feed * hole.faster):
        go_to_height(control, height, rapid=False)
