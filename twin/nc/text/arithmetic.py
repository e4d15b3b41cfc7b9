"""What operators and functions of expressions compute, for every dialect. Truth is 1, falsehood 0.

The compiled tier (``expression_kernels``) compiles these functions as they stand here, so that it
computes the same bits. Where a value is undefined Python raises ``ArithmeticError`` or
``ValueError``; the compiled ones give infinity or NaN there.
"""

import math


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


def square(a: float) -> float:
    """The number times itself."""
    return a * a


def power_of_ten(a: float) -> float:
    """Ten to this power."""
    return math.pow(10.0, a)


def whole_part(a: float) -> float:
    """What stands before the point."""
    return float(math.trunc(a))


def fraction(a: float) -> float:
    """What stands behind the point."""
    return a - math.trunc(a)


def nearest_whole(a: float) -> float:
    """The nearest whole number; halves go up."""
    return float(math.floor(a + 0.5))


def next_whole(a: float) -> float:
    """The least whole number that is not below it."""
    return float(math.ceil(a))


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
