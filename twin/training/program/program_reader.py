"""A program, or an MDI block, interpreted in parts: up to each place where somebody has to act before the axes go on.

A part ends at a program stop, a tool change, an error, or the end. The axes rest at such places anyway,
so that each part can be planned on its own.
"""

import bisect
import dataclasses
from collections import deque
from collections.abc import Iterator
from typing import Literal

import numpy as np

from twin.machine.description.config import MachineConfig
from twin.machine.watching.travel import soft_limit_alarm
from twin.nc.canonical import Chunk, Event, FloatArray, Function, Motion, Moves
from twin.nc.control.dialect import Dialect
from twin.nc.control.executor import Executor
from twin.nc.control.settings import ControlSettings
from twin.nc.functions import OPTIONAL_STOP, PROGRAM_STOPS, TOOL_CHANGE, SpindleState
from twin.nc.path.feed_rates import FEED_FACTORS
from twin.nc.text.blocks import Block
from twin.nc.text.diagnostics.diagnostics import Diagnostic, ProgramError
from twin.nc.text.source import Source
from twin.run.dry_run.spindle_dwells import SpindleDwells
from twin.training.program.block_search import BlockSearch
from twin.training.program.block_tracker import BlockTracker, ModalState
from twin.training.program.run_options import Inherited, RunOptions

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


MOVES_AT_ONCE = 256
"""Moves that are interpreted before they are handed on."""
READ_AT_ONCE = 200
"""Blocks that are read at once where none of them is driven."""

Ending = Literal["end", "stop", "tool", "wait", "soft-limit", "program"]


class ProgramReader:
    """Interprets a program, a bounded number of blocks at a time.

    Attributes:
        tracker: The blocks of the present part.
        waiting: Groups of them that nobody has taken yet.
        start: Where the part begins, machine coordinates, shape (k,) [mm or deg].
        zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        ending: Why the present part ends; known once it has been interpreted to its end.
        ending_line: Source line at which it ends.
        message: Reason of an ending by error.
        finding: What the interpreter found, where that is the error.
        tool: The tool that a tool change asks for.
        optional: The stop that the present part ends with is M1's.
    """

    def __init__(
        self,
        source: Source,
        dialect: Dialect,
        settings: ControlSettings,
        machine: MachineConfig,
        options: RunOptions,
    ) -> None:
        """Read a program from its beginning.

        Args:
            settings: What the control knows of the machine as it is.

        Raises:
            ProgramError: The program cannot be begun.
        """
        self._machine = machine
        self._options = options
        self._executor = Executor(dialect, settings, source)
        self._executor.prepare()
        self._control = self._executor.control
        if options.inherited is not None:
            options.inherited.put_into(self._control)
        self._search = BlockSearch(options.search)
        self._found: Block | None = None
        self._active: tuple[float, ...] = ()
        self._codes: tuple[str, ...] = ()
        self.optional = False
        self.ending: Ending | None = None
        self.ending_line = 0
        self.message = ""
        self.finding: Diagnostic | None = None
        self.tool: int | None = self._control.tools.spindle
        self.start = self.zero = np.zeros(0)
        self._clear_part()

    def _clear_part(self) -> None:
        self.tracker = BlockTracker()
        self.moves = MoveWindow()
        self.waiting: deque[Chunk] = deque()

    def begin_part(self, start: FloatArray, zero: FloatArray, spindle: SpindleState) -> None:
        """Go on with the part that comes next.

        Args:
            start: Where the setpoints are, machine coordinates, shape (k,) [mm or deg].
            zero: Machine coordinates of program zero, shape (k,) [mm or deg].
            spindle: What it has been commanded: the axes wait until it has come to its speed.
        """
        self._clear_part()
        tools = self._control.tools
        table = self._machine.file.spindle
        self._spindle_dwells = SpindleDwells(table, {}, tools.spindle or 0, spindle, tools.selected)
        self.start, self.zero = start, zero
        self.ending = None

    def read(self, start: FloatArray, zero: FloatArray, spindle: SpindleState) -> Iterator[Moves]:
        """Interpret the part that comes next to its end, for somebody who drives none of it.

        Args:
            start: As for ``begin_part``.
            zero: As for ``begin_part``.
            spindle: As for ``begin_part``.

        Yields:
            Moves, none where ``READ_AT_ONCE`` blocks made too few to be handed on; ``ending`` is
            known behind the last.
        """
        self.begin_part(start, zero, spindle)
        while self.ending is None:
            self.interpret(READ_AT_ONCE)
            if self.ending is None and not self.waiting:
                self.hand_on()
            read = [chunk.moves for chunk in self.waiting]
            self.waiting.clear()
            yield from read or [Moves.empty(self._control.settings.axes)]

    @property
    def count(self) -> int:
        """Moves of the part that have been interpreted, handed on or not."""
        return self.moves.count + self._control.path.columns.count

    def interpret(self, most: int, driven: int = 0) -> None:
        """Interpret at most so many blocks, until there are enough moves or the part ends.

        Args:
            driven: Moves of the part that the axes have begun.
        """
        columns, stream = self._control.path.columns, self._options.stream
        arrival, refused, enough = None, None, False
        try:
            while most > 0 and not enough and self.ending is None:
                most -= 1
                block = self._next_block(driven)
                if block is None:
                    break
                if self._search.line and block.line == self._search.line:
                    arrival = self._arrive(block)
                    break
                mark = self.count
                refused = columns.refusal(block.line)
                self._executor.run(block)
                refused = None
                if self._search.line:
                    self._search.collect(columns.take())
                    continue
                self._note(block, mark)
                self._look_for_stop(block)
                # the axes come to rest behind the block: no corner follows
                if self.ending is not None:
                    self._control.path.flush()
                enough = columns.count >= MOVES_AT_ONCE
        except ProgramError as error:
            if stream is None:
                self._end_by(error.diagnostic)
            else:
                stream.refuse(self._executor, error.diagnostic)
        streamed = stream is not None and (columns.count or refused is not None)
        if arrival is not None:
            self._finish_chunk(arrival)
        elif enough or self.ending is not None or streamed:
            self._finish_chunk(columns.take(refused))

    def _next_block(self, driven: int) -> Block | None:
        """The next block; None where the part ends, or where no block of a stream has come."""
        control, stream = self._control, self._options.stream
        if stream is not None:
            block = stream.next(self._executor, self.count - driven)
            if block is None and control.ended:
                self.end_stream()
            return block
        block, self._found = self._found, None
        if block is None and not control.ended:
            block = control.program_counter.next()
        if block is None:
            if self._options.typed:
                control.path.finish()
            else:
                self._executor.finish()
            self.ending = "end"
            if self._search.line:
                self._fail(
                    self._search.line, f"the program never comes to line {self._search.line}"
                )
        return block

    def take(self) -> Chunk | None:
        """The next group of moves; None: there is none."""
        return self.waiting.popleft() if self.waiting else None

    def hand_on(self) -> None:
        """Hand on the moves that there are, though they are few."""
        if self._control.path.columns.count:
            self._finish_chunk(self._control.path.columns.take())

    def end_here(self) -> None:
        """End the part where the planner is quicker than the interpreter; it goes on with another one."""
        if self._options.stream is not None:
            self.end_stream()
            return
        self._finish_chunk(self._control.path.columns.take())
        if not len(self.waiting[-1].moves) and self.ending is None:
            self.ending = "wait"

    def end_stream(self) -> None:
        """What has been streamed is a whole: what comes now begins another part."""
        self._control.path.finish()
        self.ending = "end"
        self._finish_chunk(self._control.path.columns.take())

    def _fail(self, line: int, message: str) -> None:
        self.ending, self.ending_line, self.message = "program", line, message

    def _end_by(self, finding: Diagnostic) -> None:
        """The program is wrong."""
        self.finding = finding
        self.tracker.forget_refused(finding.line, self.count)
        self._fail(finding.line, f"{finding.code}: {finding.message}")

    def _finish_chunk(self, chunk: Chunk) -> None:
        """Hand moves on to the planner, up to the first one that would leave the travel."""
        alarm = None
        dry = self._options.dry_feed
        if dry is not None:
            feeds = np.where(chunk.moves.motion == Motion.FEED, dry, chunk.moves.feed)
            chunk = Chunk(dataclasses.replace(chunk.moves, feed=feeds), chunk.events)
        if self._options.soft_limits:
            alarm = soft_limit_alarm(self._machine, chunk.moves, self.zero)
        if alarm is not None:
            outside = int(np.flatnonzero(chunk.moves.line == alarm.line)[0])
            chunk = Chunk(chunk.moves[:outside], ())
            self.tracker.forget_refused(alarm.line, self.moves.count + outside)
            self.ending, self.ending_line, self.message = "soft-limit", alarm.line, alarm.message
        # No time passes for a tool that is not there: the change is reported at once.
        changes = self.ending == "tool"
        happen = [one for one in chunk.events if changes or not _is_tool_change(one)]
        chunk = Chunk(chunk.moves, tuple(self._spindle_dwells.among(happen)))
        for event in chunk.events:
            self.tracker.note_event(self.moves.count, event)
        self.moves.add(chunk.moves)
        self.waiting.append(chunk)

    def _note(self, block: Block, mark: int) -> None:
        control = self._control
        active = control.modal.active.numbers()
        if active != self._active:
            self._active, self._codes = active, tuple(map(self._executor.dialect.code_name, active))
        factor = FEED_FACTORS.get(control.modal.feed_mode)
        feed, tool = control.motion.feed, control.tools.spindle
        self.tracker.note(mark, ModalState(block.line, self._codes, feed, tool, factor))

    def _look_for_stop(self, block: Block) -> None:
        words = [f"M{word.value:g}" for word in block.words if word.address == "M"
                 and isinstance(word.value, float)]  # fmt: skip
        if TOOL_CHANGE in words:
            self.ending, self.ending_line = "tool", block.line
            self.tool = self._control.tools.spindle
            if self.tool not in self._control.settings.tools:
                self._fail(block.line, f"no tool {self.tool}")
        elif any(word in PROGRAM_STOPS for word in words):
            self.ending, self.ending_line = "stop", block.line
            self.optional = OPTIONAL_STOP in words

    def _arrive(self, block: Block) -> Chunk | None:
        """The block that was searched for comes next: the move to where it begins, and a stop there."""
        control, self._found = self._control, block
        self._search.end()
        control.path.columns.take()
        refusal = self._search.refusal(control, self.tool)
        if refusal:
            self._fail(block.line, refusal)
            return None
        self.ending, self.ending_line, self.optional = "stop", block.line, False
        self._note(block, self.moves.count)
        return self._search.arrival(control, self.start - self.zero, block.line)

    def left(self) -> Inherited:
        """What an MDI block leaves in force for the next one; a stream its dialect's memory as well."""
        return Inherited.of(self._control, memory=self._options.stream is not None)


def _is_tool_change(event: Event) -> bool:
    return isinstance(event, Function) and event.word == TOOL_CHANGE
