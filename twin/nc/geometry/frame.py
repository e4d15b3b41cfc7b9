"""From programmed coordinates to the part's: offsets, presets, turns, mirror, rotation, scale."""

import operator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.compilation.compilable import compilable, inlined
from twin.nc.geometry.arcs import Point
from twin.nc.geometry.matrices import (
    IDENTITY,
    Matrix,
    applied,
    handedness,
    inverse,
    product,
    rotated,
    stretched,
    turned_unit,
)
from twin.nc.geometry.planes import Directions, Plane, Vector, along, cross, world

FloatArray = npt.NDArray[np.float64]
Values = list[float] | FloatArray

SHIFTS = ("offset", "preset", "length", "increment", "rotation", "turns")
"""Every shift, in the order in which they are added."""


SHIFTS_OF_ZERO = ("offset", "preset", "increment")
"""Those that say where the zero of an axis is; turns of a table and of the plane do not."""


@compilable
def to_part(matrix: Matrix, total: Values, place: Vector) -> Vector:
    """Part coordinates of a point of X, Y, Z: mirrored, scaled and rotated, then shifted."""
    x, y, z = applied(matrix, place)
    return (x + total[0], y + total[1], z + total[2])


def to_programmed(matrix: Matrix, total: Values, part: Vector) -> Vector:
    """The inverse of ``to_part``."""
    shifted = (part[0] - total[0], part[1] - total[1], part[2] - total[2])
    return applied(inverse(matrix), shifted)


def plane_of_part(matrix: Matrix, plane: Directions) -> Directions:
    """The directions of a working plane as the part sees them."""
    normal, abscissa = turned_unit(matrix, plane[2]), turned_unit(matrix, plane[0])
    return (abscissa, cross(normal, abscissa), normal)


class Arc(NamedTuple):
    """An arc in space.

    Attributes:
        center: At the height of its start [mm].
        normal: Unit vector that it turns about.
        sweep: Signed angle with all turns [deg].
    """

    center: Vector
    normal: Vector
    sweep: float


@inlined
def arc_about(plane: Directions, start: Values, center: Point, sweep: float) -> Arc:
    """The arc of a plane that begins at a position, shape (k,), about a centre."""
    height = along((start[0], start[1], start[2]), plane[2])
    return Arc(world(plane, center, height), plane[2], sweep)


@inlined
def arc_of_part(arc: Arc, matrix: Matrix, total: Values, turned: bool) -> Arc:
    """A programmed arc as the part sees it; a mirror reverses the sense."""
    if turned:
        return _turned_arc(arc, matrix, total)
    x, y, z = arc.center
    return Arc((x + total[0], y + total[1], z + total[2]), arc.normal, arc.sweep)


@compilable
def _turned_arc(arc: Arc, matrix: Matrix, total: Values) -> Arc:
    center, sweep = to_part(matrix, total, arc.center), arc.sweep * handedness(matrix)
    return Arc(center, turned_unit(matrix, arc.normal), sweep)


def composed(
    signs: Vector, scale: float, plane: Directions, rotation: float, center: Point
) -> tuple[Matrix, Vector]:
    """Scale, then mirror, then a rotation in the working plane.

    Args:
        signs: -1 for each of X, Y and Z that is mirrored.
        scale: Of all three.
        plane: Abscissa, ordinate and normal.
        rotation: Its angle, NaN for none [deg].
        center: Abscissa and ordinate of its centre [mm].

    Returns:
        The matrix of all, and the shift that comes after it.
    """
    matrix, shift = stretched(signs, scale), (0.0, 0.0, 0.0)
    if rotation == rotation:
        matrix, shift = rotated(matrix, plane, rotation, center)
    return matrix, shift


def chained(outer: tuple[Matrix, Vector], inner: tuple[Matrix, Vector]) -> tuple[Matrix, Vector]:
    """Two maps, each a matrix and the shift that comes after it, one after the other."""
    matrix, shift = outer
    x, y, z = applied(matrix, inner[1])
    return product(matrix, inner[0]), (x + shift[0], y + shift[1], z + shift[2])


def moved_shift(shift: float, part: float, there: float) -> float:
    """A shift of an axis that gives the place where it is other programmed coordinates.

    Args:
        part: Where the axis is in part coordinates.
        there: Where it would stand with its new coordinates and the shift as it was.
    """
    return shift + part - there


class Frame:
    """``part = matrix · programmed + shift`` for X, Y, Z; further axes are shifted only.

    The shift is the sum of named ones (a work offset, a preset, whole turns of a rotary axis), so
    that each can be changed without knowing of the others.

    Attributes:
        total: Sum of all shifts, shape (k,) [mm or deg].
        matrix: Mirror, rotation and scale of X, Y, Z.
        screen: The inverse of the matrix; None where it is the identity.
    """

    def __init__(self, axes: int) -> None:
        """Programmed coordinates are those of the part; for so many axes."""
        self._shifts: dict[str, list[float]] = {name: [0.0] * axes for name in SHIFTS}
        self.total = [0.0] * axes
        self.matrix: Matrix = IDENTITY
        self.is_identity = True
        self.screen: Matrix | None = None

    def shift(self, name: str) -> list[float]:
        """The named shift, shape (k,)."""
        return list(self._shifts[name])

    def set_shift(self, name: str, values: list[float]) -> None:
        """Replace the named shift."""
        self._shifts[name] = list(values)
        self._add_up()

    @property
    def shifts(self) -> list[list[float]]:
        """All of them in the order of ``SHIFTS``, shape (s, k)."""
        return [self.shift(name) for name in SHIFTS]

    def zero(self) -> list[float]:
        """Where the work offset puts the zeros of the axes, part coordinates, shape (k,) [mm or deg]."""
        return list(map(sum, zip(*(self._shifts[name] for name in SHIFTS_OF_ZERO), strict=True)))

    def set_shifts(self, shifts: list[list[float]]) -> None:
        """Replace all of them, in this order."""
        self._shifts = {name: list(each) for name, each in zip(SHIFTS, shifts, strict=True)}
        self._add_up()

    def _add_up(self) -> None:
        """From the first to the last: the order of a sum is part of its value."""
        total = [0.0] * len(self.total)
        for shift in self._shifts.values():
            total = list(map(operator.add, total, shift))
        self.total = total

    def set_matrix(self, matrix: Matrix) -> None:
        """Replace mirror, rotation and scale."""
        self.matrix = matrix
        self.is_identity = matrix == IDENTITY
        self.screen = None if self.is_identity else inverse(matrix)

    def to_part(self, programmed: list[float]) -> list[float]:
        """Part coordinates of a programmed position, shape (k,)."""
        if self.is_identity:
            return list(map(operator.add, programmed, self.total))
        others = zip(programmed[3:], self.total[3:], strict=True)
        place = to_part(self.matrix, self.total, (programmed[0], programmed[1], programmed[2]))
        return [*place, *(value + shift for value, shift in others)]

    def to_programmed(self, part: list[float]) -> list[float]:
        """The inverse of ``to_part``."""
        values = list(map(operator.sub, part, self.total))
        if self.is_identity:
            return values
        place = (part[0], part[1], part[2])
        return [*to_programmed(self.matrix, self.total, place), *values[3:]]

    def unturn(self, vector: Vector) -> Vector:
        """A direction of the part's X, Y, Z as it is programmed."""
        return vector if self.is_identity else applied(inverse(self.matrix), vector)

    def arc(self, arc: Arc) -> Arc:
        """A programmed arc as the part sees it."""
        return arc_of_part(arc, self.matrix, self.total, not self.is_identity)

    def plane(self, plane: Plane) -> Plane:
        """A working plane as the part sees it."""
        if self.is_identity:
            return plane
        return Plane(plane.name, *plane_of_part(self.matrix, plane.directions))
