"""Runs a program: text in, chunks of canonical moves out."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from twin.nc.canonical import Chunk, FloatArray
from twin.nc.control import Control
from twin.nc.diagnostics import Diagnostic, ProgramError
from twin.nc.dialect import Dialect
from twin.nc.move_columns import CHUNK
from twin.nc.settings import ControlSettings
from twin.nc.source import Source

if TYPE_CHECKING:
    from twin.nc.plain import PlainRunner

PLAIN_FROM = 500
"""Blocks after which a program of more lines takes the fast way, which costs time to load."""


class Interpretation:
    """One run of a program on one control.

    Attributes:
        source: The program.
        dialect: The language it is read in.
        settings: What the control was told of the machine and the job.
    """

    def __init__(
        self,
        source: Source,
        dialect: Dialect,
        settings: ControlSettings,
        *,
        plain_from: int = PLAIN_FROM,
    ) -> None:
        """Take a program.

        Args:
            source: The program.
            dialect: The language it is read in.
            settings: What the control is told of the machine and the job.
            plain_from: Blocks after which plain ones take the fast way, where it has as many lines.
        """
        self.source = source
        self.dialect = dialect
        self.settings = settings
        self._plain_from = plain_from
        self._control = Control(dialect, settings, source)

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
            general = 0
            plain = self._plain_runner() if self._plain_from == 0 else None
            while not control.ended:
                if plain is None or not plain.run():
                    block = control.flow.next()
                    if block is None:
                        break
                    control.run(block)
                    general += 1
                    if general == self._plain_from:
                        plain = self._plain_runner()
                if len(control.path) >= CHUNK:
                    yield control.path.take()
            control.finish()
        except ProgramError:
            yield control.path.take()
            raise
        yield control.path.take()

    def _plain_runner(self) -> "PlainRunner | None":
        if len(self.source.lines) < self._plain_from:
            return None
        from twin.nc.plain import PlainRunner

        return PlainRunner(self._control)
