"""Operators and functions of expressions by number, compiled as they stand in ``arithmetic``.

A value that is undefined comes out as infinity or NaN, and stops the block before anything happens.
"""

import math
from collections.abc import Callable, Mapping

import numpy as np

from twin.compilation.compilable import compilable_arithmetic, inlined
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.bytecode import Instruction
from twin.nc.bytecode.frames import WORDS, Scratch, VariableStore
from twin.nc.bytecode.registers import BAILOUT
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.compiled.kernels.variables import NO_SLOT, assign, load, slot_of_number
from twin.nc.text import arithmetic
from twin.nc.text.expressions import LARGEST_NUMBER

UNARY_FUNCTIONS: Mapping[Callable[..., float], int] = {
    arithmetic.inverted_bits: 0,
    arithmetic.sine_of_degrees: 1,
    arithmetic.cosine_of_degrees: 2,
    arithmetic.tangent_of_degrees: 3,
    arithmetic.arc_sine_in_degrees: 4,
    arithmetic.arc_cosine_in_degrees: 5,
    arithmetic.arc_tangent_in_degrees: 6,
    arithmetic.square: 7,
    arithmetic.power_of_ten: 8,
    arithmetic.whole_part: 9,
    arithmetic.fraction: 10,
    arithmetic.nearest_whole: 11,
    arithmetic.next_whole: 12,
    arithmetic.opposite: 13,
    math.sin: 14,
    math.cos: 15,
    math.tan: 16,
    math.asin: 17,
    math.acos: 18,
    math.atan: 19,
    math.fabs: 20,
    math.sqrt: 21,
    math.exp: 22,
    math.log: 23,
    math.log10: 24,
}
"""Functions of one value, by number."""
BINARY_FUNCTIONS: Mapping[Callable[..., float], int] = {
    arithmetic.add: 0,
    arithmetic.subtract: 1,
    arithmetic.multiply: 2,
    arithmetic.divide: 3,
    arithmetic.less: 4,
    arithmetic.greater: 5,
    arithmetic.at_most: 6,
    arithmetic.at_least: 7,
    arithmetic.equal: 8,
    arithmetic.unequal: 9,
    arithmetic.both: 10,
    arithmetic.either: 11,
    arithmetic.one_alone: 12,
    arithmetic.bits_of_both: 13,
    arithmetic.bits_of_either: 14,
    arithmetic.bits_of_one_alone: 15,
    arithmetic.direction_in_degrees: 16,
    arithmetic.smaller: 17,
    arithmetic.larger: 18,
    math.fmod: 19,
    math.pow: 20,
}
"""Functions of two values."""
TERNARY_FUNCTIONS: Mapping[Callable[..., float], int] = {
    arithmetic.limited: 0,
    arithmetic.chosen: 1,
}
"""Functions of three values."""


@compilable_arithmetic
def unary(function: int, a: float) -> float:
    """The function of ``UNARY_FUNCTIONS`` with this number."""
    if function == 0:
        return arithmetic.inverted_bits(a)
    if function == 1:
        return arithmetic.sine_of_degrees(a)
    if function == 2:
        return arithmetic.cosine_of_degrees(a)
    if function == 3:
        return arithmetic.tangent_of_degrees(a)
    if function == 4:
        return arithmetic.arc_sine_in_degrees(a)
    if function == 5:
        return arithmetic.arc_cosine_in_degrees(a)
    if function == 6:
        return arithmetic.arc_tangent_in_degrees(a)
    if function == 7:
        return arithmetic.square(a)
    if function == 8:
        return arithmetic.power_of_ten(a)
    if function == 9:
        return arithmetic.whole_part(a)
    if function == 10:
        return arithmetic.fraction(a)
    if function == 11:
        return arithmetic.nearest_whole(a)
    if function == 12:
        return arithmetic.next_whole(a)
    if function == 13:
        return arithmetic.opposite(a)
    if function == 14:
        return math.sin(a)
    if function == 15:
        return math.cos(a)
    if function == 16:
        return math.tan(a)
    if function == 17:
        return math.asin(a)
    if function == 18:
        return math.acos(a)
    if function == 19:
        return math.atan(a)
    if function == 20:
        return math.fabs(a)
    if function == 21:
        return math.sqrt(a)
    if function == 22:
        return math.exp(a)
    if function == 23:
        return math.log(a)
    return math.log10(a)


@compilable_arithmetic
def binary(function: int, a: float, b: float) -> float:
    """The function of ``BINARY_FUNCTIONS`` with this number."""
    if function == 0:
        return arithmetic.add(a, b)
    if function == 1:
        return arithmetic.subtract(a, b)
    if function == 2:
        return arithmetic.multiply(a, b)
    if function == 3:
        return arithmetic.divide(a, b)
    if function == 4:
        return arithmetic.less(a, b)
    if function == 5:
        return arithmetic.greater(a, b)
    if function == 6:
        return arithmetic.at_most(a, b)
    if function == 7:
        return arithmetic.at_least(a, b)
    if function == 8:
        return arithmetic.equal(a, b)
    if function == 9:
        return arithmetic.unequal(a, b)
    if function == 10:
        return arithmetic.both(a, b)
    if function == 11:
        return arithmetic.either(a, b)
    if function == 12:
        return arithmetic.one_alone(a, b)
    if function == 13:
        return arithmetic.bits_of_both(a, b)
    if function == 14:
        return arithmetic.bits_of_either(a, b)
    if function == 15:
        return arithmetic.bits_of_one_alone(a, b)
    if function == 16:
        return arithmetic.direction_in_degrees(a, b)
    if function == 17:
        return arithmetic.smaller(a, b)
    if function == 18:
        return arithmetic.larger(a, b)
    if function == 19:
        # NumPy warns of a remainder by zero; its own is exact, as that of math, which Numba lacks.
        return np.fmod(a, b) if b != 0.0 else math.nan
    return math.pow(a, b)


@compilable_arithmetic
def ternary(function: int, a: float, b: float, c: float) -> float:
    """The function of ``TERNARY_FUNCTIONS`` with this number."""
    if function == 0:
        return arithmetic.limited(a, b, c)
    return arithmetic.chosen(a, b, c)


@inlined
def compute(
    instruction: Instruction,
    top: int,
    depth: int,
    numbered: IntArray,
    memory: VariableStore,
    scratch: Scratch,
) -> int:
    """Run an instruction that fills stack, variables or words.

    Args:
        instruction: One from ``CONSTANT`` to ``WORD_CONSTANT``.
        top: How many values there are.
        depth: Row of the local variables.
        numbered: Slots of the variables that have a number.
        memory: The variables.
        scratch: Values and words.

    Returns:
        How many values there are then, or ``BAILOUT`` where one is undefined.
    """
    opcode, words = instruction.opcode, scratch.counts[WORDS]
    if opcode <= opcodes.DROP:
        return _evaluate(instruction, scratch.stack, top, depth, numbered, memory)
    if opcode <= opcodes.STORE_NUMBERED:
        return top - 1 if assign(instruction, top, depth, numbered, memory, scratch) else BAILOUT
    value = instruction.immediate
    if opcode == opcodes.WORD:
        top -= 1
        value = scratch.stack[top]
    scratch.token_kinds[words], scratch.values[words] = instruction.operand, value
    scratch.counts[WORDS] = words + 1
    return top


@inlined
def _evaluate(
    instruction: Instruction,
    stack: FloatArray,
    top: int,
    depth: int,
    numbered: IntArray,
    memory: VariableStore,
) -> int:
    """Run an instruction that does nothing but compute.

    Args:
        instruction: One from ``CONSTANT`` to ``DROP``.
        stack: Values.
        top: How many there are.
        depth: Row of the local variables.
        numbered: Slots of the variables that have a number.
        memory: The variables.

    Returns:
        How many values there are then, or ``BAILOUT`` where one is undefined.
    """
    opcode, operand = instruction.opcode, instruction.operand
    if opcode == opcodes.CONSTANT:
        stack[top] = instruction.immediate
        top += 1
    elif opcode == opcodes.LOAD:
        value = load(memory, depth, operand)
        if np.isnan(value):
            return BAILOUT
        stack[top] = value
        top += 1
    elif opcode == opcodes.BINARY:
        top -= 1
        value = binary(operand, stack[top - 1], stack[top])
        if not abs(value) <= LARGEST_NUMBER:
            return BAILOUT
        stack[top - 1] = value
    elif opcode == opcodes.UNARY:
        value = unary(operand, stack[top - 1])
        if not abs(value) <= LARGEST_NUMBER:
            return BAILOUT
        stack[top - 1] = value
    elif opcode == opcodes.TERNARY:
        top -= 2
        value = ternary(operand, stack[top - 1], stack[top], stack[top + 1])
        if not abs(value) <= LARGEST_NUMBER:
            return BAILOUT
        stack[top - 1] = value
    elif opcode == opcodes.NEGATE:
        stack[top - 1] = -stack[top - 1]
    elif opcode == opcodes.LOAD_NUMBERED:
        slot = slot_of_number(numbered, stack[top - 1])
        value = np.nan if slot == NO_SLOT else load(memory, depth, slot)
        if np.isnan(value):
            return BAILOUT
        stack[top - 1] = value
    elif opcode in (opcodes.LOAD_BELOW, opcodes.LOAD_NUMBERED_BELOW):
        slot = operand
        if opcode == opcodes.LOAD_NUMBERED_BELOW:
            slot = slot_of_number(numbered, stack[top - 2])
        value = np.nan if slot == NO_SLOT else load(memory, depth, slot)
        if np.isnan(value):
            return BAILOUT
        stack[top] = stack[top - 1]
        stack[top - 1] = value
        top += 1
    elif opcode == opcodes.DEFINED:
        stack[top] = 0.0 if np.isnan(load(memory, depth, operand)) else 1.0
        top += 1
    elif opcode == opcodes.DROP:
        top -= 1
    return top
