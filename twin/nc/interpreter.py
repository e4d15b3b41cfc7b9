"""Runs a program: text in, chunks of canonical moves out."""

import sys
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from twin.nc.canonical import Chunk, FloatArray
from twin.nc.control.control import Control
from twin.nc.control.dialect import Dialect
from twin.nc.control.settings import ControlSettings
from twin.nc.path.move_columns import CHUNK
from twin.nc.text.diagnostics import Diagnostic, ProgramError
from twin.nc.text.source import Source

if TYPE_CHECKING:
    from twin.nc.compiled.runner import PlainRunner

PLAIN_FROM = 500
"""Blocks and moves after which a program of more lines takes the fast way, which costs time to load."""
SHORT_PROGRAM = 100
"""A program of fewer lines, which can only loop, takes it after so many times as many blocks where
it is not loaded yet."""
_FAST_WAY = "twin.nc.compiled.runner"


class Interpretation:
    """One run of a program on one control.

    Attributes:
        source: The program.
        dialect: The language it is read in.
        settings: What the control was told of the machine and the job.
        before_fast_way: Done when the fast way is about to be loaded, which may have to compile it.
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
            plain_from: Blocks and moves after which the fast way is taken where there are as many
                lines, or where it is loaded.
        """
        self.source = source
        self.dialect = dialect
        self.settings = settings
        self.before_fast_way: Callable[[], None] = lambda: None
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
            done, fast_from = 0, self._fast_from()
            plain = self._plain_runner() if fast_from == 0 else None
            while not control.ended:
                if plain is None or not plain.run():
                    block = control.flow.next()
                    if block is None:
                        break
                    before = len(control.path)
                    control.run(block)
                    if plain is None:
                        done += 1 + len(control.path) - before
                        if done >= fast_from:
                            plain = self._plain_runner()
                if len(control.path) >= CHUNK or (plain is not None and plain.full):
                    yield control.path.take()
            control.finish()
        except ProgramError:
            yield control.path.take()
            raise
        yield control.path.take()

    def _plain_runner(self) -> "PlainRunner":
        self.before_fast_way()
        from twin.nc.compiled.runner import PlainRunner

        return PlainRunner(self._control)

    def _fast_from(self) -> int:
        """Blocks and moves after which the fast way begins."""
        long = len(self.source.lines) >= self._plain_from
        return self._plain_from * (1 if long or _FAST_WAY in sys.modules else SHORT_PROGRAM)
