"""The fast way: runs of plain blocks go past the control's words, in one compiled loop.

The control stays the one place that knows what a program means. It hands its state to the loop,
the loop runs blocks as far as they are plain, and the control takes the state back; where a
dialect remembers something that acts on such blocks, they go the general way.
"""

import math

import numpy as np

from twin.nc.canonical import Corner, Motion
from twin.nc.control import Control
from twin.nc.move_columns import CHUNK, Segment
from twin.nc.plain_kernels import run_blocks
from twin.nc.plain_state import Constants, Rows, State
from twin.nc.plain_tables import FEED_FACTORS, PlainTables
from twin.nc.plain_words_kernels import NOT_PLAIN
from twin.nc.planes import XY, YZ, ZX

_LINE = 2
"""Column of ``Rows.codes``."""
_WORTHWHILE = 4
"""Blocks that a run must have to pay for handing the state over and back."""
_LONGEST_PAUSE = 256
"""Blocks after which a new run is tried, where plain blocks are rare."""


class PlainRunner:
    """Runs plain blocks for a control."""

    def __init__(self, control: Control) -> None:
        axes = len(control.settings.axes)
        self._control = control
        self._lines = control.flow.lines
        self._tables = PlainTables(control.dialect, control.settings)
        self._rows = Rows(
            np.zeros((CHUNK, 5), np.int64), np.zeros((CHUNK, 11)), np.zeros((CHUNK, 3, axes))
        )
        self._pause = 1
        self._wait = 0

    def run(self) -> bool:
        """Run the plain blocks that come next; False when there are none."""
        if self._wait > 0:
            self._wait -= 1
            return False
        control = self._control
        lines = control.flow.straight_on()
        room = CHUNK - len(control.path)
        if not lines or not self._may_run():
            return False
        page = self._lines.page_of(lines.start)
        first = page.lines.start
        stop = min(lines.stop, page.lines.stop)
        state = self._state()
        rows = self._rows.first(room)
        reached, made, blocks, inked = run_blocks(
            page.data,
            page.starts,
            lines.start - first,
            stop - first,
            self._tables.lines,
            self._tables.blocks,
            self._constants(),
            state,
            rows,
        )
        reached += first
        rows.codes[:made, _LINE] += first
        if blocks >= _WORTHWHILE or made == room or reached == stop:
            self._pause = 1
        else:
            self._wait = self._pause
            self._pause = min(2 * self._pause, _LONGEST_PAUSE)
        if reached == lines.start:
            return False
        control.flow.passed(reached, blocks)
        if inked != NOT_PLAIN:
            control.report.line = first + inked + 1
        self._give_back(state, rows.first(made))
        return True

    def _may_run(self) -> bool:
        control = self._control
        modal, disturbed = control.modal, control.dialect.disturbed
        return (
            modal.cycle is None
            and modal.plane in (XY, YZ, ZX)
            and modal.feed_mode in FEED_FACTORS
            and control.frame.plain
            and modal.correct_center
            and control.path.open
            and math.isnan(control.rapid_acceleration)
            and math.isnan(control.rapid_deceleration)
            and not (control.axis_limits or control.axis_accelerations)
            and (disturbed is None or not disturbed(control))
        )

    def _constants(self) -> Constants:
        control = self._control
        return Constants(
            total=np.array(control.frame.total),
            plane=np.array(control.modal.plane.axes),
            default_feed=control.settings.default_feed,
            default_rotary_feed=control.settings.default_rotary_feed,
            feed_may_lack=control.report.has_said("no-feed"),
            rapid_feed=control.rapid_feed,
            last_values=np.array(
                [control.modal.corner_tolerance, control.acceleration, control.deceleration]
            ),
        )

    def _state(self) -> State:
        control = self._control
        return State(
            modal=self._tables.modal(control.modal),
            in_force=np.full(len(self._tables.groups), NOT_PLAIN, np.int64),
            feed=np.array([math.nan if control.feed is None else control.feed]),
            programmed=np.array(control.programmed),
            part=np.array(control.part),
        )

    def _give_back(self, state: State, rows: Rows) -> None:
        control = self._control
        for number in state.in_force.tolist():
            if number != NOT_PLAIN:
                control.put_into_force(number, control.dialect.g[number])
        feed = float(state.feed[0])
        control.feed = None if math.isnan(feed) else feed
        last = None
        if len(rows.codes):
            last = _segment(rows)
            control.path.add_rows(rows.codes, rows.values, rows.positions, last)
        control.came_to(state.programmed.tolist(), state.part.tolist(), last)


def _segment(rows: Rows) -> Segment:
    """The last row as the control keeps it."""
    motion, _, line, block, corner = rows.codes[-1].tolist()
    *center_and_normal, sweep, feed, tolerance, acceleration, deceleration = rows.values[
        -1
    ].tolist()
    start, end, display = rows.positions[-1].tolist()
    a, b, c, i, j, k = center_and_normal
    return Segment(
        motion=Motion(motion),
        line=line,
        block=block,
        start=start,
        end=end,
        display=display,
        feed=feed,
        corner=Corner(corner),
        corner_tolerance=tolerance,
        acceleration=acceleration,
        deceleration=deceleration,
        center=None if math.isnan(a) else (a, b, c),
        normal=(i, j, k),
        sweep=sweep,
    )
