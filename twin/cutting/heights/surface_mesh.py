"""A mesh of vertices over a height map, with a rim that lies exactly on the blank's edge.

Cells are cut as a whole, by their middles. Where a wall passes beside these is known closer
(``twin/cutting/kernels/wall_distance.py``): the vertices on both of its sides are moved onto it.
"""

import dataclasses

import numpy as np
import numpy.typing as npt

from twin.cutting.heights.height_map import HeightMap
from twin.cutting.heights.outline import BoolArray
from twin.cutting.kernels.wall_distance import EQUAL_MM, WallColumn, share_before
from twin.cutting.kernels.wall_places import NEARER_CELLS, Vertices, Walls, onto_walls
from twin.nc.canonical import FloatArray, IntArray

_NEIGHBOURS = ((0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1))
_ALONG = 0.3
"""Cosine between a wall and the blank's edge from which on it is not followed along the edge."""

_SHARE = 0.999
"""Share of the distance to a wall by which vertices are moved, so that no two come to lie on each other."""


@dataclasses.dataclass(frozen=True, slots=True)
class SurfaceMesh:
    """Vertices in the middles of cells, and a rim around them; it stays as the map is cut.

    Attributes:
        x: Shape (my, mx) [mm].
        y: Shape (my, mx) [mm].
        cell: The cell, counted through the map's heights, that gives each vertex its height,
            shape (my, mx); -1 for vertices that do not belong to the blank.
        rim: Vertices on the blank's edge, counted through the mesh, shape (n,).
        inside: How far the middles of cells lie inside of the blank's edge, shape (ny, nx) [cells].
        patches: Which squares between four vertices belong to the blank, shape (my-1, mx-1).
        step: Cells from one vertex to the next, except towards the rim.
    """

    x: FloatArray
    y: FloatArray
    cell: IntArray
    rim: IntArray
    inside: npt.NDArray[np.float32]
    patches: BoolArray
    step: int

    def vertices(self, height_map: HeightMap) -> FloatArray:
        """Where every vertex is, shape (my, mx, 3) [mm]; at the bottom where there is no blank."""
        z, size = self._heights(height_map), height_map.cell
        walls = Walls(height_map.heights, height_map.behind, self.inside)
        x, y = (self.x - height_map.origin[0]) / size, (self.y - height_map.origin[1]) / size
        moved = np.zeros((*z.shape, 3))
        vertices = Vertices(x, y, z, self.cell, self.step, self.step * size)
        onto_walls(walls, vertices, moved)
        self._along_edge(height_map, moved)
        at = moved.any(axis=-1)
        here = np.stack([self.x[at], self.y[at]])
        there = here + size * moved[at, :2].T
        # Where a wall meets the blank's edge, only the rim follows it up to there.
        inner = np.ones(z.size, np.bool_)
        inner[self.rim] = False
        leaves = inner.reshape(z.shape)[at] & ~height_map.outline.contains(*there)
        there = np.where(leaves, here, height_map.outline.snap(*there))
        result = np.stack([self.x, self.y, z], axis=-1)
        result[at, :2] = (here + _SHARE * (there - here)).T
        result[at, 2] += np.where(leaves, 0.0, moved[at, 2])
        return result

    def _heights(self, height_map: HeightMap) -> FloatArray:
        """Height of every vertex, shape (my, mx) [mm]; a rim before which a wall was cut is as low as its foot."""
        result = np.where(self.cell < 0, height_map.bottom, height_map.heights.ravel()[self.cell])
        cells = self.cell.ravel()[self.rim]
        row, column = np.divmod(cells, height_map.heights.shape[1])
        wall, own = height_map.behind[row, column], height_map.heights[row, column]
        inside = self.inside[row, column]
        inwards = height_map.outline.inwards(height_map.x[column], height_map.y[row])
        widest = np.abs(inwards).max(axis=1)
        raw = np.where(inside < widest, share_before(inside, widest), 0.0)
        cut = (wall[:, WallColumn.SHARE] > raw + NEARER_CELLS) & (wall[:, WallColumn.LOWEST] < own)
        result.ravel()[self.rim] = np.where(
            cut, np.minimum(wall[:, WallColumn.FOOT] - EQUAL_MM, own), own
        )
        return result

    def _along_edge(self, height_map: HeightMap, moved: FloatArray) -> None:
        """Let vertices of the rim come to their walls along the blank's edge."""
        shift = moved.reshape(-1, 3)[self.rim, :2]
        inwards = height_map.outline.inwards(self.x.ravel()[self.rim], self.y.ravel()[self.rim])
        along = np.stack([-inwards[:, 1], inwards[:, 0]], 1)
        share, length = (shift * along).sum(1), np.hypot(*shift.T)
        meets = np.abs(share) > _ALONG * length
        reach = np.where(meets, length**2 / np.where(meets, share, 1.0), 0.0)
        moved.reshape(-1, 3)[self.rim] = np.column_stack(
            [reach[:, None] * along, np.zeros(len(reach))]
        )


def surface_mesh(height_map: HeightMap, step: int = 1) -> SurfaceMesh:
    """The mesh of a height map.

    Args:
        step: Take every ``step``-th cell.
    """
    spacing = step * height_map.cell
    rows, columns = height_map.heights.shape
    x, y = height_map.x[::step], height_map.y[::step]
    grid_x, grid_y = np.meshgrid(
        np.concatenate([[x[0] - spacing], x, [x[-1] + spacing]]),
        np.concatenate([[y[0] - spacing], y, [y[-1] + spacing]]),
    )
    number = columns * np.arange(0, rows, step)[:, None] + np.arange(0, columns, step)
    number = np.pad(number, 1, constant_values=-1)
    inside = height_map.outline.contains(grid_x, grid_y) & (number >= 0)
    snapped_x, snapped_y = height_map.outline.snap(grid_x, grid_y)
    best = np.full(inside.shape, np.inf)
    cell = np.where(inside, number, -1)
    for shift in _NEIGHBOURS:
        there, from_x, from_y, from_cell = (
            np.roll(array, shift, (0, 1)) for array in (inside, grid_x, grid_y, number)
        )
        distance = np.hypot(from_x - snapped_x, from_y - snapped_y)
        better = ~inside & there & (distance < best)
        best[better] = distance[better]
        cell[better] = from_cell[better]
    return SurfaceMesh(
        np.where(inside, grid_x, snapped_x),
        np.where(inside, grid_y, snapped_y),
        cell,
        np.nonzero((~inside & (cell >= 0)).ravel())[0],
        (height_map.outline.inside(height_map.x, height_map.y[:, None]) / height_map.cell).astype(
            np.float32
        ),
        all_corners(cell >= 0) & ~all_corners(~inside),
        step,
    )


def all_corners(vertices: BoolArray) -> BoolArray:
    """Squares all of whose four corners are marked, shape (my - 1, mx - 1)."""
    return vertices[:-1, :-1] & vertices[1:, :-1] & vertices[:-1, 1:] & vertices[1:, 1:]


def surface_faces(patches: BoolArray, heights: FloatArray) -> IntArray:
    """Two triangles for each patch, counter-clockwise from above, as vertex numbers, (2n, 3).

    The edge between them joins the two corners that are the more alike in height, as a wall's upper or lower edge does.

    Args:
        heights: Of the vertices, shape (my, mx) [mm].
    """
    columns = patches.shape[1] + 1
    row, column = np.nonzero(patches)
    a = row * columns + column
    corners = np.stack([a, a + 1, a + columns + 1, a + columns])
    z = heights.ravel()[corners]
    turned = np.abs(z[1] - z[3]) < np.abs(z[0] - z[2])
    a, b, c, d = np.where(turned, np.roll(corners, -1, axis=0), corners)
    return np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def open_edges(patches: BoolArray) -> IntArray:
    """Edges with a patch on their left only, as vertex numbers, shape (n, 2)."""
    columns = patches.shape[1] + 1
    padded = np.pad(patches, 1)
    sides: tuple[tuple[BoolArray, tuple[int, int], tuple[int, int]], ...] = (
        (padded[:-2, 1:-1], (0, 0), (0, 1)),
        (padded[1:-1, 2:], (0, 1), (1, 1)),
        (padded[2:, 1:-1], (1, 1), (1, 0)),
        (padded[1:-1, :-2], (1, 0), (0, 0)),
    )
    edges: list[IntArray] = []
    for neighbour, first, last in sides:
        row, column = np.nonzero(patches & ~neighbour)
        start = (row + first[0]) * columns + column + first[1]
        end = (row + last[0]) * columns + column + last[1]
        edges.append(np.stack([start, end], 1))
    return np.concatenate(edges)
