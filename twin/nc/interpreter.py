"""Runs a program: text in, chunks of canonical moves out."""

from collections.abc import Iterator

import numpy as np

from twin.nc.canonical import Chunk, FloatArray
from twin.nc.control.dialect import Dialect
from twin.nc.control.executor import Executor
from twin.nc.control.settings import ControlSettings
from twin.nc.path.move_columns import CHUNK
from twin.nc.text.diagnostics import Diagnostic, ProgramError
from twin.nc.text.source import Source


class Interpretation:
    """One run of a program on one control.

    Attributes:
        source: The program.
        dialect: The language it is read in.
        settings: What the control was told of the machine and the job.
    """

    def __init__(self, source: Source, dialect: Dialect, settings: ControlSettings) -> None:
        self.source = source
        self.dialect = dialect
        self.settings = settings
        self._control = Executor(dialect, settings, source)

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The warnings so far."""
        return tuple(self._control.report.warnings)

    @property
    def position(self) -> FloatArray:
        """Where the axes stand in part coordinates, shape (k,) [mm or deg]."""
        return np.array(self._control.path.position)

    @property
    def display(self) -> FloatArray:
        """What the control's screen shows, shape (k,) [mm or deg]."""
        return np.array(self._control.programmed)

    def chunks(self) -> Iterator[Chunk]:
        """Run the program once; a few thousand moves at a time.

        Raises:
            ProgramError: The program is wrong; the moves before the error have been yielded.
        """
        control = self._control
        try:
            control.prepare()
            while not control.ended:
                block = control.program_counter.next()
                if block is None:
                    break
                control.run(block)
                if len(control.path) >= CHUNK:
                    yield control.path.take()
            control.finish()
        except ProgramError:
            yield control.path.take()
            raise
        yield control.path.take()
