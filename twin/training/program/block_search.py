"""Block search: what stands before a block is only computed, then the axes go to where it begins."""

import dataclasses
import math

from twin.nc.canonical import Chunk, FloatArray, Function
from twin.nc.control.control import Control
from twin.nc.functions import (
    COOLANT_OFF,
    COOLANT_ON,
    SPINDLE_SPEED,
    SPINDLE_STARTS,
    SPINDLE_STOPS,
)
from twin.training.program.approach import Z, approach

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
        """The way to where the block begins, with spindle and coolant as they are needed there.

        Args:
            control: After the blocks that were only computed.
            stand: Where the axes are, part coordinates, shape (k,) [mm or deg].
            line: Source line of the block.
        """
        events = tuple(
            dataclasses.replace(event, before=0, at=0.0, line=line)
            for name, event in self._functions.items()
            if name in ("spindle", "coolant", SPINDLE_SPEED)
        )
        return Chunk(approach(control, stand, line, self._clearance), events)
