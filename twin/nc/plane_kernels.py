"""Points in a plane, compiled: the bits of ``Plane.local`` and ``Plane.world``."""

from twin.nc.canonical import FloatArray
from twin.nc.compile_kernels import kernel
from twin.nc.matrices import Matrix
from twin.nc.planes import Vector


@kernel
def one(axis: int, other: int) -> float:
    """Component of the unit vector along an axis."""
    return 1.0 if axis == other else 0.0


@kernel
def along_axis(position: FloatArray, direction: Vector | FloatArray) -> float:
    """A coordinate of a point, the sign of zero included."""
    x, y, z = position[0], position[1], position[2]
    return direction[0] * x + direction[1] * y + direction[2] * z


@kernel
def place(
    plane: Matrix | FloatArray, point: tuple[float, float], height: float, target: FloatArray
) -> None:
    """Put X, Y and Z of a point of the plane into the first places of a column."""
    a, o, n = plane[0], plane[1], plane[2]
    target[0] = a[0] * point[0] + o[0] * point[1] + n[0] * height
    target[1] = a[1] * point[0] + o[1] * point[1] + n[1] * height
    target[2] = a[2] * point[0] + o[2] * point[1] + n[2] * height
