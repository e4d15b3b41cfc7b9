"""Where a plain block goes: where its words lead, as ``path.moves`` says, and polar coordinates in its plane."""

from typing import NamedTuple

from twin.compilation.compilable import compilable, inlined
from twin.nc.bytecode.coordinates import directions
from twin.nc.bytecode.registers import INCREMENTAL, UNIT, Constants, State
from twin.nc.bytecode.token_kinds import AXIS
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.geometry.planes import aim
from twin.nc.path.moves import LARGEST_COORDINATE, axis_target


class PlainBlock(NamedTuple):
    """A block of plain words, and what is in force with its codes.

    Attributes:
        line: Its line, from 1.
        number: Its N number.
        token_kinds: What each word's letter is, shape (w,).
        values: The words' values, shape (w,).
        seen: Which token kinds there are, as bits.
        feed: F.
        modal: What is in force with its codes, shape (``OF_PLAIN_BLOCKS``,).
        polar: The target of ``State`` holds where it goes in the plane.
    """

    line: int
    number: int
    token_kinds: IntArray
    values: FloatArray
    seen: int
    feed: float
    modal: FloatArray
    polar: bool


@compilable
def value_of(token_kind: int, block: PlainBlock) -> float:
    """Value of the word with a token kind; 0 where there is none."""
    for word in range(len(block.token_kinds)):
        if block.token_kinds[word] == token_kind:
            return block.values[word]
    return 0.0


@inlined
def put_target(
    block: PlainBlock, seen: int, constants: Constants, state: State, goal: FloatArray
) -> bool:
    """Fill in where the block wants its axes, as programmed; whether that is not too far.

    Args:
        block: Its words.
        seen: Those of them that say where it goes, as bits.
        constants: What stays.
        state: Where the block begins; of a polar block its target is abscissa and ordinate.
        goal: Shape (k,).
    """
    modal, incremental = block.modal, block.modal[INCREMENTAL] != 0.0
    for axis in range(len(goal)):
        goal[axis] = state.programmed[axis]
        if seen & (1 << (AXIS + axis)):
            value, linear = value_of(AXIS + axis, block), constants.linear[axis]
            goal[axis] = axis_target(value, modal[UNIT], linear, incremental, goal[axis])
        if not abs(goal[axis]) <= LARGEST_COORDINATE:
            return False
    if block.polar:
        aim(directions(constants, modal), (state.target[0], state.target[1]), goal)
    return True
