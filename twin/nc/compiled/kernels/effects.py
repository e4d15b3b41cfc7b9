"""What blocks do besides moving and computing, compiled: events, tools, shifts of coordinates, polar moves.

Each is what ``instructions.Step`` says of it; the state is kept before the first of a block.
"""

import numpy as np
from numba.extending import register_jitable

from twin.compilation.kernel import kernel
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.registers import (
    CYCLE,
    DOUBTFUL,
    GIVEN,
    IN_SPINDLE,
    INCREMENTAL,
    OFFSET_ON,
    PLANE,
    POLAR_ABSCISSA,
    POLAR_ANGLE,
    POLAR_ORDINATE,
    POLAR_RADIUS,
    RADIUS_GIVEN,
    ROTATION,
    ROTATION_ABSCISSA,
    ROTATION_ORDINATE,
    SCALE,
    SELECTED,
    SIGNS,
    SPINDLE,
    UNIT,
    BlockTables,
    Constants,
    Rows,
    State,
)
from twin.nc.canonical import FloatArray
from twin.nc.compiled.kernels.frame import add_up, reframe, to_part, transform
from twin.nc.control.drilling_cycle import Cycle
from twin.nc.control.motion import LARGEST_COORDINATE
from twin.nc.geometry import arcs
from twin.nc.geometry.frame import SHIFTS
from twin.nc.geometry.matrices import LARGEST_SCALE, SMALLEST_SCALE
from twin.nc.path.event_columns import (
    AUXILIARY,
    DWELL,
    FUNCTION_ALONE,
    FUNCTION_WITH_SPEED,
    SPEED,
    TOOL,
)

register_jitable(arcs.angle_of)

_NO_EVENT = -1
_PECKING = Cycle._fields.index("pecking")
_LENGTH = SHIFTS.index("length")
_LARGEST_NUMBER = 1e6
"""Numbers of tools and of auxiliary functions above this are left to the general way."""


@kernel
def run_deed(
    step: int,
    argument: int,
    stack: FloatArray,
    top: int,
    line: int,
    made: int,
    tables: BlockTables,
    constants: Constants,
    state: State,
    rows: Rows,
    compensates: bool,
) -> int:
    """Do one step.

    Args:
        step: Which.
        argument: Its argument.
        stack: Values.
        top: How many there are.
        line: The block's line, from 1.
        made: Moves that were made.
        tables: What words mean.
        constants: What stays.
        state: What changes.
        rows: Where events go.
        compensates: Radius compensation is in force.

    Returns:
        How many values are left, or ``DOUBTFUL``.
    """
    registers = state.registers
    value = stack[top - 1] if top > 0 else 0.0
    kind, number, amount = _NO_EVENT, argument, np.nan
    if step == opcodes.IN_FORCE:
        state.in_force[tables.group[argument]] = argument
    elif step == opcodes.PLANE:
        doubtful = np.isnan(registers[POLAR_ABSCISSA]) or not np.isnan(registers[ROTATION])
        if compensates or doubtful:
            return DOUBTFUL
        state.modal[PLANE] = argument
        registers[POLAR_ABSCISSA] = registers[POLAR_ORDINATE] = 0.0
        registers[POLAR_RADIUS] = registers[POLAR_ANGLE] = np.nan
    elif step == opcodes.FUNCTION:
        kind = FUNCTION_ALONE
    elif step == opcodes.SPINDLE_FUNCTION:
        kind, amount = FUNCTION_WITH_SPEED, registers[SPINDLE]
    elif step == opcodes.SPEED:
        if value < 0.0:
            return DOUBTFUL
        registers[SPINDLE] = value
        if argument:
            kind, amount = SPEED, value
        top -= 1
    elif step == opcodes.TOOL:
        if not 0.0 <= value <= _LARGEST_NUMBER or value != np.floor(value):
            return DOUBTFUL
        if argument and len(constants.tools) > 0 and _tool(constants, value) == DOUBTFUL:
            return DOUBTFUL
        registers[SELECTED] = value
        kind, number = TOOL, int(value)
        top -= 1
    elif step == opcodes.AUXILIARY:
        if not 0.0 <= value < _LARGEST_NUMBER or value != np.floor(value):
            return DOUBTFUL
        kind, number = AUXILIARY, int(value)
        top -= 1
    elif step == opcodes.DWELL:
        if value < 0.0:
            return DOUBTFUL
        kind, amount = DWELL, value
        top -= 1
    elif step == opcodes.CHANGE_TOOL:
        registers[IN_SPINDLE] = registers[SELECTED]
    elif step == opcodes.OFFSET_ON:
        registers[OFFSET_ON] = argument
    elif step == opcodes.TOOL_LENGTH:
        longer = 0.0
        if registers[OFFSET_ON] != 0.0:
            tool = _tool(constants, registers[IN_SPINDLE])
            if tool == DOUBTFUL:
                return DOUBTFUL
            longer = constants.longer[tool]
        state.shifts[_LENGTH, :] = 0.0
        state.shifts[_LENGTH, 2] = longer
        reframe(state)
    elif step == opcodes.SHIFT:
        top -= len(state.part)
        for axis in range(len(state.part)):
            state.shifts[argument, axis] = stack[top + axis]
    elif step == opcodes.REFRAME:
        reframe(state)
    elif step == opcodes.BEGIN_LABEL:
        for axis in range(len(state.part)):
            state.label[axis] = state.programmed[axis]
    elif step == opcodes.LABEL:
        state.label[argument] = value
        top -= 1
    elif step == opcodes.RELABEL:
        here = constants.over
        to_part(state.label, state, here)
        for axis in range(len(state.part)):
            shift = state.shifts[argument, axis]
            state.shifts[argument, axis] = shift + state.part[axis] - here[axis]
            state.programmed[axis] = state.label[axis]
        add_up(state)
    elif step == opcodes.POLAR_ORIGIN:
        if np.isnan(registers[POLAR_ABSCISSA]):
            return DOUBTFUL
        _set_polar_origin(stack, top, argument, constants, state)
        top -= argument
    elif step == opcodes.TO_MILLIMETRES:
        stack[top - 1] = value * (state.modal[UNIT] if tables.linear[argument] else 1.0)
    elif step == opcodes.NO_PECKS:
        if tables.cycles[int(state.modal[CYCLE]), _PECKING] != 0.0:
            return DOUBTFUL
    elif step == opcodes.TOOL_RADIUS:
        tool = _tool(constants, registers[IN_SPINDLE])
        if tool == DOUBTFUL:
            return DOUBTFUL
        offset = argument == 0 or registers[OFFSET_ON] != 0.0
        stack[top] = constants.radii[tool] if offset else 0.0
        top += 1
    elif step == opcodes.FORGET_POLAR:
        registers[POLAR_RADIUS] = registers[POLAR_ANGLE] = np.nan
    elif step == opcodes.CYCLE_WORD:
        registers[GIVEN + argument] = value
        top -= 1
    elif step == opcodes.PROGRAMMED_RADIUS and argument:
        registers[RADIUS_GIVEN] = value * state.modal[UNIT]
        stack[top - 1] = registers[RADIUS_GIVEN]
    elif step == opcodes.PROGRAMMED_RADIUS:
        stack[top] = registers[RADIUS_GIVEN]
        top += 1
    elif step == opcodes.MIRROR:
        if abs(value) != 1.0:
            return DOUBTFUL
        registers[SIGNS + argument] = value
        top -= 1
    elif step == opcodes.SCALE:
        if not SMALLEST_SCALE <= value <= LARGEST_SCALE:
            return DOUBTFUL
        registers[SCALE] = value
        top -= 1
    elif step == opcodes.ROTATE:
        if not np.isnan(registers[ROTATION]):
            return DOUBTFUL
        registers[ROTATION] = stack[top - 3]
        registers[ROTATION_ABSCISSA] = stack[top - 2] * state.modal[UNIT]
        registers[ROTATION_ORDINATE] = stack[top - 1] * state.modal[UNIT]
        top -= 3
    elif step == opcodes.END_ROTATION:
        registers[ROTATION] = np.nan
    elif step == opcodes.TRANSFORM:
        if compensates:
            return DOUBTFUL
        transform(constants, state)
    if kind != _NO_EVENT:
        report(rows, state, made, line, kind, number, amount)
    return top


@kernel
def _tool(constants: Constants, number: float) -> int:
    """Row of a tool that the job lists, or ``DOUBTFUL``."""
    for tool in range(len(constants.tools)):
        if constants.tools[tool] == number:
            return tool
    return DOUBTFUL


@kernel
def _set_polar_origin(
    stack: FloatArray, top: int, given: int, constants: Constants, state: State
) -> None:
    """The polar origin: two values on the stack, or where the tool stands."""
    plane = constants.planes[int(state.modal[PLANE])]
    abscissa, ordinate = _along(state.programmed, plane[0]), _along(state.programmed, plane[1])
    if given:
        abscissa, ordinate = stack[top - 2] * state.modal[UNIT], stack[top - 1] * state.modal[UNIT]
    registers = state.registers
    registers[POLAR_ABSCISSA], registers[POLAR_ORDINATE] = abscissa, ordinate
    registers[POLAR_RADIUS] = registers[POLAR_ANGLE] = np.nan


@kernel
def _along(position: FloatArray, axis: int) -> float:
    """A coordinate as ``Plane.local`` computes it, the sign of zero included."""
    x, y, z = position[0], position[1], position[2]
    if axis == 0:
        return 1.0 * x + 0.0 * y + 0.0 * z
    if axis == 1:
        return 0.0 * x + 1.0 * y + 0.0 * z
    return 0.0 * x + 0.0 * y + 1.0 * z


@kernel
def polar_target(
    seen: int, radius_word: float, angle_word: float, constants: Constants, state: State
) -> bool:
    """Where R and Q lead: ``state.label`` becomes abscissa and ordinate.

    Args:
        seen: 1 with R, 2 with Q, 3 with both.
        radius_word: Value of R.
        angle_word: Value of Q.
        constants: What stays.
        state: Its registers get the last R and Q.

    Returns:
        Whether nothing about it is doubtful.
    """
    registers, modal = state.registers, state.modal
    plane = constants.planes[int(modal[PLANE])]
    origin = (registers[POLAR_ABSCISSA], registers[POLAR_ORDINATE])
    if np.isnan(origin[0]):
        return False
    start = (_along(state.programmed, plane[0]), _along(state.programmed, plane[1]))
    radius, angle = registers[POLAR_RADIUS], registers[POLAR_ANGLE]
    if np.isnan(radius):
        radius = arcs.distance(origin, start)
    if np.isnan(angle):
        angle = arcs.angle_of(start, origin)
    incremental = modal[INCREMENTAL] != 0.0
    if seen & 1:
        value = radius_word * modal[UNIT]
        radius = radius + value if incremental else value
        if not 0.0 <= radius <= LARGEST_COORDINATE:
            return False
    if seen & 2:
        angle = angle + angle_word if incremental else angle_word
        if not abs(angle) <= LARGEST_COORDINATE:
            return False
    cosine, sine = arcs.direction(angle)
    end = (origin[0] + radius * cosine, origin[1] + radius * sine)
    if arcs.distance(start, end) < arcs.SAME_POINT / 1000.0:
        end = start
    state.label[0], state.label[1] = end
    registers[POLAR_RADIUS], registers[POLAR_ANGLE] = radius, angle
    return True


@kernel
def report(
    rows: Rows, state: State, before: int, line: int, kind: int, number: int, amount: float
) -> None:
    """Write an event."""
    at = state.happened[0]
    event = rows.events[at]
    event[0], event[1], event[2], event[3] = before, line, kind, number
    rows.amounts[at] = amount
    state.happened[0] = at + 1
