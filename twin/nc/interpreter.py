"""Runs a program: text in, chunks of canonical moves out."""

import sys
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from twin.nc.canonical import Chunk, FloatArray
from twin.nc.control.dialect import Dialect
from twin.nc.control.executor import Executor
from twin.nc.control.settings import ControlSettings
from twin.nc.path.move_columns import CHUNK
from twin.nc.text.diagnostics import Diagnostic, ProgramError
from twin.nc.text.source import Source

if TYPE_CHECKING:
    from twin.nc.compiled.virtual_machine import VirtualMachine

COMPILED_FROM = 500
"""Blocks and moves after which a program of more lines takes the compiled tier, which costs time to load."""
SHORT_PROGRAM = 100
"""A program of fewer lines, which can only loop, takes it after so many times as many blocks where
it is not loaded yet."""
_COMPILED_TIER = "twin.nc.compiled.virtual_machine"


class Interpretation:
    """One run of a program on one control.

    Attributes:
        source: The program.
        dialect: The language it is read in.
        settings: What the control was told of the machine and the job.
        before_compiled_tier: Done when the compiled tier is about to be loaded, which may have to compile it.
    """

    def __init__(
        self,
        source: Source,
        dialect: Dialect,
        settings: ControlSettings,
        *,
        compiled_from: int = COMPILED_FROM,
    ) -> None:
        """Take a program.

        Args:
            source: The program.
            dialect: The language it is read in.
            settings: What the control is told of the machine and the job.
            compiled_from: Blocks and moves after which the compiled tier is taken where there are as many
                lines, or where it is loaded.
        """
        self.source = source
        self.dialect = dialect
        self.settings = settings
        self.before_compiled_tier: Callable[[], None] = lambda: None
        self._compiled_from = compiled_from
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
            done, compiled_after = 0, self._compiled_after()
            plain = self._virtual_machine() if compiled_after == 0 else None
            while not control.ended:
                if plain is None or not plain.run():
                    block = control.program_counter.next()
                    if block is None:
                        break
                    before = len(control.path)
                    control.run(block)
                    if plain is None:
                        done += 1 + len(control.path) - before
                        if done >= compiled_after:
                            plain = self._virtual_machine()
                if len(control.path) >= CHUNK or (plain is not None and plain.full):
                    yield control.path.take()
            control.finish()
        except ProgramError:
            yield control.path.take()
            raise
        yield control.path.take()

    def _virtual_machine(self) -> "VirtualMachine":
        self.before_compiled_tier()
        from twin.nc.compiled.virtual_machine import VirtualMachine

        return VirtualMachine(self._control)

    def _compiled_after(self) -> int:
        """Blocks and moves after which the compiled tier begins."""
        long = len(self.source.lines) >= self._compiled_from
        return self._compiled_from * (1 if long or _COMPILED_TIER in sys.modules else SHORT_PROGRAM)
