"""What the passes hand each other: the path ahead, a state on it, and a brake."""

from typing import NamedTuple

from twin.nc.canonical import FloatArray


class PathAhead(NamedTuple):
    """n segments of the path ahead.

    Attributes:
        limits: Rows length, velocity, acceleration, deceleration, jerk, shape (5, n).
        entry: Highest v at each border, shape (n + 1,).
        controllable: Highest v at each border from which, with a = 0, there is a brake (rows of
            ``backward_pass``), shape (n + 1,).
    """

    limits: FloatArray
    entry: FloatArray
    controllable: FloatArray


class State(NamedTuple):
    """A state on the path.

    Attributes:
        x: Place within it [mm or deg].
        v: Velocity [mm/s or deg/s].
        a: Acceleration [mm/s² or deg/s²].
    """

    segment: int
    x: float
    v: float
    a: float


class Brake(NamedTuple):
    """A brake that ends at a border at the latest, with a = 0.

    Attributes:
        velocity: At its end [mm/s or deg/s].
        deceleration: Highest -a [mm/s² or deg/s²].
        jerk: Highest abs(j) [mm/s³ or deg/s³].
    """

    border: int
    velocity: float
    deceleration: float
    jerk: float
