"""Tool lengths along a program: which are called, and what is fed while none of the tool in the spindle counts."""

from typing import NamedTuple

import numpy as np

from twin.nc.canonical import Chunk, Motion
from twin.nc.control.tools import LENGTH_ENDED, Tools


class LengthCall(NamedTuple):
    """A tool's length put into force.

    Attributes:
        number: Whose length.
        spindle: The tool in the spindle behind that block; None: there is none.
    """

    number: int
    spindle: int | None


class LengthCalls:
    """Follows a program block by block.

    Attributes:
        calls: Calls of tool lengths by the number of a tool, by source line.
        fed_without: Lines that feed behind a call whose length was ended, or was called for a tool that is not in the
            spindle any more.
    """

    def __init__(self, *, by_code: bool) -> None:
        """Nothing was run yet; ``by_code``: as ``Rules.length_by_code``."""
        self.calls: dict[int, LengthCall] = {}
        self.fed_without: set[int] = set()
        self._by_code = by_code
        self._called_for: int | None = None
        self._ended = False
        self._begin: int | None = None
        self._stretches: list[tuple[int, int]] = []

    def note(self, tools: Tools, line: int, move: int) -> None:
        """A block was run.

        Args:
            move: Its first move, counted from the first of the chunk that is being made.
        """
        number, tools.length_call = tools.length_call, None
        if number == LENGTH_ENDED:
            # Where a code alone calls a length, one that ends it before the first call is that of a start line.
            self._ended = not self._by_code or self._called_for is not None
        elif number is not None:
            self.calls[line] = LengthCall(number, tools.spindle)
            self._called_for, self._ended = tools.spindle, False
        without = self._ended or self._called_for not in {None, tools.spindle}
        if without and self._begin is None:
            self._begin = move
        elif not without and self._begin is not None:
            self._stretches.append((self._begin, move))
            self._begin = None

    def passed(self, chunk: Chunk) -> Chunk:
        """Take note of the moves of a chunk that is complete."""
        moves = chunk.moves
        if self._begin is not None:
            self._stretches.append((self._begin, len(moves)))
            self._begin = 0
        for begin, end in self._stretches:
            feeds = np.flatnonzero(moves.motion[begin:end] != Motion.RAPID) + begin
            self.fed_without.update(np.unique(moves.line[feeds]).tolist())
        self._stretches.clear()
        return chunk
