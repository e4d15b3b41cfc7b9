"""Runs a program: text in, chunks of canonical moves out."""

from collections.abc import Callable, Iterator

import numpy as np

from twin.nc.canonical import Chunk, FloatArray
from twin.nc.control.dialect import Dialect
from twin.nc.control.executor import Executor
from twin.nc.control.settings import ControlSettings
from twin.nc.coverage import Coverage
from twin.nc.length_calls import LengthCalls
from twin.nc.line_kernel.plain_state import LineKernel, LineRuns, usual_kernel
from twin.nc.path.move_columns import CHUNK, Refused
from twin.nc.text.blocks import Block
from twin.nc.text.diagnostics.diagnostics import Diagnostic, ProgramError
from twin.nc.text.source import Source

_NO_COMPENSATION = 40
_COMPENSATION = (41, 42)
"""Whole parts of the codes of radius compensation, in every dialect."""


class Interpretation:
    """One run of a program on one control.

    Attributes:
        lengths: The tool lengths that it calls.
        compensated: Source lines that were run under radius compensation: their moves are the tool centre's.
        drilled: Source lines that made a hole by a drilling cycle.
    """

    def __init__(
        self,
        source: Source,
        dialect: Dialect,
        settings: ControlSettings,
        *,
        kernel: Callable[[int], LineKernel | None] = usual_kernel,
    ) -> None:
        """Take a program; ``kernel``: what runs plain lines, given how many lines it has; None: Python alone."""
        self.source = source
        self.dialect = dialect
        self.settings = settings
        self._kernel = kernel
        self._executor = Executor(dialect, settings, source)
        self._control = self._executor.control
        self.coverage = Coverage(source, dialect)
        self.lengths = LengthCalls(by_code=dialect.rules.length_by_code)
        self.compensated: set[int] = set()
        self.drilled: set[int] = set()

    @property
    def programs_in_inches(self) -> bool:
        """Whether lengths are programmed in inches now."""
        return self._control.modal.unit != 1.0

    @property
    def tool_names(self) -> dict[int, str]:
        """Tools that the program called by names which the job does not give, by number."""
        return {number: name for name, number in self._control.tools.names.items()}

    @property
    def written_zero(self) -> dict[str, float]:
        """What the program has written first into its table of work offsets, by axis [mm or deg]."""
        return dict(self._control.written_zero)

    @property
    def written_tools(self) -> dict[int, dict[str, float]]:
        """Radius and length that the program has written into the control's table, by tool [mm]."""
        return self._control.tools.written

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The warnings so far."""
        return tuple(self._control.report.warnings)

    @property
    def position(self) -> FloatArray:
        """Where the axes are in part coordinates, shape (k,) [mm or deg]."""
        return np.array(self._control.path.position)

    @property
    def display(self) -> FloatArray:
        """What the control's screen shows, shape (k,) [mm or deg]."""
        return np.array(self._control.motion.programmed)

    def chunks(self) -> Iterator[Chunk]:
        """Run the program once; a few thousand moves at a time.

        Raises:
            ProgramError: The program is wrong; the moves before the wrong block have been yielded.
        """
        control, begun = self._control, None
        columns = control.path.columns
        kernel = self._kernel(len(self.source.lines))
        lines = None if kernel is None else LineRuns(self._executor, kernel)
        try:
            self._executor.prepare()
            while not control.ended:
                if lines is not None and (run := lines.run()):
                    self.coverage.note(run.start + 1, run.stop + 1)
                    if columns.count >= CHUNK:
                        yield self.lengths.passed(columns.take())
                    continue
                block = control.program_counter.next()
                if block is None:
                    break
                begun = (columns.count, len(columns.events), block.line)
                self._executor.run(block)
                self._note(block, begun[0])
                begun = None
                if columns.count >= CHUNK:
                    yield self.lengths.passed(columns.take())
            self._executor.finish()
        except ProgramError:
            yield self.lengths.passed(columns.take(None if begun is None else Refused(*begun)))
            raise
        yield self.lengths.passed(columns.take())

    def _note(self, block: Block, first: int) -> None:
        """A block was run whose first move has that number in its chunk."""
        control, tools = self._control, self._control.tools
        if not (block.skippable and control.settings.skips(block)):
            self.coverage.note_line(block.line)
        code = int(control.modal.active.get("compensation", _NO_COMPENSATION))
        if code in _COMPENSATION or control.path.compensation.in_force:
            self.compensated.add(block.line)
        if tools.drills:
            self.drilled.add(block.line)
            tools.drills = False
        self.lengths.note(tools, block.line, first)
        if control.ended:
            self.coverage.ends_at = block.line
