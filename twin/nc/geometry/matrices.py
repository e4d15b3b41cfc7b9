"""Matrices of X, Y and Z as tuples of rows: what mirror, scale and rotation do to vectors.

The kernel of plain lines uses some: they hold nothing whose compiled bits could differ, such as ``sum``.
"""

import math

from twin.compilation.compilable import compilable
from twin.nc.geometry.arcs import Point, direction
from twin.nc.geometry.planes import Directions, Vector, along, cross

Matrix = Directions
IDENTITY: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))

SMALLEST_SCALE, LARGEST_SCALE = 1e-3, 1e3
"""A scale beyond these is a slip of the pen."""


@compilable
def applied(matrix: Matrix, vector: Vector) -> Vector:
    """The vector that a matrix makes of another."""
    x, y, z = vector
    a, b, c = matrix
    return (
        a[0] * x + a[1] * y + a[2] * z,
        b[0] * x + b[1] * y + b[2] * z,
        c[0] * x + c[1] * y + c[2] * z,
    )


@compilable
def determinant(matrix: Matrix) -> float:
    """Of a matrix; below 0 where it mirrors."""
    a, b, c = matrix
    return along(cross(b, c), a)


def inverse(matrix: Matrix) -> Matrix:
    """The matrix that undoes another."""
    a, b, c = matrix
    x, y, z = cross(b, c), cross(c, a), cross(a, b)
    d = along(x, a)
    return (
        (x[0] / d, y[0] / d, z[0] / d),
        (x[1] / d, y[1] / d, z[1] / d),
        (x[2] / d, y[2] / d, z[2] / d),
    )


def transposed(matrix: Matrix) -> Matrix:
    """Rows as columns."""
    a, b, c = matrix
    return ((a[0], b[0], c[0]), (a[1], b[1], c[1]), (a[2], b[2], c[2]))


def dot(left: Vector, right: Vector) -> float:
    """The scalar product; its zero has no sign."""
    return 0.0 + left[0] * right[0] + left[1] * right[1] + left[2] * right[2]


def product(left: Matrix, right: Matrix) -> Matrix:
    """The matrix product."""
    (a, b, c), (x, y, z) = left, transposed(right)
    return (
        (dot(a, x), dot(a, y), dot(a, z)),
        (dot(b, x), dot(b, y), dot(b, z)),
        (dot(c, x), dot(c, y), dot(c, z)),
    )


@compilable
def turned_unit(matrix: Matrix, vector: Vector) -> Vector:
    """The direction that a matrix makes of another, of unit length."""
    x, y, z = applied(matrix, vector)
    length = math.sqrt(x * x + y * y + z * z)
    return (x / length, y / length, z / length)


@compilable
def handedness(matrix: Matrix) -> float:
    """-1 where a matrix mirrors, else 1."""
    return math.copysign(1.0, determinant(matrix))


def stretched(signs: Vector, factor: float) -> Matrix:
    """Scales by a factor, and mirrors the axes whose sign is -1."""
    return (
        (signs[0] * factor, 0.0, 0.0),
        (0.0, signs[1] * factor, 0.0),
        (0.0, 0.0, signs[2] * factor),
    )


def rotated(matrix: Matrix, axes: Matrix, angle: float, center: Point) -> tuple[Matrix, Vector]:
    """A matrix, and after it a rotation in a plane.

    Args:
        matrix: What comes first.
        axes: Abscissa, ordinate and normal of the plane.
        angle: Of the rotation [deg].
        center: Abscissa and ordinate that stay where they are [mm].

    Returns:
        The matrix of both, and the shift that comes after it.
    """
    cosine, sine = direction(angle)
    to_world = transposed(axes)
    turn = ((cosine, -sine, 0.0), (sine, cosine, 0.0), (0.0, 0.0, 1.0))
    turning = product(product(to_world, turn), axes)
    middle = applied(to_world, (center[0], center[1], 0.0))
    x, y, z = applied(turning, middle)
    return product(turning, matrix), (middle[0] - x, middle[1] - y, middle[2] - z)
