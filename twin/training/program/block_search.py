"""Block search: what is before a block is only computed, then the axes go to where it begins."""

import dataclasses
import itertools
import math

import numpy as np

from twin.nc.canonical import NO_BLOCK_NUMBER, Chunk, Corner, FloatArray, Function, Motion, Moves
from twin.nc.control.control import Control
from twin.nc.functions import (
    COOLANT_OFF,
    COOLANT_ON,
    SPINDLE_SPEED,
    SPINDLE_STARTS,
    SPINDLE_STOPS,
)
from twin.nc.path.feed_rates import FEED_FACTORS
from twin.nc.path.move_columns import NAN, MoveColumns, Segment

Z = 2
SHORTEST = 1e-6
"""A jog move that is shorter is left out [mm or deg]."""


def approach(control: Control, stand: FloatArray, line: int, clearance: float) -> Moves:
    """Straight moves to where the control is after a search.

    The tool is lifted first, travels at the height of clearance, and goes down last, in the feed that is in
    force there: it may stand in the part, and may have material under it. Where the other axes are
    right, Z goes straight.

    Args:
        control: After the blocks that were only computed.
        stand: Where the axes stand, part coordinates, shape (k,) [mm or deg].
        clearance: Height at which the tool travels, at least, part coordinates [mm].
    """
    motion = control.motion
    goal = np.array(motion.part)
    label = np.array(motion.programmed) - goal
    above_stand, above_goal = stand.copy(), goal.copy()
    travels = bool(np.abs(np.delete(goal - stand, Z)).max() >= SHORTEST)
    height = max(goal[Z], stand[Z], clearance if travels else -np.inf)
    above_stand[Z] = above_goal[Z] = height
    factor = FEED_FACTORS.get(control.modal.feed_mode)
    feed = motion.feed * factor if motion.feed and factor else control.settings.default_feed
    columns = MoveColumns(control.settings.axes)
    for start, end in itertools.pairwise((stand, above_stand, above_goal, goal)):
        if np.abs(end - start).max() < SHORTEST:
            continue
        down = end[Z] < start[Z]
        columns.add(
            Segment(
                motion=Motion.FEED if down else Motion.RAPID,
                line=line,
                block=NO_BLOCK_NUMBER,
                start=start.tolist(),
                end=end.tolist(),
                display=(end + label).tolist(),
                feed=feed if down else NAN,
                corner=Corner.EXACT_STOP,
                corner_tolerance=NAN,
            )
        )
    return columns.take().moves


NO_COMPENSATION = 40
"""G code that ends radius compensation, in every dialect that has any."""


class BlockSearch:
    """What a search remembers of the blocks that it passes over.

    Attributes:
        line: Source line that is searched for; 0: none, or it has been found.
    """

    def __init__(self, line: int) -> None:
        self.line = line
        self._functions: dict[str, Function] = {}
        self._clearance = -math.inf

    def end(self) -> None:
        """The block has been found."""
        self.line = 0

    def collect(self, skipped: Chunk) -> None:
        """Of what is passed over, keep the last commands of spindle and coolant, and the highest Z."""
        if len(skipped.moves):
            self._clearance = max(self._clearance, float(skipped.moves.end[:, Z].max()))
        for event in skipped.events:
            if isinstance(event, Function):
                name = "coolant" if event.word in COOLANT_ON | COOLANT_OFF else event.word
                name = "spindle" if event.word in SPINDLE_STARTS | SPINDLE_STOPS else name
                self._functions[name] = event

    def refusal(self, control: Control, mounted: int | None) -> str:
        """Why the block that was found cannot be begun at; empty: it can.

        Args:
            control: After the blocks that were only computed.
            mounted: Number of the tool in the spindle.
        """
        if control.modal.active.get("compensation", NO_COMPENSATION) != NO_COMPENSATION:
            return "a search cannot begin within a compensated contour"
        needed = control.tools.spindle
        if needed != mounted:
            return f"T{needed} belongs into the spindle there: change the tool first"
        return ""

    def arrival(self, control: Control, stand: FloatArray, line: int) -> Chunk:
        """The path to where the block begins, with spindle and coolant as they are needed there.

        Args:
            control: After the blocks that were only computed.
            stand: Where the axes are, part coordinates, shape (k,) [mm or deg].
        """
        events = tuple(
            dataclasses.replace(event, before=0, at=0.0, line=line)
            for name, event in self._functions.items()
            if name in ("spindle", "coolant", SPINDLE_SPEED)
        )
        return Chunk(approach(control, stand, line, self._clearance), events)
