"""Where a plain block goes: the goals of its axes, as ``Control.target`` and the polar forms have them."""

from typing import NamedTuple

from twin.compilation.compilable import compilable, inlined
from twin.nc.bytecode.coordinates import directions
from twin.nc.bytecode.registers import INCREMENTAL, PLANE, UNIT, Constants, State
from twin.nc.bytecode.token_kinds import AXIS
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.geometry.planes import along, put_point
from twin.nc.path.moves import axis_target


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
def target_of_axis(
    axis: int, block: PlainBlock, seen: int, constants: Constants, state: State
) -> float:
    """Where the block wants an axis, as programmed; a polar block has aimed already.

    Args:
        axis: Which.
        block: Its words.
        seen: Those of them that say where it goes, as bits.
        constants: What stays.
        state: Where the block begins.
    """
    if block.polar and axis < 3:
        return state.target[axis]
    if not seen & (1 << (AXIS + axis)):
        return state.programmed[axis]
    value, unit = value_of(AXIS + axis, block), block.modal[UNIT]
    incremental = block.modal[INCREMENTAL] != 0.0
    return axis_target(value, unit, constants.linear[axis], incremental, state.programmed[axis])


@compilable
def aim(constants: Constants, block: PlainBlock, seen: int, state: State) -> None:
    """Abscissa and ordinate of the target and the height of the block, as ``Plane.world`` has them."""
    abscissa, ordinate = state.target[0], state.target[1]
    x, y, z = state.programmed[0], state.programmed[1], state.programmed[2]
    plane = int(block.modal[PLANE])
    across = int(constants.planes[plane, 2])
    if seen & (1 << (AXIS + across)):
        value, unit = value_of(AXIS + across, block), block.modal[UNIT]
        incremental = block.modal[INCREMENTAL] != 0.0
        height = axis_target(value, unit, True, incremental, state.programmed[across])
        x = height if across == 0 else x
        y = height if across == 1 else y
        z = height if across == 2 else z
    axes = directions(constants, block.modal)
    put_point(axes, (abscissa, ordinate), along((x, y, z), axes[2]), state.target)
