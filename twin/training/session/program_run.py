"""A program, or an MDI block, on its way to the machine: parts between stops, each with its moves.

The program is interpreted block by block. It is cut into parts where an operator or the control
has to do something before the axes go on: a program stop, a tool change, an error. The axes rest at
such places anyway, so that each part can be planned on its own.
"""

import bisect
import dataclasses
import math
from collections.abc import Iterator
from typing import Literal

import numpy as np

from twin.machine.config import Machine
from twin.machine.motion_limits import motion_limits
from twin.machine.travel import soft_limit_alarm
from twin.motion.live.live_motion import LiveMotion
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Chunk, FloatArray, Function, Motion, Moves
from twin.nc.control.dialect import Dialect
from twin.nc.control.executor import Executor
from twin.nc.control.settings import ControlSettings
from twin.nc.functions import PROGRAM_STOPS, TOOL_CHANGE
from twin.nc.text.blocks import Block
from twin.nc.text.diagnostics import ProgramError
from twin.nc.text.source import Source

MOVES_AT_ONCE = 256
"""Moves that are interpreted before the planner hears of them."""

LARGEST_OVERRIDE = 1.2
"""Factor at the end of the feed override dial."""

Ending = Literal["end", "stop", "tool", "soft-limit", "program"]


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
        motion: The part that is being driven.
        ending: Why the present part ends; known once it has been interpreted to its end.
        message: What there is to say of an ending by error.
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
        self._machine = machine
        self._limits = motion_limits(machine)
        self._control = Executor(dialect, settings, source)
        self._control.prepare()
        self._soft_limits = soft_limits
        self.dropped = False
        self.ending: Ending | None = None
        self.ending_line = 0
        self.message = ""
        self.tool: int | None = self._control.tools.spindle
        self._zero = np.zeros(0)
        self._forget()

    def begin(self, start: FloatArray, zero: FloatArray) -> None:
        """Plan the part that comes next.

        Args:
            start: Where the setpoints stand, machine coordinates, shape (k,) [mm or deg].
            zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        """
        self._forget()
        self._zero = zero
        self.ending = None
        self.motion = LiveMotion(
            self._chunks(),
            self._limits,
            period_s=self._machine.file.servo_period_s,
            part_zero=zero,
            start=start,
            largest_override=LARGEST_OVERRIDE,
        )

    def _forget(self) -> None:
        self._count = 0
        self._marks: list[int] = []
        self._modal: list[ModalState] = []
        self._functions: list[tuple[int, Function]] = []
        self._moves: list[Moves] = []
        self._firsts: list[int] = []

    def _chunks(self) -> Iterator[Chunk]:
        while self.ending is None:
            chunk = self._next_chunk()
            alarm = None
            if self._soft_limits:
                alarm = soft_limit_alarm(self._machine, chunk.moves, self._zero)
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
            yield chunk

    def _next_chunk(self) -> Chunk:
        """Interpret until there are enough moves, or a place at which the part ends."""
        control = self._control
        try:
            while len(control.path) < MOVES_AT_ONCE and self.ending is None:
                block = None if control.ended else control.program_counter.next()
                if block is None:
                    control.finish()
                    self.ending = "end"
                    break
                self._marks.append(self._count + len(control.path))
                control.run(block)
                self._note(block)
                self._look_for_stop(block)
        except ProgramError as error:
            diagnostic = error.diagnostic
            self.ending, self.message = "program", f"{diagnostic.code}: {diagnostic.message}"
            self.ending_line = diagnostic.line
        return control.path.take()

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

    def drop(self) -> None:
        """Come to rest on the path, and forget the rest."""
        self.dropped = True
        self.motion.reset()

    def passed(self, setpoints: Setpoints) -> list[Function]:
        """The functions that have happened since the last call."""
        place = math.inf if self.motion.finished else -1.0
        if len(setpoints) and not self.motion.finished:
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
