"""From programmed coordinates to the part's: offsets, presets, turns, mirror, rotation, scale."""

from collections.abc import Iterable

from twin.nc.geometry.matrices import (
    IDENTITY,
    Matrix,
    applied,
    handedness,
    inverse,
    turned_unit,
)
from twin.nc.geometry.planes import Vector

SHIFTS = ("offset", "preset", "length", "increment", "rotation", "turns")
"""Every shift, in the order in which they are added."""


class Frame:
    """``part = matrix · programmed + shift`` for X, Y, Z; further axes are shifted only.

    The shift is the sum of named ones (a work offset, a preset, whole turns of a rotary axis), so
    that each can be changed without knowing of the others.
    """

    def __init__(self, axis_count: int) -> None:
        self._shifts: dict[str, list[float]] = {name: [0.0] * axis_count for name in SHIFTS}
        self.total = [0.0] * axis_count
        """Sum of all shifts, shape (k,) [mm or deg]."""
        self.matrix = IDENTITY
        """Mirror, rotation and scale of X, Y, Z."""
        self.is_identity = True
        """The matrix is the identity."""

    def shift(self, name: str) -> list[float]:
        """The named shift, shape (k,)."""
        return list(self._shifts[name])

    def set_shift(self, name: str, values: list[float]) -> None:
        """Replace the named shift."""
        self._shifts[name] = values
        self.total = [added(each) for each in zip(*self._shifts.values(), strict=True)]

    @property
    def shifts(self) -> list[list[float]]:
        """All of them in the order of ``SHIFTS``, shape (s, k)."""
        return list(self._shifts.values())

    def set_shifts(self, shifts: list[list[float]]) -> None:
        """Replace all of them, in this order."""
        self._shifts = dict(zip(SHIFTS, shifts, strict=True))
        self.total = [added(each) for each in zip(*shifts, strict=True)]

    def set_matrix(self, matrix: Matrix) -> None:
        """Replace mirror, rotation and scale."""
        self.matrix = matrix
        self.is_identity = matrix == IDENTITY

    def to_part(self, programmed: list[float]) -> list[float]:
        """Part coordinates of a programmed position, shape (k,)."""
        if self.is_identity:
            return [value + shift for value, shift in zip(programmed, self.total, strict=True)]
        turned = [*self.turn((programmed[0], programmed[1], programmed[2])), *programmed[3:]]
        return [value + shift for value, shift in zip(turned, self.total, strict=True)]

    def to_programmed(self, part: list[float]) -> list[float]:
        """The inverse of ``to_part``."""
        values = [value - shift for value, shift in zip(part, self.total, strict=True)]
        if self.is_identity:
            return values
        return [*applied(inverse(self.matrix), (values[0], values[1], values[2])), *values[3:]]

    def point(self, programmed: Vector) -> Vector:
        """Part coordinates of a point of X, Y, Z."""
        x, y, z = programmed if self.is_identity else self.turn(programmed)
        return (x + self.total[0], y + self.total[1], z + self.total[2])

    def turn(self, vector: Vector) -> Vector:
        """A direction of X, Y, Z as the part sees it."""
        return applied(self.matrix, vector)

    def unturn(self, vector: Vector) -> Vector:
        """The inverse of ``turn``."""
        return vector if self.is_identity else applied(inverse(self.matrix), vector)

    @property
    def handedness(self) -> float:
        """-1 where the matrix mirrors, else 1."""
        return 1.0 if self.is_identity else handedness(self.matrix)

    def arc(self, normal: Vector, sweep: float) -> tuple[Vector, float]:
        """Normal and sweep of an arc as the part sees them; a mirror reverses the sense."""
        if self.is_identity:
            return normal, sweep
        return turned_unit(self.matrix, normal), sweep * self.handedness


def added(values: Iterable[float]) -> float:
    """The sum from left to right: Python's own has more digits from version to version."""
    total = 0.0
    for value in values:
        total += value
    return total
