"""Points in a plane along the axes, compiled: the bits of ``Plane.local`` and ``Plane.world``."""

from twin.nc.canonical import FloatArray, IntArray
from twin.nc.compile_kernels import kernel


@kernel
def one(axis: int, other: int) -> float:
    """Component of the unit vector along an axis."""
    return 1.0 if axis == other else 0.0


@kernel
def along_axis(position: FloatArray, axis: int) -> float:
    """A coordinate as ``Plane.local`` computes it, the sign of zero included."""
    x, y, z = position[0], position[1], position[2]
    return one(axis, 0) * x + one(axis, 1) * y + one(axis, 2) * z


@kernel
def place(plane: IntArray, point: tuple[float, float], height: float, target: FloatArray) -> None:
    """Put X, Y and Z of a point of the plane into the first places of a column."""
    for axis in range(3):
        target[axis] = (
            one(plane[0], axis) * point[0]
            + one(plane[1], axis) * point[1]
            + one(plane[2], axis) * height
        )
