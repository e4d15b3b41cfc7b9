"""What operators and functions of expressions compute, for every dialect. Truth is 1, falsehood 0.

Where a value is undefined they raise ``ArithmeticError`` or ``ValueError``.
"""

import math

from twin.compilation.compilable import compilable

LARGEST_WHOLE = 2.0**53
"""Whole numbers up to here are exact."""


@compilable
def is_whole(value: float, largest: float) -> bool:
    """Whether a value is a whole number from 0 to the largest."""
    return 0.0 <= value <= largest and value == int(value)


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


def bits_of_both(a: float, b: float) -> float:
    """The bits that both whole numbers have."""
    return float(int(a) & int(b))


def bits_of_either(a: float, b: float) -> float:
    """The bits that one of the whole numbers has."""
    return float(int(a) | int(b))


def bits_of_one_alone(a: float, b: float) -> float:
    """The bits that exactly one of the whole numbers has."""
    return float(int(a) ^ int(b))


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


def fraction(a: float) -> float:
    """What is behind the point."""
    return a - math.trunc(a)


def nearest_whole_away(a: float) -> float:
    """The nearest whole number; halves go away from 0."""
    return float(math.floor(a + 0.5)) if a >= 0.0 else float(math.ceil(a - 0.5))


def limited(low: float, a: float, high: float) -> float:
    """The number, or the bound that it passes."""
    above = max(low, a)
    return min(above, high)
