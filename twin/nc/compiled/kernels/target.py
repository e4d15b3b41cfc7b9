"""Where a plain block goes: the goals of its axes, as ``ControlMotion.target`` and the polar forms have them."""

from twin.compilation.compilable import compilable, inlined
from twin.nc.bytecode.registers import INCREMENTAL, UNIT, BlockTables, State
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.compiled.kernels.arc import value_of
from twin.nc.compiled.kernels.frame import directions
from twin.nc.compiled.kernels.plane import place
from twin.nc.compiled.kernels.tokenizer import AXIS


@inlined
def axis_target(
    axis: int,
    token_kinds: IntArray,
    values: FloatArray,
    seen: int,
    tables: BlockTables,
    state: State,
    modal: FloatArray,
    polar: bool,
) -> float:
    """Where the block wants an axis, as programmed; a polar block has aimed already."""
    if polar and axis < 3:
        return state.target[axis]
    if not seen & (1 << (AXIS + axis)):
        return state.programmed[axis]
    value = value_of(AXIS + axis, token_kinds, values)
    value *= modal[UNIT] if tables.linear[axis] else 1.0
    return value + state.programmed[axis] if modal[INCREMENTAL] != 0.0 else value


@compilable
def aim(
    plane: IntArray,
    token_kinds: IntArray,
    values: FloatArray,
    seen: int,
    state: State,
    modal: FloatArray,
) -> None:
    """Abscissa and ordinate of the target and the height of the block, as ``Plane.world`` has them."""
    abscissa, ordinate = state.target[0], state.target[1]
    x, y, z = state.programmed[0], state.programmed[1], state.programmed[2]
    across = plane[2]
    if seen & (1 << (AXIS + across)):
        value = value_of(AXIS + across, token_kinds, values) * modal[UNIT]
        height = value + state.programmed[across] if modal[INCREMENTAL] != 0.0 else value
        x = height if across == 0 else x
        y = height if across == 1 else y
        z = height if across == 2 else z
    axes = directions(plane)
    height = axes[2][0] * x + axes[2][1] * y + axes[2][2] * z
    place(axes, (abscissa, ordinate), height, state.target)
