"""A program interpreted once, and read by all who follow its moves."""

import pickle
import tempfile
import weakref
from collections.abc import Iterable, Iterator
from typing import IO

from twin.nc.canonical import Chunk, FloatArray
from twin.run.placement import start_position
from twin.run.preparation import Preparation
from twin.run.waits import with_waits

MOVES_IN_MEMORY = 200_000
"""Of a longer program the further moves lie in a file, at some 200 bytes each: memory stays bounded."""


class InterpretedProgram:
    """The moves and events that a program makes.

    Attributes:
        moves: How many moves there are.
        start: Where the axes are at the program's start, program coordinates, shape (k,) [mm or deg]. The
            job says it, or the program itself before its first move (G92 of ``codesys``).
    """

    def __init__(self, preparation: Preparation, chunks: Iterable[Chunk] = ()) -> None:
        """Take what an interpreter makes.

        Args:
            preparation: The job made concrete.
            chunks: The whole program, or its begin.

        Raises:
            ProgramError: The program is wrong.
        """
        self._preparation = preparation
        self._kept: list[Chunk] = []
        self._file: IO[bytes] | None = None
        self._places: list[int] = []
        self.moves = 0
        self.start: FloatArray = start_position(preparation.job.file, preparation.machine)
        for chunk in chunks:
            self.add(chunk)

    def add(self, chunk: Chunk) -> None:
        """Keep the moves and events that follow the last ones."""
        if self.moves == 0 and len(chunk.moves):
            self.start = chunk.moves.start[0]
        self.moves += len(chunk.moves)
        if self.moves <= MOVES_IN_MEMORY:
            self._kept.append(chunk)
            return
        if self._file is None:
            self._file = tempfile.TemporaryFile(prefix="twin-moves-")  # noqa: SIM115 - closed with this object
            weakref.finalize(self, self._file.close)
        self._places.append(self._file.tell())
        pickle.dump(chunk, self._file, protocol=pickle.HIGHEST_PROTOCOL)

    def chunks(self) -> Iterator[Chunk]:
        """All of it in the program's order, a few thousand moves at a time."""
        yield from self._kept
        for place in self._places:
            assert self._file is not None
            self._file.seek(place)
            chunk: Chunk = pickle.load(self._file)  # noqa: S301 - written by this process, a file without a name
            yield chunk

    def timed_chunks(self) -> Iterator[Chunk]:
        """The same with the time of tool changes and of the spindle as dwells."""
        made = self._preparation
        return with_waits(self.chunks(), made.machine.file.spindle, made.job.file, made.spindle)


def interpreted(preparation: Preparation) -> InterpretedProgram:
    """A program interpreted to its end.

    Raises:
        ProgramError: The program is wrong.
    """
    return InterpretedProgram(preparation, preparation.interpretation().chunks())
