"""Variables of the compiled run, as the interpreter tier finds them in ``Variables``."""

import math

import numpy as np

from twin.compilation.compilable import compilable, inlined
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.bytecode import Instruction
from twin.nc.bytecode.frames import STORES, Scratch, VariableStore
from twin.nc.canonical import IntArray

NO_SLOT = np.iinfo(np.int64).min
"""No variable."""


@compilable
def slot_of_number(numbered: IntArray, index: float) -> int:
    """Slot of the variable with a number; ``NO_SLOT`` where it has none."""
    if not 0.0 <= index < len(numbered) or index != np.floor(index):
        return NO_SLOT
    if math.copysign(1.0, index) < 0.0:  # -0 is written otherwise than 0
        return NO_SLOT
    return numbered[int(index)]


@compilable
def own_value(memory: VariableStore, depth: int, slot: int) -> float:
    """What the program has given a variable; NaN: nothing."""
    return memory.common[slot] if slot >= 0 else memory.local[depth, ~slot]


@compilable
def load(memory: VariableStore, depth: int, slot: int) -> float:
    """Value of a variable, the job's where it has none of its own; NaN: none at all."""
    value = own_value(memory, depth, slot)
    if np.isnan(value):
        value = memory.given_common[slot] if slot >= 0 else memory.given_local[~slot]
    return value


@compilable
def store(memory: VariableStore, depth: int, slot: int, value: float) -> None:
    """Give a variable a value; NaN takes it away."""
    if slot >= 0:
        memory.common[slot] = value
    else:
        memory.local[depth, ~slot] = value


@inlined
def assign(
    instruction: Instruction,
    top: int,
    depth: int,
    numbered: IntArray,
    memory: VariableStore,
    scratch: Scratch,
) -> bool:
    """Run one of the instructions that store the topmost value.

    Args:
        instruction: One from ``STORE`` to ``STORE_NUMBERED``.
        top: How many values there are.
        depth: Row of the local variables.
        numbered: Slots of the variables that have a number.
        memory: The variables.
        scratch: The values; takes what the variable held before.

    Returns:
        Whether there is such a variable.
    """
    slot = instruction.operand
    if instruction.opcode == opcodes.STORE_NUMBERED:
        slot = slot_of_number(numbered, scratch.stack[top - 2])
        if slot == NO_SLOT:
            return False
    before = own_value(memory, depth, slot)
    if instruction.opcode == opcodes.STORE_DECLARED and np.isnan(before):
        return False
    stores = scratch.counts[STORES]
    scratch.slots[stores], scratch.before[stores] = slot, before
    scratch.counts[STORES] = stores + 1
    store(memory, depth, slot, scratch.stack[top - 1])
    return True


@inlined
def undo_stores(depth: int, memory: VariableStore, scratch: Scratch) -> None:
    """Give the variables that a block has set their values before it."""
    for change in range(scratch.counts[STORES] - 1, -1, -1):
        store(memory, depth, scratch.slots[change], scratch.before[change])
