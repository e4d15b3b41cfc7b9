"""What operators and functions of expressions compute, for every dialect. Truth is 1, falsehood 0.

Where a value is undefined they raise ``ArithmeticError`` or ``ValueError``.
"""

import math

from twin.compilation.compilable import compilable

LARGEST_WHOLE = 2.0**53
"""Whole numbers up to here are exact."""
SAME_NUMBER = 0.0001
"""RS274/NGC: numbers that differ by less are equal for EQ and NE (LinuxCNC)."""


@compilable
def is_whole(value: float, largest: float) -> bool:
    """Whether a value is a whole number from 0 to the largest."""
    return 0.0 <= value <= largest and value == int(value)


def add(a: float, b: float) -> float:
    """The sum."""
    return a + b


def subtract(a: float, b: float) -> float:
    """The difference."""
    return a - b


def multiply(a: float, b: float) -> float:
    """The product."""
    return a * b


def divide(a: float, b: float) -> float:
    """The quotient."""
    return a / b


def less(a: float, b: float) -> float:
    """Whether ``a`` is below ``b``."""
    return 1.0 if a < b else 0.0


def greater(a: float, b: float) -> float:
    """Whether ``a`` is above ``b``."""
    return 1.0 if a > b else 0.0


def at_most(a: float, b: float) -> float:
    """Whether ``a`` is not above ``b``."""
    return 1.0 if a <= b else 0.0


def at_least(a: float, b: float) -> float:
    """Whether ``a`` is not below ``b``."""
    return 1.0 if a >= b else 0.0


def equal(a: float, b: float) -> float:
    """Whether they are the same number."""
    return 1.0 if a == b else 0.0


def unequal(a: float, b: float) -> float:
    """Whether they are different numbers."""
    return 1.0 if a != b else 0.0


def nearly_equal(a: float, b: float) -> float:
    """Whether they differ by less than ``SAME_NUMBER``."""
    return 1.0 if abs(a - b) < SAME_NUMBER else 0.0


def not_nearly_equal(a: float, b: float) -> float:
    """Whether they differ by ``SAME_NUMBER`` or more."""
    return 0.0 if abs(a - b) < SAME_NUMBER else 1.0


def positive_remainder(a: float, b: float) -> float:
    """The remainder of a division, never below 0."""
    rest = math.fmod(a, b)
    return rest + abs(b) if rest < 0.0 else rest


def equal_or_vacant(a: float, b: float) -> float:
    """Whether they are the same number, or neither has a value (NaN)."""
    return 1.0 if a == b or (a != a and b != b) else 0.0


def unequal_or_vacant(a: float, b: float) -> float:
    """Whether they are different numbers, or one of them has no value (NaN)."""
    return 0.0 if a == b or (a != a and b != b) else 1.0


def remainder_of_wholes(a: float, b: float) -> float:
    """The remainder of a division of whole numbers, to which both are rounded."""
    return math.fmod(nearest_whole_away(a), nearest_whole_away(b))


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


def from_binary_decimal(a: float) -> float:
    """The number whose decimal digits are in four bits each."""
    return _defined(_digits_elsewhere(a, 16.0, 10.0))


def to_binary_decimal(a: float) -> float:
    """A whole number with its decimal digits in four bits each."""
    return _defined(_digits_elsewhere(a, 10.0, 16.0))


def _defined(value: float) -> float:
    if math.isinf(value):
        raise ValueError(value)
    return value


def both(a: float, b: float) -> float:
    """Whether both are true."""
    return 1.0 if a != 0.0 and b != 0.0 else 0.0


def either(a: float, b: float) -> float:
    """Whether one of them is true."""
    return 1.0 if a != 0.0 or b != 0.0 else 0.0


def one_alone(a: float, b: float) -> float:
    """Whether exactly one of them is true."""
    return 1.0 if (a != 0.0) != (b != 0.0) else 0.0


def opposite(a: float) -> float:
    """Whether it is false."""
    return 1.0 if a == 0.0 else 0.0


def bits_of_both(a: float, b: float) -> float:
    """The bits that both whole numbers have."""
    return float(int(a) & int(b))


def bits_of_either(a: float, b: float) -> float:
    """The bits that one of the whole numbers has."""
    return float(int(a) | int(b))


def bits_of_one_alone(a: float, b: float) -> float:
    """The bits that exactly one of the whole numbers has."""
    return float(int(a) ^ int(b))


def inverted_bits(a: float) -> float:
    """A whole number with its bits inverted."""
    return float(~int(a))


def sine_of_degrees(a: float) -> float:
    """Sine of an angle [deg]."""
    return math.sin(math.radians(a))


def cosine_of_degrees(a: float) -> float:
    """Cosine of an angle [deg]."""
    return math.cos(math.radians(a))


def tangent_of_degrees(a: float) -> float:
    """Tangent of an angle [deg]."""
    return math.tan(math.radians(a))


def arc_sine_in_degrees(a: float) -> float:
    """The angle whose sine it is [deg]."""
    return math.degrees(math.asin(a))


def arc_cosine_in_degrees(a: float) -> float:
    """The angle whose cosine it is [deg]."""
    return math.degrees(math.acos(a))


def arc_tangent_in_degrees(a: float) -> float:
    """The angle whose tangent it is [deg]."""
    return math.degrees(math.atan(a))


def direction_in_degrees(x: float, y: float) -> float:
    """The direction of a vector, from its components [deg]."""
    return math.degrees(math.atan2(y, x))


def direction_of_quotient(y: float, x: float) -> float:
    """The direction of a vector, its ordinate first [deg]."""
    return math.degrees(math.atan2(y, x))


def direction_from_zero(y: float, x: float) -> float:
    """The direction of a vector, its ordinate first, from 0 up to 360 [deg]."""
    angle = math.degrees(math.atan2(y, x))
    return angle + 360.0 if angle < 0.0 else angle


def arc_sine_from_zero(a: float) -> float:
    """The angle whose sine it is, from 270 over 0 to 90 [deg]."""
    angle = math.degrees(math.asin(a))
    return angle + 360.0 if angle < 0.0 else angle


def square(a: float) -> float:
    """The number times itself."""
    return a * a


def power_of_ten(a: float) -> float:
    """Ten to this power."""
    return math.pow(10.0, a)


def whole_part(a: float) -> float:
    """What is before the point."""
    return float(math.trunc(a))


def fraction(a: float) -> float:
    """What is behind the point."""
    return a - math.trunc(a)


def sign(a: float) -> float:
    """-1 below 0, 1 above it, else 0."""
    return float((a > 0.0) - (a < 0.0))


def nearest_whole(a: float) -> float:
    """The nearest whole number; halves go up."""
    return float(math.floor(a + 0.5))


def nearest_whole_away(a: float) -> float:
    """The nearest whole number; halves go away from 0."""
    return float(math.floor(a + 0.5)) if a >= 0.0 else float(math.ceil(a - 0.5))


def whole_below(a: float) -> float:
    """The greatest whole number that is not above it."""
    return float(math.floor(a))


def next_whole(a: float) -> float:
    """The least whole number that is not below it."""
    return float(math.ceil(a))


def whole_away(a: float) -> float:
    """The nearest whole number that is not nearer to 0."""
    return float(math.ceil(a)) if a >= 0.0 else float(math.floor(a))


def smaller(a: float, b: float) -> float:
    """The smaller of both."""
    return min(a, b)


def larger(a: float, b: float) -> float:
    """The larger of both."""
    return max(a, b)


def limited(low: float, a: float, high: float) -> float:
    """The number, or the bound that it passes."""
    above = max(low, a)
    return min(above, high)


def chosen(choice: float, no: float, yes: float) -> float:
    """The last value where the choice is true, else the one before."""
    return yes if choice != 0.0 else no
