"""Hot loops of the surface: where it crosses the lattice's edges, and one vertex for each of its patches."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.compilation.kernel import arithmetic_kernel
from twin.cutting.tridexel.dexels import Dexels, FacetArray, Lattice
from twin.cutting.tridexel.normals import unpacked
from twin.cutting.tridexel.surface.cell_loops import CellLoops
from twin.nc.canonical import FloatArray

Flags = npt.NDArray[np.uint8]
Numbers = npt.NDArray[np.int32]

_MARGIN = 2e-3
"""How far vertices stay off the nodes and faces of a cube, in cells: none of them fall on one another."""
_DAMPING = 2e-3
"""Pull towards the middle of a patch's crossings, beside unit normals: what lies on one plane stays there."""


class Coarse(NamedTuple):
    """The nodes that are taken.

    Attributes:
        first: Number of the first along every direction.
        step: From one to the next.
    """

    first: int
    step: int


class Crossings(NamedTuple):
    """Where the surface crosses edges of the lattice, and how they hang together.

    Attributes:
        point: Crossings, then one vertex for each patch, shape (n + p, 3) [mm].
        facet: Normal and tool at each, shape (n + p,).
        segment: Of the rims of patches: first crossing, next crossing, patch, shape (4 n, 3).
        layer: Numbers of the crossings of the layers of edges that are at hand: along X; along Y and Z before
            and behind, shape (5, ny, nz).
    """

    point: FloatArray
    facet: FacetArray
    segment: Numbers
    layer: Numbers


@arithmetic_kernel
def mark_inside(dexels: Dexels, lattice: Lattice, coarse: Coarse, inside: Flags) -> None:
    """Mark the nodes in the material, by the lines along Z; a layer of nodes outside is around them."""
    step, first = coarse.step, coarse.first
    for i in range(1, inside.shape[0] - 1):
        for j in range(1, inside.shape[1] - 1):
            column, row = first + (i - 1) * step, first + (j - 1) * step
            line = lattice.base[2] + row * lattice.shape[0] + column
            start = dexels.first[line]
            for place in range(start, start + dexels.filled[line]):
                low = (dexels.ends[place, 0] - lattice.origin[2]) / lattice.cell - first
                high = (dexels.ends[place, 1] - lattice.origin[2]) / lattice.cell - first
                begin = max(0, math.ceil(low / step))
                end = min(inside.shape[2] - 3, math.floor(high / step))
                for k in range(begin, end + 1):
                    inside[i, j, k + 1] = 1


@arithmetic_kernel
def find_surface(
    dexels: Dexels,
    lattice: Lattice,
    coarse: Coarse,
    inside: Flags,
    loops: CellLoops,
    found: Crossings,
    crossings: int,
) -> int:
    """Find crossings, patches and the segments of their rims, one layer of cubes along X after the other.

    Args:
        inside: Which of them are in the material.
        loops: How the surface goes through a cube.
        found: Set to it.

    Returns:
        How many patches there are.
    """
    layer = found.layer
    number = _cross_layer(dexels, lattice, coarse, inside, 0, found, 0)
    patches, segments = 0, 0
    for i in range(inside.shape[0] - 1):
        for j in range(inside.shape[1]):
            for k in range(inside.shape[2]):
                layer[0, j, k] = -1
                layer[1, j, k], layer[2, j, k] = layer[3, j, k], layer[4, j, k]
                if inside[i, j, k] != inside[i + 1, j, k]:
                    _cross(
                        dexels,
                        lattice,
                        coarse,
                        (i - 1, j - 1, k - 1),
                        0,
                        inside[i, j, k],
                        found,
                        number,
                    )
                    layer[0, j, k] = number
                    number += 1
        number = _cross_layer(dexels, lattice, coarse, inside, i + 1, found, number)
        for j in range(inside.shape[1] - 1):
            for k in range(inside.shape[2] - 1):
                corners = 0
                for corner in range(8):
                    x, y, z = corner & 1, corner >> 1 & 1, corner >> 2
                    corners |= int(inside[i + x, j + y, k + z]) << corner
                if corners not in (0, 255):
                    low = (i - 1, j - 1, k - 1)
                    patches, segments = _patch(
                        lattice,
                        coarse,
                        loops,
                        found,
                        (corners, j, k),
                        low,
                        (crossings, patches, segments),
                    )
    return patches


@arithmetic_kernel
def _cross_layer(
    dexels: Dexels,
    lattice: Lattice,
    coarse: Coarse,
    inside: Flags,
    i: int,
    found: Crossings,
    number: int,
) -> int:
    """Find the crossings of the edges along Y and Z of one layer of nodes; returns the next number."""
    for j in range(inside.shape[1]):
        for k in range(inside.shape[2]):
            here = inside[i, j, k]
            found.layer[3, j, k] = found.layer[4, j, k] = -1
            if j + 1 < inside.shape[1] and inside[i, j + 1, k] != here:
                _cross(dexels, lattice, coarse, (i - 1, j - 1, k - 1), 1, here, found, number)
                found.layer[3, j, k] = number
                number += 1
            if k + 1 < inside.shape[2] and inside[i, j, k + 1] != here:
                _cross(dexels, lattice, coarse, (i - 1, j - 1, k - 1), 2, here, found, number)
                found.layer[4, j, k] = number
                number += 1
    return number


@arithmetic_kernel
def _cross(
    dexels: Dexels,
    lattice: Lattice,
    coarse: Coarse,
    node: tuple[int, int, int],
    d: int,
    ends: int,
    found: Crossings,
    number: int,
) -> None:
    """Find where material ends, or begins, on the edge from a node along a direction.

    Lines of other directions have shown which nodes are inside; where a surface goes all but through a node,
    this one may see its end just beyond the edge, and the nearest place on the edge is taken.
    """
    u, v = (d + 1) % 3, (d + 2) % 3
    first, step, cell = coarse.first, coarse.step, lattice.cell
    across = (first + node[u] * step, first + node[v] * step)
    line = lattice.base[d] + across[1] * lattice.shape[u] + across[0]
    low = lattice.origin[d] + cell * (first + node[d] * step)
    length = cell * step
    best, nearest, facet = math.inf, low + 0.5 * length, 0
    for place in range(dexels.first[line], dexels.first[line] + dexels.filled[line]):
        t = dexels.ends[place, ends]
        off = max(low - t, t - low - length, 0.0)
        if off < best:
            best, nearest, facet = off, t, dexels.facet[place, ends]
    margin = _MARGIN * length
    found.point[number, d] = min(max(nearest, low + margin), low + length - margin)
    found.point[number, u] = lattice.origin[u] + cell * across[0]
    found.point[number, v] = lattice.origin[v] + cell * across[1]
    found.facet[number] = facet


@arithmetic_kernel
def _edge(loops: CellLoops, found: Crossings, edge: int, j: int, k: int) -> int:
    """Number of the crossing on an edge of the cube between the layers that are at hand."""
    corner, axis = loops.ends[edge, 0], loops.axis[edge]
    return found.layer[
        axis + 2 * (corner & 1) if axis else 0, j + (corner >> 1 & 1), k + (corner >> 2)
    ]


@arithmetic_kernel
def _patch(
    lattice: Lattice,
    coarse: Coarse,
    loops: CellLoops,
    found: Crossings,
    cube: tuple[int, int, int],
    low: tuple[int, int, int],
    counts: tuple[int, int, int],
) -> tuple[int, int]:
    """Lay one vertex for each patch in a cube; returns the next numbers of patches and segments."""
    corners, j, k = cube
    crossings, patches, segments = counts
    number = 0
    while True:
        start = -1
        for edge in range(12):
            if loops.loop[corners, edge] == number:
                start = edge
                break
        if start < 0:
            return patches, segments
        vertex = crossings + patches
        _place(lattice, coarse, loops, found, (corners, j, k), low, start, vertex)
        edge = start
        while True:
            after = loops.following[corners, edge]
            found.segment[segments, 0] = _edge(loops, found, edge, j, k)
            found.segment[segments, 1] = _edge(loops, found, after, j, k)
            found.segment[segments, 2] = vertex
            segments += 1
            edge = after
            if edge == start:
                break
        patches += 1
        number += 1


@arithmetic_kernel
def _place(
    lattice: Lattice,
    coarse: Coarse,
    loops: CellLoops,
    found: Crossings,
    cube: tuple[int, int, int],
    low: tuple[int, int, int],
    start: int,
    vertex: int,
) -> None:
    """Lay a patch's vertex where the planes of its crossings meet (Ju et al., "Dual contouring of Hermite data", 2002).

    The normal equations of the planes, seen from the middle of the crossings, are damped and solved by
    Cramer's rule.
    """
    corners, j, k = cube
    mx, my, mz, count = 0.0, 0.0, 0.0, 0
    edge = start
    while count == 0 or edge != start:
        point = found.point[_edge(loops, found, edge, j, k)]
        mx, my, mz, count = mx + point[0], my + point[1], mz + point[2], count + 1
        edge = loops.following[corners, edge]
    mx, my, mz = mx / count, my / count, mz / count
    a, b, c, d, e, f = _DAMPING, 0.0, 0.0, _DAMPING, 0.0, _DAMPING
    p, q, r = 0.0, 0.0, 0.0
    for _ in range(count):
        number = _edge(loops, found, edge, j, k)
        point = found.point[number]
        x, y, z = unpacked(found.facet[number])
        scale = 1.0 / math.sqrt(x * x + y * y + z * z)
        x, y, z = x * scale, y * scale, z * scale
        off = x * (point[0] - mx) + y * (point[1] - my) + z * (point[2] - mz)
        a, b, c = a + x * x, b + x * y, c + x * z
        d, e, f = d + y * y, e + y * z, f + z * z
        p, q, r = p + x * off, q + y * off, r + z * off
        edge = loops.following[corners, edge]
    whole = a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d)
    x = (p * (d * f - e * e) - b * (q * f - r * e) + c * (q * e - r * d)) / whole
    y = (a * (q * f - r * e) - p * (b * f - c * e) + c * (b * r - c * q)) / whole
    z = (a * (d * r - e * q) - b * (b * r - c * q) + p * (b * e - c * d)) / whole
    length = lattice.cell * coarse.step
    margin = _MARGIN * length * (1 + loops.loop[corners, start])
    for axis, t in enumerate((mx + x, my + y, mz + z)):
        begin = lattice.origin[axis] + lattice.cell * (coarse.first + low[axis] * coarse.step)
        found.point[vertex, axis] = min(max(t, begin + margin), begin + length - margin)
    found.facet[vertex] = found.facet[_edge(loops, found, start, j, k)]
