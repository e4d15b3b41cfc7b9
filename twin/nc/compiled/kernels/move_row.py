"""A plain block's move as a row: what lines, arcs and the moves of drilling cycles have alike."""

from typing import NamedTuple

import numpy as np

from twin.compilation.compilable import inlined
from twin.nc.bytecode.coordinates import turn_place
from twin.nc.bytecode.registers import (
    ACCELERATION,
    CORNER,
    CORNER_TOLERANCE,
    DECELERATION,
    FEED_MODE,
    RAPID_FEED,
    SPINDLE,
    SPINDLE_TURNS,
    UNIT,
    Constants,
    State,
)
from twin.nc.bytecode.token_kinds import FEED as FEED_WORD
from twin.nc.canonical import FloatArray, Motion
from twin.nc.compiled.kernels.target import PlainBlock
from twin.nc.path.move_columns import LINE
from twin.nc.path.moves import RAPIDS_END
from twin.nc.path.paces import (
    PACED,
    WITHOUT_FEED,
    feed_per_minute,
    finding_of_feed,
    needs_own_feed,
    rapid_feed,
)
from twin.nc.path.rows import Rows

RAPID, FEED, STOP = int(Motion.RAPID), int(Motion.FEED), int(RAPIDS_END)


class Travel(NamedTuple):
    """How a move goes.

    Attributes:
        motion: Rapid or feed.
        pace: [mm/min or deg/min]; NaN: the machine's.
        corner: How its end is passed.
    """

    motion: int
    pace: float
    corner: int


@inlined
def has_pace(block: PlainBlock, constants: Constants, state: State) -> bool:
    """Whether nothing about the pace of a block's moves with a feed is doubtful."""
    registers, mode = state.registers, int(block.modal[FEED_MODE])
    if needs_own_feed(mode) and not block.seen & (1 << FEED_WORD):
        return False
    speed, turns = registers[SPINDLE], registers[SPINDLE_TURNS]
    finding = finding_of_feed(block.feed, mode, speed, turns)
    return finding == PACED or (finding == WITHOUT_FEED and constants.feed_may_lack)


@inlined
def travel_of(
    block: PlainBlock,
    speed: float,
    length: float,
    turning: bool,
    constants: Constants,
    state: State,
) -> Travel:
    """How a move of a block goes, which ``has_pace`` where it has a feed.

    Args:
        block: The block.
        speed: How many times as fast as F says; 0: rapidly.
        length: How far the move goes [mm or deg].
        turning: Only rotary axes move.
        constants: What stays.
        state: S is among its registers.
    """
    registers = state.registers
    if speed == 0.0:
        own = constants.own_rapid_feed
        pace = registers[RAPID_FEED] if np.isnan(own) else rapid_feed(own, block.feed)
        return Travel(RAPID, pace, STOP)
    mode, unit = int(block.modal[FEED_MODE]), block.modal[UNIT]
    otherwise = (constants.default_feed, constants.default_rotary_feed)
    feed, spindle = block.feed * speed, registers[SPINDLE]
    pace = feed_per_minute(feed, mode, length, turning, unit, spindle, otherwise)
    return Travel(FEED, pace, int(block.modal[CORNER]))


@inlined
def put_positions(goal: FloatArray, part: FloatArray, state: State, position: FloatArray) -> None:
    """Start, end and display of a move from a place of the part to a programmed one.

    Args:
        goal: The programmed place, shape (k,).
        part: Where the move begins, shape (k,).
        state: Its shifts and its matrix lead from the one to the other.
        position: Filled in, shape (3, k).
    """
    for axis in range(len(goal)):
        position[0, axis] = part[axis]
        position[1, axis] = goal[axis] + state.total[axis]
        position[2, axis] = goal[axis]
    turn_place(goal, state, position[1])


@inlined
def put_move(
    block: PlainBlock, travel: Travel, shape: int, state: State, rows: Rows, row: int
) -> None:
    """Fill in what is no position of a move; an arc has its centre, normal and sweep already."""
    value, code = rows.values[row], rows.codes[row]
    if shape == LINE:
        value[:6] = np.nan
        value[6] = 0.0
    value[7] = travel.pace
    value[8] = state.modal[CORNER_TOLERANCE]
    value[9], value[10] = state.registers[ACCELERATION], state.registers[DECELERATION]
    code[0], code[1], code[2], code[3] = travel.motion, shape, block.line, block.number
    code[4] = travel.corner
