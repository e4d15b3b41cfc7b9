"""Normal and tool of a surface in one number of 32 bits."""

import math

import numpy as np

from twin.compilation.kernel import arithmetic_kernel
from twin.cutting.tridexel.dexels import FacetArray
from twin.nc.canonical import FloatArray, IntArray

_STEPS = 2047
"""Steps of each of two coordinates of a normal: it is kept to 0.06 degrees."""
_BITS = 11
_LARGEST = (1 << _BITS) - 1
MOST_TOOLS = 511
"""Tools that are distinguished."""
OWN = 0
"""In place of a tool's number: the blank's own surface."""


@arithmetic_kernel
def packed(x: float, y: float, z: float, tool: int) -> int:
    """A unit normal, unfolded from an octahedron to a square (Meyer et al. 2010), and a tool."""
    scale = 1.0 / (abs(x) + abs(y) + abs(z))
    u, v = x * scale, y * scale
    if z < 0.0:
        u, v = (1.0 - abs(v)) * math.copysign(1.0, u), (1.0 - abs(u)) * math.copysign(1.0, v)
    column = math.floor((u + 1.0) * 0.5 * _STEPS + 0.5)
    row = math.floor((v + 1.0) * 0.5 * _STEPS + 0.5)
    return column | row << _BITS | tool << 2 * _BITS


@arithmetic_kernel
def unpacked(facet: int) -> tuple[float, float, float]:
    """The direction of a normal, on the octahedron: not of unit length."""
    column, row = facet & _LARGEST, facet >> _BITS & _LARGEST
    u, v = 2.0 * column / _STEPS - 1.0, 2.0 * row / _STEPS - 1.0
    z = 1.0 - abs(u) - abs(v)
    folded = max(-z, 0.0)
    return u - math.copysign(folded, u), v - math.copysign(folded, v), z


@arithmetic_kernel
def squared_part(facet: int, direction: int) -> float:
    """Square of a unit normal's part along X, Y or Z."""
    x, y, z = unpacked(facet)
    part = z if direction == 2 else (x if direction == 0 else y)
    return part * part / (x * x + y * y + z * z)


def normals(facet: FacetArray) -> FloatArray:
    """Unit normals out of the material, shape (..., 3)."""
    column, row = facet & _LARGEST, facet >> _BITS & _LARGEST
    u, v = 2.0 * column / _STEPS - 1.0, 2.0 * row / _STEPS - 1.0
    z = 1.0 - np.abs(u) - np.abs(v)
    folded = np.maximum(-z, 0.0)
    normal = np.stack([u - np.copysign(folded, u), v - np.copysign(folded, v), z], axis=-1)
    return normal / np.linalg.norm(normal, axis=-1, keepdims=True)


def tools(facet: FacetArray) -> IntArray:
    """Which tool left each surface, 0 for the blank's own."""
    return (facet >> 2 * _BITS).astype(np.int64)
