"""A program, or an MDI block, as it reaches the machine: parts between stops, each with its moves.

It is interpreted ahead of the axes, a bounded number of blocks in each slice of time, so that a program
that loops for ever keeps nobody waiting: where the axes have caught up with it, they come to rest until there are
moves.
"""

import math

import numpy as np

from twin.machine.description.config import MachineConfig
from twin.motion.blocks.corners import CONTEXT
from twin.motion.live.live_motion import LiveMotion
from twin.motion.profile.windows import LOOK_AHEAD
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Chunk, FloatArray, Function
from twin.nc.control.dialect import Dialect
from twin.nc.control.settings import ControlSettings
from twin.nc.functions import SpindleState
from twin.nc.text.source import Source
from twin.training.program.block_tracker import ModalState
from twin.training.program.program_reader import (
    MOVES_AT_ONCE,
    MOVES_KEPT_BEHIND,
    READ_AT_ONCE,
    ProgramReader,
)
from twin.training.program.run_options import RunOptions

CHUNKS_AHEAD = 2 * math.ceil(LOOK_AHEAD / MOVES_AT_ONCE)
"""Groups of so many moves that are interpreted ahead of the planner, to begin with: where it makes one
block of several moves, it looks ahead to more of them."""
BLOCKS_AT_REST, BLOCKS_IN_MOTION = READ_AT_ONCE, 50
"""Blocks that are interpreted in one slice of time, before the axes move and while they do."""
BLOCKS_FOR_PLANNER = 400
"""Blocks more that are interpreted in one slice where the planner has caught up."""
PLANNED_AT_REST = 8
"""Steps of planning in one slice before the axes can go: corners that are tried take a few milliseconds each."""
SLICES_AT_REST = 100
"""Slices after which the axes begin with what moves there are."""

STREAMED_LOOK_AHEAD = 64
"""Blocks of a stream that are planned at a time, and that the planner sees at least beyond these."""
STREAMED_AHEAD = 3 * STREAMED_LOOK_AHEAD + CONTEXT
"""Moves of a stream that make its axes begin, though more come: what the planner sees at least."""

LARGEST_OVERRIDE = 1.2
"""Factor at the end of the feed override dial."""

PASSED = 0.5
"""A stop at the end of a block is given as the end of its move or as the beginning of the next."""


class _TooFewMovesError(Exception):
    """The planner cannot begin yet without ending the part where the program goes on."""


class ProgramRun:
    """One run of a program.

    Attributes:
        dropped: An operator has given up the rest.
    """

    def __init__(
        self,
        source: Source,
        dialect: Dialect,
        settings: ControlSettings,
        machine: MachineConfig,
        options: RunOptions,
    ) -> None:
        """Read a program from its beginning; see ``ProgramReader`` for arguments and errors."""
        self._machine = machine
        self._limits = machine.motion_limits
        self._stream = options.stream
        self.reader = ProgramReader(source, dialect, settings, machine, options)
        self.dropped = False
        self._clear_part()

    @property
    def held(self) -> bool:
        """Whether cycle start is waited for."""
        return self._motion is not None and (self._motion.held or self.reader.tracker.paused)

    @property
    def finished(self) -> bool:
        """Whether the present part has come to its end, or to rest after ``drop``."""
        if self._motion is None or self.dropped:
            return self.dropped and (self._motion is None or self._motion.finished)
        return self._motion.finished and not self.reader.tracker.paused

    @property
    def singly(self) -> set[int]:
        """Source lines of the present part that were run in single block, from stop to stop."""
        return self.reader.tracker.singly

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
            spindle: What it has been commanded: the axes wait until it has come to its speed.
            paused: Whether start is waited for before its first block.
        """
        self._clear_part()
        self.reader.begin_part(start, zero, spindle)
        self._begin_paused = paused
        self._look_ahead()

    def drive(self, count: int, feed: float, rapid: float, *, single: bool) -> Setpoints | None:
        """The next setpoints; None while the first moves are being interpreted."""
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
            # A program may be endless: what the axes are past is dropped.
            self.reader.moves.forget_behind(int(setpoints.move[0]))
            self.reader.tracker.forget(int(setpoints.move[0]) - MOVES_KEPT_BEHIND)
        if single and not self.dropped and not self.reader.tracker.paused:
            self._stop_behind_block(motion, setpoints)
        return setpoints

    def _begin_singly(self) -> None:
        """The first block of a part: it may move nothing, or wait for start."""
        assert self._motion is not None
        if self._begin_paused:
            self.reader.tracker.pause_before_all()
        elif self._single and self._moves_next():
            self.reader.tracker.run_next()
        elif self._single:
            self.reader.tracker.pass_one()
        if self.reader.tracker.paused:
            self._motion.hold()

    def _moves_next(self) -> bool:
        """Whether the block that comes next moves the axes, or is the last one of the part."""
        line = self.reader.tracker.next_line()
        after = self.reader.moves.line(self._last_move + 1)
        if self.reader.ending is not None and self.reader.tracker.next_is_last:
            return True
        return after == line

    def _stop_behind_block(self, motion: LiveMotion, setpoints: Setpoints) -> None:
        """Notice that single block has stopped behind a block that moved."""
        if len(setpoints):
            move, share = int(setpoints.move[-1]), float(setpoints.fraction[-1])
            self._last_move = max(self._last_move, move if share > PASSED else move - 1)
        if motion.finished:
            self._last_move = self.reader.moves.count - 1
        stopped = motion.held and motion.standing and not self._hold_asked
        if motion.finished and self.reader.tracker.at_last:
            self.reader.tracker.go_freely()
            return
        if not (stopped or motion.finished):
            return
        if self._last_move == self._stopped_behind and not motion.finished:
            # Behind the wait for the spindle, or a dwell: the block that was started comes now.
            motion.start()
            return
        self._stopped_behind = self._last_move
        line = self.reader.moves.line(self._last_move)
        if line is not None:
            self.reader.tracker.stop_behind(self._last_move, line)
        if motion.finished and self.reader.tracker.at_last:
            self.reader.tracker.end_singly()

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
        if self.reader.tracker.paused and self._single and not held and not self._moves_next():
            self.reader.tracker.pass_one()
            return
        if self.reader.tracker.paused and self._single:
            self.reader.tracker.run_next()
        elif not self._single:
            self.reader.tracker.go_freely()
        self._motion.start()

    def drop(self) -> None:
        """Come to rest on the path, and forget the rest."""
        self.dropped = True
        self.reader.tracker.end_singly()
        if self._motion is not None:
            self._motion.reset()

    def _look_ahead(self) -> None:
        """Interpret some blocks more; the axes can go once there are moves."""
        reader, stream = self.reader, self._stream
        most = BLOCKS_AT_REST if self._motion is None else BLOCKS_IN_MOTION
        self._left = BLOCKS_FOR_PLANNER
        if reader.ending is None and (stream is not None or len(reader.waiting) < self._ahead):
            reader.interpret(most, self._move)
        self._looks += 1
        if stream is not None and self._motion is None and reader.ending is None and stream.is_idle:
            reader.end_stream()
        long_enough = self._looks > SLICES_AT_REST and stream is None
        if self._motion is None and long_enough:
            reader.hand_on()
        if self._motion is not None and (reader.waiting or reader.ending is not None):
            self._motion.work()
        if stream is None:
            begins = len(reader.waiting) >= CHUNKS_AHEAD
        else:
            begins = reader.moves.count >= STREAMED_AHEAD
        known = reader.waiting or self._beginning is not None
        enough = long_enough or reader.ending is not None or begins
        if self._motion is None and known and enough:
            self._begin_to_plan(at_any_rate=long_enough)

    def _begin_to_plan(self, *, at_any_rate: bool) -> None:
        """Let the planner begin; if it looks ahead to more moves than there are, it goes on when they come."""
        if self._beginning is None:
            self._beginning = LiveMotion(
                iter(self._next_chunk, None),
                self._limits,
                period_s=self._machine.file.servo_period_s,
                part_zero=self.reader.zero,
                start=self.reader.start,
                largest_override=LARGEST_OVERRIDE,
                look_ahead=LOOK_AHEAD if self._stream is None else STREAMED_LOOK_AHEAD,
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

    def _clear_part(self) -> None:
        self._motion: LiveMotion | None = None
        self._beginning: LiveMotion | None = None
        self._looks = self._left = self._move = 0
        self._ahead = CHUNKS_AHEAD
        self._takes_any = False
        self._driven = self._begin_paused = self._single = self._hold_asked = False
        self._last_move = self._stopped_behind = -1

    def _next_chunk(self) -> Chunk | None:
        """What the planner pulls; where it is quicker than the interpreter, the part ends there."""
        reader = self.reader
        if not reader.waiting and reader.ending is None and not self._takes_any:
            raise _TooFewMovesError
        if not reader.waiting and reader.ending is None:
            reader.interpret(min(BLOCKS_IN_MOTION, self._left), self._move)
            self._left -= BLOCKS_IN_MOTION
        if not reader.waiting and reader.ending is None:
            reader.end_here()
        return reader.take()

    @property
    def moves_ahead(self) -> int:
        """Moves that are interpreted and not yet driven."""
        return self.reader.count - self._move

    def take_streamed(self) -> None:
        """Interpret what a stream has for the run, before the next slice of time comes to it."""
        if self.reader.ending is None:
            self.reader.interpret(BLOCKS_IN_MOTION, self._move)

    def passed(self, setpoints: Setpoints) -> list[Function]:
        """The functions that have happened since the last call; none once the rest is given up."""
        if self._motion is None or self.dropped:
            return []
        if self.finished:
            return self.reader.tracker.due(math.inf, 0)
        found: list[Function] = []
        for row in _changes(setpoints):
            # What comes before the first move begins with the wait for it.
            place = max(int(setpoints.move[row]) + float(setpoints.fraction[row]), 0.0)
            found += self.reader.tracker.due(place, int(setpoints.line[row]))
        return found

    def modal(self, move: int) -> ModalState | None:
        """What is in force during a move of the part."""
        return self.reader.tracker.state(move)

    def line(self, line: int) -> int:
        """Source line of the block that runs, or behind which single block has stopped."""
        return self.reader.tracker.line if self.reader.tracker.paused else line


def _changes(setpoints: Setpoints) -> list[int]:
    """The last setpoint of each block, of a wait as of a move."""
    border = (np.diff(setpoints.line) != 0) | (np.diff(setpoints.move) != 0)
    return [*np.flatnonzero(border).tolist(), len(setpoints) - 1] if len(setpoints) else []
