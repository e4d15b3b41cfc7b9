"""One plain block: its words, modal codes, and the row of its move, compiled.

Each step is the control's own (``control``, ``control_motion``) for a block in which nothing is
doubtful, and computes the same bits. A block in which something is, be it wrong or only rare, is
left untouched; the control runs it and makes its diagnostics.
"""

import numpy as np

from twin.compilation.kernel import inlined_kernel
from twin.nc.bytecode.registers import (
    ARC,
    CODES,
    CORNER,
    CYCLE,
    EARLY,
    FEED_FACTOR,
    INTERPOLATION,
    NO_MOTION,
    PLANE,
    POLAR_ANGLE,
    POLAR_RADIUS,
    PROGRAMMED_FEED,
    RAPID_LINE,
    UNIT,
    BlockTables,
    Constants,
    Rows,
    State,
)
from twin.nc.canonical import NO_BLOCK_NUMBER, Corner, FloatArray, IntArray, Motion, Shape
from twin.nc.compiled.kernels.arc import write_arc
from twin.nc.compiled.kernels.columns import copy
from twin.nc.compiled.kernels.cycle import drill
from twin.nc.compiled.kernels.effects import report
from twin.nc.compiled.kernels.frame import turn_place
from twin.nc.compiled.kernels.plane import straight_way
from twin.nc.compiled.kernels.target import aim, goal_of
from twin.nc.compiled.kernels.tokenizer import (
    AXIS,
    CODE,
    FEED,
    FUNCTION,
    NOT_PLAIN,
    NUMBER,
    RADIUS,
)
from twin.nc.control.motion import LARGEST_COORDINATE
from twin.nc.path.event_columns import FUNCTION_ALONE
from twin.nc.text.line_reader import LARGEST_LABEL

_RAPID, _FEED = int(Motion.RAPID), int(Motion.FEED)
_LINE, _ARC = int(Shape.LINE), int(Shape.ARC)
_STOP = int(Corner.EXACT_STOP)


@inlined_kernel
def run_words(
    line: int,
    roles: IntArray,
    values: FloatArray,
    tables: BlockTables,
    constants: Constants,
    state: State,
    modal: FloatArray,
    rows: Rows,
    row: int,
    polar: bool,
) -> int:
    """Run one block of words.

    Args:
        line: Its line, from 1.
        roles: What each word's letter is, shape (w,).
        values: The words' values, shape (w,).
        tables: What blocks mean.
        constants: What stays.
        state: What changes.
        modal: Room for the modal state, shape (``MODAL``,).
        rows: Room for the move.
        row: Its row.
        polar: The label of ``state`` holds where the move goes in the plane.

    Returns:
        The number of rows after it, or ``NOT_PLAIN`` or ``NO_ROOM`` with the state untouched.
    """
    copy(state.modal, modal)
    number, seen, groups = int(np.int64(NO_BLOCK_NUMBER)), int(np.int64(0)), 0
    function, begins = NOT_PLAIN, 0
    feed = state.registers[PROGRAMMED_FEED]
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
            cycle = tables.cycle[code]
            if cycle == 0:
                modal[CYCLE] = 0.0
            elif cycle > 0:
                begins = cycle
        else:
            if seen & (1 << role) or not abs(value) <= LARGEST_COORDINATE:
                return NOT_PLAIN
            seen |= 1 << role
            if role == FEED:
                if not value > 0.0:
                    return NOT_PLAIN
                feed = value
            elif role == FUNCTION:
                if not 0.0 <= value < CODES or value != np.floor(value):
                    return NOT_PLAIN
                function = int(value)
                if tables.function[function] == NOT_PLAIN:
                    return NOT_PLAIN
    after, happened = row, state.happened[0]
    anew = modal[CYCLE] == 0.0
    if begins:
        modal[CYCLE] = begins
    drills = modal[CYCLE] != 0.0
    moves = begins != 0 or polar or seen >> RADIUS != 0
    plane = constants.planes[int(modal[PLANE])]
    in_plane = seen & ((1 << (AXIS + plane[0])) | (1 << (AXIS + plane[1]))) != 0
    if polar and in_plane:
        return NOT_PLAIN
    early = function != NOT_PLAIN and tables.function[function] == EARLY
    if early:
        report(rows, state, row, line, FUNCTION_ALONE, function, np.nan)
    if drills and moves:
        after = drill(
            line,
            number,
            roles,
            values,
            seen,
            begins != 0,
            anew,
            tables,
            constants,
            state,
            modal,
            feed,
            rows,
            row,
            polar,
        )
    elif moves:
        after = _move(
            line,
            number,
            roles,
            values,
            seen,
            tables,
            constants,
            state,
            modal,
            feed,
            rows,
            row,
            polar,
        )
    if after < 0:
        state.happened[0] = happened
        return after
    if function != NOT_PLAIN and not early:
        report(rows, state, after, line, FUNCTION_ALONE, function, np.nan)
    for word in range(len(roles)):
        if roles[word] == CODE:
            code = int(values[word])
            state.in_force[tables.group[code]] = code
    copy(modal, state.modal)
    state.registers[PROGRAMMED_FEED] = feed
    if moves:
        if drills:
            copy(state.label, state.part)
            copy(constants.over, state.programmed)
        else:
            copy(rows.positions[row, 1], state.part)
            copy(rows.positions[row, 2], state.programmed)
        if in_plane:
            state.registers[POLAR_RADIUS] = state.registers[POLAR_ANGLE] = np.nan
    return after


@inlined_kernel
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
    polar: bool,
) -> int:
    """Write the block's move; the number of rows after it, or ``NOT_PLAIN``."""
    kind = tables.kind[int(modal[INTERPOLATION])]
    if kind == NO_MOTION:
        return NOT_PLAIN
    is_arc = kind == ARC
    if polar and is_arc:
        return NOT_PLAIN
    if not is_arc and (seen >> RADIUS) & ((1 << (AXIS - RADIUS)) - 1):
        return NOT_PLAIN
    axes = len(state.part)
    position = rows.positions[row]
    if polar:
        aim(constants.planes[int(modal[PLANE])], roles, values, seen, state, modal)
    for axis in range(axes):
        target = goal_of(axis, roles, values, seen, tables, state, modal, polar)
        if not abs(target) <= LARGEST_COORDINATE:
            return NOT_PLAIN
        position[0, axis] = state.part[axis]
        position[1, axis] = target + state.total[axis]
        position[2, axis] = target
    turn_place(position[2], state, position[1])
    if is_arc:
        if not write_arc(roles, values, seen, tables, constants, state, modal, rows, row):
            return NOT_PLAIN
    else:
        way = straight_way(position)
        if way <= 0.0:
            return row if way == 0.0 else NOT_PLAIN
        rows.values[row, :6] = np.nan
        rows.values[row, 6] = 0.0
    pace = constants.rapid_feed
    own = constants.own_rapid_feed
    if kind == RAPID_LINE and not np.isnan(own):
        pace = (own if own != 0.0 else feed) * 60.0
    elif kind != RAPID_LINE:
        turning = not is_arc
        for axis in range(axes):
            moves = position[0, axis] != position[1, axis]
            turning = turning and not (moves and tables.linear[axis])
        if np.isnan(feed):
            if not constants.feed_may_lack:
                return NOT_PLAIN
            pace = constants.default_rotary_feed if turning else constants.default_feed
        else:
            pace = (feed if turning else feed * modal[UNIT]) * modal[FEED_FACTOR]
    rows.values[row, 7] = pace
    copy(constants.last_values, rows.values[row, 8:])
    rows.codes[row, 0] = _RAPID if kind == RAPID_LINE else _FEED
    rows.codes[row, 1] = _ARC if is_arc else _LINE
    rows.codes[row, 2] = line
    rows.codes[row, 3] = number
    rows.codes[row, 4] = _STOP if kind == RAPID_LINE else int(modal[CORNER])
    return row + 1
