"""A program, or an MDI block, on its way to the machine: parts between stops, each with its moves.

The program is interpreted block by block. It is cut into parts where an operator or the control
has to do something before the axes go on: a program stop, a tool change, an error. The axes rest at
such places anyway, so that each part can be planned on its own. It is interpreted ahead of the
axes, a bounded number of blocks in each slice of time, so that a program that loops for ever keeps
nobody waiting: where the axes have caught up with it, they come to rest until there are moves.
"""

import bisect
import dataclasses
import math
from collections import deque
from collections.abc import Iterator
from typing import Literal, NamedTuple, Protocol

import numpy as np

from twin.machine.description.config import Machine
from twin.machine.description.motion_limits import motion_limits
from twin.machine.watching.travel import soft_limit_alarm
from twin.motion.blocks.corners import CONTEXT
from twin.motion.live.live_motion import LiveMotion
from twin.motion.profile.windows import LOOK_AHEAD
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Chunk, Event, FloatArray, Function, Motion, Moves
from twin.nc.control.dialect import Dialect
from twin.nc.control.executor import Executor
from twin.nc.control.modal import Modal
from twin.nc.control.settings import ControlSettings
from twin.nc.functions import (
    COOLANT_OFF,
    COOLANT_ON,
    OPTIONAL_STOP,
    PROGRAM_STOPS,
    SPINDLE_SPEED,
    SPINDLE_STARTS,
    SPINDLE_STOPS,
    TOOL_CHANGE,
    SpindleState,
)
from twin.nc.geometry.frame import SHIFTS
from twin.nc.path.feed_rates import FEED_FACTORS
from twin.nc.text.blocks import Block
from twin.nc.text.diagnostics import Diagnostic, ProgramError
from twin.nc.text.source import Source
from twin.run.waits import Waits
from twin.training.session.approach import Z, approach
from twin.training.session.block_walk import BlockWalk, ModalState

MOVES_AT_ONCE = 256
"""Moves that are interpreted before the planner hears of them."""
CHUNKS_AHEAD = 2 * math.ceil(LOOK_AHEAD / MOVES_AT_ONCE)
"""Groups of so many moves that are interpreted ahead of the planner, to begin with: where it makes one
block of several moves, it looks ahead to more of them."""
BLOCKS_AT_REST, BLOCKS_IN_MOTION = 200, 50
"""Blocks that are interpreted in one slice of time, before the axes move and while they do."""
BLOCKS_FOR_PLANNER = 400
"""Blocks more that are interpreted in one slice where the planner has caught up."""
PLANNED_AT_REST = 8
"""Steps of planning in one slice before the axes can go: corners that are tried take a few milliseconds each."""
MOVES_KEPT_BEHIND = 2
"""Moves behind the axes that are remembered: a stop at a block's end may count as the next one's beginning."""
SLICES_AT_REST = 100
"""Slices after which the axes begin with what moves there are."""

STREAMED_LOOK_AHEAD = 64
"""Blocks of a stream that are planned at a time, and that the planner sees at least beyond these."""
STREAMED_AHEAD = 3 * STREAMED_LOOK_AHEAD + CONTEXT
"""Moves of a stream that make its axes begin, though more come: what the planner sees at least."""

LARGEST_OVERRIDE = 1.2
"""Factor at the end of the feed override dial."""

NO_COMPENSATION = 40
"""G code that ends radius compensation, in every dialect that has any."""

PASSED = 0.5
"""A stop at the end of a block is given as the end of its move or as the beginning of the next."""


class _TooFewMovesError(Exception):
    """The planner cannot begin yet without ending the part where the program goes on."""


Ending = Literal["end", "stop", "tool", "wait", "soft-limit", "program"]


class BlockStream(Protocol):
    """Blocks that come while they are run, as a sender streams them.

    They are a program part as long as they come: it ends where none came for a while before the axes have begun,
    or where the planner has caught up with them.
    """

    @property
    def quiet(self) -> bool:
        """Whether no block has come for a while."""
        ...

    def next(self, executor: Executor, moves_ahead: int) -> Block | None:
        """The next block, told how many moves lie ahead of the axes; None: none has come, or none is wanted."""
        ...

    def refuse(self, executor: Executor, finding: Diagnostic) -> None:
        """The last block is wrong: it is to leave no trace."""
        ...


class Inherited(NamedTuple):
    """What a block finds in force that those before it, typed in or streamed, left.

    Attributes:
        modal: G codes.
        shifts: Of the part's zero, as the frame keeps them [mm or deg].
        feed: F as programmed, or None.
        spindle: S as programmed, or None [1/min].
        memory: What the dialect remembers, where it outlives a program; None: it begins with its own.
    """

    modal: Modal
    shifts: list[list[float]]
    feed: float | None
    spindle: float | None
    memory: object = None

    def after_offset(self, name: str, column: int, moved: float) -> "Inherited":
        """The same after a work offset has changed: the one in force shifts the part's zero.

        Args:
            name: Of the offset, such as ``G55``.
            column: Of the axis.
            moved: By how much it has changed [mm or deg].
        """
        if name != f"G{self.modal.active.get('offset', 0.0):g}":
            return self
        shifts = [list(shift) for shift in self.shifts]
        shifts[SHIFTS.index("offset")][column] += moved
        return self._replace(shifts=shifts)


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class RunOptions:
    """How a program is run.

    Attributes:
        soft_limits: Whether to stop before a move that leaves the travel.
        dry_feed: What all feeds are replaced by in a dry run [mm/min]; None: none.
        search: Source line to begin at: what stands before it is only computed. 0: the beginning.
        inherited: What is in force at the beginning; None: what the control begins with.
        stream: Where blocks come from, in place of the source.
    """

    soft_limits: bool = True
    dry_feed: float | None = None
    search: int = 0
    inherited: Inherited | None = None
    stream: BlockStream | None = None


class ProgramRun:
    """One run of a program.

    Attributes:
        ending: Why the present part ends; known once it has been interpreted to its end.
        message: What there is to say of an ending by error.
        finding: What the interpreter found, where that is the error.
        tool: The tool that a tool change asks for.
        optional: The stop that the present part ends with is M1's.
        dropped: An operator has given up the rest.
    """

    def __init__(
        self,
        source: Source,
        dialect: Dialect,
        settings: ControlSettings,
        machine: Machine,
        options: RunOptions,
    ) -> None:
        """Read a program from its beginning.

        Args:
            source: The program.
            dialect: Its language.
            settings: What the control knows of the machine as it stands.
            machine: The machine.
            options: How it is run.

        Raises:
            ProgramError: The program cannot be begun.
        """
        self._machine = machine
        self._limits = motion_limits(machine)
        self._executor = Executor(dialect, settings, source)
        self._control = self._executor.control
        self._executor.prepare()
        self._options = options
        self._searched = options.search
        self._found: Block | None = None
        self._arrival: Chunk | None = None
        self._collected: dict[str, Function] = {}
        self._clearance = -math.inf
        if options.inherited is not None:
            self._inherit(options.inherited)
        self._active: tuple[float, ...] = ()
        self._codes: tuple[str, ...] = ()
        self.dropped = False
        self.optional = False
        self.ending: Ending | None = None
        self.ending_line = 0
        self.message = ""
        self.finding: Diagnostic | None = None
        self.tool: int | None = self._control.tools.spindle
        self._begin = np.zeros(0), np.zeros(0)
        self._forget()

    @property
    def held(self) -> bool:
        """Whether cycle start is waited for."""
        return self._motion is not None and (self._motion.held or self._walk.paused)

    @property
    def finished(self) -> bool:
        """Whether the present part has come to its end, or to rest after ``drop``."""
        if self._motion is None or self.dropped:
            return self.dropped and (self._motion is None or self._motion.finished)
        return self._motion.finished and not self._walk.paused

    @property
    def singly(self) -> set[int]:
        """Source lines of the present part that were run in single block, from stop to stop."""
        return self._walk.singly

    def begin(
        self,
        start: FloatArray,
        zero: FloatArray,
        spindle: SpindleState,
        *,
        paused: bool = False,
    ) -> None:
        """Plan the part that comes next.

        Args:
            start: Where the setpoints stand, machine coordinates, shape (k,) [mm or deg].
            zero: Machine coordinates of program zero, shape (k,) [mm or deg].
            spindle: What it has been told: the axes wait until it has come to its speed.
            paused: Whether start is waited for before its first block.
        """
        self._prepare_part(start, zero, spindle)
        self._begin_paused = paused
        self._look_ahead()

    def _prepare_part(self, start: FloatArray, zero: FloatArray, spindle: SpindleState) -> None:
        self._forget()
        tools = self._control.tools
        self._waits = Waits(
            self._machine.file.spindle, {}, tools.spindle or 0, spindle, tools.selected
        )
        self._begin = start, zero
        self.ending = None

    READ_AT_ONCE = BLOCKS_AT_REST

    def read(self, start: FloatArray, zero: FloatArray, spindle: SpindleState) -> Iterator[Moves]:
        """Interpret the part that comes next to its end, for somebody who drives none of it.

        Args:
            start: Where the part begins, machine coordinates, shape (k,) [mm or deg].
            zero: Machine coordinates of program zero, shape (k,) [mm or deg].
            spindle: What it has been told.

        Yields:
            Moves, none where ``READ_AT_ONCE`` blocks made too few to be handed on; ``ending`` is
            known behind the last.
        """
        self._prepare_part(start, zero, spindle)
        while self.ending is None:
            self._interpret(self.READ_AT_ONCE)
            if self.ending is None and not self._waiting and self._control.path.columns.count:
                self._finish_chunk(self._control.path.columns.take())
            read = [chunk.moves for chunk in self._waiting]
            self._waiting.clear()
            yield from read or [Moves.empty(self._control.settings.axes)]

    def drive(self, count: int, feed: float, rapid: float, *, single: bool) -> Setpoints | None:
        """The next setpoints; None while the first moves are being interpreted.

        Args:
            count: How many servo periods.
            feed: Factor of the feed override.
            rapid: Factor of the rapid override.
            single: Whether to stop at the end of every block.
        """
        self._look_ahead()
        motion = self._motion
        if motion is None:
            return None
        motion.feed_override, motion.rapid_override = feed, rapid
        motion.single_block = single
        self._single = single
        if not self._driven:
            self._driven = True
            self._begin_singly()
        setpoints = motion.advance(count)
        if len(setpoints):
            self._move = int(setpoints.move[-1])
            self._forget_behind(int(setpoints.move[0]))
        if single and not self.dropped and not self._walk.paused:
            self._stop_behind_block(motion, setpoints)
        return setpoints

    def _forget_behind(self, move: int) -> None:
        """Drop what nobody asks for once the axes are past it: a program may be endless."""
        while len(self._firsts) > 1 and self._firsts[1] < move - MOVES_KEPT_BEHIND:
            del self._firsts[0], self._moves[0]
        self._walk.forget(move - MOVES_KEPT_BEHIND)

    def _begin_singly(self) -> None:
        """The first block of a part: it may move nothing, or wait for start."""
        assert self._motion is not None
        if self._begin_paused:
            self._walk.pause_before_all()
        elif self._single and self._moves_next():
            self._walk.run_next()
        elif self._single:
            self._walk.pass_one()
        if self._walk.paused:
            self._motion.hold()

    def _moves_next(self) -> bool:
        """Whether the block that comes next moves the axes, or is the last one of the part."""
        line = self._walk.next_line()
        after = self._find(self._last_move + 1)
        if self.ending is not None and self._walk.next_is_last:
            return True
        return after is not None and int(after[0].line[after[1]]) == line

    def _stop_behind_block(self, motion: LiveMotion, setpoints: Setpoints) -> None:
        """Notice that single block has stopped behind a block that moved."""
        if len(setpoints):
            move, share = int(setpoints.move[-1]), float(setpoints.fraction[-1])
            self._last_move = max(self._last_move, move if share > PASSED else move - 1)
        if motion.finished:
            self._last_move = self._count - 1
        stopped = motion.held and motion.standing and not self._hold_asked
        if motion.finished and self._walk.at_last:
            self._walk.go_freely()
            return
        if not (stopped or motion.finished):
            return
        if self._last_move == self._stopped_behind and not motion.finished:
            # Behind the wait for the spindle, or a dwell: the block that was started comes now.
            motion.start()
            return
        self._stopped_behind = self._last_move
        last = self._find(self._last_move)
        if last is not None:
            self._walk.stop_behind(self._last_move, int(last[0].line[last[1]]))
        if motion.finished and self._walk.at_last:
            self._walk.end_singly()

    def hold(self) -> None:
        """Stop on the path until ``start``."""
        self._hold_asked = True
        if self._motion is not None:
            self._motion.hold()

    def start(self) -> None:
        """Go on after a hold or at the end of a single block."""
        if self._motion is None:
            return
        held, self._hold_asked = self._hold_asked, False
        if self._walk.paused and self._single and not held and not self._moves_next():
            self._walk.pass_one()
            return
        if self._walk.paused and self._single:
            self._walk.run_next()
        elif not self._single:
            self._walk.go_freely()
        self._motion.start()

    def drop(self) -> None:
        """Come to rest on the path, and forget the rest."""
        self.dropped = True
        self._walk.paused = False
        if self._motion is not None:
            self._motion.reset()

    def _look_ahead(self) -> None:
        """Interpret some blocks more; the axes can go once there are moves."""
        most = BLOCKS_AT_REST if self._motion is None else BLOCKS_IN_MOTION
        self._left = BLOCKS_FOR_PLANNER
        stream = self._options.stream
        if self.ending is None and (stream is not None or len(self._waiting) < self._ahead):
            self._interpret(most)
        self._looks += 1
        if stream is not None and self._motion is None and self.ending is None and stream.quiet:
            self._end_stream()
        long_enough = self._looks > SLICES_AT_REST and stream is None
        if self._motion is None and long_enough and self._control.path.columns.count:
            self._finish_chunk(self._control.path.columns.take())
        begins = (
            len(self._waiting) >= CHUNKS_AHEAD if stream is None else self._count >= STREAMED_AHEAD
        )
        enough = long_enough or self.ending is not None or begins
        if self._motion is not None and (self._waiting or self.ending is not None):
            self._motion.work()
        known = self._waiting or self._beginning is not None
        if self._motion is None and known and enough:
            self._begin_to_plan(at_any_rate=long_enough)

    def _begin_to_plan(self, *, at_any_rate: bool) -> None:
        """Let the planner begin; if it looks ahead to more moves than there are, it goes on when they come."""
        if self._beginning is None:
            start, zero = self._begin
            self._beginning = LiveMotion(
                iter(self._next_chunk, None),
                self._limits,
                period_s=self._machine.file.servo_period_s,
                part_zero=zero,
                start=start,
                largest_override=LARGEST_OVERRIDE,
                look_ahead=LOOK_AHEAD if self._options.stream is None else STREAMED_LOOK_AHEAD,
            )
        self._takes_any = at_any_rate
        try:
            if not any(self._beginning.work() for _ in range(PLANNED_AT_REST)):
                return
            self._beginning.begin()
        except _TooFewMovesError:
            self._ahead += CHUNKS_AHEAD
        else:
            self._motion, self._beginning, self._takes_any = self._beginning, None, True

    def _forget(self) -> None:
        self._motion: LiveMotion | None = None
        self._beginning: LiveMotion | None = None
        self._looks = self._left = self._move = 0
        self._ahead = CHUNKS_AHEAD
        self._takes_any = False
        self._waiting: deque[Chunk] = deque()
        self._count = 0
        self._walk = BlockWalk()
        self._driven = self._begin_paused = self._single = self._hold_asked = False
        self._last_move = self._stopped_behind = -1
        self._moves: list[Moves] = []
        self._firsts: list[int] = []

    def _next_chunk(self) -> Chunk | None:
        """What the planner pulls; where it is quicker than the interpreter, the part ends there.

        Raises:
            _TooFewMovesError: The planner is to begin, and there are no more moves yet.
        """
        if not self._waiting and self.ending is None and not self._takes_any:
            raise _TooFewMovesError
        if not self._waiting and self.ending is None:
            self._interpret(min(BLOCKS_IN_MOTION, self._left))
            self._left -= BLOCKS_IN_MOTION
        if not self._waiting and self.ending is None and self._options.stream is not None:
            self._end_stream()
        if not self._waiting and self.ending is None:
            self._finish_chunk(self._control.path.columns.take())
            if not len(self._waiting[-1].moves) and self.ending is None:
                self.ending = "wait"
        return self._waiting.popleft() if self._waiting else None

    @property
    def moves_ahead(self) -> int:
        """Moves that are interpreted and not yet driven."""
        return self._count + self._control.path.columns.count - self._move

    def take_streamed(self) -> None:
        """Interpret what a stream has for the run, before the next slice of time comes to it."""
        if self.ending is None:
            self._interpret(BLOCKS_IN_MOTION)

    def _end_stream(self) -> None:
        """What has been streamed is a whole: what comes now begins another part."""
        self._control.path.finish()
        self.ending = "end"
        self._finish_chunk(self._control.path.columns.take())

    def _interpret(self, most: int) -> None:
        """Interpret at most so many blocks, until there are enough moves or the part ends."""
        control, refused, stream = self._control, None, self._options.stream
        enough = False
        try:
            while most > 0 and not enough and self.ending is None:
                most -= 1
                block, self._found = self._found, None
                if stream is not None:
                    block = stream.next(self._executor, self.moves_ahead)
                elif block is None and not control.ended:
                    block = control.program_counter.next()
                if block is None and stream is not None:
                    if control.ended:
                        self._end_stream()
                    break
                if block is None:
                    self._executor.finish()
                    self.ending = "end"
                    self._require_found()
                    break
                if self._searched and block.line == self._searched:
                    self._arrive(block)
                    break
                mark = self._count + control.path.columns.count
                refused = control.path.columns.refusal(block.line)
                self._executor.run(block)
                refused = None
                if self._searched:
                    self._collect(control.path.columns.take())
                    continue
                self._note(block, mark)
                self._look_for_stop(block)
                enough = control.path.columns.count >= MOVES_AT_ONCE
        except ProgramError as error:
            if stream is None:
                self._end_by(error.diagnostic)
            else:
                stream.refuse(self._executor, error.diagnostic)
        if self._arrival is not None:
            chunk, self._arrival = self._arrival, None
            self._finish_chunk(chunk)
        elif (
            enough
            or self.ending is not None
            or (stream is not None and (control.path.columns.count or refused is not None))
        ):
            self._finish_chunk(control.path.columns.take(refused))

    def _end_by(self, finding: Diagnostic) -> None:
        """The program is wrong."""
        self.ending, self.finding = "program", finding
        self.message, self.ending_line = f"{finding.code}: {finding.message}", finding.line

    def _finish_chunk(self, chunk: Chunk) -> None:
        """Hand moves on to the planner, up to the first one that would leave the travel."""
        alarm = None
        dry = self._options.dry_feed
        if dry is not None:
            feeds = np.where(chunk.moves.motion == Motion.FEED, dry, chunk.moves.feed)
            chunk = Chunk(dataclasses.replace(chunk.moves, feed=feeds), chunk.events)
        if self._options.soft_limits:
            alarm = soft_limit_alarm(self._machine, chunk.moves, self._begin[1])
        if alarm is not None:
            outside = int(np.flatnonzero(chunk.moves.line == alarm.line)[0])
            chunk = Chunk(chunk.moves[:outside], ())
            self.ending, self.message = "soft-limit", alarm.message
            self.ending_line = alarm.line
        # No time passes for a tool that is not there: it is told at once.
        changes = self.ending == "tool"
        happen = [one for one in chunk.events if changes or not _is_tool_change(one)]
        chunk = Chunk(chunk.moves, tuple(self._waits.among(happen)))
        for event in chunk.events:
            self._walk.note_event(self._count, event)
        self._firsts.append(self._count)
        self._moves.append(chunk.moves)
        self._count += len(chunk.moves)
        self._waiting.append(chunk)

    def _note(self, block: Block, mark: int) -> None:
        control = self._control
        active = control.modal.active.numbers()
        if active != self._active:
            self._active, self._codes = active, tuple(map(self._executor.dialect.code_name, active))
        factor = FEED_FACTORS.get(control.modal.feed_mode)
        state = ModalState(
            block.line, self._codes, control.motion.feed, control.tools.spindle, factor
        )
        self._walk.note(mark, state)

    def _look_for_stop(self, block: Block) -> None:
        words = [f"M{word.value:g}" for word in block.words if word.address == "M"
                 and isinstance(word.value, float)]  # fmt: skip
        if TOOL_CHANGE in words:
            self.ending, self.tool = "tool", self._control.tools.spindle
            if self.tool not in self._control.settings.tools:
                self.ending, self.message = "program", f"no tool {self.tool}"
        elif any(word in PROGRAM_STOPS for word in words):
            self.ending, self.optional = "stop", OPTIONAL_STOP in words
        if self.ending is not None:
            self.ending_line = block.line

    def passed(self, setpoints: Setpoints) -> list[Function]:
        """The functions that have happened since the last call; none once the rest is given up."""
        if self._motion is None or self.dropped:
            return []
        if self.finished:
            return self._walk.due(math.inf, 0)
        found: list[Function] = []
        for row in _changes(setpoints):
            # What comes before the first move begins with the wait for it.
            place = max(int(setpoints.move[row]) + float(setpoints.fraction[row]), 0.0)
            found += self._walk.due(place, int(setpoints.line[row]))
        return found

    def modal(self, move: int) -> ModalState | None:
        """What is in force during a move of the part."""
        return self._walk.state(move)

    def line(self, line: int) -> int:
        """Source line of the block that runs, or behind which single block has stopped.

        Args:
            line: Of the setpoints.
        """
        return self._walk.line if self._walk.paused else line

    def left(self) -> Inherited:
        """What an MDI block leaves in force for the next one."""
        control, motion = self._control, self._control.motion
        shifts = [list(shift) for shift in control.frame.shifts]
        memory = None if self._options.stream is None else control.memory
        return Inherited(control.modal.fork(), shifts, motion.feed, motion.spindle, memory)

    def _inherit(self, before: Inherited) -> None:
        control, motion = self._control, self._control.motion
        if before.memory is not None:
            control.memory = before.memory
        control.modal.restore(before.modal)
        control.frame.set_shifts([list(shift) for shift in before.shifts])
        motion.reframed()
        motion.feed, motion.spindle = before.feed, before.spindle

    def _collect(self, skipped: Chunk) -> None:
        """Of what a search passes over, keep the last commands of spindle and coolant, and the highest Z."""
        if len(skipped.moves):
            self._clearance = max(self._clearance, float(skipped.moves.end[:, Z].max()))
        for event in skipped.events:
            if isinstance(event, Function):
                name = "coolant" if event.word in COOLANT_ON | COOLANT_OFF else event.word
                name = "spindle" if event.word in SPINDLE_STARTS | SPINDLE_STOPS else name
                self._collected[name] = event

    def _arrive(self, block: Block) -> None:
        """The block that was searched for comes next: go to where it begins, and wait there."""
        control, self._searched, self._found = self._control, 0, block
        self.ending_line, self.optional = block.line, False
        control.path.columns.take()
        needed = control.tools.spindle
        if control.modal.active.get("compensation", NO_COMPENSATION) != NO_COMPENSATION:
            self.ending = "program"
            self.message = "a search cannot begin within a compensated contour"
        elif needed != self.tool:
            self.ending = "program"
            self.message = f"T{needed} belongs into the spindle there: change the tool first"
        else:
            self.ending = "stop"
            stand = self._begin[0] - self._begin[1]
            events = tuple(
                dataclasses.replace(event, before=0, at=0.0, line=block.line)
                for name, event in self._collected.items()
                if name in ("spindle", "coolant", SPINDLE_SPEED)
            )
            self._note(block, self._count)
            self._arrival = Chunk(approach(control, stand, block.line, self._clearance), events)

    def _require_found(self) -> None:
        if self._searched:
            self.ending, self.ending_line = "program", self._searched
            self.message = f"the program never comes to line {self._searched}"

    def rapid(self, move: int) -> bool:
        """Whether a move of the part is a rapid."""
        found = self._find(move)
        return found is not None and int(found[0].motion[found[1]]) == Motion.RAPID

    def target(self, move: int) -> tuple[FloatArray, FloatArray] | None:
        """Where a move ends and what the screen shows there, part coordinates, (k,) each."""
        found = self._find(move)
        return None if found is None else (found[0].end[found[1]], found[0].display[found[1]])

    def _find(self, move: int) -> tuple[Moves, int] | None:
        if not self._firsts or not self._firsts[0] <= move < self._count:
            return None
        chunk = bisect.bisect_right(self._firsts, move) - 1
        return self._moves[chunk], move - self._firsts[chunk]


def _is_tool_change(event: Event) -> bool:
    return isinstance(event, Function) and event.word == TOOL_CHANGE


def _changes(setpoints: Setpoints) -> list[int]:
    """The last setpoint of each block, of a wait as of a move."""
    border = (np.diff(setpoints.line) != 0) | (np.diff(setpoints.move) != 0)
    return [*np.flatnonzero(border).tolist(), len(setpoints) - 1] if len(setpoints) else []
