"""What operators and functions of expressions compute, for every dialect. Truth is 1, falsehood 0.

The compiled tier compiles these functions as they stand here, so that it computes the same bits. Where a value is undefined Python raises ``ArithmeticError`` or
``ValueError``; the compiled ones give infinity or NaN there.
"""

import math
from collections.abc import Callable
from typing import cast

import numpy as np

from twin.compilation.compilable import compilable, compilable_as

LARGEST_WHOLE = 2.0**53
"""Whole numbers up to here are exact."""
SAME_NUMBER = 0.0001
"""RS274/NGC: numbers that differ by less are equal for EQ and NE (LinuxCNC)."""


@compilable
def is_whole(value: float, largest: float) -> bool:
    """Whether a value is a whole number from 0 to the largest."""
    return 0.0 <= value <= largest and value == int(value)


@compilable
def add(a: float, b: float) -> float:
    """The sum."""
    return a + b


@compilable
def subtract(a: float, b: float) -> float:
    """The difference."""
    return a - b


@compilable
def multiply(a: float, b: float) -> float:
    """The product."""
    return a * b


@compilable
def divide(a: float, b: float) -> float:
    """The quotient."""
    return a / b


@compilable
def less(a: float, b: float) -> float:
    """Whether ``a`` is below ``b``."""
    return 1.0 if a < b else 0.0


@compilable
def greater(a: float, b: float) -> float:
    """Whether ``a`` is above ``b``."""
    return 1.0 if a > b else 0.0


@compilable
def at_most(a: float, b: float) -> float:
    """Whether ``a`` is not above ``b``."""
    return 1.0 if a <= b else 0.0


@compilable
def at_least(a: float, b: float) -> float:
    """Whether ``a`` is not below ``b``."""
    return 1.0 if a >= b else 0.0


@compilable
def equal(a: float, b: float) -> float:
    """Whether they are the same number."""
    return 1.0 if a == b else 0.0


@compilable
def unequal(a: float, b: float) -> float:
    """Whether they are different numbers."""
    return 1.0 if a != b else 0.0


@compilable
def nearly_equal(a: float, b: float) -> float:
    """Whether they differ by less than ``SAME_NUMBER``."""
    return 1.0 if abs(a - b) < SAME_NUMBER else 0.0


@compilable
def not_nearly_equal(a: float, b: float) -> float:
    """Whether they differ by ``SAME_NUMBER`` or more."""
    return 0.0 if abs(a - b) < SAME_NUMBER else 1.0


@compilable
def positive_remainder(a: float, b: float) -> float:
    """The remainder of a division, never below 0."""
    rest = math.fmod(a, b)
    return rest + abs(b) if rest < 0.0 else rest


@compilable
def equal_or_vacant(a: float, b: float) -> float:
    """Whether they are the same number, or neither has a value (NaN)."""
    return 1.0 if a == b or (a != a and b != b) else 0.0


@compilable
def unequal_or_vacant(a: float, b: float) -> float:
    """Whether they are different numbers, or one of them has no value (NaN)."""
    return 0.0 if a == b or (a != a and b != b) else 1.0


@compilable
def remainder_of_wholes(a: float, b: float) -> float:
    """The remainder of a division of whole numbers, to which both are rounded."""
    return math.fmod(nearest_whole_away(a), nearest_whole_away(b))


@compilable
def _digits_elsewhere(a: float, old: float, new: float) -> float:
    """The number with the decimal digits that another has at a base, at a new one; infinite where it has others."""
    number, place, rest = 0.0, 1.0, a
    if not 0.0 <= a <= LARGEST_WHOLE or a != math.floor(a):
        return math.inf
    while rest > 0.0:
        digit = math.fmod(rest, old)
        if digit > 9.0:
            return math.inf
        number += digit * place
        place *= new
        rest = math.floor(rest / old)
    return number


def _from_binary_decimal(a: float) -> float:
    return _digits_elsewhere(a, 16.0, 10.0)


@compilable_as(_from_binary_decimal)
def from_binary_decimal(a: float) -> float:
    """The number whose decimal digits stand in four bits each."""
    return _defined(_from_binary_decimal(a))


def _to_binary_decimal(a: float) -> float:
    return _digits_elsewhere(a, 10.0, 16.0)


@compilable_as(_to_binary_decimal)
def to_binary_decimal(a: float) -> float:
    """A whole number with its decimal digits in four bits each."""
    return _defined(_to_binary_decimal(a))


def _defined(value: float) -> float:
    if math.isinf(value):
        raise ValueError(value)
    return value


@compilable
def both(a: float, b: float) -> float:
    """Whether both are true."""
    return 1.0 if a != 0.0 and b != 0.0 else 0.0


@compilable
def either(a: float, b: float) -> float:
    """Whether one of them is true."""
    return 1.0 if a != 0.0 or b != 0.0 else 0.0


@compilable
def one_alone(a: float, b: float) -> float:
    """Whether exactly one of them is true."""
    return 1.0 if (a != 0.0) != (b != 0.0) else 0.0


@compilable
def opposite(a: float) -> float:
    """Whether it is false."""
    return 1.0 if a == 0.0 else 0.0


@compilable
def bits_of_both(a: float, b: float) -> float:
    """The bits that both whole numbers have."""
    return float(int(a) & int(b))


@compilable
def bits_of_either(a: float, b: float) -> float:
    """The bits that one of the whole numbers has."""
    return float(int(a) | int(b))


@compilable
def bits_of_one_alone(a: float, b: float) -> float:
    """The bits that exactly one of the whole numbers has."""
    return float(int(a) ^ int(b))


@compilable
def inverted_bits(a: float) -> float:
    """A whole number with its bits inverted."""
    return float(~int(a))


@compilable
def sine_of_degrees(a: float) -> float:
    """Sine of an angle [deg]."""
    return math.sin(math.radians(a))


@compilable
def cosine_of_degrees(a: float) -> float:
    """Cosine of an angle [deg]."""
    return math.cos(math.radians(a))


@compilable
def tangent_of_degrees(a: float) -> float:
    """Tangent of an angle [deg]."""
    return math.tan(math.radians(a))


@compilable
def arc_sine_in_degrees(a: float) -> float:
    """The angle whose sine it is [deg]."""
    return math.degrees(math.asin(a))


@compilable
def arc_cosine_in_degrees(a: float) -> float:
    """The angle whose cosine it is [deg]."""
    return math.degrees(math.acos(a))


@compilable
def arc_tangent_in_degrees(a: float) -> float:
    """The angle whose tangent it is [deg]."""
    return math.degrees(math.atan(a))


@compilable
def direction_in_degrees(x: float, y: float) -> float:
    """The direction of a vector, from its components [deg]."""
    return math.degrees(math.atan2(y, x))


@compilable
def direction_of_quotient(y: float, x: float) -> float:
    """The direction of a vector, its ordinate first [deg]."""
    return math.degrees(math.atan2(y, x))


@compilable
def direction_from_zero(y: float, x: float) -> float:
    """The direction of a vector, its ordinate first, from 0 up to 360 [deg]."""
    angle = math.degrees(math.atan2(y, x))
    return angle + 360.0 if angle < 0.0 else angle


@compilable
def arc_sine_from_zero(a: float) -> float:
    """The angle whose sine it is, from 270 over 0 to 90 [deg]."""
    angle = math.degrees(math.asin(a))
    return angle + 360.0 if angle < 0.0 else angle


@compilable
def square(a: float) -> float:
    """The number times itself."""
    return a * a


@compilable
def power_of_ten(a: float) -> float:
    """Ten to this power."""
    return math.pow(10.0, a)


@compilable
def whole_part(a: float) -> float:
    """What stands before the point."""
    return float(math.trunc(a))


@compilable
def fraction(a: float) -> float:
    """What stands behind the point."""
    return a - math.trunc(a)


@compilable
def nearest_whole(a: float) -> float:
    """The nearest whole number; halves go up."""
    return float(math.floor(a + 0.5))


@compilable
def nearest_whole_away(a: float) -> float:
    """The nearest whole number; halves go away from 0."""
    return float(math.floor(a + 0.5)) if a >= 0.0 else float(math.ceil(a - 0.5))


@compilable
def whole_below(a: float) -> float:
    """The greatest whole number that is not above it."""
    return float(math.floor(a))


@compilable
def next_whole(a: float) -> float:
    """The least whole number that is not below it."""
    return float(math.ceil(a))


@compilable
def whole_away(a: float) -> float:
    """The nearest whole number that is not nearer to 0."""
    return float(math.ceil(a)) if a >= 0.0 else float(math.floor(a))


@compilable
def smaller(a: float, b: float) -> float:
    """The smaller of both."""
    return min(a, b)


@compilable
def larger(a: float, b: float) -> float:
    """The larger of both."""
    return max(a, b)


@compilable
def limited(low: float, a: float, high: float) -> float:
    """The number, or the bound that it passes."""
    above = max(low, a)
    return min(above, high)


@compilable
def chosen(choice: float, no: float, yes: float) -> float:
    """The last value where the choice is true, else the one before."""
    return yes if choice != 0.0 else no


def _remainder(a: float, b: float) -> float:
    """NumPy's remainder is as exact, and warns of a division by zero."""
    return np.fmod(a, b) if b != 0.0 else math.nan


compilable_as(cast("Callable[..., float]", _remainder))(math.fmod)
