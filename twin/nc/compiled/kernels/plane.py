"""Directions of planes along the axes, and whether a move goes anywhere, compiled."""

from twin.compilation.compilable import compilable, inlined
from twin.nc.canonical import FloatArray


@compilable
def one(axis: int, other: int) -> float:
    """Component of the unit vector along an axis."""
    return 1.0 if axis == other else 0.0


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
