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
    BAILOUT,
    IN_SPINDLE,
    INCREMENTAL,
    OFFSET_ON,
    PLANE,
    POLAR_ABSCISSA,
    POLAR_ANGLE,
    POLAR_ORDINATE,
    POLAR_RADIUS,
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
from twin.nc.geometry.planes import along, vector_of
from twin.nc.path.event_columns import DWELL, FUNCTION
from twin.nc.path.hole import Act
from twin.nc.path.moves import LARGEST_COORDINATE
from twin.nc.path.rows import Rows, copy
from twin.nc.text.arithmetic import is_whole

_LENGTH = SHIFTS.index("length")
_WAIT = int(Act.DWELL)


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
        How many values are left.
    """
    opcode, operand = instruction.opcode, instruction.operand
    if opcode == opcodes.FUNCTION:
        report_function(operand, block, on)
    elif opcode == opcodes.REPORT:
        top -= 1
        report(on.rows, on.state, block.made, block.line, operand, 0, stack[top])
    elif opcode == opcodes.TOOL_RADIUS:
        tool = _tool(on.constants, on.state.registers[IN_SPINDLE])
        stack[top] = on.constants.radii[tool]
        top += 1
    elif opcode == opcodes.COORDINATE:
        stack[top] = _in_plane(on.constants, on.state)[operand]
        top += 1
    else:
        top = _change_frame(instruction, stack, top, on)
    return top


@inlined
def use_register(
    instruction: Instruction, stack: Stack, top: int, block: BlockPlace, on: Affected
) -> int:
    """Run an instruction of registers, one from ``REGISTER`` to ``CHECK``; as ``run_effect``.

    Returns:
        How many values are left, or ``BAILOUT`` where a check does not hold.
    """
    opcode, operand = instruction.opcode, instruction.operand
    if opcode == opcodes.REGISTER:
        stack[top] = on.state.registers[operand]
        return top + 1
    if opcode == opcodes.SET_REGISTER:
        on.state.registers[operand] = stack[top - 1]
        return top - 1
    if opcode == opcodes.EMPTY_REGISTER:
        on.state.registers[operand] = np.nan
        return top
    if opcode == opcodes.TO_MILLIMETRES:
        stack[top - 1] *= on.state.modal[UNIT]
        return top
    value = stack[top - 1] if top > 0 else np.nan
    return top if _holds(instruction, value, block, on.constants) else BAILOUT


@inlined
def _holds(instruction: Instruction, value: float, block: BlockPlace, constants: Constants) -> bool:
    """Whether a check holds of a value."""
    check, bound = instruction.operand, instruction.immediate
    if check == opcodes.AT_LEAST:
        return value >= bound
    if check == opcodes.AT_MOST:
        return value <= bound
    if check == opcodes.WHOLE:
        return is_whole(value, bound)
    if check == opcodes.SIGN:
        return abs(value) == 1.0
    if check == opcodes.LISTED_TOOL:
        return _tool(constants, value) < len(constants.tools)
    if check == opcodes.UNCOMPENSATED:
        return not block.compensates
    return np.isnan(value) == (check == opcodes.ABSENT)


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
def _change_frame(instruction: Instruction, stack: Stack, top: int, on: Affected) -> int:
    """Lengths of tools, shifts, mirror, scale and rotation, and the plane; as ``run_effect``."""
    opcode, operand = instruction.opcode, instruction.operand
    state, registers = on.state, on.state.registers
    if opcode == opcodes.TOOL_LENGTH:
        state.shifts[_LENGTH, :] = 0.0
        if registers[OFFSET_ON] != 0.0:
            tool = _tool(on.constants, registers[IN_SPINDLE])
            state.shifts[_LENGTH, 2] = on.constants.longer[tool]
        reframe(state)
    elif opcode == opcodes.SHIFT:
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
    elif opcode == opcodes.TRANSFORM:
        transform(on.constants, state)
    else:
        state.modal[PLANE] = operand
        registers[POLAR_ABSCISSA] = registers[POLAR_ORDINATE] = 0.0
        registers[POLAR_RADIUS] = registers[POLAR_ANGLE] = np.nan
    return top


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
    axes = directions(constants, state.modal)
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
    old = polar.seen_from(origin, start, registers[POLAR_RADIUS], registers[POLAR_ANGLE])
    incremental, words = modal[INCREMENTAL] != 0.0, (radius_word * modal[UNIT], angle_word)
    radius, angle = polar.changed(seen, old, words, (incremental, incremental))
    if not (0.0 <= radius <= LARGEST_COORDINATE and abs(angle) <= LARGEST_COORDINATE):
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
