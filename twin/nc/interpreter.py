"""Runs a program: text in, chunks of canonical moves out."""

import sys
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from twin.compilation.speed import Speed, usual_speed
from twin.nc.canonical import Chunk, FloatArray
from twin.nc.control.dialect import Dialect
from twin.nc.control.executor import Executor
from twin.nc.control.settings import ControlSettings
from twin.nc.path.move_columns import CHUNK
from twin.nc.text.diagnostics import Diagnostic, ProgramError
from twin.nc.text.source import Source

if TYPE_CHECKING:
    from twin.nc.compiled.virtual_machine import VirtualMachine

AT_HAND_FROM = 40
"""Blocks and moves after which the compiled tier is taken, where this process has run it before: to hand it
the program costs as much as so many blocks of the interpreter tier."""
COMPILED_FROM = 500
"""Blocks and moves after which the compiled tier is taken, where the compiler is loaded or the program is long."""
LONG_PROGRAM = 10_000
"""Lines of a program for which it pays to load the compiler: about a second."""
SHORT_PROGRAM = 100
"""A shorter one, which can only loop, takes the compiled tier after so many times as many blocks."""
_LOOK_AGAIN = 2_000
"""Blocks and moves after which a run looks again whether the kernels are there."""
_PAYS = 2_000_000
"""Blocks and moves after which it waits for them: to go on without would take longer by then."""
_COMPILER, _ENTRIES = "twin.compilation.kernel", "twin.nc.compiled.entries"


class Interpretation:
    """One run of a program on one control.

    Attributes:
        source: The program.
        dialect: The language it is read in.
        settings: What the control was told of the machine and the job.
        before_compiled_tier: Done when the compiled tier is about to be loaded, which may have to compile it.
        compiled_after: Blocks and moves after which the compiled tier has taken over; None: it has not.
    """

    def __init__(
        self,
        source: Source,
        dialect: Dialect,
        settings: ControlSettings,
        *,
        compiled_from: int | None = None,
        speed: Speed | None = None,
    ) -> None:
        """Take a program.

        Args:
            source: The program.
            dialect: The language it is read in.
            settings: What the control is told of the machine and the job.
            compiled_from: Blocks and moves after which the compiled tier is taken; None: where that pays.
            speed: What it does while that is not compiled; None: as is usual.
        """
        self.source = source
        self.dialect = dialect
        self.settings = settings
        self.before_compiled_tier: Callable[[], None] = lambda: None
        self.compiled_after: int | None = None
        self._compiled_from = compiled_from
        self._speed = usual_speed() if speed is None else speed
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
            ProgramError: The program is wrong; the moves before the wrong block have been yielded.
        """
        control, refused = self._control, None
        try:
            control.prepare()
            done, moves, due = 0, 0, self._compiled_after()
            machine = self._virtual_machine(done) if due == 0 else None
            while not control.ended:
                if machine is None or not machine.run():
                    block = control.program_counter.next()
                    if block is None:
                        break
                    refused = control.path.refusal(block.line)
                    control.run(block)
                    refused = None
                before, moves = moves, len(control.path)
                if machine is None:
                    done += 1 + moves - before
                    if done >= due:
                        machine, due = self._virtual_machine(done), done + _LOOK_AGAIN
                if moves >= CHUNK or (machine is not None and machine.full):
                    yield control.path.take()
                    moves = 0
            control.finish()
        except ProgramError:
            yield control.path.take(refused)
            raise
        yield control.path.take()

    def _virtual_machine(self, done: int) -> "VirtualMachine | None":
        """What runs compiled blocks; None while its kernels are being compiled beside this run."""
        self.before_compiled_tier()
        from twin.nc.compiled.entries import COLD, hot
        from twin.nc.compiled.virtual_machine import VirtualMachine, compiles_beside

        cold = VirtualMachine(self._control, COLD)
        if self._speed is Speed.COLD:
            return cold
        waits = self._speed is Speed.HOT or done >= _PAYS
        if not waits and compiles_beside(cold):
            return None
        self.compiled_after = done
        return VirtualMachine(self._control, hot())

    def _compiled_after(self) -> int:
        """Blocks and moves after which the compiled tier begins."""
        if self._compiled_from is not None:
            return self._compiled_from
        if _ENTRIES in sys.modules:
            from twin.nc.compiled.entries import at_hand

            if at_hand():
                return AT_HAND_FROM
        pays = _COMPILER in sys.modules or len(self.source.lines) >= LONG_PROGRAM
        return COMPILED_FROM * (1 if pays else SHORT_PROGRAM)
