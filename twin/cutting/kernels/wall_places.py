"""Where a mesh over a height map has its walls: its vertices beside a wall are moved onto it.

A vertex stands over the middle of a cell, and a wall passes between two of them. How far the middles of
cells that stand are behind walls is known (``wall_distance``); which way a wall faces, the cells beside them tell: along
a wall the distance stays, across it grows. So vertices on both sides of a wall come to lie on it, and the
faces between them are upright.
"""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.compilation.compilable import inlined
from twin.compilation.kernel import kernel
from twin.cutting.kernels.wall_distance import EQUAL_MM, KNOWN, WallColumn, WallDistance
from twin.nc.canonical import FloatArray, IntArray

NEARER_CELLS = 0.02
"""By how much a wall must lie before the blank's edge to be another one: single precision and the grid's shift [cells]."""
_FARTHEST = 1.5
"""How far a vertex is moved at most: to a wall that passes two of the grid's squares at a corner [spacings]."""
_ROUNDS = 3
"""Steps of Newton's method after which the direction of a wall no longer changes."""
_LEAST = 0.5
"""Height of the lowest step that is a wall [cells]."""
_EVEN = 0.5
"""By how much the foot of a wall and a vertex before it may differ in height: what a ball leaves is rounder [cells]."""
_NEAR = 0.01
"""Square of the distance within which walls count alike [square cells]."""


class Walls(NamedTuple):
    """A height map whose walls are looked for.

    Attributes:
        heights: Shape (ny, nx) [mm].
        behind: How far the middles of cells are behind walls.
        inside: How far they lie inside of the blank's edge, negative outside, shape (ny, nx) [cells].
    """

    heights: FloatArray
    behind: WallDistance
    inside: npt.NDArray[np.float32]


class Vertices(NamedTuple):
    """The vertices of a mesh over a height map.

    Attributes:
        x: In cells from the middle of the first one, shape (my, mx).
        y: As ``x``.
        z: Shape (my, mx) [mm].
        cell: Which gives each its height, counted through the map; -1: it does not belong to the blank, shape (my, mx).
        step: Cells from one to the next.
        spacing: As ``step`` [mm].
    """

    x: FloatArray
    y: FloatArray
    z: FloatArray
    cell: IntArray
    step: int
    spacing: float


class _Place(NamedTuple):
    """Where a vertex is.

    Attributes:
        x: [cells].
        y: [cells].
        z: [mm].
        at_foot: Whether the wall rises from it.
    """

    x: float
    y: float
    z: float
    at_foot: bool


@kernel
def onto_walls(walls: Walls, vertices: Vertices, moved: FloatArray) -> None:
    """Find by how much each vertex beside a wall is off it.

    Args:
        moved: Set to the shift of each vertex onto its wall in X and Y [cells], and along the surface up [mm], 0 where there is
            no wall, shape (my, mx, 3).
    """
    for row in range(vertices.z.shape[0]):
        for column in range(vertices.z.shape[1]):
            moved[row, column] = 0.0
            if vertices.cell[row, column] < 0:
                continue
            low, high = _span(vertices, row, column)
            z = vertices.z[row, column]
            rise, fall = high - z, z - low
            if max(rise, fall) <= _LEAST * vertices.spacing / vertices.step:
                continue
            place = _Place(vertices.x[row, column], vertices.y[row, column], z, rise >= fall)
            x, y = _to_wall(walls, place, vertices)
            if math.hypot(x, y) <= _FARTHEST * vertices.step:
                moved[row, column, 0], moved[row, column, 1] = x, y
                moved[row, column, 2] = _step_down(
                    vertices, (row, column), (row, column - _sign(x))
                ) * abs(x)
                moved[row, column, 2] += _step_down(
                    vertices, (row, column), (row - _sign(y), column)
                ) * abs(y)


@inlined
def _sign(value):
    return 1 if value > 0.0 else -1


@inlined
def _step_down(vertices, here, there):
    """How much lower the surface is at another vertex, a cell on [mm]; 0 where it is steeper than 45 degrees."""
    rows, columns = vertices.z.shape
    if not (0 <= there[0] < rows and 0 <= there[1] < columns) or vertices.cell[there] < 0:
        return 0.0
    lower = vertices.z[here] - vertices.z[there]
    return lower / vertices.step if abs(lower) <= vertices.spacing else 0.0


@inlined
def _span(vertices, row, column):
    """The lowest and the highest of a vertex and the four beside it [mm]."""
    low = high = vertices.z[row, column]
    for down, along in ((0, 1), (1, 0), (0, -1), (-1, 0)):
        y, x = row + down, column + along
        within = 0 <= y < vertices.z.shape[0] and 0 <= x < vertices.z.shape[1]
        if within and vertices.cell[y, x] >= 0:
            low, high = min(low, vertices.z[y, x]), max(high, vertices.z[y, x])
    return low, high


@kernel
def _to_wall(walls: Walls, place: _Place, vertices: Vertices) -> tuple[float, float]:
    """The shift from a place onto the nearest walls [cells]."""
    rows, columns = walls.heights.shape
    middle_row, middle_column = round(place.y), round(place.x)
    for ring in range(vertices.step + 1):
        sum_x = sum_y = total = 0.0
        for row in range(max(0, middle_row - ring), min(rows, middle_row + ring + 1)):
            next_column = 1 if abs(row - middle_row) == ring else 2 * ring
            for column in range(middle_column - ring, middle_column + ring + 1, next_column):
                if not 0 <= column < columns:
                    continue
                if not _ends_at(walls, row, column, place, vertices.spacing / vertices.step):
                    continue
                off, normal_x, normal_y = _wall_before(walls, row, column)
                if off < 0.0:
                    continue
                x, y = place.x - column, place.y - row
                tall = walls.heights[row, column] - walls.behind[row, column, WallColumn.LOWEST]
                weight = (tall / (x * x + y * y + _NEAR)) ** 2
                behind = off + x * normal_x + y * normal_y
                sum_x -= weight * behind * normal_x
                sum_y -= weight * behind * normal_y
                total += weight
        if total > 0.0:
            return sum_x / total, sum_y / total
    return 0.0, 0.0


@inlined
def _ends_at(walls, row, column, place, cell):
    """Whether the upper edge of the wall before a cell, or its foot, is as high as a place."""
    wall = walls.behind[row, column]
    lowest, foot = wall[WallColumn.LOWEST], wall[WallColumn.FOOT]
    if not place.at_foot:
        return foot <= place.z + 2.0 * EQUAL_MM
    off = min(abs(lowest - place.z), abs(foot - place.z))
    return walls.heights[row, column] > place.z + EQUAL_MM and off < _EVEN * cell


@kernel
def _wall_before(walls: Walls, row: int, column: int) -> tuple[float, float, float]:
    """How far a cell's middle is behind the wall next to it, negative where there is none, and the way into the material."""
    off = _behind_cut(walls, row, column)
    if off < 0.0:
        return -1.0, 0.0, 0.0
    rows, columns = walls.heights.shape
    own, x, y = walls.heights[row, column], 0.0, 0.0
    for down in range(-1, 2):
        for along in range(-1, 2):
            to_row, to_column = row + down, column + along
            within = 0 <= to_row < rows and 0 <= to_column < columns
            if not within or walls.heights[to_row, to_column] < own - EQUAL_MM:
                away = max(down * down + along * along, 1)
                x, y = x - along / away, y - down / away
    if x == 0.0 and y == 0.0:
        return -1.0, 0.0, 0.0
    for _ in range(_ROUNDS):
        size, error, slope = math.hypot(x, y), 0.0, 0.0
        x, y = x / size, y / size
        for down in range(-1, 2):
            for along in range(-1, 2):
                to_row, to_column = row + down, column + along
                if not (0 <= to_row < rows and 0 <= to_column < columns):
                    continue
                beside = _behind_cut(walls, to_row, to_column)
                higher = walls.behind[to_row, to_column, WallColumn.LOWEST] >= own - EQUAL_MM
                if beside < 0.0 or higher or walls.heights[to_row, to_column] < own - EQUAL_MM:
                    continue
                across = along * y - down * x
                error += across * (off + along * x + down * y - beside)
                slope += across * across
        turn = error / slope if slope > 0.0 else 0.0
        x, y = x - turn * y, y + turn * x
    size = math.hypot(x, y)
    return off, x / size, y / size


@inlined
def _behind_cut(walls, row, column):
    """How far a cell's middle is behind a wall that was cut [cells]; negative where none is known but the blank's own side."""
    wall = walls.behind[row, column]
    off = wall[WallColumn.DISTANCE] - KNOWN
    known = off > 0.0 and wall[WallColumn.LOWEST] < walls.heights[row, column]
    return off if known and walls.inside[row, column] - off > NEARER_CELLS else -1.0
