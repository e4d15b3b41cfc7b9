"""Instructions that compute, with the operators and functions of ``text/arithmetic`` by number.

A value that is undefined comes out as infinity or NaN, and stops the block before anything happens.
"""

import math
from collections.abc import Callable, Mapping

import numpy as np

from twin.compilation.compilable import compilable_choice, inlined
from twin.nc.bytecode import opcodes
from twin.nc.bytecode.bytecode import Instruction
from twin.nc.bytecode.frames import WORDS, Scratch, VariableStore
from twin.nc.bytecode.registers import BAILOUT
from twin.nc.bytecode.variables import NO_SLOT, assign, load, slot_of_number
from twin.nc.canonical import FloatArray, IntArray
from twin.nc.text import arithmetic
from twin.nc.text.expressions import LARGEST_NUMBER

_UNARY = (
    arithmetic.inverted_bits,
    arithmetic.sine_of_degrees,
    arithmetic.cosine_of_degrees,
    arithmetic.tangent_of_degrees,
    arithmetic.arc_sine_in_degrees,
    arithmetic.arc_cosine_in_degrees,
    arithmetic.arc_tangent_in_degrees,
    arithmetic.square,
    arithmetic.power_of_ten,
    arithmetic.whole_part,
    arithmetic.fraction,
    arithmetic.nearest_whole,
    arithmetic.next_whole,
    arithmetic.nearest_whole_away,
    arithmetic.whole_below,
    arithmetic.arc_sine_from_zero,
    arithmetic.whole_away,
    arithmetic.opposite,
    arithmetic.from_binary_decimal,
    arithmetic.to_binary_decimal,
    math.sin,
    math.cos,
    math.tan,
    math.asin,
    math.acos,
    math.atan,
    math.fabs,
    math.sqrt,
    math.exp,
    math.log,
    math.log10,
)
_BINARY = (
    arithmetic.add,
    arithmetic.subtract,
    arithmetic.multiply,
    arithmetic.divide,
    arithmetic.less,
    arithmetic.greater,
    arithmetic.at_most,
    arithmetic.at_least,
    arithmetic.equal,
    arithmetic.unequal,
    arithmetic.both,
    arithmetic.either,
    arithmetic.one_alone,
    arithmetic.bits_of_both,
    arithmetic.bits_of_either,
    arithmetic.bits_of_one_alone,
    arithmetic.direction_in_degrees,
    arithmetic.direction_of_quotient,
    arithmetic.nearly_equal,
    arithmetic.not_nearly_equal,
    arithmetic.positive_remainder,
    arithmetic.direction_from_zero,
    arithmetic.equal_or_vacant,
    arithmetic.unequal_or_vacant,
    arithmetic.remainder_of_wholes,
    arithmetic.smaller,
    arithmetic.larger,
    math.fmod,
    math.pow,
)
_TERNARY = (
    arithmetic.limited,
    arithmetic.chosen,
)

Numbers = Mapping[Callable[..., float], int]
UNARY_FUNCTIONS: Numbers = {function: number for number, function in enumerate(_UNARY)}
BINARY_FUNCTIONS: Numbers = {function: number for number, function in enumerate(_BINARY)}
TERNARY_FUNCTIONS: Numbers = {function: number for number, function in enumerate(_TERNARY)}
"""Functions of one, two and three values, by number."""

unary = compilable_choice(_UNARY)
binary = compilable_choice(_BINARY)
ternary = compilable_choice(_TERNARY)
"""The functions with these numbers; the number is the first argument."""


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
    elif opcode == opcodes.DEFINED:
        stack[top] = 0.0 if np.isnan(load(memory, depth, operand)) else 1.0
        top += 1
    elif opcode == opcodes.DROP:
        top -= 1
    return top
