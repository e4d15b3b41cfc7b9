"""One plain block: its words, modal codes, and the row of its move, compiled.

Each step is the control's own (``control.executor``, ``control.control``) for a block in which nothing
is doubtful, and computes the same bits. A block in which something is, be it wrong or only rare, is
left untouched; the control runs it and makes its diagnostics.
"""

import numpy as np

from twin.compilation.compilable import inlined
from twin.nc.bytecode.effects import Affected, BlockPlace, report_function
from twin.nc.bytecode.registers import (
    ACTIVE,
    ARC,
    CODES,
    CYCLE,
    EARLY,
    FEED_LINE,
    INTERPOLATION,
    NO_MOTION,
    OF_PLAIN_BLOCKS,
    PLANE,
    POLAR_ANGLE,
    POLAR_RADIUS,
    PROGRAMMED_FEED,
    RAPID_LINE,
    BlockTables,
    Machine,
    State,
)
from twin.nc.bytecode.token_kinds import (
    AXIS,
    CODE,
    FEED,
    FUNCTION,
    NUMBER,
    RADIUS,
    UNSUPPORTED,
)
from twin.nc.canonical import NO_BLOCK_NUMBER, FloatArray, IntArray
from twin.nc.compiled.kernels.arc import emit_arc
from twin.nc.compiled.kernels.cycle import drill
from twin.nc.compiled.kernels.move_row import has_pace, put_move, put_positions, travel_of
from twin.nc.compiled.kernels.target import PlainBlock, put_target
from twin.nc.path import move_columns
from twin.nc.path.moves import LARGEST_COORDINATE, SMALLEST_MOVE, line_length, only_turns
from twin.nc.path.rows import copy
from twin.nc.text.arithmetic import is_whole
from twin.nc.text.line_reader import LARGEST_LABEL

_MOTION_WORDS = -1 << RADIUS
_ARC_WORDS = (1 << AXIS) - (1 << RADIUS)
"""Token kinds as bits: of words that make a block move, and of those that only arcs have."""


@inlined
def execute_block(
    line: int,
    token_kinds: IntArray,
    values: FloatArray,
    machine: Machine,
    modal: FloatArray,
    row: int,
    polar: bool,
) -> int:
    """Run one block of words.

    Args:
        line: Its line, from 1.
        token_kinds: What each word's letter is, shape (w,).
        values: The words' values, shape (w,).
        machine: What it runs on.
        modal: Room for what is in force in the block, shape (``OF_PLAIN_BLOCKS``,).
        row: The row of its move.
        polar: ``State.target`` holds where the move goes in the plane.

    Returns:
        The number of rows after it, or ``UNSUPPORTED`` or ``NO_ROOM`` with the state untouched.
    """
    state, tables, rows = machine.state, machine.tables, machine.rows
    known, block, function, cycle = _decode(line, token_kinds, values, tables, state, modal, polar)
    if not known:
        return UNSUPPORTED
    event_count, anew, begins = state.event_count[0], modal[CYCLE] == 0.0, cycle != 0
    if begins:
        modal[CYCLE] = cycle
    drills = modal[CYCLE] != 0.0
    moves = begins or polar or block.seen & _MOTION_WORDS != 0
    plane = machine.constants.planes[int(modal[PLANE])]
    in_plane = block.seen & ((1 << (AXIS + plane[0])) | (1 << (AXIS + plane[1]))) != 0
    if polar and in_plane:
        return UNSUPPORTED
    if not moves and block.seen & (1 << CODE):
        kind = tables.kind[int(modal[INTERPOLATION])]
        if kind == ARC or (kind != RAPID_LINE and not has_pace(block, machine.constants, state)):
            return UNSUPPORTED
    early = function != UNSUPPORTED and tables.function[function] == EARLY
    on = Affected(machine.constants, state, rows)
    if early:
        report_function(function, BlockPlace(line, row, False), on)
    after = row
    if drills and moves:
        after = drill(block, (begins, anew), tables, machine.constants, state, rows, row)
    elif moves:
        after = _move(block, machine, row)
    if after < 0:
        state.event_count[0] = event_count
        return after
    if function != UNSUPPORTED and not early:
        report_function(function, BlockPlace(line, after, False), on)
    _activate(block, tables, state)
    if moves:
        if drills:
            copy(state.target, state.part)
            copy(machine.constants.over, state.programmed)
        else:
            copy(rows.positions[row, 1], state.part)
            copy(rows.positions[row, 2], state.programmed)
        if in_plane:
            state.registers[POLAR_RADIUS] = state.registers[POLAR_ANGLE] = np.nan
    return after


@inlined
def _decode(
    line: int,
    token_kinds: IntArray,
    values: FloatArray,
    tables: BlockTables,
    state: State,
    modal: FloatArray,
    polar: bool,
) -> tuple[bool, PlainBlock, int, int]:
    """Read what words mean; the arguments are those of ``execute_block``.

    Returns:
        Whether nothing about them is doubtful, the block, its M function or ``UNSUPPORTED``, and the
        drilling cycle that it calls or 0.
    """
    copy(state.modal[:OF_PLAIN_BLOCKS], modal)
    known = True
    number, seen, groups = int(np.int64(NO_BLOCK_NUMBER)), int(np.int64(0)), 0
    function, cycle = UNSUPPORTED, 0
    feed = state.registers[PROGRAMMED_FEED]
    for word in range(len(token_kinds)):
        token_kind, value = token_kinds[word], values[word]
        if token_kind == NUMBER:
            if word > 0 or not is_whole(value, LARGEST_LABEL):
                known = False
                break
            number = int(value)
        elif token_kind == CODE:
            if not is_whole(value, CODES - 1):
                known = False
                break
            code = int(value)
            group = 1 << tables.group[code]
            if tables.field[code] == UNSUPPORTED or groups & group:
                known = False
                break
            groups |= group
            modal[tables.field[code]] = tables.value[code]
            if tables.field[code] == INTERPOLATION:
                seen |= 1 << CODE
            if tables.cycle[code] == 0:
                modal[CYCLE] = 0.0
            elif tables.cycle[code] > 0:
                cycle = tables.cycle[code]
        else:
            if seen & (1 << token_kind) or not abs(value) <= LARGEST_COORDINATE:
                known = False
                break
            seen |= 1 << token_kind
            if token_kind == FEED:
                if not value > 0.0:
                    known = False
                    break
                feed = value
            elif token_kind == FUNCTION:
                if not is_whole(value, CODES - 1):
                    known = False
                    break
                function = int(value)
                if tables.function[function] == UNSUPPORTED:
                    known = False
                    break
    block = PlainBlock(line, number, token_kinds, values, seen, feed, modal, polar)
    return known, block, function, cycle


@inlined
def _activate(block: PlainBlock, tables: BlockTables, state: State) -> None:
    """What the block's codes and its F have set holds from here on."""
    for word in range(len(block.token_kinds)):
        if block.token_kinds[word] == CODE:
            code = int(block.values[word])
            state.modal[ACTIVE + tables.group[code]] = code
    copy(block.modal, state.modal)
    state.registers[PROGRAMMED_FEED] = block.feed


@inlined
def _move(block: PlainBlock, machine: Machine, row: int) -> int:
    """Write the block's move; the number of rows after it, or ``UNSUPPORTED``."""
    tables, constants, state = machine.tables, machine.constants, machine.state
    modal, seen, rows = block.modal, block.seen, machine.rows
    kind = tables.kind[int(modal[INTERPOLATION])]
    is_arc = kind == ARC
    if kind == NO_MOTION or (block.polar and is_arc) or (not is_arc and seen & _ARC_WORDS):
        return UNSUPPORTED
    if kind != RAPID_LINE and not has_pace(block, constants, state):
        return UNSUPPORTED
    position = rows.positions[row]
    if not put_target(block, seen, constants, state, position[2]):
        return UNSUPPORTED
    put_positions(position[2], state.part, state, position)
    if is_arc:
        length = emit_arc(block, tables, constants, state, rows, row)
    else:
        length = line_length(position[0], position[1])
    if length < SMALLEST_MOVE:
        return row if length >= 0.0 else UNSUPPORTED
    speed = 0.0 if kind == RAPID_LINE else 1.0
    turning = kind == FEED_LINE and only_turns(position[0], position[1], constants.linear)
    travel = travel_of(block, speed, length, turning, constants, state)
    shape = move_columns.ARC if is_arc else move_columns.LINE
    put_move(block, travel, shape, state, rows, row)
    return row + 1
