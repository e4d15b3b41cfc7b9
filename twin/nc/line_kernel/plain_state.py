"""When a control may let plain lines run in the kernel, what it tells it, and what it takes back."""

import functools
import math
import os
import string
import sys
from collections.abc import Callable

import numpy as np

from twin.nc.canonical import FloatArray
from twin.nc.control.codes import GCode
from twin.nc.control.control import WITHOUT_POINT
from twin.nc.control.executor import Executor
from twin.nc.control.modal import ArcRule, LineRule, MotionMode
from twin.nc.geometry.arcs import Bounds
from twin.nc.geometry.planes import PLANE_ORDER
from twin.nc.line_kernel.kernel import (
    CLOCKWISE,
    COUNTER_CLOCKWISE,
    FEED_LINE,
    NO_MOTION,
    RAPID_LINE,
    MoveRows,
    PageColumns,
    PlainRules,
    PlainState,
    run_lines,
)
from twin.nc.line_kernel.reading import (
    AXIS,
    CENTER,
    CODE,
    FEED_WORD,
    NUMBER,
    OTHER,
    RADIUS,
    LineFormat,
)
from twin.nc.path.feed_rates import PATH_COUNTS
from twin.nc.path.move_columns import CHUNK
from twin.nc.text.comments import comment_marks

VARIABLE = "MILL_TWIN_COMPILATION"
"""Environment variable: ``wait`` lets everything wait for the compiler, as tests and benches want it."""


LineKernel = Callable[[PageColumns, PlainRules, PlainState, MoveRows], int]
"""``kernel.run_lines``, as CPython runs it or compiled."""
_NO_ARC = ArcRule(bounds=Bounds(0.0, 0.0, 0.0, 0.0))
_WORTHWHILE = 4
"""Moves that a run must make to pay for its beginning and its end."""
_LONGEST_PAUSE = 256
"""Blocks after which a new run is tried, where plain lines are rare."""


class LineRuns:
    """Runs of plain lines of one program."""

    def __init__(self, executor: Executor, kernel: LineKernel) -> None:
        """Run them for a control, by this kernel."""
        self._executor = executor
        self._control = executor.control
        self._kernel = kernel
        self._rules = plain_rules(executor)
        looked_at = executor.dialect.rules.without_point(executor.control.settings)
        self._without_point = looked_at.intersection(string.ascii_uppercase)
        axes = len(self._control.settings.axes)
        self._values = np.zeros(AXIS + axes)
        self._rows = MoveRows(
            np.zeros((CHUNK, 5), np.int64), np.zeros((CHUNK, 11)), np.zeros((CHUNK, 3, axes))
        )
        self._pause = self._wait = 0

    def run(self) -> range:
        """Run the lines that come next, as far as they are plain.

        Returns:
            The lines that were run, from 0; none where the next block is Python's.
        """
        control = self._control
        if self._wait > 0:
            self._wait -= 1
            return range(0)
        room = CHUNK - control.path.columns.count
        line = control.program_counter.fresh_line
        if line is None or room <= 0 or not may_run_lines(self._executor):
            return range(0)
        if self._goes_on(line):
            return range(0)
        page = control.program_counter.lines.page_of(line)
        columns = PageColumns(page.data, page.starts, page.ends, page.lines.start)
        state = self._state(line)
        made = self._kernel(columns, self._rules, state, self._rows.first(room))
        came_to = int(state.line[0])
        if made < _WORTHWHILE and came_to < page.lines.stop:
            self._pause = min(2 * self._pause + 1, _LONGEST_PAUSE)
            self._wait = self._pause
        else:
            self._pause = 0
        if came_to > line:
            self._take_back(state, came_to, self._rows.first(made))
        return range(line, came_to)

    def _goes_on(self, line: int) -> bool:
        """Whether a line goes on with the block of the one before it."""
        continued, lines = (
            self._executor.dialect.syntax.continued,
            self._control.program_counter.lines,
        )
        return bool(continued) and line > 0 and lines[line - 1].rstrip().endswith(continued)

    def _state(self, line: int) -> PlainState:
        control, motion = self._control, self._control.motion
        modal, frame = control.modal, control.frame
        return PlainState(
            line=np.array([line, 0]),
            kind=np.array([kind_of(modal.interpolation)]),
            feed=np.array([math.nan if motion.feed is None else motion.feed]),
            position=np.array([motion.programmed, motion.part]),
            values=self._values,
            increments=self._increments(),
            total=np.array(frame.total),
            matrix=frame.matrix,
            turned=not frame.is_identity,
            plane=modal.plane.directions,
            plane_axes=modal.plane.axes,
            unit=modal.unit,
            incremental=modal.incremental,
            center_absolute=modal.center_absolute,
            feed_mode=int(modal.feed_mode),
            feed_may_lack=control.report.has_said("no-feed"),
            spindle=math.nan if motion.spindle is None else motion.spindle,
            spindle_turns=float(motion.spindle_turns),
            rapid_feed=motion.rapid_feed,
            corner=int(modal.corner),
            limits=(modal.corner_tolerance, motion.acceleration, motion.deceleration),
        )

    def _increments(self) -> FloatArray:
        """What numbers without a decimal point count now; NaN where Python must still warn of it."""
        control, factors = self._control, np.ones(len(string.ascii_uppercase))
        warned = control.report.has_said(WITHOUT_POINT)
        for letter in self._without_point:
            factor = self._executor.dialect.rules.increment(control, letter)
            factors[ord(letter) - ord("A")] = factor if warned or factor == 1.0 else math.nan
        return factors

    def _take_back(self, state: PlainState, line: int, rows: MoveRows) -> None:
        """The control is where the run has come to."""
        control, motion, feed = self._control, self._control.motion, float(state.feed[0])
        kind = int(state.kind[0])
        if kind != kind_of(control.modal.interpolation):
            number = self._numbers[kind]
            self._executor.put_into_force(number, self._executor.dialect.codes.g[number])
        motion.feed = None if math.isnan(feed) else feed
        programmed, part = state.position.tolist()
        motion.take_rows(rows, programmed, part)
        control.program_counter.pass_lines(line, int(state.line[1]))

    @property
    def _numbers(self) -> dict[int, int]:
        """The G code of each kind of motion."""
        return {int(kind): number for number, kind in enumerate(self._rules.kinds) if kind >= 0}


def may_run_lines(executor: Executor) -> bool:
    """Whether plain lines mean no more than the kernel knows, with all that is in force."""
    control, motion = executor.control, executor.control.motion
    modal = control.modal
    return (
        modal.cycle is None
        and modal.correct_center
        and modal.plane in PLANE_ORDER
        and math.isnan(motion.rapid_acceleration)
        and math.isnan(motion.rapid_deceleration)
        and not (motion.axis_limits or motion.axis_accelerations or motion.axis_decelerations)
        and control.path.passes_on
        and not executor.dialect.rules.acts_on_lines(control)
    )


def kind_of(mode: MotionMode | None) -> int:
    """How the kernel moves in a mode of motion."""
    if mode is None or mode.rule is None:
        return NO_MOTION
    if isinstance(mode.rule, LineRule):
        return RAPID_LINE if mode.rapid else FEED_LINE
    return CLOCKWISE if mode.rule.clockwise else COUNTER_CLOCKWISE


def plain_rules(executor: Executor) -> PlainRules:
    """What the dialect of a control says of plain lines."""
    dialect, motion = executor.dialect, executor.control.motion
    settings = executor.control.settings
    kinds = {number: _kind_of_code(code) for number, code in dialect.codes.g.items()}
    plain = {int(number): kind for number, kind in kinds.items() if kind != NO_MOTION}
    by_number = np.full(max(plain, default=0) + 1, NO_MOTION)
    by_number[list(plain)] = list(plain.values())
    rules = [
        getattr(dialect.codes.g[number].sets.get("interpolation"), "rule", None) for number in plain
    ]
    arc = next((rule for rule in rules if isinstance(rule, ArcRule)), _NO_ARC)
    rotary = sum(1 << (AXIS + axis) for axis, linear in enumerate(motion.linear) if not linear)
    return PlainRules(
        form=line_format(executor),
        kinds=by_number,
        bounds=arc.bounds,
        signed_radius=arc.signed_radius,
        fits_radius=arc.fits_radius,
        linear=np.array(motion.linear),
        rotary=0 if motion.feed_rule is PATH_COUNTS else rotary,
        feed_rule=motion.feed_rule,
        default_feed=settings.default_feed,
        default_rotary_feed=settings.default_rotary_feed,
    )


def _kind_of_code(code: GCode) -> int:
    """How a G code moves that does nothing but that; ``NO_MOTION`` for all others."""
    does = (
        code.action,
        code.perform,
        code.after_motion,
        code.non_modal,
        code.exclusive,
        code.refused,
    )
    if any(does) or code.sets.keys() != {"interpolation", "cycle"} or code.sets.get("cycle"):
        return NO_MOTION
    return kind_of(code.sets.get("interpolation"))


def line_format(executor: Executor) -> LineFormat:
    """How plain lines are written: letters that a dialect uses otherwise as well have no role."""
    dialect, control = executor.dialect, executor.control
    letters = {
        name: AXIS + index
        for name, index in control.axis_index.items()
        if name in dialect.words.axes
    }
    codes: dict[str, int] = {}
    if not dialect.syntax.worded:
        letters |= {"R": RADIUS, **{each: CENTER + index for index, each in enumerate("IJK")}}
        codes = {"N": NUMBER, "G": CODE}
    taken = {
        *dialect.words.actions,
        *dialect.words.references,
        *dialect.words.signed,
        *dialect.words.series,
    }
    roles = {each: role for each, role in letters.items() if each in dialect.words.motion - taken}
    roles |= {**dict.fromkeys(dialect.words.feed, FEED_WORD), **codes}
    return LineFormat(
        np.array([roles.get(letter, OTHER) for letter in string.ascii_uppercase]),
        comment_marks(dialect.syntax.comments).columns,
        dialect.syntax.longest_line,
        string.ascii_uppercase.find(dialect.syntax.line_keyword or " "),
        ord(dialect.syntax.continued or "\0"),
    )


LONG_PROGRAM = 50_000
"""Lines of a program for which it pays to load the compiler, which takes about a second."""
PAYS_LOADED = 500
"""The same where the compiler is loaded already."""
PAYS_COMPILED = 500_000
"""The same to compile the kernel where it was not: Python would take longer."""
_COMPILER = "twin.compilation.kernel"


@functools.cache
def compiled_kernel() -> LineKernel:
    """The compiled form; the first call loads the compiler, the first run compiles or loads the kernel."""
    from twin.compilation.kernel import branching_kernel

    return branching_kernel(run_lines)


def usual_kernel(lines: int) -> LineKernel | None:
    """The compiled form for a program of so many lines, where it pays; it runs nothing where it is not there."""
    if lines < (PAYS_LOADED if _COMPILER in sys.modules else LONG_PROGRAM):
        return None
    if os.environ.get(VARIABLE) == "wait" or lines >= PAYS_COMPILED:
        return compiled_kernel()
    return _WhereCompiled()


class _WhereCompiled:
    """The compiled form, if it was compiled before; else no line is plain."""

    def __init__(self) -> None:
        self._is_there: bool | None = None

    def __call__(
        self, page: PageColumns, rules: PlainRules, state: PlainState, rows: MoveRows
    ) -> int:
        if self._is_there is None:
            from twin.compilation.cache import is_compiled

            self._is_there = is_compiled(compiled_kernel(), (page, rules, state, rows))
        return compiled_kernel()(page, rules, state, rows) if self._is_there else 0
