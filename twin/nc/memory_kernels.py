"""Variables of the compiled run, as the general way finds them in ``Variables``."""

import math

import numpy as np

from twin.nc.canonical import IntArray
from twin.nc.compile_kernels import kernel
from twin.nc.routine_state import Memory

NO_SLOT = np.iinfo(np.int64).min
"""No variable."""


@kernel
def slot_of_number(numbered: IntArray, index: float) -> int:
    """Slot of the variable with a number; ``NO_SLOT`` where it has none."""
    if not 0.0 <= index < len(numbered) or index != np.floor(index):
        return NO_SLOT
    if math.copysign(1.0, index) < 0.0:  # -0 is written otherwise than 0
        return NO_SLOT
    return numbered[int(index)]


@kernel
def own_value(memory: Memory, depth: int, slot: int) -> float:
    """What the program has given a variable; NaN: nothing."""
    return memory.common[slot] if slot >= 0 else memory.local[depth, ~slot]


@kernel
def load(memory: Memory, depth: int, slot: int) -> float:
    """Value of a variable, the job's where it has none of its own; NaN: none at all."""
    value = own_value(memory, depth, slot)
    if np.isnan(value):
        value = memory.given_common[slot] if slot >= 0 else memory.given_local[~slot]
    return value


@kernel
def store(memory: Memory, depth: int, slot: int, value: float) -> None:
    """Give a variable a value; NaN takes it away."""
    if slot >= 0:
        memory.common[slot] = value
    else:
        memory.local[depth, ~slot] = value
