"""The moves of a part around the axes: those that have been interpreted and are not long driven."""

import bisect

from twin.nc.canonical import FloatArray, Motion, Moves

MOVES_KEPT_BEHIND = 2
"""Moves behind the axes that are remembered: a stop at a block's end may count as the next one's beginning."""


class MoveWindow:
    """Moves of a part by their number.

    Attributes:
        count: Moves that have been interpreted so far.
    """

    def __init__(self) -> None:
        self.count = 0
        self._moves: list[Moves] = []
        self._firsts: list[int] = []

    def add(self, moves: Moves) -> None:
        """Moves that come next."""
        self._firsts.append(self.count)
        self._moves.append(moves)
        self.count += len(moves)

    def forget_behind(self, move: int) -> None:
        """Drop what nobody asks for once the axes are past it: a program may be endless."""
        while len(self._firsts) > 1 and self._firsts[1] < move - MOVES_KEPT_BEHIND:
            del self._firsts[0], self._moves[0]

    def rapid(self, move: int) -> bool:
        """Whether a move is a rapid."""
        found = self._find(move)
        return found is not None and int(found[0].motion[found[1]]) == Motion.RAPID

    def line(self, move: int) -> int | None:
        """Source line of a move; None: it is not known."""
        found = self._find(move)
        return None if found is None else int(found[0].line[found[1]])

    def target(self, move: int) -> tuple[FloatArray, FloatArray] | None:
        """Where a move ends and what the screen shows there, part coordinates, (k,) each."""
        found = self._find(move)
        return None if found is None else (found[0].end[found[1]], found[0].display[found[1]])

    def _find(self, move: int) -> tuple[Moves, int] | None:
        if not self._firsts or not self._firsts[0] <= move < self.count:
            return None
        chunk = bisect.bisect_right(self._firsts, move) - 1
        return self._moves[chunk], move - self._firsts[chunk]
