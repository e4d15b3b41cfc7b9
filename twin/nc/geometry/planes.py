"""Working planes: the two directions in which arcs are drawn, and the one they turn about."""

import dataclasses
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.compilation.compilable import compilable

Vector = tuple[float, float, float]
Column = list[float] | npt.NDArray[np.float64]
Directions = tuple[Vector, Vector, Vector]
"""Abscissa, ordinate and normal of a plane."""


@compilable
def vector_of(column: Sequence[float] | npt.NDArray[np.float64]) -> Vector:
    """The first three of a column's numbers."""
    return (float(column[0]), float(column[1]), float(column[2]))


@compilable
def along(point: Vector, direction: Vector) -> float:
    """A coordinate of a point, the sign of zero included."""
    return direction[0] * point[0] + direction[1] * point[1] + direction[2] * point[2]


@compilable
def point_of(plane: Directions, point: Vector) -> tuple[float, float]:
    """Abscissa and ordinate of a point."""
    return (along(point, plane[0]), along(point, plane[1]))


@compilable
def world(plane: Directions, point: tuple[float, float], height: float) -> Vector:
    """The point of X, Y and Z that a plane sees at an abscissa, an ordinate and a height."""
    a, o, n = plane
    return (
        a[0] * point[0] + o[0] * point[1] + n[0] * height,
        a[1] * point[0] + o[1] * point[1] + n[1] * height,
        a[2] * point[0] + o[2] * point[1] + n[2] * height,
    )


def put_point(plane: Directions, point: tuple[float, float], height: float, target: Column) -> None:
    """Put that point into the first places of a column."""
    target[0], target[1], target[2] = world(plane, point, height)


def aim(plane: Directions, point: tuple[float, float], target: Column) -> None:
    """Let a position, shape (k,), have another abscissa and ordinate in a plane, at its own height."""
    put_point(plane, point, along((target[0], target[1], target[2]), plane[2]), target)


class Local(NamedTuple):
    """A point as a plane sees it [mm]."""

    abscissa: float
    ordinate: float
    height: float


@dataclasses.dataclass(frozen=True, slots=True)
class Plane:
    """A right-handed frame of unit vectors: abscissa x ordinate = normal.

    Attributes:
        name: As the programmer calls it; ``OWN_PLANE`` where the program has chosen the directions.
        abscissa: Direction of angle 0.
        ordinate: Direction of angle 90.
        normal: Axis that positive arcs turn about counter-clockwise.
        axes: Columns of abscissa, ordinate and normal, for planes along the axes.
    """

    name: str
    abscissa: Vector
    ordinate: Vector
    normal: Vector
    axes: tuple[int, int, int] = dataclasses.field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        columns = (_column(self.abscissa), _column(self.ordinate), _column(self.normal))
        object.__setattr__(self, "axes", columns)

    @property
    def directions(self) -> Directions:
        """Abscissa, ordinate and normal."""
        return (self.abscissa, self.ordinate, self.normal)

    def point(self, place: Vector | list[float]) -> tuple[float, float]:
        """Abscissa and ordinate of a place of X, Y, Z (further axes are ignored)."""
        return point_of(self.directions, (place[0], place[1], place[2]))

    def local(self, point: Vector | list[float]) -> Local:
        """A point of X, Y, Z (further axes are ignored) seen from the plane."""
        place = (point[0], point[1], point[2])
        return Local(
            along(place, self.abscissa), along(place, self.ordinate), along(place, self.normal)
        )

    def world(self, abscissa: float, ordinate: float, height: float) -> Vector:
        """The inverse of ``local``."""
        return world(self.directions, (abscissa, ordinate), height)

    def aim(self, target: list[float], point: tuple[float, float]) -> None:
        """Let a position, shape (k,), have another abscissa and ordinate, at its own height."""
        aim(self.directions, point, target)


def _column(direction: Vector) -> int:
    return max(range(3), key=lambda index: abs(direction[index]))


_X, _Y, _Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)

XY = Plane("XY (G17)", _X, _Y, _Z)
ZX = Plane("ZX (G18)", _Z, _X, _Y)
YZ = Plane("YZ (G19)", _Y, _Z, _X)
PLANE_ORDER = (XY, ZX, YZ)
"""Those along the axes."""


OWN_PLANE = "of the program"


def plane_with_normal(normal: Vector) -> Plane:
    """A plane of any normal; its abscissa lies level, as near to +X as it can.

    Raises:
        ValueError: The vector has no direction.
    """
    length = math.sqrt(sum(value * value for value in normal))
    if not length > 0.0:
        raise ValueError("a plane's normal needs a direction")
    x, y, z = (value / length for value in normal)
    level = math.hypot(x, y)
    abscissa = (y / level, -x / level, 0.0) if level > 1e-12 else _X
    if abscissa[0] < 0.0:
        abscissa = (-abscissa[0], -abscissa[1], 0.0)
    unit = (x, y, z)
    return Plane(OWN_PLANE, abscissa, cross(unit, abscissa), unit)


@compilable
def cross(left: Vector, right: Vector) -> Vector:
    """The vector product."""
    return (
        left[1] * right[2] - left[2] * right[1],
        left[2] * right[0] - left[0] * right[2],
        left[0] * right[1] - left[1] * right[0],
    )
