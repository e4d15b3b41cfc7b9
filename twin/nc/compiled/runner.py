"""The fast way: plain and translated blocks go past the control's words, in one compiled loop.

The control stays the one place that knows what a program means. It hands its state to the loop,
the loop runs blocks as far as they are plain, and the control takes the state back; where a
dialect remembers something that acts on such blocks, they go the general way.
"""

import math

import numpy as np

from twin.nc.bytecode.frames import FULL, LEFT, OFF_PAGE, PAUSED, UNREAD
from twin.nc.bytecode.registers import (
    CYCLE,
    GIVEN,
    IN_SPINDLE,
    MATRIX,
    PROGRAMMED_FEED,
    REGISTERS,
    REMEMBERED,
    ROTATION,
    SCALE,
    SELECTED,
    SIGNS,
    SPINDLE,
    TURNED,
    Constants,
    Rows,
    State,
)
from twin.nc.canonical import FloatArray
from twin.nc.compiled.contour_columns import fill, gone, new_contour
from twin.nc.compiled.hand_over import HandOver, put_into_force
from twin.nc.compiled.kernels.block import new_bench
from twin.nc.compiled.kernels.cycle import MOST_STOPS
from twin.nc.compiled.kernels.program import run_program
from twin.nc.compiled.kernels.tokenizer import NOT_PLAIN
from twin.nc.compiled.tables import FEED_FACTORS, PlainTables
from twin.nc.compiled.translator import Translator
from twin.nc.control.control import Control
from twin.nc.control.drilling_cycle import most_acts, no_values
from twin.nc.geometry.planes import PLANE_ORDER
from twin.nc.path.contour_registers import Row
from twin.nc.path.event_columns import EventRows
from twin.nc.path.move_columns import CHUNK
from twin.nc.text.lines import Page

_PLANES = np.array([plane.axes for plane in PLANE_ORDER])
_WORTHWHILE = 4
"""Blocks that a run must have to pay for handing the state over and back."""
_LONGEST_PAUSE = 256
"""Blocks after which a new run is tried, where plain blocks are rare."""
_MOST = 200_000
"""Blocks after which a run without moves lets an interruption through."""


class PlainRunner:
    """Runs plain blocks, and those that were translated, for a control.

    Attributes:
        full: The path has no room for the next block's moves.
    """

    def __init__(self, control: Control) -> None:
        axes = len(control.settings.axes)
        self._control = control
        self._lines = control.flow.lines
        self._page = Page(0, b"")
        self._tables = PlainTables(control.dialect, control.settings)
        self._translator = Translator(control, self._tables)
        self._rows = Rows(
            np.zeros((CHUNK, 5), np.int64),
            np.zeros((CHUNK, 11)),
            np.zeros((CHUNK, 3, axes)),
            np.zeros((CHUNK, 4), np.int64),
            np.zeros(CHUNK),
        )
        table = control.tools.table
        self._tools = np.array([float(number) for number in table])
        self._longer = np.array([control.tools.longer(tool) for tool in table.values()])
        self._radii = np.array([tool.radius for tool in table.values()])
        self._hole = np.zeros((4, most_acts(MOST_STOPS)))
        self._contour = new_contour(axes)
        self._bench = new_bench(self._state())
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
        state, rows = self._state(), self._rows.first(room)
        fill(self._contour, control.path.followed, control.path.position)
        handed = HandOver(control, state, self._contour)
        why = self._run(state, rows, handed)
        self.full = why == FULL and room - handed.made < CHUNK
        worthwhile = handed.blocks >= _WORTHWHILE
        if why == LEFT:
            self._wait = 1 if worthwhile else self._pause
        self._pause = 1 if worthwhile or why != LEFT else min(2 * self._pause, _LONGEST_PAUSE)
        if not handed.gone_on:
            return self.full
        handed.give_back()
        self._give_back(state, rows.first(handed.made))
        return True

    def _run(self, state: State, rows: Rows, handed: HandOver) -> int:
        """Run; why the run ended."""
        translator, constants = self._translator, self._constants()
        instructions = translator.instructions
        while True:
            why = run_program(
                self._page.data,
                self._page.starts,
                self._page.lines.start,
                self._tables.lines,
                self._tables.blocks,
                constants,
                state,
                rows,
                instructions.table,
                handed.routine,
                self._bench,
                _MOST,
            )
            if why == OFF_PAGE:
                self._page = self._lines.page_of(handed.line)
            elif why == UNREAD:
                if not translator.translate(handed.line):
                    return LEFT
            elif why != PAUSED:
                return why

    def _may_run(self) -> bool:
        control = self._control
        modal, disturbed = control.modal, control.dialect.disturbed
        return (
            self._tables.knows_cycle(modal.cycle)
            and modal.plane in PLANE_ORDER
            and modal.feed_mode in FEED_FACTORS
            and modal.correct_center
            and control.path.hands_over
            and math.isnan(control.rapid_acceleration)
            and math.isnan(control.rapid_deceleration)
            and not (control.axis_limits or control.axis_accelerations)
            and (disturbed is None or not disturbed(control))
        )

    def _constants(self) -> Constants:
        control, rapid = self._control, self._tables.rapid_feed
        return Constants(
            default_feed=control.settings.default_feed,
            default_rotary_feed=control.settings.default_rotary_feed,
            feed_may_lack=control.report.has_said("no-feed"),
            rapid_feed=control.rapid_feed,
            own_rapid_feed=math.nan if rapid is None else rapid(control),
            last_values=np.array(
                [control.modal.corner_tolerance, control.acceleration, control.deceleration]
            ),
            planes=_PLANES,
            tools=self._tools,
            longer=self._longer,
            radii=self._radii,
            square_corners=control.modal.square_corners,
            indirect_leads=control.modal.indirect_leads,
            over=np.zeros(len(control.part)),
            room=np.zeros((3, len(control.part))),
            hole=self._hole,
        )

    def _state(self) -> State:
        control = self._control
        return State(
            modal=self._tables.modal(control.modal),
            in_force=np.full(len(self._tables.groups), NOT_PLAIN, np.int64),
            programmed=np.array(control.programmed),
            part=np.array(control.part),
            happened=np.zeros(1, np.int64),
            registers=self._registers(),
            shifts=np.array(control.frame.shifts),
            total=np.array(control.frame.total),
            label=np.zeros(len(control.part)),
        )

    def _registers(self) -> FloatArray:
        control = self._control
        registers = np.zeros(REGISTERS)
        registers[REMEMBERED:GIVEN], registers[GIVEN:MATRIX] = control.hole_values, math.nan
        registers[SCALE], registers[ROTATION], registers[SIGNS:REMEMBERED] = 1.0, math.nan, 1.0
        registers[TURNED] = not control.frame.plain
        registers[MATRIX:] = np.ravel(control.frame.matrix)
        tools = control.tools
        for place, value in (
            (PROGRAMMED_FEED, control.feed),
            (SPINDLE, control.spindle),
            (SELECTED, tools.selected),
            (IN_SPINDLE, tools.spindle),
        ):
            registers[place] = math.nan if value is None else value
        for place, number in control.dialect.registers(control).items():
            registers[place] = number
        return registers

    def _take_registers(self, registers: list[float]) -> None:
        control = self._control
        control.feed, speed, selected, in_spindle = (
            None if math.isnan(registers[place]) else registers[place]
            for place in (PROGRAMMED_FEED, SPINDLE, SELECTED, IN_SPINDLE)
        )
        control.spindle = speed
        control.tools.selected = None if selected is None else int(selected)
        control.tools.spindle = None if in_spindle is None else int(in_spindle)
        control.dialect.take_registers(control, registers)

    def _give_cycle_back(self, state: State) -> None:
        cycle = self._tables.cycle(state.modal[CYCLE])
        values = state.registers[REMEMBERED:GIVEN].tolist()
        self._control.modal.cycle = cycle
        self._control.hole_values = no_values() if cycle is None else values

    def _give_back(self, state: State, rows: Rows) -> None:
        control = self._control
        put_into_force(control, state.in_force)
        self._give_cycle_back(state)
        self._take_registers(state.registers.tolist())
        control.frame.set_shifts(state.shifts.tolist())
        a, b, c, d, e, f, g, h, i = state.registers[MATRIX:].tolist()
        control.frame.set_matrix(((a, b, c), (d, e, f), (g, h, i)))
        happened = int(state.happened[0])
        events = EventRows(rows.events[:happened], rows.amounts[:happened])
        moves = Row(rows.codes, rows.values, rows.positions)
        gone_on, placed = gone(self._contour, moves, events)
        control.path.add_rows(moves, placed, gone_on)
        control.came_to(state.programmed.tolist(), state.part.tolist(), gone_on.latest)
