"""Holes of drilling cycles, compiled: ``drilling.drill`` for a block that names a hole by plain words."""

import numpy as np

from twin.nc.canonical import Corner, FloatArray, Motion, Shape
from twin.nc.column_kernels import copy
from twin.nc.compile_kernels import kernel
from twin.nc.control_motion import LARGEST_COORDINATE
from twin.nc.drilling import Act
from twin.nc.event_columns import DWELL, FUNCTION_ALONE, FUNCTION_WITH_SPEED
from twin.nc.event_kernels import report
from twin.nc.frame_kernels import turn_place
from twin.nc.plain_state import (
    CORNER,
    FEED_FACTOR,
    PLANE,
    SPINDLE,
    UNIT,
    Constants,
    Rows,
    State,
)
from twin.nc.plain_words_kernels import NOT_PLAIN
from twin.nc.way_kernels import straight_way

NO_ROOM = -2
"""The rows are full."""
_UP, _DOWN, _DWELL, _M5 = int(Act.RAPID), int(Act.FEED), int(Act.DWELL), int(Act.M5)
_RAPID, _FEED = int(Motion.RAPID), int(Motion.FEED)
_LINE = int(Shape.LINE)
_STOP = int(Corner.EXACT_STOP)


@kernel
def write_hole(
    line: int,
    number: int,
    target: FloatArray,
    constants: Constants,
    state: State,
    modal: FloatArray,
    feed: float,
    rows: Rows,
    row: int,
) -> int:
    """Go over the hole, drill it, return.

    Args:
        line: The block's line, from 1.
        number: Its N number.
        target: Programmed position of the hole, shape (k,); its height is not used. It becomes
            where the tool stands.
        constants: What stays, the cycle among it.
        state: Where the block begins.
        modal: The modal state with this block's codes.
        feed: F.
        rows: Room for moves and events.
        row: The next row.

    Returns:
        The number of rows after it, ``NO_ROOM``, or ``NOT_PLAIN``.
    """
    hole = constants.hole
    if row + len(hole.acts) + 2 > len(rows.codes):
        return NO_ROOM
    if np.isnan(feed) and not constants.feed_may_lack:
        return NOT_PLAIN
    pace = constants.default_feed if np.isnan(feed) else feed * modal[UNIT] * modal[FEED_FACTOR]
    axis = int(constants.planes[int(modal[PLANE])][2])
    here, part, goal = constants.room[0], constants.room[1], constants.room[2]
    copy(state.programmed, here)
    copy(state.part, part)
    copy(state.programmed, goal)
    over = max(here[axis], hole.reference)
    after = row
    for step in range(-2, len(hole.acts)):
        act = _UP if step < 0 else hole.acts[step]
        if act <= _DOWN:
            if step == -1:
                copy(target, goal)
            goal[axis] = over if step < 0 else hole.values[step]
            rapid = act == _UP
            speed = constants.rapid_feed if rapid else pace
            corner = _STOP if rapid else int(modal[CORNER])
            after = _go(goal, rapid, speed, corner, here, part, state, rows, after)
            if after == NOT_PLAIN:
                return NOT_PLAIN
        else:
            kind, amount = FUNCTION_WITH_SPEED, state.registers[SPINDLE]
            if act == _DWELL:
                kind, amount = DWELL, hole.values[step]
            elif act == _M5:
                kind, amount = FUNCTION_ALONE, np.nan
            report(rows, state, after, line, kind, act, amount)
    for each in range(row, after):
        rows.codes[each, 2], rows.codes[each, 3] = line, number
        copy(constants.last_values, rows.values[each, 8:])
    copy(here, target)
    copy(part, state.label)
    return after


@kernel
def _go(
    goal: FloatArray,
    rapid: bool,
    pace: float,
    corner: int,
    here: FloatArray,
    part: FloatArray,
    state: State,
    rows: Rows,
    row: int,
) -> int:
    """Write a straight move; ``here`` and ``part`` become its end."""
    position = rows.positions[row]
    for axis in range(len(goal)):
        if not abs(goal[axis]) <= LARGEST_COORDINATE:
            return NOT_PLAIN
        end = goal[axis] + state.total[axis]
        position[0, axis], position[1, axis], position[2, axis] = part[axis], end, goal[axis]
    turn_place(goal, state, position[1])
    way = straight_way(position)
    copy(goal, here)
    if way <= 0.0:
        return row if way == 0.0 else NOT_PLAIN
    copy(position[1], part)
    value, code = rows.values[row], rows.codes[row]
    value[:6] = np.nan
    value[6], value[7] = 0.0, pace
    code[0], code[1], code[4] = _RAPID if rapid else _FEED, _LINE, corner
    return row + 1
