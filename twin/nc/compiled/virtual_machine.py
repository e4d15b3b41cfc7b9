"""The compiled tier: plain and compiled blocks go past the control's words, in one compiled loop.

The loop works on the columns of the control's own state, as far as blocks are plain; of what the control
keeps besides, it is given the position, and gives it back. Where a dialect remembers something that acts
on such blocks, they go the interpreter tier.
"""

import math

from twin.nc.bytecode.frames import (
    BLOCKS,
    FULL,
    LINE,
    MADE,
    OFF_PAGE,
    PAUSED,
    TRAPPED,
    UNCOMPILED_LINE,
    ExecutionState,
    new_scratch,
)
from twin.nc.bytecode.registers import CYCLE_WORDS, MATRIX, Constants, Machine
from twin.nc.compiled.decode_tables import DecodeTables
from twin.nc.compiled.entries import Kernels, hot, page_columns
from twin.nc.compiled.kernels.dispatch import knows
from twin.nc.compiled.line_compiler import LineCompiler
from twin.nc.control.executor import Executor
from twin.nc.path.compensation.contour import Contour, new_contour
from twin.nc.path.event_columns import EventRows
from twin.nc.path.move_columns import CHUNK
from twin.nc.path.rows import Row, Rows, new_rows
from twin.nc.text.lines import Page

_WORTHWHILE = 4
"""Blocks that a run must have to pay for its beginning and its end."""
_LONGEST_PAUSE = 256
"""Blocks after which a new run is tried, where plain blocks are rare."""
_MOST = 200_000
"""Blocks after which a run without moves lets an interruption through."""


class VirtualMachine:
    """Runs plain blocks, and those that were compiled, for a control.

    Attributes:
        full: The path has no room for the next block's moves.
    """

    def __init__(self, control: Executor, kernels: Kernels) -> None:
        """Run for a control, at the speed of these kernels."""
        axes = len(control.settings.axes)
        self._control = control
        self._kernels = kernels
        self._lines = control.program_counter.lines
        self._page = Page(0, b"")
        self._tables = DecodeTables(
            control.dialect, control.settings, control.modal, control.interpreted_functions
        )
        self._line_compiler = LineCompiler(control, self._tables, kernels)
        self._rows = new_rows(CHUNK, CHUNK, axes)
        self._scratch = new_scratch(control.state)
        self._pause = 1
        self._wait = 0
        self.full = False

    def run(self) -> bool:
        """Run the blocks that come next as far as possible; False when one is for the control."""
        self.full = False
        if self._wait > 0:
            self._wait -= 1
            return False
        control = self._control
        room = CHUNK - len(control.path)
        if room <= 0 or not self._may_run():
            return False
        contour = control.path.begin_rows()
        if contour is None:
            return False
        rows = self._rows.first(room)
        control.program_counter.leave_line()
        progress = control.program_counter.progress
        begin = progress[LINE]
        progress[[BLOCKS, MADE]] = 0
        self._enter_state()
        why = self._run(rows, contour)
        made = int(progress[MADE])
        self.full = why == FULL and room - made < CHUNK
        worthwhile = progress[BLOCKS] >= _WORTHWHILE
        if why == TRAPPED:
            self._wait = 1 if worthwhile else self._pause
        self._pause = 1 if worthwhile or why != TRAPPED else min(2 * self._pause, _LONGEST_PAUSE)
        if progress[BLOCKS] == 0 and made == 0 and progress[LINE] == begin:
            return self.full  # it has gone past no line, and let go no move that was held
        self._leave_state(rows.first(made))
        return True

    def _run(self, rows: Rows, contour: Contour) -> int:
        """Run; why the run ended."""
        line_compiler, progress = self._line_compiler, self._control.program_counter.progress
        machine = Machine(self._tables.blocks, self._constants(), self._control.state, rows)
        while True:
            why = self._kernels.run_program(*self._arguments(machine, contour))
            if why == OFF_PAGE:
                self._page = self._lines.page_of(int(progress[LINE]))
            elif why == UNCOMPILED_LINE:
                if not line_compiler.compile(int(progress[LINE])):
                    return TRAPPED
            elif why != PAUSED:
                return why

    def is_compiled(self) -> bool:
        """Whether the hot kernels could run now, without waiting for the compiler."""
        from twin.compilation.cache import is_compiled

        machine = Machine(self._tables.blocks, self._constants(), self._control.state, self._rows)
        contour = new_contour(len(self._control.settings.axes))
        return is_compiled(hot().run_program, self._arguments(machine, contour))

    def _arguments(self, machine: Machine, contour: Contour) -> tuple[object, ...]:
        """What ``run_program`` is given; the columns of variables grow when lines are compiled."""
        counter = self._control.program_counter
        return (
            page_columns(self._page),
            self._tables.lines,
            self._line_compiler.bytecode.table,
            machine,
            ExecutionState(
                counter.progress,
                counter.calls,
                self._control.variables.columns,
                self._control.modal_of_calls,
                contour,
            ),
            self._scratch,
            _MOST,
        )

    def _may_run(self) -> bool:
        control = self._control
        disturbed = control.dialect.disturbed
        return (
            knows(control.state.modal, self._tables.blocks)
            and math.isnan(control.rapid_acceleration)
            and math.isnan(control.rapid_deceleration)
            and not (
                control.axis_limits or control.axis_accelerations or control.axis_decelerations
            )
            and (disturbed is None or not disturbed(control))
        )

    def _constants(self) -> Constants:
        control, rapid = self._control, self._control.dialect.rapid_feed
        return control.constants._replace(
            feed_may_lack=control.report.has_said("no-feed"),
            own_rapid_feed=math.nan if rapid is None else rapid(control),
        )

    def _enter_state(self) -> None:
        """Where the control stands goes into the columns of the state."""
        control, state = self._control, self._control.state
        state.programmed[:], state.part[:] = control.programmed, control.part
        state.event_count[0] = 0
        state.registers[CYCLE_WORDS:MATRIX] = math.nan

    def _leave_state(self, rows: Rows) -> None:
        """The control takes back where it stands, and the path what was made."""
        control, state = self._control, self._control.state
        if control.modal.cycle is None:
            control.forget_cycle()
        control.frame.refresh()
        event_count = int(state.event_count[0])
        events = EventRows(rows.events[:event_count], rows.event_values[:event_count])
        moves = Row(rows.codes, rows.values, rows.positions)
        latest = control.path.add_rows(moves, events)
        control.resume_at(state.programmed.tolist(), state.part.tolist(), latest)


def compiles_beside(machine: VirtualMachine) -> bool:
    """Whether the hot kernels are missing; then they are compiled beside, where that lasts."""
    from twin.compilation.beside import beside
    from twin.compilation.folders import lasts

    compilation = beside("twin.nc.compile_all")
    if compilation.is_own():
        return True
    if machine.is_compiled():
        return False
    if lasts():
        compilation.start()
    return True
