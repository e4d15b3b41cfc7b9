"""Additional axes that go evenly over several moves (CODESYS SoftMotion's G71 and G70).

From G71 to G70 such an axis keeps one slope over the length of the path, wherever between them the
program names it (the library's page on SMC_SmoothAddAxes). So the moves are kept until G70.
"""

import dataclasses
from collections.abc import Callable

from twin.nc.canonical import Event
from twin.nc.path.move_columns import Segment
from twin.nc.path.segments import spatial_length

MOST_MOVES = 10_000
"""Moves between G71 and G70; the page leaves this to the size of a buffer."""


class SynchronousAxes:
    """Holds the moves over which axes go evenly."""

    def __init__(self, emit: Callable[[Segment], None], happen: Callable[[Event], None]) -> None:
        self._emit = emit
        self._happen = happen
        self._held: list[Segment | Event] = []
        self._begins: dict[int, int] = {}

    @property
    def idle(self) -> bool:
        """No axis goes evenly, and nothing is kept."""
        return not self._begins

    def begin(self, axis: int) -> None:
        """The axis of this column goes evenly over the moves that follow."""
        self._begins.setdefault(axis, len(self._held))

    def end(self, axis: int) -> None:
        """It has arrived."""
        begin = self._begins.pop(axis, None)
        if begin is not None:
            self._spread(axis, begin)
        if not self._begins:
            held, self._held = self._held, []
            for each in held:
                if not isinstance(each, Segment):
                    self._happen(each)
                elif each.center is not None or each.start != each.end:
                    self._emit(each)

    def finish(self) -> None:
        """The program has ended: every axis has arrived."""
        for axis in list(self._begins):
            self.end(axis)

    def add(self, move: Segment) -> bool:
        """The next move; False where there are too many to hold."""
        self._held.append(move)
        return len(self._held) <= MOST_MOVES

    def event(self, event: Event) -> None:
        """Something that happens where the path has come to."""
        self._held.append(event)

    def _spread(self, axis: int, begin: int) -> None:
        held = enumerate(self._held[begin:], begin)
        moves = [(row, each) for row, each in held if isinstance(each, Segment)]
        total = sum(spatial_length(move) for _, move in moves)
        if total == 0.0:
            return
        first, last = moves[0][1].start[axis], moves[-1][1].end[axis]
        distance, here = 0.0, first
        for row, move in moves:
            distance += spatial_length(move)
            there = last if distance == total else first + (last - first) * distance / total
            self._held[row] = dataclasses.replace(
                move,
                start=_with(move.start, axis, here),
                end=_with(move.end, axis, there),
                display=_with(move.display, axis, move.display[axis] + there - move.end[axis]),
            )
            here = there


def _with(position: list[float], axis: int, value: float) -> list[float]:
    return [*position[:axis], value, *position[axis + 1 :]]
