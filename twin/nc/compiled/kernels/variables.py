"""Instructions of variables and words."""

import numpy as np

from twin.compilation.compilable import inlined
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.bytecode import Instruction
from twin.nc.bytecode.frames import STORES, WORDS, Scratch, VariableStore
from twin.nc.bytecode.registers import BAILOUT
from twin.nc.bytecode.variables import NO_SLOT, load, own_value, slot_of_number, store
from twin.nc.canonical import IntArray


@inlined
def use_variable(
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
        scratch: Values and words; takes what a variable held before.

    Returns:
        How many values there are then, or ``BAILOUT`` where a variable is not there.
    """
    opcode, slot, stack = instruction.opcode, instruction.operand, scratch.stack
    if opcode >= opcodes.WORD:
        top -= opcode == opcodes.WORD
        word = scratch.counts[WORDS]
        value = stack[top] if opcode == opcodes.WORD else instruction.immediate
        scratch.token_kinds[word], scratch.values[word] = instruction.operand, value
        scratch.counts[WORDS] = word + 1
        return top
    if opcode == opcodes.LOAD_NUMBERED or opcode == opcodes.STORE_NUMBERED:
        slot = slot_of_number(numbered, stack[top - (1 if opcode == opcodes.LOAD_NUMBERED else 2)])
        if slot == NO_SLOT:
            return BAILOUT
    if opcode <= opcodes.DEFINED:
        value = load(memory, depth, slot)
        if opcode == opcodes.DEFINED:
            value = 0.0 if np.isnan(value) else 1.0
        top -= opcode == opcodes.LOAD_NUMBERED
        stack[top] = value
        return BAILOUT if np.isnan(value) else top + 1
    before = own_value(memory, depth, slot)
    if opcode == opcodes.STORE_DECLARED and np.isnan(before):
        return BAILOUT
    stores = scratch.counts[STORES]
    scratch.slots[stores], scratch.before[stores] = slot, before
    scratch.counts[STORES] = stores + 1
    store(memory, depth, slot, stack[top - 1])
    return top - 1
