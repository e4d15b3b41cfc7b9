"""What blocks do besides moving and computing, compiled: events, tools, shifts of coordinates, polar moves.

Each does what ``opcodes`` says of it; the state is kept before the first of a block.
"""

from typing import NamedTuple

import numpy as np

from twin.compilation.compilable import compilable
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.bytecode import Instruction
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
    SPINDLE_TURNS,
    UNIT,
    Constants,
    Machine,
    State,
)
from twin.nc.canonical import FloatArray
from twin.nc.compiled.kernels.frame import add_up, reframe, to_part, transform
from twin.nc.control.control import LARGEST_COORDINATE
from twin.nc.functions import turns_behind
from twin.nc.geometry import polar
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
from twin.nc.path.rows import Rows, copy

_NO_EVENT = -1
_PECKING = Cycle._fields.index("pecking")
_LENGTH = SHIFTS.index("length")
LARGEST_TOOL, LARGEST_AUXILIARY = 1e6, 999_999.0
"""Numbers of tools and of auxiliary functions above these are left to the interpreter tier."""


class BlockPlace(NamedTuple):
    """Where the block of an instruction stands.

    Attributes:
        line: Its line, from 1.
        made: Moves that were made before it.
        compensates: Radius compensation is in force.
    """

    line: int
    made: int
    compensates: bool


@compilable
def run_effect(
    instruction: Instruction, stack: FloatArray, top: int, block: BlockPlace, machine: Machine
) -> int:
    """Run one instruction.

    Args:
        instruction: One from ``ACTIVATE`` on.
        stack: Values.
        top: How many there are.
        block: Whose it is.
        machine: What it runs on.

    Returns:
        How many values are left, or ``BAILOUT``.
    """
    opcode, operand = instruction.opcode, instruction.operand
    if opcode == opcodes.ACTIVATE:
        machine.state.active_codes[machine.tables.group[operand]] = operand
        return top
    if opcode <= opcodes.DWELL:
        return _report_effect(instruction, stack, top, block, machine)
    if opcode <= opcodes.PROGRAMMED_RADIUS:
        return _use_tool(instruction, stack, top, machine)
    if opcode <= opcodes.TO_MILLIMETRES:
        return _shift_coordinates(instruction, stack, top, machine)
    if opcode <= opcodes.FORGET_POLAR:
        return _choose_plane(instruction, stack, top, block, machine)
    if opcode <= opcodes.CYCLE_WORD:
        return _prepare_cycle(instruction, stack, top, machine)
    return _transform(instruction, stack, top, block, machine)


@compilable
def _report_effect(
    instruction: Instruction, stack: FloatArray, top: int, block: BlockPlace, machine: Machine
) -> int:
    """Functions, speeds, tools and dwells, which are reported; as ``run_effect``."""
    opcode, operand = instruction.opcode, instruction.operand
    registers, constants = machine.state.registers, machine.constants
    value = stack[top - 1] if top > 0 else 0.0
    kind, number, amount = FUNCTION_ALONE, operand, np.nan
    if opcode in (opcodes.FUNCTION, opcodes.SPINDLE_FUNCTION):
        registers[SPINDLE_TURNS] = turns_behind(operand, registers[SPINDLE_TURNS])
    if opcode == opcodes.SPINDLE_FUNCTION:
        kind, amount = FUNCTION_WITH_SPEED, registers[SPINDLE]
    elif opcode == opcodes.SPEED:
        if value < 0.0:
            return BAILOUT
        registers[SPINDLE] = value
        kind, amount = SPEED if operand else _NO_EVENT, value
        top -= 1
    elif opcode == opcodes.TOOL:
        if not is_whole(value, LARGEST_TOOL):
            return BAILOUT
        if operand and len(constants.tools) > 0 and _tool(constants, value) == BAILOUT:
            return BAILOUT
        registers[SELECTED] = value
        kind, number = TOOL, int(value)
        top -= 1
    elif opcode == opcodes.AUXILIARY:
        if not is_whole(value, LARGEST_AUXILIARY):
            return BAILOUT
        kind, number = AUXILIARY, int(value)
        top -= 1
    elif opcode == opcodes.DWELL:
        if value < 0.0:
            return BAILOUT
        kind, amount = DWELL, value
        top -= 1
    if kind != _NO_EVENT:
        report(machine.rows, machine.state, block.made, block.line, kind, number, amount)
    return top


@compilable
def _use_tool(instruction: Instruction, stack: FloatArray, top: int, machine: Machine) -> int:
    """The tool in use, its length and its radius; as ``run_effect``."""
    opcode, operand = instruction.opcode, instruction.operand
    state, constants = machine.state, machine.constants
    registers = state.registers
    if opcode == opcodes.CHANGE_TOOL:
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
    elif opcode == opcodes.TOOL_RADIUS:
        tool = _tool(constants, registers[IN_SPINDLE])
        if tool == BAILOUT:
            return BAILOUT
        offset = operand == 0 or registers[OFFSET_ON] != 0.0
        stack[top] = constants.radii[tool] if offset else 0.0
        top += 1
    elif operand:
        registers[RADIUS_GIVEN] = stack[top - 1] * state.modal[UNIT]
        stack[top - 1] = registers[RADIUS_GIVEN]
    else:
        stack[top] = registers[RADIUS_GIVEN]
        top += 1
    return top


@compilable
def _shift_coordinates(
    instruction: Instruction, stack: FloatArray, top: int, machine: Machine
) -> int:
    """Shifts, and other coordinates for the present position; as ``run_effect``."""
    opcode, operand = instruction.opcode, instruction.operand
    state = machine.state
    if opcode == opcodes.SHIFT:
        top -= len(state.part)
        for axis in range(len(state.part)):
            state.shifts[operand, axis] = stack[top + axis]
    elif opcode == opcodes.REFRAME:
        reframe(state)
    elif opcode == opcodes.BEGIN_TARGET:
        copy(state.programmed, state.target)
    elif opcode == opcodes.TARGET:
        top -= 1
        state.target[operand] = stack[top]
    elif opcode == opcodes.SET_POSITION:
        here = machine.constants.over
        to_part(state.target, state, here)
        for axis in range(len(state.part)):
            shift = state.shifts[operand, axis]
            state.shifts[operand, axis] = shift + state.part[axis] - here[axis]
            state.programmed[axis] = state.target[axis]
        add_up(state)
    else:
        unit = state.modal[UNIT] if machine.tables.linear[operand] else 1.0
        stack[top - 1] *= unit
    return top


@compilable
def _choose_plane(
    instruction: Instruction, stack: FloatArray, top: int, block: BlockPlace, machine: Machine
) -> int:
    """The plane, and what polar coordinates refer to; as ``run_effect``."""
    opcode, operand = instruction.opcode, instruction.operand
    state = machine.state
    registers = state.registers
    if opcode == opcodes.PLANE:
        doubtful = np.isnan(registers[POLAR_ABSCISSA]) or not np.isnan(registers[ROTATION])
        if block.compensates or doubtful:
            return BAILOUT
        state.modal[PLANE] = operand
        registers[POLAR_ABSCISSA] = registers[POLAR_ORDINATE] = 0.0
    elif opcode == opcodes.POLAR_ORIGIN:
        if np.isnan(registers[POLAR_ABSCISSA]):
            return BAILOUT
        plane, unit = machine.constants.planes[int(state.modal[PLANE])], state.modal[UNIT]
        abscissa, ordinate = _along(state.programmed, plane[0]), _along(state.programmed, plane[1])
        if operand:
            abscissa, ordinate = stack[top - 2] * unit, stack[top - 1] * unit
        registers[POLAR_ABSCISSA], registers[POLAR_ORDINATE] = abscissa, ordinate
        top -= operand
    registers[POLAR_RADIUS] = registers[POLAR_ANGLE] = np.nan
    return top


@compilable
def _prepare_cycle(instruction: Instruction, stack: FloatArray, top: int, machine: Machine) -> int:
    """Words of drilling cycles; as ``run_effect``."""
    opcode, operand = instruction.opcode, instruction.operand
    state = machine.state
    if opcode == opcodes.NO_PECKS:
        pecks = machine.tables.cycles[int(state.modal[CYCLE]), _PECKING] != 0.0
        return BAILOUT if pecks else top
    top -= 1
    state.registers[CYCLE_WORDS + operand] = stack[top]
    return top


@compilable
def _transform(
    instruction: Instruction, stack: FloatArray, top: int, block: BlockPlace, machine: Machine
) -> int:
    """Mirror, scale and rotation; as ``run_effect``."""
    opcode, operand = instruction.opcode, instruction.operand
    state = machine.state
    registers, unit = state.registers, state.modal[UNIT]
    if opcode == opcodes.MIRROR:
        top -= 1
        if abs(stack[top]) != 1.0:
            return BAILOUT
        registers[SIGNS + operand] = stack[top]
    elif opcode == opcodes.SCALE:
        top -= 1
        if not SMALLEST_SCALE <= stack[top] <= LARGEST_SCALE:
            return BAILOUT
        registers[SCALE] = stack[top]
    elif opcode == opcodes.ROTATE:
        if not np.isnan(registers[ROTATION]):
            return BAILOUT
        top -= 3
        registers[ROTATION] = stack[top]
        registers[ROTATION_ABSCISSA] = stack[top + 1] * unit
        registers[ROTATION_ORDINATE] = stack[top + 2] * unit
    elif opcode == opcodes.END_ROTATION:
        registers[ROTATION] = np.nan
    else:
        if block.compensates:
            return BAILOUT
        transform(machine.constants, state)
    return top


@compilable
def is_whole(value: float, largest: float) -> bool:
    """Whether a value is a whole number from 0 to the largest."""
    return 0.0 <= value <= largest and value == np.floor(value)


@compilable
def _tool(constants: Constants, number: float) -> int:
    """Row of a tool that the job lists, or ``BAILOUT``."""
    for tool in range(len(constants.tools)):
        if constants.tools[tool] == number:
            return tool
    return BAILOUT


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
    radius, angle = polar.seen_from(origin, start, registers[POLAR_RADIUS], registers[POLAR_ANGLE])
    incremental = modal[INCREMENTAL] != 0.0
    if seen & 1:
        radius = polar.changed(radius, radius_word * modal[UNIT], incremental)
        if not 0.0 <= radius <= LARGEST_COORDINATE:
            return False
    if seen & 2:
        angle = polar.changed(angle, angle_word, incremental)
        if not abs(angle) <= LARGEST_COORDINATE:
            return False
    state.target[0], state.target[1] = polar.point_at(origin, start, radius, angle)
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
