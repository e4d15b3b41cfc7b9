"""Runs a program: text in, chunks of canonical moves out."""

from collections.abc import Callable, Iterator

import numpy as np

from twin.nc.canonical import Chunk, FloatArray
from twin.nc.control.dialect import Dialect
from twin.nc.control.executor import Executor
from twin.nc.control.settings import ControlSettings
from twin.nc.line_kernel.choice import usual_kernel
from twin.nc.line_kernel.plain_state import LineKernel, LineRuns
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

    def __init__(
        self,
        source: Source,
        dialect: Dialect,
        settings: ControlSettings,
        *,
        kernel: Callable[[int], LineKernel | None] = usual_kernel,
    ) -> None:
        """Take a program.

        Args:
            source: The program.
            dialect: The language it is read in.
            settings: What the control is told of the machine and the job.
            kernel: What runs plain lines, given how many lines the program has; None: Python alone.
        """
        self.source = source
        self.dialect = dialect
        self.settings = settings
        self._kernel = kernel
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
        kernel = self._kernel(len(self.source.lines))
        lines = None if kernel is None else LineRuns(control, kernel)
        try:
            control.prepare()
            while not control.ended:
                if lines is not None and lines.run():
                    if len(control.path) >= CHUNK:
                        yield control.path.take()
                    continue
                block = control.program_counter.next()
                if block is None:
                    break
                refused = control.path.refusal(block.line)
                control.run(block)
                refused = None
                if len(control.path) >= CHUNK:
                    yield control.path.take()
            control.finish()
        except ProgramError:
            yield control.path.take(refused)
            raise
        yield control.path.take()
