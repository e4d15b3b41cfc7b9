"""The path of a program, before it is run: what the room's own interpreter makes of it, drawn and not driven.

A program is read through all its parts as ``ProgramReader`` would read it, from the place and with the
tables of the moment in which it was asked for, also behind a search. Nothing is planned and nothing
of the machine is touched, so that this can be done in parallel with the machine's thread.
"""

import dataclasses
import time
from typing import Any

import numpy as np
import numpy.typing as npt

from twin.errors import TwinError
from twin.machine.description.config import MachineConfig
from twin.nc.canonical import FloatArray, Motion, Moves
from twin.nc.control.dialect import Dialect
from twin.nc.control.settings import ControlSettings
from twin.nc.functions import SpindleState
from twin.nc.text.diagnostics.diagnostics import Diagnostic, ProgramError
from twin.nc.text.source import Source
from twin.toolpath.geometry import geometry
from twin.toolpath.part_frame import PartFrame
from twin.training.program.program_reader import READ_AT_ONCE, ProgramReader
from twin.training.program.run_options import RunOptions

MOST_MOVES = 20_000
"""Moves that are drawn; of a longer program its beginning."""
MOST_POINTS = 60_000
"""Points that are drawn."""
MOST_BLOCKS = 100_000
"""Blocks that are read, also where they move nothing."""
FINEST_DEG = 5.0
"""Of an arc, or of a turning table, that is drawn as one straight line."""
MOST_PER_MOVE = 720
"""Straight lines that one move is drawn as, however often it goes round."""
REST_SHARE = 1.0
"""Time that is left to the machine for each that is computed."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Preview:
    """A path to draw.

    Attributes:
        points: The tip's path in the part's frame, shape (n, 3) [mm].
        origin: Where program zero lies there, as the control has it, shape (3,) [mm].
        rapid: Whether the line that leads to each point is a rapid, shape (n,).
        complete: The program has no more.
        message: Why the path ends early, or is not drawn; empty: it does not.
        finding: What the interpreter found, where that is the reason.
        line: Source line that the message is about; 0: none.
    """

    points: npt.NDArray[np.float32]
    origin: FloatArray
    rapid: npt.NDArray[np.bool_]
    moves: int
    complete: bool
    message: str = ""
    finding: Diagnostic | None = None
    line: int = 0


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class PathToCome:
    """All that the next start would begin with.

    Attributes:
        settings: What the control knows of the machine as it is.
        search: Source line that the next start begins at; 0: the first.
        stand: Where the setpoints stand, machine coordinates, shape (k,) [mm or deg].
        zero: Machine coordinates of program zero for the first tool, as the control has it, shape (k,).
        length_difference: How much longer than the first each tool is in the control's table, by number [mm].
    """

    source: Source
    dialect: Dialect
    settings: ControlSettings
    machine: MachineConfig
    search: int
    stand: FloatArray
    zero: FloatArray
    length_difference: dict[int, float]
    tool: int
    spindle: SpindleState
    frame: PartFrame

    @property
    def key(self) -> tuple[Any, ...]:
        """What two paths that are the same have in common."""
        numbers = (
            self.stand.round(3).tobytes(),
            self.zero.tobytes(),
            tuple(self.length_difference.items()),
        )
        return self.source.sha256, self.search, self.tool, repr(self.settings), *numbers

    def drawn(self) -> Preview:
        """Read the program and draw it; a program that is wrong is not drawn at all."""
        drawing = _Drawing(self.frame, self.zero)
        try:
            reader = ProgramReader(
                self.source,
                self.dialect,
                self.settings,
                self.machine,
                RunOptions(search=self.search),
            )
            tool, stand = self.tool, self.stand
            while True:
                zero = self._zero_with(tool)
                self._draw_part(reader, stand, zero, drawing)
                if reader.ending not in ("stop", "tool"):
                    break
                if reader.ending == "tool":
                    tool = self._changed(reader)
                stand = drawing.last + zero
        except ProgramError as error:
            return drawing.refused(error.diagnostic)
        except TwinError as error:
            return dataclasses.replace(drawing.preview(), message=str(error))
        if reader.finding is not None:
            return drawing.refused(reader.finding)
        found = drawing.preview()
        if reader.ending == "end":
            return dataclasses.replace(found, complete=True)
        return dataclasses.replace(found, message=reader.message, line=reader.ending_line)

    def _draw_part(
        self, reader: ProgramReader, stand: FloatArray, zero: FloatArray, drawing: "_Drawing"
    ) -> None:
        began = time.perf_counter()
        for moves in reader.read(stand, zero, self.spindle):
            drawing.add(moves)
            if drawing.full:
                return
            time.sleep(REST_SHARE * (time.perf_counter() - began))
            began = time.perf_counter()

    def _zero_with(self, tool: int | None) -> FloatArray:
        zero = self.zero.copy()
        zero[2] += self.length_difference.get(tool or 0, 0.0)
        return zero

    def _changed(self, reader: ProgramReader) -> int | None:
        if reader.tool not in self.length_difference:
            raise TwinError(f"no tool {reader.tool}")
        return reader.tool


class _Drawing:
    """Points as they come."""

    def __init__(self, frame: PartFrame, zero: FloatArray) -> None:
        self._frame, self._zero = frame, zero
        self._points: list[FloatArray] = []
        self._rapid: list[npt.NDArray[np.bool_]] = []
        self._count = 0
        self._readings = 0
        self.moves = 0
        self.last = np.zeros(len(zero))

    @property
    def full(self) -> bool:
        """Whether nothing more is drawn."""
        most = self.moves >= MOST_MOVES or self._count >= MOST_POINTS
        return most or self._readings * READ_AT_ONCE >= MOST_BLOCKS

    def add(self, moves: Moves) -> None:
        """Draw moves behind the last ones."""
        self._readings += 1
        moves = moves[: MOST_MOVES - self.moves]
        if not len(moves):
            return
        turned = np.abs(moves.sweep)
        if moves.end.shape[1] > 3:
            turned = np.maximum(turned, np.abs(moves.end - moves.start)[:, 3:].max(axis=1))
        pieces = np.clip(np.ceil(turned / FINEST_DEG), 1, MOST_PER_MOVE).astype(np.int64)
        number = np.repeat(np.arange(len(moves)), pieces)
        step = np.arange(len(number)) - np.repeat(np.cumsum(pieces) - pieces, pieces) + 1
        points = geometry(moves).position(number, step / pieces[number])
        if not self._points:
            points = np.concatenate([moves.start[:1], points])
            number = np.concatenate([number[:1], number])
        self._points.append(self._frame.position(points + self._zero))
        self._rapid.append(moves.motion[number] == Motion.RAPID)
        self._count += len(points)
        self.moves += len(moves)
        self.last = moves.end[-1].copy()

    def preview(self) -> Preview:
        """What was drawn so far."""
        points = np.concatenate([np.zeros((0, 3)), *self._points])[:MOST_POINTS]
        rapid = np.concatenate([np.zeros(0, np.bool_), *self._rapid])[:MOST_POINTS]
        return Preview(
            points=points.astype(np.float32),
            origin=self._frame.position(self._zero[None])[0],
            rapid=rapid,
            moves=self.moves,
            complete=False,
        )

    def refused(self, finding: Diagnostic) -> Preview:
        """Nothing of a program that is wrong."""
        self._points, self._rapid, self.moves = [], [], 0
        message = f"{finding.code}: {finding.message}"
        return dataclasses.replace(
            self.preview(), message=message, finding=finding, line=finding.line
        )
