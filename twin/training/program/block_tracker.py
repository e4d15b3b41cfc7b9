"""The blocks of a part of a program, and how far single block has let them go.

Single block stops behind every block, also behind one that moves nothing (LinuxCNC, "Running a
program one block at a time"; Fagor 8070, operating manual, "single block"). Blocks with motion are
stopped by the planner; between two of them each further press of start goes one block on.
"""

import bisect
import copy
import dataclasses
import itertools
from collections import deque
from typing import Self

from twin.copies import Forkable
from twin.nc.canonical import Dwell, Event, Function

FORGOTTEN_AT_ONCE = 256
"""Blocks behind the axes that are dropped together."""


@dataclasses.dataclass(frozen=True, slots=True)
class ModalState:
    """What is in force while a block runs.

    Attributes:
        codes: G codes in force, such as ``G90``.
        feed: As programmed, or None.
        tool: Number of the tool in the spindle, or None.
        per_minute: What the programmed feed is multiplied by to count per minute; None: it counts
            something else.
    """

    line: int
    codes: tuple[str, ...]
    feed: float | None
    tool: int | None
    per_minute: float | None = 1.0


class BlockTracker(Forkable):
    """What single block knows of a part.

    Attributes:
        blocks: What is in force in each block, in the order in which they run.
        paused: Start is waited for behind a block.
        singly: Source lines that were run from one press of start to the stop behind them.
    """

    def __init__(self) -> None:
        self.blocks: list[ModalState] = []
        self.paused = False
        self.singly: set[int] = set()
        self._marks: list[int] = []
        self._events: deque[tuple[float, int, Event]] = deque()
        self._current = -1
        self._of_event = 0
        self._stepping = False

    def fork(self) -> Self:
        """An independent copy; blocks and events are immutable."""
        other = copy.copy(self)
        for name, value in vars(self).items():
            setattr(other, name, copy.copy(value))
        return other

    def note(self, mark: int, state: ModalState) -> None:
        """A block has been interpreted.

        Args:
            mark: How many moves of the part came before it.
        """
        self._marks.append(mark)
        self.blocks.append(state)

    def note_event(self, moves: int, event: Event) -> None:
        """A function of the blocks so far, or a wait; ``moves``: how many of the part lie before its chunk."""
        for index in range(self._of_event, len(self.blocks)):
            if self.blocks[index].line == event.line:
                self._of_event = index
                break
        at = event.at if isinstance(event, Function) else 0.0
        self._events.append((moves + event.before + at, self._of_event, event))

    def forget(self, move: int) -> None:
        """Drop the blocks before the one that a move belongs to: a program may be endless."""
        gone = self.of_move(move)
        if self._stepping or self.paused:
            gone = min(gone, self._current)
        if gone < FORGOTTEN_AT_ONCE:
            return
        del self.blocks[:gone], self._marks[:gone]
        self._current = max(self._current - gone, -1)
        self._of_event = max(self._of_event - gone, 0)
        self._events = deque((at, block - gone, event) for at, block, event in self._events)

    def forget_refused(self, line: int, move: int) -> None:
        """The block of a source line that was to begin with a move is refused: nothing of it was in force."""
        begins = range(bisect.bisect_left(self._marks, move), len(self.blocks))
        first = next((each for each in begins if self.blocks[each].line == line), len(self.blocks))
        del self.blocks[first:], self._marks[first:]

    def of_move(self, move: int) -> int:
        """Number of the block that a move belongs to, as far as its mark tells; -1: none."""
        return bisect.bisect_right(self._marks, max(move, 0)) - 1

    @property
    def line(self) -> int:
        """Source line of the block that was reached last; 0: none."""
        return self.blocks[self._current].line if 0 <= self._current < len(self.blocks) else 0

    @property
    def at_last(self) -> bool:
        """Whether all blocks that are known have been run."""
        return self._current >= len(self.blocks) - 1

    @property
    def next_is_last(self) -> bool:
        """Whether the next block is the last that is known, or there is none."""
        return self._current + 1 >= len(self.blocks) - 1

    def state(self, move: int) -> ModalState | None:
        """What is in force during a move, or where start is waited for."""
        if not self.blocks:
            return None
        index = self._current if self.paused else self.of_move(move)
        return self.blocks[min(max(index, 0), len(self.blocks) - 1)]

    def pause_before_all(self) -> None:
        """Start is waited for before the first block."""
        self.paused, self._stepping = True, True

    def run_next(self) -> None:
        """The next block, which moves, begins; or what is left comes to its end."""
        self.paused, self._stepping = False, True
        self._current = min(self._current + 1, max(len(self.blocks) - 1, 0))
        if self.at_last and self.blocks:
            self.singly.add(self.line)

    def pass_one(self) -> None:
        """The next block, which does not move, has been run."""
        self._current += 1
        self.paused, self._stepping = True, True
        self.singly.add(self.line)

    def stop_behind(self, move: int, line: int) -> None:
        """The axes have stopped at the end of a block.

        Args:
            move: The last move that was run, or part of it.
        """
        if self._stepping and self.line == line:
            self.singly.add(line)
        else:
            at = self.of_move(move)
            while at > 0 and self.blocks[at].line != line:
                at -= 1
            self._current = at
        self.paused = True

    def end_singly(self) -> None:
        """The block behind which the axes have stopped was the last one: nothing waits."""
        self.paused = False

    def go_freely(self) -> None:
        """Single block is off."""
        self.paused = self._stepping = False

    def next_line(self) -> int:
        """Source line of the block that comes next; 0 where none is known."""
        index = self._current + 1
        return self.blocks[index].line if index < len(self.blocks) else 0

    def due(self, place: float, line: int) -> list[Function]:
        """Functions that have happened and were not reported yet: what they wait for is over.

        Args:
            place: How many moves, and which share of the next, lie behind.
            line: Source line of what the setpoints do there, be it a wait.
        """
        last = self._current if self._stepping or self.paused else len(self.blocks)
        found: list[Function] = []
        while self._events:
            at, block, event = self._events[0]
            behind = self.paused and block <= self._current
            if block > last or (at > place and not behind):
                break
            if isinstance(event, Function):
                found.append(event)
            elif at == place and not behind and not self._is_over(line):
                break
            self._events.popleft()
        return found

    def _is_over(self, line: int) -> bool:
        """Whether the setpoints have come from the first wait that is noted to a later one."""
        first, _, wait = self._events[0]
        here = itertools.takewhile(lambda one: one[0] == first, self._events)
        return line != wait.line and any(
            isinstance(event, Dwell) and event.line == line for _, _, event in here
        )
