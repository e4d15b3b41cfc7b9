"""Instructions of variables and words."""

import numpy as np

from twin.compilation.compilable import inlined
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.bytecode import Instruction
from twin.nc.bytecode.frames import WORDS, Scratch, VariableStore
from twin.nc.bytecode.registers import BAILOUT
from twin.nc.bytecode.variables import NO_SLOT, assign, load, slot_of_number
from twin.nc.canonical import IntArray


@inlined
def compute(
    instruction: Instruction,
    top: int,
    depth: int,
    numbered: IntArray,
    memory: VariableStore,
    scratch: Scratch,
) -> int:
    """Run an instruction of variables or words.

    Args:
        instruction: One from ``LOAD`` to ``WORD_CONSTANT``.
        top: How many values there are.
        depth: Row of the local variables.
        numbered: Slots of the variables that have a number.
        memory: The variables.
        scratch: Values and words.

    Returns:
        How many values there are then, or below 0 where one is undefined.
    """
    opcode, stack, words = instruction.opcode, scratch.stack, scratch.counts[WORDS]
    if opcode == opcodes.LOAD or opcode == opcodes.LOAD_NUMBERED:
        slot = instruction.operand
        if opcode == opcodes.LOAD_NUMBERED:
            top -= 1
            slot = slot_of_number(numbered, stack[top])
        value = np.nan if slot == NO_SLOT else load(memory, depth, slot)
        stack[top] = value
        return BAILOUT if np.isnan(value) else top + 1
    if opcode == opcodes.DEFINED:
        stack[top] = 0.0 if np.isnan(load(memory, depth, instruction.operand)) else 1.0
        return top + 1
    if opcode <= opcodes.STORE_NUMBERED:
        return top - 1 if assign(instruction, top, depth, numbered, memory, scratch) else BAILOUT
    value = instruction.immediate
    if opcode == opcodes.WORD:
        top -= 1
        value = stack[top]
    scratch.token_kinds[words], scratch.values[words] = instruction.operand, value
    scratch.counts[WORDS] = words + 1
    return top
