"""Instructions that jump, count loops and call."""

from typing import NamedTuple

import numpy as np

from twin.compilation.compilable import inlined
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.bytecode import Instruction
from twin.nc.bytecode.frames import (
    AGAIN,
    BACK,
    BLOCKS,
    CALLS,
    CODES_RESTORED,
    DEPTH,
    FIRST,
    FURTHEST,
    LAST,
    NO_LOCATION,
    NOTHING_RESTORED,
    OWNS_SCOPE,
    RESTORES,
    VariableStore,
    go_to,
    innermost,
)
from twin.nc.bytecode.registers import BAILOUT
from twin.nc.bytecode.variables import own_value, store
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.path.rows import copy

Stack = list[float] | FloatArray


class Transfer(NamedTuple):
    """Where a block leads.

    Attributes:
        going: The location that comes next.
        behind: The location behind the block.
        depth: Row of the local variables then.
        called: Parts that are being run for a caller then.
        range_end: Where the range ends that is repeated next, or ``NO_LOCATION``.
        owns_scope: The part that is called next has local variables of its own.
        restores: What its end puts back into force; behind ``RETURN``: what the end of the part does.
        ends: The block ends, whatever it says behind.
    """

    going: int
    behind: int
    depth: int
    called: int
    range_end: int
    owns_scope: int
    restores: int
    ends: bool


@inlined
def straight_on(progress: IntArray, behind: int) -> Transfer:
    """To the block behind, which begins at this location."""
    return Transfer(
        behind, behind, progress[DEPTH], progress[CALLS], NO_LOCATION, 0, NOTHING_RESTORED, False
    )


@inlined
def going_to(location: int, to: Transfer) -> Transfer:
    """Let another location come next."""
    return Transfer(
        location, to.behind, to.depth, to.called, to.range_end, to.owns_scope, to.restores, True
    )


@inlined
def arrive(to: Transfer, here: int, progress: IntArray) -> None:
    """The block at a location has ended: the program has come to where it leads."""
    progress[FURTHEST] = max(progress[FURTHEST], here)
    go_to(to.going, progress)
    progress[DEPTH], progress[CALLS] = to.depth, to.called
    progress[BLOCKS] += 1


@inlined
def jumps(instruction: Instruction, stack: Stack, top: int) -> bool:
    """Whether a jump is taken, given how many values there are."""
    if instruction.opcode == opcodes.JUMP:
        return True
    if instruction.opcode == opcodes.JUMP_CASE:
        return stack[top - 1] == stack[top - 2]
    return (stack[top - 1] != 0.0) == (instruction.opcode == opcodes.JUMP_IF)


@inlined
def count_loop(
    instruction: Instruction, stack: Stack, top: int, depth: int, memory: VariableStore
) -> int:
    """Run one of the instructions of counted loops.

    Args:
        instruction: One from ``BEGIN_FOR`` to ``COUNT_DOWN``.
        stack: Values.
        top: How many there are.
        depth: Row of the local variables.
        memory: The variables.

    Returns:
        How many values there are then, or ``BAILOUT`` for a step of 0.
    """
    if instruction.opcode == opcodes.BEGIN_FOR:
        first, last, width = stack[top - 3], stack[top - 2], stack[top - 1]
        if width == 0.0:
            return BAILOUT
        stack[top - 3] = 1.0 if (first - last) * width > 0.0 else 0.0
        stack[top - 2] = first
        return top - 1
    if instruction.opcode == opcodes.STEP_FOR:
        last, width = stack[top - 3], stack[top - 2]
        if width == 0.0:
            return BAILOUT
        value = stack[top - 1] + width
        stack[top - 4] = 1.0 if (value - last) * width <= 0.0 else 0.0
        stack[top - 3] = value
        return top - 2
    left = own_value(memory, depth, instruction.operand)
    if np.isnan(left):
        left = instruction.immediate
    store(memory, depth, instruction.operand, np.nan if left == 0.0 else left - 1.0)
    stack[top] = 0.0 if left == 0.0 else 1.0
    return top + 1


@inlined
def transfer(
    instruction: Instruction, value: float, to: Transfer, calls: IntArray, local: FloatArray
) -> tuple[bool, Transfer]:
    """Run one of the instructions that call parts of the program or go back.

    Args:
        instruction: One from ``CHECK_CALL`` to ``RETURN``.
        value: The topmost value.
        to: Where the block leads so far.
        calls: The parts that are being run; written to.
        local: Local variables of all calls.

    Returns:
        Whether nothing about it is wrong, and where the block leads.
    """
    opcode, operand = instruction.opcode, instruction.operand
    going, depth, called = to.going, to.depth, to.called
    range_end, owns_scope, restores = to.range_end, to.owns_scope, to.restores
    known, ends = True, False
    if opcode == opcodes.CHECK_CALL:
        known = called < min(operand, len(calls)) and depth + 1 < len(local)
    elif opcode == opcodes.OWN_VARIABLES:
        depth += 1
        owns_scope = 1
        local[depth, :] = np.nan
    elif opcode == opcodes.RESTORE_CODES:
        restores = CODES_RESTORED
    elif opcode == opcodes.RANGE:
        range_end = operand
    elif opcode == opcodes.CHECK_RETURN:
        known = innermost(calls, called) > 0
    elif opcode == opcodes.RETURN:
        called, ends = innermost(calls, called) - 1, True
        if calls[called, AGAIN] > 0:
            calls[called, AGAIN] -= 1
            going, restores = calls[called, FIRST], NOTHING_RESTORED
            called += 1
        else:
            depth -= calls[called, OWNS_SCOPE]
            going = calls[called, BACK]
            restores = calls[called, RESTORES]
    else:
        again = value - 1.0 if opcode == opcodes.REPEAT else 0.0
        known = again >= 0.0 and again == np.floor(again)
        if known:
            call = calls[called]
            call[BACK], call[FIRST], call[AGAIN] = to.behind, operand, int(again)
            call[LAST], call[OWNS_SCOPE], call[RESTORES] = range_end, owns_scope, restores
            called += 1
            going, ends = operand, True
    return known, Transfer(going, to.behind, depth, called, range_end, owns_scope, restores, ends)


@inlined
def keep_codes(opcode: int, to: Transfer, modal: FloatArray, saved: FloatArray) -> None:
    """Save what is in force at a call whose end restores it, and put it back at that end.

    Args:
        opcode: The instruction that has run.
        to: Where it leads.
        modal: What is in force, shape (m,).
        saved: Of each call, shape (``MOST_CALLS``, m).
    """
    if to.restores == CODES_RESTORED and opcode == opcodes.RETURN:
        copy(saved[to.called], modal)
    elif to.restores == CODES_RESTORED and opcodes.CALL <= opcode <= opcodes.REPEAT:
        copy(modal, saved[to.called - 1])
