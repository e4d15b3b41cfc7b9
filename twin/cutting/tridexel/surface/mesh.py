"""The material of a tri-dexel stock as a closed mesh."""

import struct
import zlib
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from twin.cutting.heights.colours import MACHINED_RGB, RAW_RGB, Colours
from twin.cutting.tridexel.dexels import FacetArray, TriDexel
from twin.cutting.tridexel.normals import OWN, tools
from twin.cutting.tridexel.surface.cell_loops import cell_loops
from twin.cutting.tridexel.surface.surface import Coarse, Crossings, find_surface, mark_inside
from twin.nc.canonical import FloatArray, IntArray

if TYPE_CHECKING:
    import trimesh

MESH_CROSSINGS = 250_000
"""Crossings of the finest mesh that is written; a finer stock is thinned to it."""
TRIANGLES = 4
"""Triangles of a mesh for each crossing."""
MOST_VERTICES = 7 / 3
"""Vertices for each crossing at most: itself, and of the patches in four cubes, which have three or more, a share."""
MARKED_NODES = 100_000_000
"""Nodes that are marked at a time: as many bytes."""


class Surface(NamedTuple):
    """A closed surface.

    Attributes:
        points: Vertices, shape (n, 3) [mm].
        facet: Normal and tool at each (``normals``), shape (n,).
        faces: Triangles, counter-clockwise from outside, the first corner a crossing, shape (m, 3).
        step: From one node of the lattice that was taken to the next, 1 for all of them.
    """

    points: FloatArray
    facet: FacetArray
    faces: IntArray
    step: int


Paint = Callable[[Surface], Colours]
"""Colours of the vertices of a surface, shape (n, 3)."""


def surface(stock: TriDexel, crossings: int = MESH_CROSSINGS, step: int = 1) -> Surface:
    """The surface of the material, with sharp edges where the lines have seen both sides of them.

    What is thinner than the distance of the nodes that are taken may be left out, on both sides.

    Args:
        crossings: So many edges of the lattice may be crossed; if there are more, nodes are left out.
        step: From one node to the next at least, in nodes.
    """
    while np.prod(-(-stock.lattice.shape // step) + 2.0) > MARKED_NODES:
        step += 1
    while True:
        coarse = Coarse((step - 1) // 2, step)
        inside, count = _marked(stock, coarse)
        if count <= crossings:
            break
        step = max(step + 1, int(step * (count / crossings) ** 0.5))
    found = Crossings(
        np.zeros((count + 2 * count, 3)),
        np.zeros(count + 2 * count, np.int32),
        np.zeros((4 * count, 3), np.int32),
        np.zeros((5, *inside.shape[1:]), np.int32),
    )
    patches = find_surface(stock.dexels, stock.lattice, coarse, inside, cell_loops(), found, count)
    vertices = count + patches
    return Surface(found.point[:vertices], found.facet[:vertices], _faces(found.segment), step)


def _marked(stock: TriDexel, coarse: Coarse) -> tuple[np.ndarray, int]:
    """Which nodes are in the material, with a layer around them that is not, and how many edges change."""
    shape = -(-(stock.lattice.shape - coarse.first) // coarse.step) + 2
    inside = np.zeros(tuple(shape), np.uint8)
    mark_inside(stock.dexels, stock.lattice, coarse, inside)
    count = sum(int(np.count_nonzero(np.diff(inside, axis=axis))) for axis in range(inside.ndim))
    return inside, count


def _faces(segments: np.ndarray) -> IntArray:
    """Triangles from the rims of patches.

    A segment of a rim lies between two patches and is part of both rims, once to and once fro. The two triangles
    between it and the patches' vertices are turned about: their common edge goes from vertex to vertex, along
    the edge of the part if there is one. Where two patches meet in two segments that edge would be there
    twice; there the triangles stay as they are.
    """
    rim = segments.astype(np.int64)
    key = rim[:, :2].min(axis=1) * (rim.max(initial=0) + 1) + rim[:, :2].max(axis=1)
    order = np.argsort(key, kind="stable")
    one, other = rim[order[::2]], rim[order[1::2]]
    a, b, first, last = one[:, 2], other[:, 2], one[:, 0], one[:, 1]
    pair = np.minimum(a, b) * (rim.max(initial=0) + 1) + np.maximum(a, b)
    _, place, times = np.unique(pair, return_inverse=True, return_counts=True)
    turned = times[place] == 1
    faces = np.stack(
        [
            np.where(turned[:, None], np.stack([first, b, a], 1), np.stack([first, last, a], 1)),
            np.where(turned[:, None], np.stack([last, a, b], 1), np.stack([last, first, b], 1)),
        ],
        axis=1,
    )
    return faces.reshape(-1, 3)


def part_mesh(stock: TriDexel, colours: Paint | None = None) -> "trimesh.Trimesh":
    """The material as a mesh; nothing left gives an empty one.

    Args:
        colours: Of its vertices; None: none.
    """
    import trimesh  # As long to load as the rest of a run, and most runs cut no part.

    found = surface(stock)
    painted = None if colours is None else colours(found)
    return trimesh.Trimesh(found.points, found.faces, vertex_colors=painted, process=False)


def part_colours(found: Surface) -> Colours:
    """Raw where the blank's own surface is untouched, machined elsewhere, shape (n, 3)."""
    machined = (tools(found.facet) != OWN)[:, None]
    return np.where(machined, MACHINED_RGB, RAW_RGB).astype(np.uint8)


MESH = 3
"""First byte of the message of a mesh, beside ``patches.PATCH``."""
_MOST_TOOL = 255


def mesh_message(stock: TriDexel, crossings: int) -> bytes:
    """Kind, number of vertices and of triangles; then deflated the vertices, the triangles' corners, the tool that left each.

    Args:
        crossings: How finely it is drawn; see ``surface``.
    """
    found = surface(stock, crossings)
    by = np.minimum(tools(found.facet[found.faces[:, 0]]), _MOST_TOOL).astype(np.uint8)
    head = struct.pack("<BxxxII", MESH, len(found.points), len(found.faces))
    content = (
        found.points.astype("<f4").tobytes() + found.faces.astype("<u4").tobytes() + by.tobytes()
    )
    return head + zlib.compress(content, 1)
