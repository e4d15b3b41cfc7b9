"""Variables of the compiled run, as the interpreter tier finds them in ``Variables``."""

import math

import numpy as np

from twin.compilation.compilable import compilable
from twin.nc.bytecode.bytecode import PART_BITS
from twin.nc.bytecode.frames import (
    AGAIN,
    BACK,
    CALLS,
    DEPTH,
    FIRST,
    LAST,
    LINE,
    NO_LOCATION,
    OWNS_SCOPE,
    PART,
    VariableStore,
)
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


_PART_MASK = (1 << PART_BITS) - 1


@compilable
def end_parts(progress: IntArray, calls: IntArray) -> None:
    """Parts that end by place and have been passed run again, or go back to their caller."""
    while progress[CALLS] > 0:
        call = calls[progress[CALLS] - 1]
        here = progress[LINE] << PART_BITS | progress[PART]
        if call[LAST] == NO_LOCATION or here <= call[LAST]:
            return
        to = call[FIRST]
        if call[AGAIN] > 0:
            call[AGAIN] -= 1
        else:
            to = call[BACK]
            progress[CALLS] -= 1
            progress[DEPTH] -= call[OWNS_SCOPE]
        progress[LINE], progress[PART] = to >> PART_BITS, to & _PART_MASK


@compilable
def innermost(calls: IntArray, called: int) -> int:
    """How many parts are being run up to the innermost that a word ends; 0: there is none."""
    while called > 0 and calls[called - 1, LAST] != NO_LOCATION:
        called -= 1
    return called
