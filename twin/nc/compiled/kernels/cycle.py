"""Drilling cycles on columns: what ``iso.drilling`` does for a block of plain words, by the same ``path.hole``."""

import numpy as np

from twin.compilation.compilable import compilable
from twin.nc.bytecode.effects import Affected, BlockPlace, report_act
from twin.nc.bytecode.registers import (
    CYCLE,
    CYCLE_STATE,
    CYCLE_WORDS,
    FEED_MODE,
    INCREMENTAL,
    PLANE,
    TO_REFERENCE,
    UNIT,
    BlockTables,
    Constants,
    State,
)
from twin.nc.bytecode.token_kinds import AXIS, RADIUS, UNSUPPORTED
from twin.nc.canonical import FloatArray
from twin.nc.compiled.kernels.move_row import LINE, has_pace, put_move, put_positions, travel_of
from twin.nc.compiled.kernels.target import PlainBlock, put_target
from twin.nc.path.drilling_cycle import VALUES, Cycle, CycleBlock, cycle_of, read_words
from twin.nc.path.hole import MOST_STOPS, NO_MOVE, Hole, hole_of, most_acts, next_place, write_acts
from twin.nc.path.moves import LARGEST_COORDINATE, line_length
from twin.nc.path.paces import counts_blocks
from twin.nc.path.rows import Rows, copy

NO_ROOM = -2
"""The rows are full."""
_WORDS = len(Cycle._fields)
_AS_WRITTEN = Cycle._fields.index("as_written")


@compilable
def drill(
    block: PlainBlock,
    called: tuple[bool, bool],
    tables: BlockTables,
    constants: Constants,
    state: State,
    rows: Rows,
    row: int,
) -> int:
    """Drill the hole that a block names.

    Args:
        block: Its words.
        called: Whether the block calls the cycle, and whether no cycle was in force before.
        tables: What blocks mean.
        constants: What stays; its ``over`` becomes where the tool stands.
        state: Where the block begins; its target becomes where the path ends.
        rows: Room for moves and events.
        row: The next row.

    Returns:
        The number of rows after it, ``NO_ROOM``, or ``UNSUPPORTED`` with the cycle untouched.
    """
    plane = constants.planes[int(block.modal[PLANE])]
    as_written = tables.cycles[int(block.modal[CYCLE])][_AS_WRITTEN] != 0.0
    names_place = block.polar or block.seen >> AXIS != 0
    modal, other = block.modal, called[0] or not names_place
    other = other or modal[INCREMENTAL] != 0.0 or counts_blocks(int(modal[FEED_MODE]))
    if as_written and other:
        return UNSUPPORTED
    taken, hole = _read_cycle(block, called, tables, constants, state)
    if as_written and state.programmed[plane[2]] < hole.reference:
        return UNSUPPORTED
    if hole.fault != 0 or hole.stops > MOST_STOPS:
        return UNSUPPORTED
    rest = block.seen & ~taken
    if (rest >> RADIUS) & ((1 << (AXIS - RADIUS)) - 1) or rest & (1 << (AXIS + plane[2])):
        return UNSUPPORTED
    if not put_target(block, rest, constants, state, constants.over):
        return UNSUPPORTED
    after = _emit_hole(block, hole, constants, state, rows, row)
    if after >= 0:
        for value in range(VALUES):
            state.registers[CYCLE_STATE + value] = constants.hole[0, value]
            state.registers[CYCLE_WORDS + value] = np.nan
    return after


@compilable
def _read_cycle(
    block: PlainBlock,
    called: tuple[bool, bool],
    tables: BlockTables,
    constants: Constants,
    state: State,
) -> tuple[int, Hole]:
    """Take the words of a block that belong to its drilling cycle: ``drilling`` does the same.

    The first row of ``constants.hole`` becomes what the cycle remembers.

    Returns:
        The token kinds of those words as bits, and what is done at the hole.
    """
    modal, (calls, anew) = block.modal, called
    row = tables.cycles[int(modal[CYCLE])]
    cycle = cycle_of(row)
    across = int(constants.planes[int(modal[PLANE])][2])
    remembered, given = constants.hole[0], constants.hole[1]
    for value in range(VALUES):
        remembered[value] = np.nan if anew else state.registers[CYCLE_STATE + value]
        given[value] = state.registers[CYCLE_WORDS + value]
    taken = 0
    if calls or cycle.lasting:
        for word in range(len(block.token_kinds)):
            token_kind = block.token_kinds[word]
            value = int(row[_WORDS + token_kind])
            if token_kind == AXIS + across:
                value = cycle.across
            if value >= 0:
                given[value] = block.values[word]
                taken |= 1 << token_kind
    relative = modal[INCREMENTAL] != 0.0
    here = CycleBlock(calls, across, state.programmed[across], modal[UNIT], (relative, relative))
    read_words(cycle, remembered, given, here)
    return taken, hole_of(cycle, remembered, across, modal[TO_REFERENCE] != 0.0)


@compilable
def _emit_hole(
    block: PlainBlock, hole: Hole, constants: Constants, state: State, rows: Rows, row: int
) -> int:
    """Go over the hole, drill it, return: ``drilling.drill``; the hole lies at ``constants.over``."""
    most = most_acts(hole.stops)
    if row + most > len(rows.codes) or state.event_count[0] + most > len(rows.events):
        return NO_ROOM
    if not has_pace(block, constants, state):
        return UNSUPPORTED
    axis = int(constants.planes[int(block.modal[PLANE])][2])
    here, part, goal = constants.room[0], constants.room[1], constants.room[2]
    copy(state.programmed, here)
    copy(state.part, part)
    copy(state.programmed, goal)
    acts, amounts, after = constants.hole[2], constants.hole[3], row
    for step in range(write_acts(hole, here[axis], acts, amounts)):
        act, amount = int(acts[step]), amounts[step]
        speed = next_place(act, amount, hole, constants.over, goal, axis)
        if speed != NO_MOVE:
            after = _go(goal, speed, block, constants, state, rows, after)
            if after == UNSUPPORTED:
                return UNSUPPORTED
        else:
            place = BlockPlace(block.line, after, False)
            report_act(act, amount, place, Affected(constants, state, rows))
    copy(here, constants.over)
    copy(part, state.target)
    return after


@compilable
def _go(
    goal: FloatArray,
    speed: float,
    block: PlainBlock,
    constants: Constants,
    state: State,
    rows: Rows,
    row: int,
) -> int:
    """Write a straight move; the first two rows of ``constants.room`` become its end."""
    position, here, part = rows.positions[row], constants.room[0], constants.room[1]
    for axis in range(len(goal)):
        if not abs(goal[axis]) <= LARGEST_COORDINATE:
            return UNSUPPORTED
    put_positions(goal, part, state, position)
    copy(goal, here)
    length = line_length(position[0], position[1])
    if length == 0.0:
        return row
    copy(position[1], part)
    travel = travel_of(block, speed, length, False, constants, state)
    put_move(block, travel, LINE, state, rows, row)
    return row + 1
