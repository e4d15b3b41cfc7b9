"""What blocks do besides moving and computing: events, tools, shifts of coordinates, polar moves.

Each does what ``opcodes`` says of it, for both tiers. What is wrong comes back as a number below 0.
"""

from typing import NamedTuple

import numpy as np

from twin.compilation.compilable import compilable, inlined
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.bytecode import Instruction
from twin.nc.bytecode.coordinates import directions, reframe, to_part, transform
from twin.nc.bytecode.flow import Stack
from twin.nc.bytecode.registers import (
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
    State,
)
from twin.nc.functions import starts_spindle, turns_behind
from twin.nc.geometry import polar
from twin.nc.geometry.arcs import Point
from twin.nc.geometry.frame import SHIFTS, add_up
from twin.nc.geometry.matrices import LARGEST_SCALE, SMALLEST_SCALE
from twin.nc.geometry.planes import along, vector_of
from twin.nc.path.event_columns import (
    AUXILIARY,
    DWELL,
    FUNCTION,
    SPEED,
    TOOL,
)
from twin.nc.path.hole import Act
from twin.nc.path.moves import LARGEST_COORDINATE
from twin.nc.path.rows import Rows, copy
from twin.nc.text.arithmetic import is_whole
from twin.nc.text.expressions import LARGEST_NUMBER

(
    NEGATIVE_SPEED,
    NO_TOOL_NUMBER,
    UNKNOWN_TOOL,
    NO_TOOL,
    OTHER_AUXILIARY,
    NEGATIVE_DWELL,
    PLANE_COMPENSATED,
    PLANE_ROTATED,
    MIRROR_SIGN,
    SCALE_RANGE,
    ROTATED_ALREADY,
    TRANSFORM_COMPENSATED,
) = range(-110, -98)
"""What is wrong with an instruction."""
_NO_EVENT = -1
_LENGTH = SHIFTS.index("length")
_WAIT = int(Act.DWELL)
LARGEST_TOOL, LARGEST_AUXILIARY = LARGEST_NUMBER, 999_999.0
"""Numbers of tools and of auxiliary functions that an event can hold."""


class Affected(NamedTuple):
    """What effects change, and what they look up.

    Attributes:
        constants: What stays.
        state: What changes.
        rows: Room for events.
    """

    constants: Constants
    state: State
    rows: Rows


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
    instruction: Instruction, stack: Stack, top: int, block: BlockPlace, on: Affected
) -> int:
    """Run one instruction.

    Args:
        instruction: One from ``FUNCTION`` on.
        stack: Values.
        top: How many there are.
        block: Whose it is.
        on: What it runs on.

    Returns:
        How many values are left, or what is wrong.
    """
    opcode = instruction.opcode
    if opcode <= opcodes.DWELL:
        return _report_effect(instruction, stack, top, block, on)
    if opcode <= opcodes.PROGRAMMED_RADIUS:
        return _use_tool(instruction, stack, top, on)
    if opcode <= opcodes.TO_MILLIMETRES:
        return _shift_coordinates(instruction, stack, top, on)
    if opcode <= opcodes.FORGET_POLAR:
        return _choose_plane(instruction, stack, top, block, on)
    if opcode == opcodes.CYCLE_WORD:
        on.state.registers[CYCLE_WORDS + instruction.operand] = stack[top - 1]
        return top - 1
    return _transform(instruction, stack, top, block, on)


@compilable
def _report_effect(
    instruction: Instruction, stack: Stack, top: int, block: BlockPlace, on: Affected
) -> int:
    """Functions, speeds, tools and dwells, which are reported; as ``run_effect``."""
    opcode, operand = instruction.opcode, instruction.operand
    registers, constants = on.state.registers, on.constants
    value = stack[top - 1] if top > 0 else 0.0
    kind, number, amount = _NO_EVENT, operand, np.nan
    if opcode == opcodes.FUNCTION:
        report_function(operand, block, on)
    elif opcode == opcodes.SPEED:
        if value < 0.0:
            return NEGATIVE_SPEED
        registers[SPINDLE] = value
        kind, amount = SPEED if operand else _NO_EVENT, value
        top -= 1
    elif opcode == opcodes.TOOL:
        if not is_whole(value, LARGEST_TOOL):
            return NO_TOOL_NUMBER
        if operand and not _is_listed(constants, value):
            return UNKNOWN_TOOL
        registers[SELECTED] = value
        kind, number = TOOL, int(value)
        top -= 1
    elif opcode == opcodes.AUXILIARY:
        if not is_whole(value, LARGEST_AUXILIARY):
            return OTHER_AUXILIARY
        kind, number = AUXILIARY, int(value)
        top -= 1
    elif opcode == opcodes.DWELL:
        if value < 0.0:
            return NEGATIVE_DWELL
        kind, amount = DWELL, value
        top -= 1
    if kind != _NO_EVENT:
        report(on.rows, on.state, block.made, block.line, kind, number, amount)
    return top


@compilable
def report_function(function: int, block: BlockPlace, on: Affected) -> None:
    """An M function that does nothing to the path; a start of the spindle bears its speed."""
    registers = on.state.registers
    registers[SPINDLE_TURNS] = turns_behind(function, registers[SPINDLE_TURNS])
    speed = _speed_with(function, on)
    report(on.rows, on.state, block.made, block.line, FUNCTION, function, speed)


@compilable
def _speed_with(function: int, on: Affected) -> float:
    return on.state.registers[SPINDLE] if starts_spindle(function) else np.nan


@inlined
def report_act(act: int, amount: float, block: BlockPlace, on: Affected) -> None:
    """What happens at a hole and is no move: a dwell [s], or an M function of the spindle."""
    kind, value = FUNCTION, _speed_with(act, on)
    if act == _WAIT:
        kind, value = DWELL, amount
    report(on.rows, on.state, block.made, block.line, kind, act, value)


@compilable
def _use_tool(instruction: Instruction, stack: Stack, top: int, on: Affected) -> int:
    """The tool in use, its length and its radius; as ``run_effect``."""
    opcode, operand = instruction.opcode, instruction.operand
    state, constants = on.state, on.constants
    registers = state.registers
    if opcode == opcodes.CHANGE_TOOL:
        registers[IN_SPINDLE] = registers[SELECTED]
    elif opcode == opcodes.OFFSET_ON:
        registers[OFFSET_ON] = operand
    elif opcode == opcodes.TOOL_LENGTH:
        longer = 0.0
        if registers[OFFSET_ON] != 0.0:
            longer = constants.longer[_tool(constants, registers[IN_SPINDLE])]
        state.shifts[_LENGTH, :] = 0.0
        state.shifts[_LENGTH, 2] = longer
        reframe(state)
    elif opcode == opcodes.TOOL_RADIUS:
        radius = constants.radii[_tool(constants, registers[IN_SPINDLE])]
        if np.isnan(radius):
            return NO_TOOL
        offset = operand == 0 or registers[OFFSET_ON] != 0.0
        stack[top] = radius if offset else 0.0
        top += 1
    elif operand:
        registers[RADIUS_GIVEN] = stack[top - 1] * state.modal[UNIT]
        stack[top - 1] = registers[RADIUS_GIVEN]
    else:
        stack[top] = registers[RADIUS_GIVEN]
        top += 1
    return top


@compilable
def _shift_coordinates(instruction: Instruction, stack: Stack, top: int, on: Affected) -> int:
    """Shifts, and other coordinates for the present position; as ``run_effect``."""
    opcode, operand = instruction.opcode, instruction.operand
    state = on.state
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
        here = on.constants.over
        to_part(state.target, state, here)
        for axis in range(len(state.part)):
            shift = state.shifts[operand, axis]
            state.shifts[operand, axis] = shift + state.part[axis] - here[axis]
            state.programmed[axis] = state.target[axis]
        add_up(state.shifts, state.total)
    else:
        unit = state.modal[UNIT] if on.constants.linear[operand] else 1.0
        stack[top - 1] *= unit
    return top


@compilable
def _choose_plane(
    instruction: Instruction, stack: Stack, top: int, block: BlockPlace, on: Affected
) -> int:
    """The plane, and what polar coordinates refer to; as ``run_effect``."""
    opcode, operand = instruction.opcode, instruction.operand
    state = on.state
    registers = state.registers
    if opcode == opcodes.PLANE:
        if block.compensates:
            return PLANE_COMPENSATED
        if not np.isnan(registers[ROTATION]):
            return PLANE_ROTATED
        state.modal[PLANE] = operand
        registers[POLAR_ABSCISSA] = registers[POLAR_ORDINATE] = 0.0
    elif opcode == opcodes.POLAR_ORIGIN:
        unit = state.modal[UNIT]
        abscissa, ordinate = _in_plane(on.constants, state)
        if operand:
            abscissa, ordinate = stack[top - 2] * unit, stack[top - 1] * unit
        registers[POLAR_ABSCISSA], registers[POLAR_ORDINATE] = abscissa, ordinate
        top -= operand
    registers[POLAR_RADIUS] = registers[POLAR_ANGLE] = np.nan
    return top


@compilable
def _transform(
    instruction: Instruction, stack: Stack, top: int, block: BlockPlace, on: Affected
) -> int:
    """Mirror, scale and rotation; as ``run_effect``."""
    opcode, operand = instruction.opcode, instruction.operand
    state = on.state
    registers, unit = state.registers, state.modal[UNIT]
    if opcode == opcodes.MIRROR:
        top -= 1
        if abs(stack[top]) != 1.0:
            return MIRROR_SIGN
        registers[SIGNS + operand] = stack[top]
    elif opcode == opcodes.SCALE:
        top -= 1
        if not SMALLEST_SCALE <= stack[top] <= LARGEST_SCALE:
            return SCALE_RANGE
        registers[SCALE] = stack[top]
    elif opcode == opcodes.ROTATE:
        if not np.isnan(registers[ROTATION]):
            return ROTATED_ALREADY
        top -= 3
        registers[ROTATION] = stack[top]
        registers[ROTATION_ABSCISSA] = stack[top + 1] * unit
        registers[ROTATION_ORDINATE] = stack[top + 2] * unit
    elif opcode == opcodes.END_ROTATION:
        registers[ROTATION] = np.nan
    else:
        if block.compensates:
            return TRANSFORM_COMPENSATED
        transform(on.constants, state)
    return top


@compilable
def _is_listed(constants: Constants, number: float) -> bool:
    """Whether the job lists a tool."""
    return _tool(constants, number) < len(constants.tools)


@compilable
def _tool(constants: Constants, number: float) -> int:
    """Row of a tool; the last for those that the job does not list."""
    for tool in range(len(constants.tools)):
        if constants.tools[tool] == number:
            return tool
    return len(constants.tools)


@compilable
def _in_plane(constants: Constants, state: State) -> Point:
    """Abscissa and ordinate of where the control stands."""
    axes = directions(constants, int(state.modal[PLANE]))
    here = vector_of(state.programmed)
    return (along(here, axes[0]), along(here, axes[1]))


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
    origin = (registers[POLAR_ABSCISSA], registers[POLAR_ORDINATE])
    start = _in_plane(constants, state)
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
