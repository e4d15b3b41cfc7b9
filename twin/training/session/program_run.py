"""A program, or an MDI block, on its way to the machine: parts between stops, each with its moves.

The program is interpreted block by block. It is cut into parts where an operator or the control
has to do something before the axes go on: a program stop, a tool change, an error. The axes rest at
such places anyway, so that each part can be planned on its own. It is interpreted ahead of the
axes, a bounded number of blocks in each slice of time, so that a program that loops for ever keeps
nobody waiting: where the axes have caught up with it, they come to rest until there are moves. All that was asked of a run is noted, so that it can be copied at any moment.
"""

import bisect
import dataclasses
import math
from collections import deque
from collections.abc import Iterator
from typing import Any, Literal

import numpy as np

from twin.machine.description.config import Machine
from twin.machine.description.motion_limits import motion_limits
from twin.machine.watching.travel import soft_limit_alarm
from twin.motion.live.live_motion import LiveMotion
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Chunk, FloatArray, Function, Motion, Moves
from twin.nc.control.dialect import Dialect
from twin.nc.control.executor import Executor
from twin.nc.control.settings import ControlSettings
from twin.nc.functions import PROGRAM_STOPS, TOOL_CHANGE
from twin.nc.text.blocks import Block
from twin.nc.text.diagnostics import Diagnostic, ProgramError
from twin.nc.text.source import Source

MOVES_AT_ONCE = 256
"""Moves that are interpreted before the planner hears of them."""
CHUNKS_AHEAD = 4
"""Groups of so many moves that are interpreted ahead of the planner."""
BLOCKS_AT_REST, BLOCKS_IN_MOTION = 200, 50
"""Blocks that are interpreted in one slice of time, before the axes move and while they do."""
BLOCKS_FOR_PLANNER = 400
"""Blocks more that are interpreted in one slice where the planner has caught up."""
SLICES_AT_REST = 100
"""Slices after which the axes begin with what moves there are."""

MADE_AGAIN_AT_ONCE = 100
"""Slices that a copied run is planned by when it is made again."""

LARGEST_OVERRIDE = 1.2
"""Factor at the end of the feed override dial."""

Ending = Literal["end", "stop", "tool", "wait", "soft-limit", "program"]


@dataclasses.dataclass(frozen=True, slots=True)
class ModalState:
    """What is in force while a block runs.

    Attributes:
        line: Source line.
        codes: G codes in force, such as ``G90``.
        feed: As programmed, or None.
        tool: Number of the tool in the spindle, or None.
    """

    line: int
    codes: tuple[str, ...]
    feed: float | None
    tool: int | None


class ProgramRun:
    """One run of a program.

    Attributes:
        ending: Why the present part ends; known once it has been interpreted to its end.
        message: What there is to say of an ending by error.
        finding: What the interpreter found, where that is the error.
        tool: The tool that a tool change asks for.
        dropped: An operator has given up the rest.
    """

    def __init__(
        self,
        source: Source,
        dialect: Dialect,
        settings: ControlSettings,
        machine: Machine,
        *,
        soft_limits: bool = True,
    ) -> None:
        """Read a program from its beginning.

        Args:
            source: The program.
            dialect: Its language.
            settings: What the control knows of the machine as it stands.
            machine: The machine.
            soft_limits: Whether to stop before a move that leaves the travel.

        Raises:
            ProgramError: The program cannot be begun.
        """
        self._recipe = (source, dialect, settings, machine, soft_limits)
        self._journal: list[tuple[Any, ...]] = []
        self._machine = machine
        self._limits = motion_limits(machine)
        self._control = Executor(dialect, settings, source)
        self._control.prepare()
        self._soft_limits = soft_limits
        self.dropped = False
        self.ending: Ending | None = None
        self.ending_line = 0
        self.message = ""
        self.finding: Diagnostic | None = None
        self.tool: int | None = self._control.tools.spindle
        self._begin = np.zeros(0), np.zeros(0)
        self._forget()

    def __deepcopy__(self, _memo: dict[int, Any]) -> "ProgramRunCopy":
        """What is needed to make this run again: planning it anew is cheap, its generators stay."""
        return ProgramRunCopy(self._recipe, tuple(self._journal))

    @property
    def begun(self) -> bool:
        """Whether the present part has moves for the axes."""
        return self._motion is not None

    @property
    def held(self) -> bool:
        """Whether cycle start is waited for."""
        return self._motion is not None and self._motion.held

    @property
    def finished(self) -> bool:
        """Whether the present part has come to its end, or to rest after ``drop``."""
        return self.dropped if self._motion is None else self._motion.finished

    def begin(self, start: FloatArray, zero: FloatArray) -> None:
        """Plan the part that comes next.

        Args:
            start: Where the setpoints stand, machine coordinates, shape (k,) [mm or deg].
            zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        """
        self._journal.append(("begin", start, zero))
        self._forget()
        self._begin = start, zero
        self.ending = None
        self._look_ahead()

    def drive(self, count: int, feed: float, rapid: float, *, single: bool) -> Setpoints | None:
        """The next setpoints; None while the first moves are being interpreted.

        Args:
            count: How many servo periods.
            feed: Factor of the feed override.
            rapid: Factor of the rapid override.
            single: Whether to stop at the end of every block.
        """
        self._note_drive(count, feed, rapid, single)
        self._look_ahead()
        motion = self._motion
        if motion is None:
            return None
        motion.feed_override, motion.rapid_override = feed, rapid
        motion.single_block = single
        return motion.advance(count)

    def _note_drive(self, count: int, feed: float, rapid: float, single: bool) -> None:
        settings = (feed, rapid, single)
        last = self._journal[-1]
        if last[0] == "drive" and last[2:] == (count, *settings):
            self._journal[-1] = ("drive", last[1] + 1, count, *settings)
        else:
            self._journal.append(("drive", 1, count, *settings))

    def hold(self) -> None:
        """Stop on the path until ``start``."""
        self._journal.append(("hold",))
        if self._motion is not None:
            self._motion.hold()

    def start(self) -> None:
        """Go on after a hold or at the end of a single block."""
        self._journal.append(("start",))
        if self._motion is not None:
            self._motion.start()

    def drop(self) -> None:
        """Come to rest on the path, and forget the rest."""
        self._journal.append(("drop",))
        self.dropped = True
        if self._motion is not None:
            self._motion.reset()

    def _look_ahead(self) -> None:
        """Interpret some blocks more; the axes can go once there are moves."""
        most = BLOCKS_AT_REST if self._motion is None else BLOCKS_IN_MOTION
        self._left = BLOCKS_FOR_PLANNER
        if self.ending is None and len(self._waiting) < CHUNKS_AHEAD:
            self._interpret(most)
        self._looks += 1
        if self._motion is None and self._looks > SLICES_AT_REST and len(self._control.path):
            self._finish_chunk(self._control.path.take())
        if self._motion is None and self._waiting:
            start, zero = self._begin
            self._motion = LiveMotion(
                self._chunks(),
                self._limits,
                period_s=self._machine.file.servo_period_s,
                part_zero=zero,
                start=start,
                largest_override=LARGEST_OVERRIDE,
            )

    def _forget(self) -> None:
        self._motion: LiveMotion | None = None
        self._looks = self._left = 0
        self._waiting: deque[Chunk] = deque()
        self._count = 0
        self._marks: list[int] = []
        self._modal: list[ModalState] = []
        self._functions: list[tuple[int, Function]] = []
        self._moves: list[Moves] = []
        self._firsts: list[int] = []

    def _chunks(self) -> Iterator[Chunk]:
        """What the planner pulls; where it is quicker than the interpreter, the part ends there."""
        while True:
            if not self._waiting and self.ending is None:
                self._interpret(min(BLOCKS_IN_MOTION, self._left))
                self._left -= BLOCKS_IN_MOTION
            if not self._waiting and self.ending is None:
                self._finish_chunk(self._control.path.take())
                if not len(self._waiting[-1].moves) and self.ending is None:
                    self.ending = "wait"
            if not self._waiting:
                return
            yield self._waiting.popleft()

    def _interpret(self, most: int) -> None:
        """Interpret at most so many blocks, until there are enough moves or the part ends."""
        control = self._control
        enough = False
        try:
            while most > 0 and not enough and self.ending is None:
                most -= 1
                block = None if control.ended else control.program_counter.next()
                if block is None:
                    control.finish()
                    self.ending = "end"
                    break
                self._marks.append(self._count + len(control.path))
                control.run(block)
                self._note(block)
                self._look_for_stop(block)
                enough = len(control.path) >= MOVES_AT_ONCE
        except ProgramError as error:
            self._end_by(error.diagnostic)
        if enough or self.ending is not None:
            self._finish_chunk(control.path.take())

    def _end_by(self, finding: Diagnostic) -> None:
        """The program is wrong."""
        self.ending, self.finding = "program", finding
        self.message, self.ending_line = f"{finding.code}: {finding.message}", finding.line

    def _finish_chunk(self, chunk: Chunk) -> None:
        """Hand moves on to the planner, up to the first one that would leave the travel."""
        alarm = None
        if self._soft_limits:
            alarm = soft_limit_alarm(self._machine, chunk.moves, self._begin[1])
        if alarm is not None:
            outside = int(np.flatnonzero(chunk.moves.line == alarm.line)[0])
            chunk = Chunk(chunk.moves[:outside], ())
            self.ending, self.message = "soft-limit", alarm.message
            self.ending_line = alarm.line
        self._functions += [
            (self._count + event.before, event)
            for event in chunk.events
            if isinstance(event, Function)
        ]
        self._firsts.append(self._count)
        self._moves.append(chunk.moves)
        self._count += len(chunk.moves)
        self._waiting.append(chunk)

    def _note(self, block: Block) -> None:
        control = self._control
        codes = tuple(f"G{number}" for number in control.active.values())
        self._modal.append(ModalState(block.line, codes, control.feed, control.tools.spindle))

    def _look_for_stop(self, block: Block) -> None:
        words = [f"M{word.value:g}" for word in block.words if word.address == "M"
                 and isinstance(word.value, float)]  # fmt: skip
        if TOOL_CHANGE in words:
            self.ending, self.tool = "tool", self._control.tools.spindle
        elif any(word in PROGRAM_STOPS for word in words):
            self.ending = "stop"
        if self.ending is not None:
            self.ending_line = block.line

    def passed(self, setpoints: Setpoints) -> list[Function]:
        """The functions that have happened since the last call."""
        if self._motion is None:
            return []
        place = math.inf if self.finished else -1.0
        if len(setpoints) and not self.finished:
            place = int(setpoints.move[-1]) + float(setpoints.fraction[-1])
        happened = [function for move, function in self._functions if move + function.at <= place]
        del self._functions[: len(happened)]
        return happened

    def modal(self, move: int) -> ModalState | None:
        """What is in force during a move of the part."""
        if not self._modal:
            return None
        index = bisect.bisect_right(self._marks, max(move, 0)) - 1
        return self._modal[min(max(index, 0), len(self._modal) - 1)]

    def rapid(self, move: int) -> bool:
        """Whether a move of the part is a rapid."""
        found = self._find(move)
        return found is not None and int(found[0].motion[found[1]]) == Motion.RAPID

    def target(self, move: int) -> tuple[FloatArray, FloatArray] | None:
        """Where a move ends and what the screen shows there, part coordinates, (k,) each."""
        found = self._find(move)
        return None if found is None else (found[0].end[found[1]], found[0].display[found[1]])

    def _find(self, move: int) -> tuple[Moves, int] | None:
        if move < 0 or move >= self._count:
            return None
        chunk = bisect.bisect_right(self._firsts, move) - 1
        return self._moves[chunk], move - self._firsts[chunk]


@dataclasses.dataclass(frozen=True)
class ProgramRunCopy:
    """A run that was copied and can be made again.

    Attributes:
        recipe: What the run was made of.
        journal: What was asked of it, in order.
    """

    recipe: tuple[Source, Dialect, ControlSettings, Machine, bool]
    journal: tuple[tuple[Any, ...], ...]

    def made_again(self) -> ProgramRun:
        """The run as it was when it was copied."""
        source, dialect, settings, machine, soft_limits = self.recipe
        run = ProgramRun(source, dialect, settings, machine, soft_limits=soft_limits)
        for what, *given in self.journal:
            if what == "drive":
                times, count, feed, rapid, single = given
                while times:
                    together = min(times, MADE_AGAIN_AT_ONCE) if run.begun else 1
                    times -= together
                    setpoints = run.drive(together * count, feed, rapid, single=single)
                    if setpoints is not None:
                        run.passed(setpoints)
            else:
                getattr(run, what)(*given)
        return run
