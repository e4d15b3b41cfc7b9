"""The kernel: one plain line after the other becomes the row of a move.

A line is plain that holds nothing but axis words, G0 to G3 with the words of its centre or radius, F, N and
comments. The run stops before a line that is not, and before one that something is wrong with or that a rule
other than those of ``path.moves``, ``path.feed_rates``, ``geometry.arcs`` and ``geometry.frame`` acts on.
"""

from typing import NamedTuple

import numpy as np

from twin.compilation.compilable import inlined
from twin.nc.canonical import NO_BLOCK_NUMBER, BoolArray, FloatArray, IntArray, Motion
from twin.nc.geometry import arcs
from twin.nc.geometry.arcs import ArcWords, Bounds, Sense
from twin.nc.geometry.frame import arc_about, arc_of_part, to_part
from twin.nc.geometry.matrices import Matrix
from twin.nc.geometry.planes import Directions, point_of, vector_of
from twin.nc.line_kernel.reading import (
    AXIS,
    CENTER,
    CODE,
    FEED_WORD,
    NOT_PLAIN,
    NUMBER,
    RADIUS,
    ByteArray,
    LineFormat,
    read_line,
)
from twin.nc.path import move_columns
from twin.nc.path.feed_rates import (
    KNOWN_FEED,
    WITHOUT_FEED,
    FeedRule,
    arc_displacement,
    feed_by_rule,
    feed_per_minute,
    finding_of_feed,
    needs_own_feed,
    rapid_feed,
)
from twin.nc.path.moves import (
    RAPIDS_END,
    SMALLEST_MOVE,
    arc_length,
    arc_radius,
    axis_target,
    line_length,
    only_turns,
)
from twin.nc.text.expressions.arithmetic import is_whole
from twin.nc.text.line_reader import LARGEST_LABEL
from twin.units import LARGEST_COORDINATE

NO_MOTION, RAPID_LINE, FEED_LINE, CLOCKWISE, COUNTER_CLOCKWISE = -1, 0, 1, 2, 3
"""How a line moves; other motions are ``NO_MOTION``."""
_RAPID, _FEED, _STOP = int(Motion.RAPID), int(Motion.FEED), int(RAPIDS_END)
_ARC_WORDS = (1 << AXIS) - (1 << RADIUS)
_DOUBTFUL = -1.0
"""Length of a move that is left to Python."""


class PageColumns(NamedTuple):
    """A page of the program.

    Attributes:
        data: Its bytes, UTF-8.
        starts: Where each line of it begins, shape (lines,).
        ends: Where each ends, shape (lines,).
        first_line: Its first line, from 0.
    """

    data: ByteArray
    starts: IntArray
    ends: IntArray
    first_line: int


class PlainRules(NamedTuple):
    """What G codes mean in plain lines of a dialect.

    Attributes:
        form: How lines are written.
        kinds: How each G code moves, shape (codes,).
        bounds: How badly the centre of an arc may fit, as ``arcs.Bounds`` has it.
        signed_radius: A negative radius asks for the larger arc, else it is not plain.
        fits_radius: A centre found by its radius is fitted like a given one.
        linear: Which axes are linear, shape (k,).
        rotary: Roles of the words of the others where F counts them, so that they are not plain, as bits.
        feed_rule: Which part of a move F counts.
        default_feed: Where none is programmed [mm/min].
        default_rotary_feed: Where none is programmed and only rotary axes move [deg/min].
    """

    form: LineFormat
    kinds: IntArray
    bounds: Bounds
    signed_radius: bool
    fits_radius: bool
    linear: BoolArray
    rotary: int
    feed_rule: FeedRule
    default_feed: float
    default_rotary_feed: float


class PlainState(NamedTuple):
    """What is in force when a run begins; nothing of it changes in one but what is written to.

    Attributes:
        line: First line, from 0, and the one behind the last that holds a block; written to, shape (2,).
        kind: How lines without a G code move; written to, shape (1,).
        feed: F, NaN for none; written to, shape (1,).
        position: Programmed and part position; written to, shape (2, k) [mm or deg].
        values: Room for the words of a line, shape (roles,).
        increments: What numbers without a decimal point count, as ``reading.read_line`` has it, shape (26,).
        total: Sum of all shifts, shape (k,) [mm or deg].
        matrix: Mirror, rotation and scale.
        turned: That is not the identity.
        plane: Abscissa, ordinate and normal.
        plane_axes: Their columns.
        incremental: Axis words count from where the tool is.
        center_absolute: The words of a centre count from part zero.
        feed_mode: What F counts, as ``FeedMode`` numbers it.
        feed_may_lack: It was warned of a missing feed already.
        spindle: S, NaN for none [1/min].
        spindle_turns: 0 where the spindle is stopped.
        rapid_feed: As ``feed_rates.rapid_feed`` has it.
        limits: Corner tolerance [mm], acceleration and deceleration [mm/s²].
    """

    line: IntArray
    kind: IntArray
    feed: FloatArray
    position: FloatArray
    values: FloatArray
    increments: FloatArray
    total: FloatArray
    matrix: Matrix
    turned: bool
    plane: Directions
    plane_axes: tuple[int, int, int]
    unit: float
    incremental: bool
    center_absolute: bool
    feed_mode: int
    feed_may_lack: bool
    spindle: float
    spindle_turns: float
    rapid_feed: float
    corner: int
    limits: tuple[float, float, float]


class MoveRows(NamedTuple):
    """Room for moves, as ``MoveColumns`` keeps them: shapes (n, 5), (n, 11) and (n, 3, k)."""

    codes: IntArray
    values: FloatArray
    positions: FloatArray

    def first(self, count: int) -> "MoveRows":
        """The first rows."""
        return MoveRows(self.codes[:count], self.values[:count], self.positions[:count])


def run_lines(page: PageColumns, rules: PlainRules, state: PlainState, rows: MoveRows) -> int:
    """Run plain lines of a page, as long as there is room for their moves; how many moves there are."""
    made, line = 0, int(state.line[0])
    for at in range(line - page.first_line, len(page.starts)):
        begin, end = int(page.starts[at]), int(page.ends[at])
        if made == len(rows.codes) or end - begin > rules.form.longest:
            break
        seen = read_line(page.data, begin, end, rules.form, state.increments, state.values)
        if seen == NOT_PLAIN:
            break
        moved = _run_line(line + 1, seen, rules, state, rows, made)
        if moved < 0:
            break
        made += moved
        line += 1
        if seen:
            state.line[1] = line
    state.line[0] = line
    return made


@inlined
def _run_line(
    line: int, seen: int, rules: PlainRules, state: PlainState, rows: MoveRows, row: int
) -> int:
    """Run one line; how many moves it has made, or ``NOT_PLAIN`` with the state as it was."""
    kind, feed, values = int(state.kind[0]), float(state.feed[0]), state.values
    if seen & 1 << CODE:
        if not is_whole(values[CODE], len(rules.kinds) - 1.0):
            return NOT_PLAIN
        kind = int(rules.kinds[int(values[CODE])])
    if seen & 1 << FEED_WORD:
        feed = float(values[FEED_WORD])
    moves = seen >> RADIUS != 0
    fits = not seen & 1 << NUMBER or is_whole(values[NUMBER], LARGEST_LABEL)
    fed = not seen & 1 << FEED_WORD or 0.0 < feed <= LARGEST_COORDINATE
    is_arc = kind >= CLOCKWISE
    if not fits or not fed or (not moves and seen & 1 << CODE):
        return NOT_PLAIN
    made = 0
    if moves:
        if kind == NO_MOTION or (not is_arc and seen & _ARC_WORDS):
            return NOT_PLAIN
        if kind != RAPID_LINE and (seen & rules.rotary or not _has_feed(seen, feed, state)):
            return NOT_PLAIN
        length = _place(seen, kind, rules, state, rows, row)
        if length < 0.0:
            return NOT_PLAIN
        position = rows.positions[row]
        if length >= SMALLEST_MOVE:
            _finish_row(line, seen, kind, feed, length, rules, state, rows, row)
            made = 1
        for axis in range(len(state.total)):
            state.position[0, axis] = position[2, axis]
            if made:
                state.position[1, axis] = position[1, axis]
    state.kind[0], state.feed[0] = kind, feed
    return made


@inlined
def _has_feed(seen: int, feed: float, state: PlainState) -> bool:
    """Whether nothing is wrong with the feed rate of a line that moves with a feed."""
    if needs_own_feed(state.feed_mode) and not seen & 1 << FEED_WORD:
        return False
    finding = finding_of_feed(feed, state.feed_mode, state.spindle, state.spindle_turns)
    return finding == KNOWN_FEED or (finding == WITHOUT_FEED and state.feed_may_lack)


@inlined
def _place(
    seen: int, kind: int, rules: PlainRules, state: PlainState, rows: MoveRows, row: int
) -> float:
    """Write where a move goes, and of an arc how; its length [mm or deg] or ``_DOUBTFUL``."""
    position, axes = rows.positions[row], len(state.total)
    for axis in range(axes):
        here = state.position[0, axis]
        goal = here
        if seen >> (AXIS + axis) & 1:
            value, linear = state.values[AXIS + axis], rules.linear[axis]
            goal = axis_target(value, state.unit, linear, state.incremental, here)
        if not abs(goal) <= LARGEST_COORDINATE:
            return _DOUBTFUL
        position[0, axis] = state.position[1, axis]
        position[1, axis] = goal + state.total[axis]
        position[2, axis] = goal
    if state.turned:
        place = to_part(state.matrix, state.total, vector_of(position[2]))
        position[1, 0], position[1, 1], position[1, 2] = place
    if kind < CLOCKWISE:
        return line_length(position[0], position[1])
    return _bend(seen, kind == CLOCKWISE, rules, state, rows, row)


@inlined
def _bend(
    seen: int, clockwise: bool, rules: PlainRules, state: PlainState, rows: MoveRows, row: int
) -> float:
    """Write centre, normal and sweep of an arc whose positions stand; as ``_place``."""
    first, second, normal = state.plane_axes
    if seen >> (CENTER + normal) & 1:
        return _DOUBTFUL
    words = ArcWords(
        _length_of(RADIUS, seen, state),
        _length_of(CENTER + first, seen, state),
        _length_of(CENTER + second, seen, state),
    )
    both = words.first == words.first and words.second == words.second
    if state.center_absolute and words.radius != words.radius and not both:
        return _DOUBTFUL
    position, value = rows.positions[row], rows.values[row]
    start = point_of(state.plane, vector_of(state.position[0]))
    end = point_of(state.plane, vector_of(position[2]))
    sense = Sense(clockwise, rules.signed_radius, rules.fits_radius)
    absolute = state.center_absolute
    finding, center = arcs.center_of_words(start, end, words, absolute, sense, rules.bounds)
    if finding != arcs.FITS:
        return _DOUBTFUL
    sweep = arcs.sweep_between(start, end, center, clockwise)
    programmed = arc_about(state.plane, state.position[0], center, sweep)
    arc = arc_of_part(programmed, state.matrix, state.total, state.turned)
    value[0], value[1], value[2] = arc.center
    value[3], value[4], value[5] = arc.normal
    value[6] = arc.sweep
    return arc_length(position[0], position[1], arc.center, arc.normal, arc.sweep)


@inlined
def _length_of(role: int, seen: int, state: PlainState) -> float:
    """Value of a word that counts a length [mm]; NaN where there is none."""
    return state.values[role] * state.unit if seen >> role & 1 else np.nan


@inlined
def _finish_row(
    line: int,
    seen: int,
    kind: int,
    feed: float,
    length: float,
    rules: PlainRules,
    state: PlainState,
    rows: MoveRows,
    row: int,
) -> None:
    """Write what is no position of a move."""
    value, code, position = rows.values[row], rows.codes[row], rows.positions[row]
    if kind < CLOCKWISE:
        value[:6] = np.nan
        value[6] = 0.0
    if kind == RAPID_LINE:
        value[7] = rapid_feed(state.rapid_feed, feed)
    else:
        turning = kind == FEED_LINE and only_turns(position[0], position[1], rules.linear)
        otherwise = (rules.default_feed, rules.default_rotary_feed)
        value[7] = feed_per_minute(
            feed, state.feed_mode, length, turning, state.unit, state.spindle, otherwise
        )
        if kind >= CLOCKWISE:
            center = (value[0], value[1], value[2])
            move = arc_displacement(length, 0.0, arc_radius(position[0], center), value[6])
            value[7] = feed_by_rule(rules.feed_rule, value[7], move, state.feed_mode, state.unit)
    value[8], value[9], value[10] = state.limits
    code[0] = _RAPID if kind == RAPID_LINE else _FEED
    code[1] = move_columns.LINE if kind < CLOCKWISE else move_columns.ARC
    code[2], code[3] = line, NO_BLOCK_NUMBER
    if seen & 1 << NUMBER:
        code[3] = int(state.values[NUMBER])
    code[4] = _STOP if kind == RAPID_LINE else state.corner
