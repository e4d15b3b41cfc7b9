"""A closed mesh as intervals along three directions."""

import numpy as np

from twin.compilation.kernel import arithmetic_kernel
from twin.cutting.tridexel.dexels import Dexels, Lattice, no_material
from twin.cutting.tridexel.intervals import LEAST_MM
from twin.cutting.tridexel.normals import packed
from twin.nc.canonical import FloatArray, IntArray


def mesh_dexels(lattice: Lattice, triangles: FloatArray, normals: FloatArray) -> Dexels:
    """Intervals of the lines within a closed mesh, or within any of several that overlap.

    Args:
        triangles: Shape (m, 3, 3) [mm].
        normals: Unit vectors out of the solid, shape (m, 3).
    """
    hits = np.zeros(lattice.lines, np.int64)
    nothing = np.zeros(0)
    _pierce(lattice, triangles, normals, hits, np.zeros(0, np.int64), nothing, nothing)
    first = np.cumsum(hits) - hits
    places, triangle = np.zeros(int(hits.sum())), np.zeros(int(hits.sum()))
    hits[:] = 0
    _pierce(lattice, triangles, normals, hits, first, places, triangle)
    dexels = no_material(lattice, (hits // 2).astype(np.int16))
    _join(dexels, lattice, normals, hits, first, places, triangle)
    return dexels


@arithmetic_kernel
def _pierce(
    lattice: Lattice,
    triangles: FloatArray,
    normals: FloatArray,
    hits: IntArray,
    first: IntArray,
    places: FloatArray,
    triangle: FloatArray,
) -> None:
    """Count where lines go through triangles, and where there is memory for it note the places."""
    cell = lattice.cell
    for number in range(len(triangles)):
        corners = triangles[number]
        for d in range(3):
            u, v = (d + 1) % 3, (d + 2) % 3
            if normals[number, d] == 0.0:
                continue
            least, most = corners[0, v], corners[0, v]
            left, right = corners[0, u], corners[0, u]
            for i in range(1, 3):
                least, most = min(least, corners[i, v]), max(most, corners[i, v])
                left, right = min(left, corners[i, u]), max(right, corners[i, u])
            top = min(lattice.shape[v] - 1, int((most - lattice.origin[v]) / cell) + 1)
            end = min(lattice.shape[u] - 1, int((right - lattice.origin[u]) / cell) + 1)
            for row in range(max(0, int((least - lattice.origin[v]) / cell) - 1), top + 1):
                y = lattice.origin[v] + row * cell
                for column in range(max(0, int((left - lattice.origin[u]) / cell) - 1), end + 1):
                    x = lattice.origin[u] + column * cell
                    if not _covers(corners, u, v, x, y):
                        continue
                    line = lattice.base[d] + row * lattice.shape[u] + column
                    if len(places):
                        normal = normals[number]
                        off = (x - corners[0, u]) * normal[u] + (y - corners[0, v]) * normal[v]
                        place = first[line] + hits[line]
                        places[place] = corners[0, d] - off / normal[d]
                        triangle[place] = number
                    hits[line] += 1


@arithmetic_kernel
def _covers(corners: FloatArray, u: int, v: int, x: float, y: float) -> bool:
    """Whether a triangle seen along a line covers a point: of two that share an edge exactly one does."""
    inside = False
    for i in range(3):
        a, b = corners[i], corners[(i + 1) % 3]
        if (a[v] > y) == (b[v] > y):
            continue
        if a[v] > b[v]:
            a, b = b, a
        if x < a[u] + (y - a[v]) / (b[v] - a[v]) * (b[u] - a[u]):
            inside = not inside
    return inside


@arithmetic_kernel
def _join(
    dexels: Dexels,
    lattice: Lattice,
    normals: FloatArray,
    hits: IntArray,
    first: IntArray,
    places: FloatArray,
    triangle: FloatArray,
) -> None:
    """Sort the places of each line and make intervals of where it is within the mesh."""
    for line in range(len(hits)):
        begin, end = first[line], first[line] + hits[line]
        d = 2 if line >= lattice.base[2] else (1 if line >= lattice.base[1] else 0)
        for i in range(begin + 1, end):
            j = i
            while j > begin and places[j - 1] > places[j]:
                places[j - 1], places[j] = places[j], places[j - 1]
                triangle[j - 1], triangle[j] = triangle[j], triangle[j - 1]
                j -= 1
        within, entered, kept = 0, 0, dexels.first[line]
        for i in range(begin, end):
            into = normals[int(triangle[i]), d] < 0.0
            if into and within == 0:
                entered = i
            within += 1 if into else -1
            if within == 0 and not into and places[i] - places[entered] > LEAST_MM:
                for side, place in enumerate((entered, i)):
                    normal = normals[int(triangle[place])]
                    dexels.ends[kept, side] = places[place]
                    dexels.facet[kept, side] = packed(normal[0], normal[1], normal[2], 0)
                kept += 1
        dexels.filled[line] = kept - dexels.first[line]
