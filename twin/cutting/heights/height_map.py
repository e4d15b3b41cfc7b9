"""The height map: how high the material is over every cell of the part's own frame.

The rotary table turns about Z, so that the tool never tilts against the part and one height per
cell describes the part exactly, up to the size of the cells.
"""

import dataclasses
from pathlib import Path

import numpy as np

from twin.cutting.heights.outline import BlankOutline, BoolArray, outline
from twin.cutting.kernels.covered_cells import Cells, Grid
from twin.cutting.kernels.rasterize import rasterize
from twin.cutting.kernels.wall_distance import KNOWN, WallDistance, no_walls_known, share_before
from twin.cutting.kernels.walls import BASE, REACH, WallArray, no_walls
from twin.errors import ConfigError
from twin.files.stl import read_stl
from twin.job.job_file import StockTable
from twin.nc.canonical import FloatArray

CELL_LIMIT = 64_000_000
"""Cells that a height map may have: half a gigabyte of heights."""
ASIDE_MM = 1e-5
"""How far the grid lies beside the blank's middle [mm]. A slot whose sides go through the middles of cells,
as round numbers do along the grid, takes those on one side only, and not a whole row too many."""


@dataclasses.dataclass(slots=True)
class HeightMap:
    """Columns of material on a square grid, in the part's frame.

    Attributes:
        origin: X and Y of the middle of cell ``[0, 0]`` [mm].
        cell: Side of a cell [mm].
        bottom: Z of the underside [mm].
        heights: Z of the material over each cell, shape (ny, nx) [mm]; ``bottom`` where there is
            none. This is what cutting changes.
        top: Z of the blank's top face [mm].
        uncut: Z of the blank's own surface over each cell, shape (ny, nx) [mm].
        behind: How far the middles of cells are behind walls.
    """

    origin: tuple[float, float]
    cell: float
    bottom: float
    heights: FloatArray
    top: float
    outline: BlankOutline
    uncut: FloatArray
    behind: WallDistance

    @property
    def grid(self) -> Grid:
        """Where the cells lie."""
        return Grid(self.origin, self.cell, self.bottom, self.top)

    @property
    def cells(self) -> Cells:
        """What kernels take."""
        return Cells(self.heights, self.behind, self.grid)

    @property
    def volume(self) -> float:
        """Material that is left, up to the very walls [mm³]."""
        _, lowest, near, down_to, far, *_ = np.moveaxis(self.behind, -1, 0)
        cut = near * np.maximum(self.heights - down_to, 0.0)
        cut += far * np.maximum(np.minimum(self.heights, down_to) - lowest, 0.0)
        return float((self.heights - self.bottom - cut).sum()) * self.cell**2

    @property
    def x(self) -> FloatArray:
        """X of the middles of the columns of cells, shape (nx,) [mm]."""
        return self.origin[0] + self.cell * np.arange(self.heights.shape[1])

    @property
    def y(self) -> FloatArray:
        """Y of the middles of the rows of cells, shape (ny,) [mm]."""
        return self.origin[1] + self.cell * np.arange(self.heights.shape[0])

    @property
    def corners(self) -> FloatArray:
        """Two opposite corners of the box around the blank, shape (2, 3) [mm]."""
        center, half = np.array(self.outline.center), np.array(self.outline.half)
        return np.array([[*(center - half), self.bottom], [*(center + half), self.top]])

    def solid(self) -> BoolArray:
        """Cells that hold any material, shape (ny, nx)."""
        return self.heights > self.bottom

    def machined(self) -> BoolArray:
        """Cells that lie lower than the blank's own surface, shape (ny, nx)."""
        return self.heights < self.uncut

    def copy(self) -> "HeightMap":
        """A map that can be cut without touching this one."""
        return dataclasses.replace(self, heights=self.heights.copy(), behind=self.behind.copy())


def blank(stock: StockTable, corner: FloatArray, cell: float) -> HeightMap:
    """The uncut stock as a height map; a cell holds material when its middle lies in the blank.

    Of an STL file's shape the highest surface counts, with material all the way down below it.

    Args:
        corner: Where the blank's program coordinates have their origin in the part's frame,
            shape (3,) [mm]: the part zero less the centre of the table.
        cell: Side of a cell [mm].

    Raises:
        ConfigError: The map would have more cells than ``CELL_LIMIT``, an STL file is wrong, or the blank is a
            cylinder that lies.
    """
    if stock.lies:
        raise ConfigError(
            f"a blank that lies along {stock.axis} is cut by a run, not here: stock.axis = 'Z' stands it up"
        )
    center = np.asarray(stock.position) + corner
    width, depth, height = stock.extent
    count_x, count_y = max(1, round(width / cell)), max(1, round(depth / cell))
    if count_x * count_y > CELL_LIMIT:
        coarsest = (width * depth / CELL_LIMIT) ** 0.5
        raise ConfigError(
            f"stock.cell = {cell:g} mm would need {count_x} x {count_y} cells; "
            f"{coarsest:.2g} mm is the finest for this stock"
        )
    origin = (
        float(center[0]) - 0.5 * (count_x - 1) * cell + ASIDE_MM,
        float(center[1]) - 0.5 * (count_y - 1) * cell + ASIDE_MM,
    )
    top, bottom = float(center[2]), float(center[2]) - height
    edge = outline(stock, (float(center[0]), float(center[1])))
    shape = (count_y, count_x)
    heights = np.full(shape, top)
    behind, uncut = no_walls_known(heights), np.broadcast_to(top, shape)
    result = HeightMap(origin, cell, bottom, heights, top, edge, uncut, behind)
    within = edge.contains(result.x, result.y[:, None])
    heights[~within] = bottom
    if stock.file is None:
        inside = edge.inside(result.x, result.y[:, None])
        beside = within & (inside <= cell)
        off, share = inside[beside] / cell, _share_outside(result, beside)
        raw = np.broadcast_arrays(off + KNOWN, bottom, share, bottom, 0.0, 0.0, 0.0)
        behind[beside] = np.column_stack(raw)
    if stock.file is not None:
        mesh = read_stl(Path(stock.file))
        low, high = mesh.bounds
        middle = np.array([*(0.5 * (low + high))[:2], high[2]])
        triangles = np.ascontiguousarray(mesh.triangles - middle + center, dtype=np.float64)
        heights[:], behind[:] = bottom, 0.0
        rasterize(heights, result.origin, cell, triangles)
        result.uncut = heights.copy()
        behind[_beside_lower(heights, bottom)] = KNOWN, bottom, 0.0, bottom, 0.0, 0.0, 0.0
    return result


def _share_outside(uncut: HeightMap, cells: BoolArray) -> FloatArray:
    """Which share of some cells by the blank's sides lies outside of it; see ``share_before``."""
    rows, columns = np.nonzero(cells)
    x, y = uncut.x[columns], uncut.y[rows]
    off = uncut.outline.inside(x, y) / uncut.cell
    widest = np.abs(uncut.outline.inwards(x, y)).max(axis=1)
    return np.where(off < widest, share_before(off, widest), 0.0)


def raw_walls(uncut: HeightMap) -> WallArray:
    """The blank's own sides as walls that forces know closer than by cells; none of an STL's."""
    walls = no_walls(uncut.heights)
    if (uncut.uncut < uncut.top).any():
        return walls
    rows, columns = np.nonzero(
        np.abs(uncut.outline.inside(uncut.x, uncut.y[:, None])) <= REACH * uncut.cell
    )
    x, y = uncut.x[columns], uncut.y[rows]
    off = uncut.outline.inside(x, y) / uncut.cell + BASE
    walls[rows, columns] = off[:, None] * uncut.outline.inwards(x, y)
    return walls


def _beside_lower(heights: FloatArray, bottom: float) -> BoolArray:
    """Cells that stand higher than one beside them: how far before their middles is not known."""
    around = np.pad(heights, 1, constant_values=bottom)
    rows, columns = _least_of_three(around), _least_of_three(around.T).T
    return heights > np.minimum(rows[:, 1:-1], columns[1:-1])


def _least_of_three(values: FloatArray) -> FloatArray:
    """The least of each row and the two beside it."""
    return np.minimum(np.minimum(values[:-2], values[1:-1]), values[2:])
