"""Setpoints: where each axis shall be at each tick of the servo clock."""

import dataclasses

from twin.columns import Columns
from twin.nc.canonical import FloatArray, IntArray


@dataclasses.dataclass(frozen=True, slots=True)
class Setpoints(Columns):
    """A chunk of n setpoints over k axes, as columns.

    Positions are machine coordinates (part coordinates plus part zero), continuous. Consecutive
    chunks go on without a gap: the first sample of a chunk is one period after the last of the
    chunk before, and the program's first sample is at time 0.

    Attributes:
        time: Shape (n,) [s]: sample number times the servo period.
        line: Source line that the sample belongs to, 0 before the first, shape (n,).
        move: Number of the move in the whole program, from 0; -1 before the first, shape (n,).
        fraction: How much of the move's path lies behind, 0 to 1, shape (n,).
        position: Shape (n, k) [mm or deg].
        velocity: Shape (n, k) [mm/s or deg/s].
        acceleration: Shape (n, k) [mm/s² or deg/s²].
    """

    time: FloatArray
    line: IntArray
    move: IntArray
    fraction: FloatArray
    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
