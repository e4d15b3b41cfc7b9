"""Points in a plane, compiled: the bits of ``Plane.local`` and ``Plane.world``."""

from twin.compilation.compilable import compilable, inlined
from twin.nc.canonical import FloatArray
from twin.nc.geometry.matrices import Matrix
from twin.nc.geometry.planes import Vector


@compilable
def one(axis: int, other: int) -> float:
    """Component of the unit vector along an axis."""
    return 1.0 if axis == other else 0.0


@compilable
def along_axis(position: FloatArray, direction: Vector | FloatArray) -> float:
    """A coordinate of a point, the sign of zero included."""
    x, y, z = position[0], position[1], position[2]
    return direction[0] * x + direction[1] * y + direction[2] * z


@compilable
def place(
    plane: Matrix | FloatArray, point: tuple[float, float], height: float, target: FloatArray
) -> None:
    """Put X, Y and Z of a point of the plane into the first places of a column."""
    a, o, n = plane[0], plane[1], plane[2]
    target[0] = a[0] * point[0] + o[0] * point[1] + n[0] * height
    target[1] = a[1] * point[0] + o[1] * point[1] + n[1] * height
    target[2] = a[2] * point[0] + o[2] * point[1] + n[2] * height


SHORTEST = 1e-7
"""A move that goes less far [mm or deg], but does go, is left to the control to measure."""
_RESTING = 1e-10
"""An axis that goes less far rests; a few of them are still below what moves the control."""
UNCERTAIN = -1.0


@inlined
def move_length(position: FloatArray) -> float:
    """How far the axis goes that goes farthest: one of X, Y, Z, or where these rest another.

    Args:
        position: Start and end of the move, shape (3, k); what rests ends where it starts.

    Returns:
        0 where nothing moves, or ``UNCERTAIN``.
    """
    spatial, other = 0.0, 0.0
    for axis in range(position.shape[1]):
        way = abs(position[1, axis] - position[0, axis])
        if axis < 3:
            spatial = max(spatial, way)
        else:
            other = max(other, way)
    way = spatial
    if spatial <= _RESTING:
        way = other if other > _RESTING else 0.0
        for axis in range(position.shape[1]):
            if axis < 3 or way == 0.0:
                position[1, axis] = position[0, axis]
    return UNCERTAIN if 0.0 < way < SHORTEST else way
