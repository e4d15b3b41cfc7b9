"""One plain block: its words, modal codes, and the row of its move, compiled.

Each step is the control's own (``control``, ``control_motion``) for a block in which nothing is
doubtful, and computes the same bits. A block in which something is, be it wrong or only rare, is
left untouched; the control runs it and makes its diagnostics.
"""

import numpy as np

from twin.compilation.compilable import inlined
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
    State,
)
from twin.nc.canonical import NO_BLOCK_NUMBER, Corner, FloatArray, IntArray, Motion, Shape
from twin.nc.compiled.kernels.arc import emit_arc
from twin.nc.compiled.kernels.cycle import drill
from twin.nc.compiled.kernels.effects import report
from twin.nc.compiled.kernels.frame import turn_place
from twin.nc.compiled.kernels.target import PlainBlock, aim, axis_target
from twin.nc.compiled.kernels.tokenizer import (
    AXIS,
    CODE,
    FEED,
    FUNCTION,
    NUMBER,
    RADIUS,
    UNSUPPORTED,
)
from twin.nc.control.control import LARGEST_COORDINATE
from twin.nc.path.event_columns import FUNCTION_ALONE
from twin.nc.path.moves import feed_per_minute, line_length, only_turns
from twin.nc.path.rows import Rows, copy
from twin.nc.text.line_reader import LARGEST_LABEL

_RAPID, _FEED = int(Motion.RAPID), int(Motion.FEED)
_LINE, _ARC = int(Shape.LINE), int(Shape.ARC)
_STOP = int(Corner.EXACT_STOP)


@inlined
def execute_block(
    line: int,
    token_kinds: IntArray,
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
        token_kinds: What each word's letter is, shape (w,).
        values: The words' values, shape (w,).
        tables: What blocks mean.
        constants: What stays.
        state: What changes.
        modal: Room for the modal state, shape (``MODAL``,).
        rows: Room for the move.
        row: Its row.
        polar: The target of ``state`` holds where the move goes in the plane.

    Returns:
        The number of rows after it, or ``UNSUPPORTED`` or ``NO_ROOM`` with the state untouched.
    """
    copy(state.modal, modal)
    number, seen, groups = int(np.int64(NO_BLOCK_NUMBER)), int(np.int64(0)), 0
    function, begins = UNSUPPORTED, 0
    feed = state.registers[PROGRAMMED_FEED]
    for word in range(len(token_kinds)):
        token_kind, value = token_kinds[word], values[word]
        if token_kind == NUMBER:
            if word > 0 or not 0.0 <= value <= LARGEST_LABEL or value != np.floor(value):
                return UNSUPPORTED
            number = int(value)
        elif token_kind == CODE:
            if not 0.0 <= value < CODES or value != np.floor(value):
                return UNSUPPORTED
            code = int(value)
            group = 1 << tables.group[code]
            if tables.field[code] == UNSUPPORTED or groups & group:
                return UNSUPPORTED
            groups |= group
            modal[tables.field[code]] = tables.value[code]
            cycle = tables.cycle[code]
            if cycle == 0:
                modal[CYCLE] = 0.0
            elif cycle > 0:
                begins = cycle
        else:
            if seen & (1 << token_kind) or not abs(value) <= LARGEST_COORDINATE:
                return UNSUPPORTED
            seen |= 1 << token_kind
            if token_kind == FEED:
                if not value > 0.0:
                    return UNSUPPORTED
                feed = value
            elif token_kind == FUNCTION:
                if not 0.0 <= value < CODES or value != np.floor(value):
                    return UNSUPPORTED
                function = int(value)
                if tables.function[function] == UNSUPPORTED:
                    return UNSUPPORTED
    after, event_count = row, state.event_count[0]
    anew = modal[CYCLE] == 0.0
    if begins:
        modal[CYCLE] = begins
    drills = modal[CYCLE] != 0.0
    moves = begins != 0 or polar or seen >> RADIUS != 0
    plane = constants.planes[int(modal[PLANE])]
    in_plane = seen & ((1 << (AXIS + plane[0])) | (1 << (AXIS + plane[1]))) != 0
    if polar and in_plane:
        return UNSUPPORTED
    early = function != UNSUPPORTED and tables.function[function] == EARLY
    if early:
        report(rows, state, row, line, FUNCTION_ALONE, function, np.nan)
    block = PlainBlock(line, number, token_kinds, values, seen, feed, modal, polar)
    if drills and moves:
        after = drill(block, (begins != 0, anew), tables, constants, state, rows, row)
    elif moves:
        after = _move(block, tables, constants, state, rows, row)
    if after < 0:
        state.event_count[0] = event_count
        return after
    if function != UNSUPPORTED and not early:
        report(rows, state, after, line, FUNCTION_ALONE, function, np.nan)
    for word in range(len(token_kinds)):
        if token_kinds[word] == CODE:
            code = int(values[word])
            state.active_codes[tables.group[code]] = code
    copy(modal, state.modal)
    state.registers[PROGRAMMED_FEED] = feed
    if moves:
        if drills:
            copy(state.target, state.part)
            copy(constants.over, state.programmed)
        else:
            copy(rows.positions[row, 1], state.part)
            copy(rows.positions[row, 2], state.programmed)
        if in_plane:
            state.registers[POLAR_RADIUS] = state.registers[POLAR_ANGLE] = np.nan
    return after


@inlined
def _move(
    block: PlainBlock,
    tables: BlockTables,
    constants: Constants,
    state: State,
    rows: Rows,
    row: int,
) -> int:
    """Write the block's move; the number of rows after it, or ``UNSUPPORTED``."""
    modal, seen, feed = block.modal, block.seen, block.feed
    kind = tables.kind[int(modal[INTERPOLATION])]
    if kind == NO_MOTION:
        return UNSUPPORTED
    is_arc = kind == ARC
    if block.polar and is_arc:
        return UNSUPPORTED
    if not is_arc and (seen >> RADIUS) & ((1 << (AXIS - RADIUS)) - 1):
        return UNSUPPORTED
    axes = len(state.part)
    position = rows.positions[row]
    if block.polar:
        aim(constants.planes[int(modal[PLANE])], block, seen, state)
    for axis in range(axes):
        target = axis_target(axis, block, seen, tables, state)
        if not abs(target) <= LARGEST_COORDINATE:
            return UNSUPPORTED
        position[0, axis] = state.part[axis]
        position[1, axis] = target + state.total[axis]
        position[2, axis] = target
    turn_place(position[2], state, position[1])
    if is_arc:
        if not emit_arc(block, tables, constants, state, rows, row):
            return UNSUPPORTED
    else:
        if line_length(position[0], position[1]) == 0.0:
            return row
        rows.values[row, :6] = np.nan
        rows.values[row, 6] = 0.0
    pace = constants.rapid_feed
    own = constants.own_rapid_feed
    if kind == RAPID_LINE and not np.isnan(own):
        pace = (own if own != 0.0 else feed) * 60.0
    elif kind != RAPID_LINE:
        if np.isnan(feed) and not constants.feed_may_lack:
            return UNSUPPORTED
        turning = not is_arc and only_turns(position[0], position[1], tables.linear)
        otherwise = (constants.default_feed, constants.default_rotary_feed)
        pace = feed_per_minute(feed, turning, modal[UNIT], modal[FEED_FACTOR], otherwise)
    rows.values[row, 7] = pace
    copy(constants.last_values, rows.values[row, 8:])
    rows.codes[row, 0] = _RAPID if kind == RAPID_LINE else _FEED
    rows.codes[row, 1] = _ARC if is_arc else _LINE
    rows.codes[row, 2] = block.line
    rows.codes[row, 3] = block.number
    rows.codes[row, 4] = _STOP if kind == RAPID_LINE else int(modal[CORNER])
    return row + 1
