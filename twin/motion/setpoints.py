"""Setpoints: where each axis shall be at each tick of the servo clock."""

import dataclasses

import numpy as np

from twin.nc.canonical import FloatArray, IntArray


@dataclasses.dataclass(frozen=True, slots=True)
class Setpoints:
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

    def __len__(self) -> int:
        return len(self.time)

    def __getitem__(self, index: slice) -> "Setpoints":
        """A run of samples, as columns again."""
        return Setpoints(*(getattr(self, field.name)[index] for field in dataclasses.fields(self)))


def join(chunks: list[Setpoints]) -> Setpoints:
    """Join consecutive chunks; for tests and short programs.

    Raises:
        ValueError: There are no chunks to join.
    """
    if not chunks:
        raise ValueError("no chunks to join")
    names = [field.name for field in dataclasses.fields(Setpoints)]
    return Setpoints(*(np.concatenate([getattr(c, name) for c in chunks]) for name in names))
