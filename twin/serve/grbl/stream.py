"""Lines of a sender as blocks of a program that runs, and an answer for each."""

import time
from collections.abc import Container
from typing import NamedTuple

from twin.machine.description.config import MachineConfig
from twin.nc.control.control import Control
from twin.nc.control.executor import Executor
from twin.nc.control.modal import Modal
from twin.nc.dialects.grbl.memory import GrblMemory, memory_of
from twin.nc.text.blocks import Block, Word
from twin.nc.text.diagnostics.diagnostics import Diagnostic, ProgramError
from twin.serve.grbl.codes import Error, error_of
from twin.serve.grbl.serial_buffer import LONGEST_LINE, SerialBuffer, cleaned

MOST_AHEAD = 640
"""Moves that are taken ahead of the axes: what the planner wants to see (some 420), and room for a sender's pauses.

Decision: Grbl itself takes 15, and slows down where they are short; boards of its family take up to some 1000.
"""
QUIET_S = 0.03
"""Time without a line behind which what has come is a whole [s]; senders answer sooner."""
_AFTER_PROGRAM = (1, 17, 54, 90, 94)
"""What M2 and M30 put into force (``gc_execute_line``)."""
_JOG = "$J="
_JOG_CODES = frozenset((20.0, 21.0, 53.0, 90.0, 91.0))


class _Before(NamedTuple):
    """What is in force before a block."""

    modal: Modal
    feed: float | None
    spindle: float | None
    spindle_turns: bool
    memory: GrblMemory
    programmed: list[float]
    part: list[float]
    shifts: list[list[float]]


class GrblStream:
    """The lines that wait, as the program run asks for them.

    Attributes:
        jogging: Whether it is jogs that are run, and no G code.
        executor: What ran the last block; None before the first.
        last_received: When the last byte came, by ``time.monotonic`` [s].
    """

    def __init__(self, serial: SerialBuffer, machine: MachineConfig, *, jogging: bool) -> None:
        self.serial = serial
        self.answers: list[str] = []
        self.jogging = jogging
        self.executor: Executor | None = None
        self.last_received = time.monotonic()
        self._machine = machine
        self._before: _Before | None = None
        self._number = 0

    @property
    def is_idle(self) -> bool:
        """Whether no line for this run has come for a while."""
        head = self.serial.head
        if head is not None:
            return not self._takes(head)
        return time.monotonic() - self.last_received > QUIET_S

    def _takes(self, line: bytes) -> bool:
        text = cleaned(line)
        return text.startswith(_JOG) if self.jogging else not text.startswith("$")

    def next(self, executor: Executor, moves_ahead: int) -> Block | None:
        """The next block; the one before it has been run, and is answered."""
        self.executor, control = executor, executor.control
        self.accept(executor)
        while (
            not control.ended
            and moves_ahead < MOST_AHEAD
            and (head := self.serial.head) is not None
        ):
            if not self._takes(head):
                break
            block = self._read(control, *self.serial.pop())
            if block is not None:
                self._before = _state_of(control)
                return block
        return None

    def refuse(self, executor: Executor, finding: Diagnostic) -> None:
        """A block is wrong: put back what was in force before it."""
        assert self._before is not None
        _restore(executor.control, self._before)
        self._before = None
        self.answers.append(f"error:{error_of(finding):d}")

    def accept(self, executor: Executor) -> None:
        """The last block has been run: answer it."""
        control, before, self._before = executor.control, self._before, None
        if before is None:
            return
        if self.jogging:
            # A jog changes nothing but the place (Grbl 1.1, "Jogging").
            control.modal.restore(before.modal)
            control.motion.feed = before.feed
        if control.ended:
            self.answers.append("[MSG:Pgm End]")
            for number in _AFTER_PROGRAM:
                executor.put_into_force(number, executor.dialect.codes.g[number])
            memory_of(control).system = 1
        self.answers.append("ok")

    def _read(self, control: Control, line: bytes, damaged: bool) -> Block | None:
        """A line as a block; None: it is answered already."""
        text = cleaned(line)
        if damaged or len(text) > LONGEST_LINE:
            self.answers.append(f"error:{Error.LINE_OVERFLOW:d}")
            return None
        if not text:
            self.answers.append("ok")
            return None
        self._number += 1
        try:
            return self._block(control, text)
        except ProgramError as error:
            self.answers.append(f"error:{error_of(error.diagnostic):d}")
        return None

    def _block(self, control: Control, text: str) -> Block | None:
        jog = text.startswith(_JOG)
        # A jog is a straight move, whatever motion is in force.
        written = f"G1{text.removeprefix(_JOG)}" if jog else text
        blocks = control.program_counter.lexer.blocks(written, self._number)
        if not blocks or blocks[0].statement is not None:
            self.answers.append(f"error:{Error.EXPECTED_LETTER:d}")
            return None
        if jog and (wrong := self._wrong_jog(control, blocks[0].words[1:])):
            self.answers.append(f"error:{wrong:d}")
            return None
        return blocks[0]

    def _wrong_jog(self, control: Control, words: tuple[Word, ...]) -> Error | None:
        values = {word.address: word.value for word in words if word.address != "G"}
        codes = {word.value for word in words if word.address == "G"}
        axes = {
            name: value
            for name, value in values.items()
            if name in "XYZ" and isinstance(value, float)
        }
        if not codes <= _JOG_CODES or not axes or not values.keys() <= set("XYZFN"):
            return Error.INVALID_JOG
        if "F" not in values:
            return Error.UNDEFINED_FEED
        target = _jog_target(control, axes, codes)
        for name, place in zip(control.settings.axes.names, target, strict=True):
            travel = self._machine.axis(name).travel
            if name in axes and travel is not None and not travel[0] <= place <= travel[1]:
                return Error.TRAVEL_EXCEEDED
        return None


def _jog_target(control: Control, axes: dict[str, float], codes: Container[object]) -> list[float]:
    """Where a jog leads, machine coordinates, shape (k,) [mm or deg]."""
    modal, names = control.modal, control.settings.axes.names
    unit = 25.4 if 20.0 in codes else 1.0 if 21.0 in codes else modal.unit
    incremental = 91.0 in codes or (modal.incremental and 90.0 not in codes)
    zero = control.settings.machine_zero or {}
    goal = list(control.motion.programmed)
    for index, name in enumerate(names):
        if name in axes and 53.0 not in codes:
            goal[index] = axes[name] * unit + (goal[index] if incremental else 0.0)
    part = control.frame.to_part(goal)
    machine = [place - zero.get(name, 0.0) for name, place in zip(names, part, strict=True)]
    if 53.0 in codes:
        for index, name in enumerate(names):
            machine[index] = axes[name] * unit if name in axes else machine[index]
    return machine


def _state_of(control: Control) -> _Before:
    return _Before(
        control.modal.fork(),
        control.motion.feed,
        control.motion.spindle,
        control.motion.spindle_turns,
        memory_of(control).fork(),
        list(control.motion.programmed),
        list(control.motion.part),
        [list(shift) for shift in control.frame.shifts],
    )


def _restore(control: Control, before: _Before) -> None:
    motion = control.motion
    control.modal.restore(before.modal)
    motion.feed, motion.spindle = before.feed, before.spindle
    motion.spindle_turns = before.spindle_turns
    control.memory = before.memory
    control.frame.set_shifts(before.shifts)
    motion.programmed, motion.part = before.programmed, before.part
