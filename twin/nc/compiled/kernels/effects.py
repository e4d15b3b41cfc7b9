"""What blocks do besides moving and computing, compiled: events, tools, shifts of coordinates, polar moves.

Each does what ``opcodes`` says of it; the state is kept before the first of a block.
"""

import numpy as np

from twin.compilation.compilable import compilable
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.registers import (
    BAILOUT,
    CYCLE,
    CYCLE_WORDS,
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
    State,
)
from twin.nc.canonical import FloatArray
from twin.nc.compiled.kernels.frame import add_up, reframe, to_part, transform
from twin.nc.control.control import LARGEST_COORDINATE
from twin.nc.geometry import arcs
from twin.nc.geometry.frame import SHIFTS
from twin.nc.geometry.matrices import LARGEST_SCALE, SMALLEST_SCALE
from twin.nc.path.drilling_cycle import Cycle
from twin.nc.path.event_columns import (
    AUXILIARY,
    DWELL,
    FUNCTION_ALONE,
    FUNCTION_WITH_SPEED,
    SPEED,
    TOOL,
)
from twin.nc.path.rows import Rows

_NO_EVENT = -1
_PECKING = Cycle._fields.index("pecking")
_LENGTH = SHIFTS.index("length")
_LARGEST_NUMBER = 1e6
"""Numbers of tools and of auxiliary functions above this are left to the interpreter tier."""


@compilable
def run_effect(
    opcode: int,
    operand: int,
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
    """Run one instruction.

    Args:
        opcode: Which.
        operand: Its operand.
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
        How many values are left, or ``BAILOUT``.
    """
    registers = state.registers
    value = stack[top - 1] if top > 0 else 0.0
    kind, number, amount = _NO_EVENT, operand, np.nan
    if opcode == opcodes.ACTIVATE:
        state.active_codes[tables.group[operand]] = operand
    elif opcode == opcodes.PLANE:
        doubtful = np.isnan(registers[POLAR_ABSCISSA]) or not np.isnan(registers[ROTATION])
        if compensates or doubtful:
            return BAILOUT
        state.modal[PLANE] = operand
        registers[POLAR_ABSCISSA] = registers[POLAR_ORDINATE] = 0.0
        registers[POLAR_RADIUS] = registers[POLAR_ANGLE] = np.nan
    elif opcode == opcodes.FUNCTION:
        kind = FUNCTION_ALONE
    elif opcode == opcodes.SPINDLE_FUNCTION:
        kind, amount = FUNCTION_WITH_SPEED, registers[SPINDLE]
    elif opcode == opcodes.SPEED:
        if value < 0.0:
            return BAILOUT
        registers[SPINDLE] = value
        if operand:
            kind, amount = SPEED, value
        top -= 1
    elif opcode == opcodes.TOOL:
        if not 0.0 <= value <= _LARGEST_NUMBER or value != np.floor(value):
            return BAILOUT
        if operand and len(constants.tools) > 0 and _tool(constants, value) == BAILOUT:
            return BAILOUT
        registers[SELECTED] = value
        kind, number = TOOL, int(value)
        top -= 1
    elif opcode == opcodes.AUXILIARY:
        if not 0.0 <= value < _LARGEST_NUMBER or value != np.floor(value):
            return BAILOUT
        kind, number = AUXILIARY, int(value)
        top -= 1
    elif opcode == opcodes.DWELL:
        if value < 0.0:
            return BAILOUT
        kind, amount = DWELL, value
        top -= 1
    elif opcode == opcodes.CHANGE_TOOL:
        registers[IN_SPINDLE] = registers[SELECTED]
    elif opcode == opcodes.OFFSET_ON:
        registers[OFFSET_ON] = operand
    elif opcode == opcodes.TOOL_LENGTH:
        longer = 0.0
        if registers[OFFSET_ON] != 0.0:
            tool = _tool(constants, registers[IN_SPINDLE])
            if tool == BAILOUT:
                return BAILOUT
            longer = constants.longer[tool]
        state.shifts[_LENGTH, :] = 0.0
        state.shifts[_LENGTH, 2] = longer
        reframe(state)
    elif opcode == opcodes.SHIFT:
        top -= len(state.part)
        for axis in range(len(state.part)):
            state.shifts[operand, axis] = stack[top + axis]
    elif opcode == opcodes.REFRAME:
        reframe(state)
    elif opcode == opcodes.BEGIN_TARGET:
        for axis in range(len(state.part)):
            state.target[axis] = state.programmed[axis]
    elif opcode == opcodes.TARGET:
        state.target[operand] = value
        top -= 1
    elif opcode == opcodes.SET_POSITION:
        here = constants.over
        to_part(state.target, state, here)
        for axis in range(len(state.part)):
            shift = state.shifts[operand, axis]
            state.shifts[operand, axis] = shift + state.part[axis] - here[axis]
            state.programmed[axis] = state.target[axis]
        add_up(state)
    elif opcode == opcodes.POLAR_ORIGIN:
        if np.isnan(registers[POLAR_ABSCISSA]):
            return BAILOUT
        _set_polar_origin(stack, top, operand, constants, state)
        top -= operand
    elif opcode == opcodes.TO_MILLIMETRES:
        stack[top - 1] = value * (state.modal[UNIT] if tables.linear[operand] else 1.0)
    elif opcode == opcodes.NO_PECKS:
        if tables.cycles[int(state.modal[CYCLE]), _PECKING] != 0.0:
            return BAILOUT
    elif opcode == opcodes.TOOL_RADIUS:
        tool = _tool(constants, registers[IN_SPINDLE])
        if tool == BAILOUT:
            return BAILOUT
        offset = operand == 0 or registers[OFFSET_ON] != 0.0
        stack[top] = constants.radii[tool] if offset else 0.0
        top += 1
    elif opcode == opcodes.FORGET_POLAR:
        registers[POLAR_RADIUS] = registers[POLAR_ANGLE] = np.nan
    elif opcode == opcodes.CYCLE_WORD:
        registers[CYCLE_WORDS + operand] = value
        top -= 1
    elif opcode == opcodes.PROGRAMMED_RADIUS and operand:
        registers[RADIUS_GIVEN] = value * state.modal[UNIT]
        stack[top - 1] = registers[RADIUS_GIVEN]
    elif opcode == opcodes.PROGRAMMED_RADIUS:
        stack[top] = registers[RADIUS_GIVEN]
        top += 1
    elif opcode == opcodes.MIRROR:
        if abs(value) != 1.0:
            return BAILOUT
        registers[SIGNS + operand] = value
        top -= 1
    elif opcode == opcodes.SCALE:
        if not SMALLEST_SCALE <= value <= LARGEST_SCALE:
            return BAILOUT
        registers[SCALE] = value
        top -= 1
    elif opcode == opcodes.ROTATE:
        if not np.isnan(registers[ROTATION]):
            return BAILOUT
        registers[ROTATION] = stack[top - 3]
        registers[ROTATION_ABSCISSA] = stack[top - 2] * state.modal[UNIT]
        registers[ROTATION_ORDINATE] = stack[top - 1] * state.modal[UNIT]
        top -= 3
    elif opcode == opcodes.END_ROTATION:
        registers[ROTATION] = np.nan
    elif opcode == opcodes.TRANSFORM:
        if compensates:
            return BAILOUT
        transform(constants, state)
    if kind != _NO_EVENT:
        report(rows, state, made, line, kind, number, amount)
    return top


@compilable
def _tool(constants: Constants, number: float) -> int:
    """Row of a tool that the job lists, or ``BAILOUT``."""
    for tool in range(len(constants.tools)):
        if constants.tools[tool] == number:
            return tool
    return BAILOUT


@compilable
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


@compilable
def _along(position: FloatArray, axis: int) -> float:
    """A coordinate as ``Plane.local`` computes it, the sign of zero included."""
    x, y, z = position[0], position[1], position[2]
    if axis == 0:
        return 1.0 * x + 0.0 * y + 0.0 * z
    if axis == 1:
        return 0.0 * x + 1.0 * y + 0.0 * z
    return 0.0 * x + 0.0 * y + 1.0 * z


@compilable
def polar_target(
    seen: int, radius_word: float, angle_word: float, constants: Constants, state: State
) -> bool:
    """Where R and Q lead: ``state.target`` becomes abscissa and ordinate.

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
    state.target[0], state.target[1] = end
    registers[POLAR_RADIUS], registers[POLAR_ANGLE] = radius, angle
    return True


@compilable
def report(
    rows: Rows, state: State, before: int, line: int, kind: int, number: int, amount: float
) -> None:
    """Write an event."""
    at = state.event_count[0]
    event = rows.events[at]
    event[0], event[1], event[2], event[3] = before, line, kind, number
    rows.event_values[at] = amount
    state.event_count[0] = at + 1
