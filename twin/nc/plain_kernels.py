"""Runs of plain blocks: words, modal codes, geometry and rows of moves in one compiled loop.

Each step is the control's own (``control``, ``control_motion``, ``circular``) for a block in which
nothing is doubtful, and computes the same bits. The first block in which something is, be it wrong
or only rare, ends the run untouched; the control runs it and makes its diagnostics.
"""

from typing import NamedTuple

import numba
import numpy as np
import numpy.typing as npt
from numba.extending import register_jitable

from twin.nc import arcs
from twin.nc.canonical import NO_BLOCK_NUMBER, Corner, FloatArray, IntArray, Motion, Shape
from twin.nc.plain_words_kernels import (
    AXIS,
    CENTER,
    CODE,
    FEED,
    MOST_WORDS,
    NOT_PLAIN,
    NUMBER,
    RADIUS,
    ByteArray,
    LineTables,
    line_end,
    read_words,
)

for _shared in (
    arcs.distance,
    arcs.sweep_between,
    arcs.reaches,
    arcs.center_at_radius,
    arcs.equidistant,
):
    register_jitable(_shared)

INTERPOLATION, INCREMENTAL, CENTER_ABSOLUTE, UNIT, CORNER, FEED_FACTOR, NOTHING = range(7)
"""Places in the modal state; ``NOTHING`` takes what codes without effect set."""

NO_MOTION, RAPID_LINE, FEED_LINE, ARC = range(4)
"""Kinds of interpolation."""

CODES = 1000
"""G codes are below this number."""
LARGEST_LABEL = 4_294_967_295
LONGEST_LINE = 65_536
LARGEST_COORDINATE = 1e7
"""As the control's own limits; what exceeds them is the control's to refuse."""
SHORTEST = 1e-7
"""A move that goes less far [mm or deg], but does go, is left to the control to measure."""


class BlockTables(NamedTuple):
    """What plain blocks mean in a dialect, on a machine.

    Attributes:
        field: Which place of the modal state each G code sets, shape (``CODES``,); ``NOT_PLAIN``
            for codes that do more.
        value: To what it sets it, shape (``CODES``,).
        group: Its modal group, shape (``CODES``,).
        kind: Kind of each interpolation, shape (i,).
        clockwise: Of arcs, shape (i,).
        mismatch: How far start and end radius of an arc may differ, shape (i,) [mm].
        mismatch_share: The same as a share of the larger one, shape (i,).
        shift: How far its centre may be moved to fit, shape (i,) [mm].
        signed_radius: A negative radius asks for the larger arc, shape (i,).
        fits_radius: A centre found by its radius is fitted like a given one, shape (i,).
        linear: Which axes are linear, shape (k,).
    """

    field: IntArray
    value: FloatArray
    group: IntArray
    kind: IntArray
    clockwise: npt.NDArray[np.bool_]
    mismatch: FloatArray
    mismatch_share: FloatArray
    shift: FloatArray
    signed_radius: npt.NDArray[np.bool_]
    fits_radius: npt.NDArray[np.bool_]
    linear: npt.NDArray[np.bool_]


class Constants(NamedTuple):
    """What stays as it is during a run.

    Attributes:
        total: From programmed to part coordinates, shape (k,) [mm or deg].
        plane: Columns of abscissa, ordinate and normal, shape (3,).
        default_feed: Where none is programmed [mm/min].
        default_rotary_feed: The same for rotary axes alone [deg/min].
        feed_may_lack: A feed move without a programmed feed was warned of already.
        rapid_feed: [mm/min]; NaN: the machine's.
        last_values: Corner tolerance, acceleration and deceleration of every move, shape (3,).
    """

    total: FloatArray
    plane: IntArray
    default_feed: float
    default_rotary_feed: float
    feed_may_lack: bool
    rapid_feed: float
    last_values: FloatArray


_RAPID, _FEED = int(Motion.RAPID), int(Motion.FEED)
_LINE, _ARC = int(Shape.LINE), int(Shape.ARC)
_STOP = int(Corner.EXACT_STOP)


class State(NamedTuple):
    """What changes during a run; the arrays are written to.

    Attributes:
        modal: The modal state, shape (7,).
        in_force: G code set in each group during the run, ``NOT_PLAIN`` for none, shape (g,).
        feed: F as programmed, NaN for none, shape (1,).
        programmed: Programmed position, shape (k,) [mm or deg].
        part: Part position, shape (k,) [mm or deg].
    """

    modal: FloatArray
    in_force: IntArray
    feed: FloatArray
    programmed: FloatArray
    part: FloatArray


class Rows(NamedTuple):
    """Room for the moves of a run, as ``MoveColumns`` keeps them.

    Attributes:
        codes: Shape (n, 5).
        values: Shape (n, 11).
        positions: Start, end and display, shape (n, 3, k).
    """

    codes: IntArray
    values: FloatArray
    positions: FloatArray


@numba.njit(cache=True)
def run_blocks(
    data: ByteArray,
    starts: IntArray,
    first: int,
    last: int,
    line_tables: LineTables,
    tables: BlockTables,
    constants: Constants,
    state: State,
    rows: Rows,
) -> tuple[int, int, int, int]:
    """Run plain blocks until one is not plain, a line is reached, or the rows are full.

    Args:
        data: The program as UTF-8.
        starts: Where each line begins, and where the last one ends, shape (lines + 1,).
        first: Line to begin with, from 0.
        last: Line to end before.
        line_tables: How lines are read.
        tables: What blocks mean.
        constants: What stays.
        state: What changes.
        rows: Room for the moves.

    Returns:
        The line reached, moves made, blocks run, and the last line that was not blank or
        ``NOT_PLAIN``.
    """
    roles = np.zeros(MOST_WORDS, np.int64)
    values = np.zeros(MOST_WORDS)
    modal = state.modal.copy()
    line, made, blocks, inked = first, 0, 0, NOT_PLAIN
    while line < last and made < len(rows.codes):
        begin = starts[line]
        end = line_end(data, begin, starts[line + 1])
        if end - begin > LONGEST_LINE:
            break
        count = read_words(data, begin, end, line_tables, roles, values)
        if count == NOT_PLAIN:
            break
        if count > 0:
            row = _run_block(
                line + 1, roles[:count], values[:count], tables, constants, state, modal, rows, made
            )
            if row == NOT_PLAIN:
                break
            made = row
            blocks += 1
        if _is_inked(data, begin, end):
            inked = line
        line += 1
    return line, made, blocks, inked


@numba.njit(cache=True)
def _is_inked(data: ByteArray, begin: int, end: int) -> bool:
    for at in range(begin, end):
        if data[at] != 32 and data[at] != 9:
            return True
    return False


@numba.njit(cache=True)
def _run_block(
    line: int,
    roles: IntArray,
    values: FloatArray,
    tables: BlockTables,
    constants: Constants,
    state: State,
    modal: FloatArray,
    rows: Rows,
    row: int,
) -> int:
    """Run one block; the number of rows after it, or ``NOT_PLAIN`` with the state untouched."""
    modal[:] = state.modal
    number, feed, seen, groups = NO_BLOCK_NUMBER, state.feed[0], 0, 0
    for word in range(len(roles)):
        role, value = roles[word], values[word]
        if role == NUMBER:
            if word > 0 or not 0.0 <= value <= LARGEST_LABEL or value != np.floor(value):
                return NOT_PLAIN
            number = int(value)
        elif role == CODE:
            if not 0.0 <= value < CODES or value != np.floor(value):
                return NOT_PLAIN
            code = int(value)
            group = 1 << tables.group[code]
            if tables.field[code] == NOT_PLAIN or groups & group:
                return NOT_PLAIN
            groups |= group
            modal[tables.field[code]] = tables.value[code]
        else:
            if seen & (1 << role) or not abs(value) <= LARGEST_COORDINATE:
                return NOT_PLAIN
            seen |= 1 << role
            if role == FEED:
                if not value > 0.0:
                    return NOT_PLAIN
                feed = value
    after = row
    if seen >> RADIUS:
        after = _move(
            line, number, roles, values, seen, tables, constants, state, modal, feed, rows, row
        )
        if after == NOT_PLAIN:
            return NOT_PLAIN
    for word in range(len(roles)):
        if roles[word] == CODE:
            code = int(values[word])
            state.in_force[tables.group[code]] = code
    state.modal[:] = modal
    state.feed[0] = feed
    if seen >> RADIUS:
        state.part[:] = rows.positions[row, 1]
        state.programmed[:] = rows.positions[row, 2]
    return after


@numba.njit(cache=True)
def _value(role: int, roles: IntArray, values: FloatArray) -> float:
    for word in range(len(roles)):
        if roles[word] == role:
            return values[word]
    return 0.0


@numba.njit(cache=True)
def _move(
    line: int,
    number: int,
    roles: IntArray,
    values: FloatArray,
    seen: int,
    tables: BlockTables,
    constants: Constants,
    state: State,
    modal: FloatArray,
    feed: float,
    rows: Rows,
    row: int,
) -> int:
    """Write the block's move; the number of rows after it, or ``NOT_PLAIN``."""
    interpolation = int(modal[INTERPOLATION])
    kind = tables.kind[interpolation]
    if kind == NO_MOTION:
        return NOT_PLAIN
    is_arc = kind == ARC
    if not is_arc and (seen >> RADIUS) & ((1 << (AXIS - RADIUS)) - 1):
        return NOT_PLAIN
    axes = len(state.part)
    position = rows.positions[row]
    turning, spatial, other = not is_arc, 0.0, 0.0
    for axis in range(axes):
        target = state.programmed[axis]
        if seen & (1 << (AXIS + axis)):
            value = _value(AXIS + axis, roles, values)
            value *= modal[UNIT] if tables.linear[axis] else 1.0
            target = value + target if modal[INCREMENTAL] != 0.0 else value
            if not abs(target) <= LARGEST_COORDINATE:
                return NOT_PLAIN
        end = target + constants.total[axis]
        position[0, axis] = state.part[axis]
        position[1, axis] = end
        position[2, axis] = target
        if end != state.part[axis]:
            turning = turning and not tables.linear[axis]
            way = abs(end - state.part[axis])
            if axis < 3:
                spatial = max(spatial, way)
            else:
                other = max(other, way)
    if is_arc:
        if not _arc(interpolation, roles, values, seen, tables, constants, state, modal, rows, row):
            return NOT_PLAIN
    else:
        way = spatial if spatial > 0.0 else other
        if way == 0.0:
            return row
        if way < SHORTEST:
            return NOT_PLAIN
        rows.values[row, :6] = np.nan
        rows.values[row, 6] = 0.0
    pace = constants.rapid_feed
    if kind != RAPID_LINE:
        if np.isnan(feed):
            if not constants.feed_may_lack:
                return NOT_PLAIN
            pace = constants.default_rotary_feed if turning else constants.default_feed
        else:
            pace = (feed if turning else feed * modal[UNIT]) * modal[FEED_FACTOR]
    rows.values[row, 7] = pace
    rows.values[row, 8:] = constants.last_values
    rows.codes[row, 0] = _RAPID if kind == RAPID_LINE else _FEED
    rows.codes[row, 1] = _ARC if is_arc else _LINE
    rows.codes[row, 2] = line
    rows.codes[row, 3] = number
    rows.codes[row, 4] = _STOP if kind == RAPID_LINE else int(modal[CORNER])
    return row + 1


@numba.njit(cache=True)
def _arc(
    interpolation: int,
    roles: IntArray,
    values: FloatArray,
    seen: int,
    tables: BlockTables,
    constants: Constants,
    state: State,
    modal: FloatArray,
    rows: Rows,
    row: int,
) -> bool:
    """Write the arc's centre, normal and sweep; whether nothing about it is doubtful."""
    first_axis, second_axis, across = constants.plane
    display = rows.positions[row, 2]
    start = (state.programmed[first_axis], state.programmed[second_axis])
    end = (display[first_axis], display[second_axis])
    clockwise = tables.clockwise[interpolation]
    has_first = seen & (1 << (CENTER + first_axis)) != 0
    has_second = seen & (1 << (CENTER + second_axis)) != 0
    if seen & (1 << (CENTER + across)):
        return False
    if seen & (1 << RADIUS):
        in_plane = (1 << (AXIS + first_axis)) | (1 << (AXIS + second_axis))
        if has_first or has_second or not seen & in_plane:
            return False
        radius = _value(RADIUS, roles, values) * modal[UNIT]
        larger = radius < 0.0 and tables.signed_radius[interpolation]
        if radius == 0.0 or not arcs.reaches(start, end, abs(radius)):
            return False
        fits = tables.fits_radius[interpolation]
        center = arcs.center_at_radius(start, end, abs(radius), clockwise, larger)
    else:
        fits = True
        if not (has_first or has_second):
            return False
        first = _value(CENTER + first_axis, roles, values) * modal[UNIT]
        second = _value(CENTER + second_axis, roles, values) * modal[UNIT]
        if modal[CENTER_ABSOLUTE] != 0.0:
            if not (has_first and has_second):
                return False
            center = (first, second)
        else:
            center = (start[0] + first, start[1] + second)
    if fits:
        given = center
        near, far = arcs.distance(start, given), arcs.distance(end, given)
        gap, longer = abs(near - far), max(near, far)
        if not (
            min(near, far) >= arcs.SAME_POINT
            and gap <= tables.mismatch[interpolation]
            and gap <= tables.mismatch_share[interpolation] * longer
        ):
            return False
        center = arcs.equidistant(start, end, given)
        if not arcs.distance(given, center) <= tables.shift[interpolation]:
            return False
    sweep = arcs.sweep_between(start, end, center, clockwise)
    if not arcs.distance(start, center) * abs(sweep) > SHORTEST * arcs.TURN:
        return False
    value = rows.values[row]
    value[first_axis] = center[0] + constants.total[first_axis]
    value[second_axis] = center[1] + constants.total[second_axis]
    value[across] = state.programmed[across] + constants.total[across]
    value[3:6] = 0.0
    value[3 + across] = 1.0
    value[6] = sweep
    return True
