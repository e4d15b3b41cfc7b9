"""A net of vertices over a height map, with a rim that lies exactly on the blank's edge."""

import dataclasses

import numpy as np

from twin.cutting.height_map import HeightMap
from twin.cutting.outline import BoolArray
from twin.nc.canonical import FloatArray, IntArray

_NEIGHBOURS = ((0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1))


@dataclasses.dataclass(frozen=True, slots=True)
class Net:
    """Vertices in the middles of cells, and a rim around them; it stays as the map is cut.

    Attributes:
        x: Shape (my, mx) [mm].
        y: Shape (my, mx) [mm].
        cell: The cell, counted through the map's heights, that gives each vertex its height,
            shape (my, mx); -1 for vertices that do not belong to the blank.
        patches: Which squares between four vertices belong to the blank, shape (my-1, mx-1).
        spacing: Between vertices, except towards the rim [mm].
    """

    x: FloatArray
    y: FloatArray
    cell: IntArray
    patches: BoolArray
    spacing: float

    def heights(self, height_map: HeightMap) -> FloatArray:
        """Height of every vertex, shape (my, mx) [mm]; the bottom where there is no blank."""
        return np.where(self.cell < 0, height_map.bottom, height_map.heights.ravel()[self.cell])


def net(height_map: HeightMap, step: int = 1) -> Net:
    """The net of a height map.

    Args:
        height_map: Cut or uncut.
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
    return Net(
        np.where(inside, grid_x, snapped_x),
        np.where(inside, grid_y, snapped_y),
        cell,
        all_corners(cell >= 0) & ~all_corners(~inside),
        spacing,
    )


def all_corners(vertices: BoolArray) -> BoolArray:
    """Squares all of whose four corners are marked, shape (my - 1, mx - 1)."""
    return vertices[:-1, :-1] & vertices[1:, :-1] & vertices[:-1, 1:] & vertices[1:, 1:]


def surface_faces(patches: BoolArray) -> IntArray:
    """Two triangles for each patch, counter-clockwise from above, as vertex numbers, (2n, 3)."""
    columns = patches.shape[1] + 1
    row, column = np.nonzero(patches)
    a = row * columns + column
    b, c, d = a + 1, a + columns + 1, a + columns
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
