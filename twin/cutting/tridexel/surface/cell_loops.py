"""How the surface goes through a cube between eight nodes, for every choice of nodes in the material.

The surface crosses those of the cube's twelve edges that have one end inside. On every face of the cube the
crossings are joined two by two, an inside corner of two that face each other diagonally by itself, as the
neighbouring cube joins them too; the joints of all faces close to loops, each the rim of one patch of the surface
(marching cubes, Lorensen and Cline 1987; one vertex for each patch, Nielson, "Dual marching cubes", 2004).
"""

import functools
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

CORNERS, EDGES = 8, 12

Table = npt.NDArray[np.int8]


class CellLoops(NamedTuple):
    """By the bits of the corners that are inside, corner x + 2 y + 4 z, and by edge.

    Attributes:
        following: The edge that follows on each crossed edge in its loop, -1 where there is no crossing,
            shape (256, 12). The loops go counter-clockwise seen from outside.
        loop: Number of the loop that each crossed edge belongs to, shape (256, 12).
        ends: Corners at the lower and upper end of each edge, shape (12, 2).
        axis: Direction of each edge, shape (12,).
    """

    following: Table
    loop: Table
    ends: Table
    axis: Table


@functools.cache
def cell_loops() -> CellLoops:
    """The tables, which are made once."""
    ends = [
        (corner, corner | 1 << axis)
        for axis in range(3)
        for corner in range(CORNERS)
        if not corner >> axis & 1
    ]
    axis = [(high - low).bit_length() - 1 for low, high in ends]
    edge = {frozenset(pair): number for number, pair in enumerate(ends)}
    following = np.full((1 << CORNERS, EDGES), -1, np.int8)
    loop = np.full((1 << CORNERS, EDGES), -1, np.int8)
    for inside in range(1 << CORNERS):
        for face in _faces():
            _join(inside, face, edge, following[inside])
        _number(following[inside], loop[inside])
    return CellLoops(following, loop, np.array(ends, np.int8), np.array(axis, np.int8))


def _faces() -> list[list[int]]:
    """Corners of the six faces, counter-clockwise seen from outside."""
    faces = []
    for axis in range(3):
        u, v = 1 << (axis + 1) % 3, 1 << (axis + 2) % 3
        faces.append([0, v, u | v, u])
        faces.append([1 << axis | corner for corner in (0, u, u | v, v)])
    return faces


def _join(inside: int, face: list[int], edge: dict[frozenset[int], int], following: Table) -> None:
    """Join the crossings of one face: where a run of inside corners ends with where it begins."""
    for place in range(4):
        corner, after = face[place], face[(place + 1) % 4]
        if not inside >> corner & 1 or inside >> after & 1:
            continue
        first = place
        while inside >> face[first - 1] & 1:
            first -= 1
        begin = edge[frozenset((face[first - 1], face[first]))]
        following[begin] = edge[frozenset((corner, after))]


def _number(following: Table, loop: Table) -> None:
    number = 0
    for start in range(EDGES):
        each = start
        if following[start] < 0 or loop[start] >= 0:
            continue
        while loop[each] < 0:
            loop[each] = number
            each = int(following[each])
        number += 1
