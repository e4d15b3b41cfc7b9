"""A mesh of vertices over a height map, with a rim that lies exactly on the blank's edge.

Cells are cut as a whole, by their middles. A cutter that leaves less than a cell beside the blank's
edge takes some cells of the rim and leaves others, so that a rim drawn by its cells alone would be a
fringe of teeth. How far such a wall lies before the middles of the cells that stand is known
(``twin/cutting/kernels/wall_distance.py``): there the rim is lowered, and the cells' vertices lie on the wall.
"""

import dataclasses

import numpy as np

from twin.cutting.heights.height_map import HeightMap
from twin.cutting.heights.outline import BoolArray
from twin.cutting.kernels.wall_distance import KNOWN
from twin.nc.canonical import FloatArray, IntArray

NEARER_CELLS = 0.02
"""By how much a wall must lie before the blank's edge to be another one: single precision and the grid's shift [cells]."""
BEHIND_CELLS = 0.5
"""How far behind such a wall the middles of cells may be cut that belong to it; others are a slot's [cells]."""
BAND_CELLS = 2.2
"""How far inside of the edge the middles of such cells lie at most [cells]."""

_NEIGHBOURS = ((0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1))


@dataclasses.dataclass(frozen=True, slots=True)
class SurfaceMesh:
    """Vertices in the middles of cells, and a rim around them; it stays as the map is cut.

    Attributes:
        x: Shape (my, mx) [mm].
        y: Shape (my, mx) [mm].
        cell: The cell, counted through the map's heights, that gives each vertex its height,
            shape (my, mx); -1 for vertices that do not belong to the blank.
        rim: Vertices on the blank's edge, counted through the mesh, shape (n,).
        band: Cells near the blank's edge, counted through the map's heights, shape (m,).
        patches: Which squares between four vertices belong to the blank, shape (my-1, mx-1).
        spacing: Between vertices, except towards the rim [mm].
    """

    x: FloatArray
    y: FloatArray
    cell: IntArray
    rim: IntArray
    band: IntArray
    patches: BoolArray
    spacing: float

    def heights(self, height_map: HeightMap) -> FloatArray:
        """Height of every vertex, shape (my, mx) [mm]; the bottom where there is no blank."""
        result = np.where(self.cell < 0, height_map.bottom, height_map.heights.ravel()[self.cell])
        cells, _, foot = _cut_rim(height_map, self.band)
        lowered = np.full(height_map.heights.size, np.inf)
        lowered[cells] = foot
        result.ravel()[self.rim] = np.minimum(
            result.ravel()[self.rim], lowered[self.cell.ravel()[self.rim]]
        )
        return result

    def places(self, height_map: HeightMap) -> tuple[FloatArray, FloatArray]:
        """X and Y of every vertex, each of shape (my, mx) [mm]: those behind a cut rim lie on its wall."""
        x, y = self.x.copy(), self.y.copy()
        cells, outwards, _ = _cut_rim(height_map, self.band)
        moved = np.zeros((height_map.heights.size, 2))
        moved[cells] = outwards
        inner = np.ones(x.size, np.bool_)
        inner[self.rim] = False
        inner &= self.cell.ravel() >= 0
        x.ravel()[inner] += moved[self.cell.ravel()[inner], 0]
        y.ravel()[inner] += moved[self.cell.ravel()[inner], 1]
        return x, y


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
        _band(height_map),
        all_corners(cell >= 0) & ~all_corners(~inside),
        spacing,
    )


def _band(height_map: HeightMap) -> IntArray:
    inside = height_map.outline.inside(height_map.x, height_map.y[:, None])
    return np.nonzero(((inside >= 0.0) & (inside <= BAND_CELLS * height_map.cell)).ravel())[0]


def _cut_rim(height_map: HeightMap, band: IntArray) -> tuple[IntArray, FloatArray, FloatArray]:
    """Cells that stand at the blank's edge behind a wall that was cut between it and their middles.

    Args:
        band: The cells near the edge, counted through the map's heights.

    Returns:
        The cells, the displacement from each one's middle to its wall, shape (n, 2) [mm], and the height at
        the wall's foot, shape (n,) [mm]; of a cut so thin that it took no cell at all, none.
    """
    heights, size = height_map.heights, height_map.cell
    row, column = np.divmod(band, heights.shape[1])
    x, y = height_map.x[column], height_map.y[row]
    edge = height_map.outline.inside(x, y) / size
    told, lowest = height_map.behind[row, column, 0] - KNOWN, height_map.behind[row, column, 1]
    wall = edge - told
    cut = (told >= 0.0) & (wall > NEARER_CELLS) & (heights[row, column] > lowest)
    cells, row, column, x, y = band[cut], row[cut], column[cut], x[cut], y[cut]
    told, wall, own = told[cut], wall[cut], heights[row, column]
    foot, slot = np.full(len(cells), np.inf), np.zeros(len(cells), np.bool_)
    for down, along in _NEIGHBOURS:
        there = np.clip(row + down, 0, heights.shape[0] - 1)
        beside = np.clip(column + along, 0, heights.shape[1] - 1)
        inside = height_map.outline.inside(height_map.x[beside], height_map.y[there]) / size
        lower = (heights[there, beside] < own) & (inside >= 0.0)
        before = lower & (inside < wall + BEHIND_CELLS)
        slot |= lower & ~before
        foot = np.where(before, np.minimum(foot, heights[there, beside]), foot)
    foot = _of_the_nearest(
        np.arctan2(y - height_map.outline.center[1], x - height_map.outline.center[0]), foot
    )
    keep = ~slot & (foot < own)
    outwards = -height_map.outline.inwards(x, y) * (told * size)[:, None]
    return cells[keep], outwards[keep], foot[keep]


def _of_the_nearest(turn: FloatArray, values: FloatArray) -> FloatArray:
    """Values around a middle, where one is infinite that of the nearest other; all infinite: as they are."""
    order = np.argsort(turn)
    known = order[np.isfinite(values[order])]
    if not len(known):
        return values
    turns = np.concatenate([turn[known[-1:]] - 2 * np.pi, turn[known], turn[known[:1]] + 2 * np.pi])
    around = np.concatenate([values[known[-1:]], values[known], values[known[:1]]])
    after = np.searchsorted(turns, turn).clip(1, len(turns) - 1)
    nearest = np.where(turn - turns[after - 1] <= turns[after] - turn, after - 1, after)
    return np.where(np.isfinite(values), values, around[nearest])


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
