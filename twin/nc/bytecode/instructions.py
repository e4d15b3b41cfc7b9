"""Runs the instructions that both tiers run alike: those from ``CONSTANT`` on."""

from typing import NamedTuple

from twin.compilation.compilable import inlined
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.bytecode import Instruction
from twin.nc.bytecode.effects import Affected, BlockPlace, run_effect, use_register
from twin.nc.bytecode.expressions import compute_value
from twin.nc.bytecode.flow import Stack, Transfer, count_loop, going_to, jumps, transfer
from twin.nc.bytecode.frames import VariableStore
from twin.nc.bytecode.registers import BAILOUT
from twin.nc.canonical import IntArray


class Surroundings(NamedTuple):
    """Where an instruction is run.

    Attributes:
        memory: The program's variables.
        calls: The parts that are being run.
        block: Whose it is.
        on: What effects change.
    """

    memory: VariableStore
    calls: IntArray
    block: BlockPlace
    on: Affected


@inlined
def run_instruction(
    instruction: Instruction, stack: Stack, top: int, to: Transfer, around: Surroundings
) -> tuple[int, Transfer]:
    """Run one instruction, by its kind.

    Args:
        instruction: One from ``CONSTANT`` on.
        stack: Values.
        top: How many there are.
        to: Where the block leads so far.
        around: Where it is run.

    Returns:
        How many values there are then, below 0 where something is wrong; and where the block leads.
    """
    opcode, memory = instruction.opcode, around.memory
    if opcode <= opcodes.DROP:
        return compute_value(instruction, stack, top), to
    if opcode >= opcodes.FUNCTION:
        return run_effect(instruction, stack, top, around.block, around.on), to
    if opcode >= opcodes.REGISTER:
        return use_register(instruction, stack, top, around.block, around.on), to
    if opcode >= opcodes.CHECK_CALL:
        known, to = transfer(instruction, stack[top - 1], to, around.calls, memory.local)
        return top if known else BAILOUT, to
    if opcode >= opcodes.BEGIN_FOR:
        return count_loop(instruction, stack, top, to.depth, memory), to
    if jumps(instruction, stack, top):
        to = going_to(instruction.operand, to)
    return top if opcode == opcodes.JUMP else top - 1, to
