"""How far the surfaces of two height maps are from each other, beside their walls too.

Over a cell at which one map is higher, the other has either to be cut down to it or to be built up to
it: what counts is how far the higher top is from the other's material, straight down or sideways,
whichever is less. Where walls lie is known closer than by whole cells (``wall_distance``): a cell that both
maps hold tells by how much one wall lies before the other.
"""

import enum
import math
from typing import NamedTuple

from twin.compilation.compilable import inlined
from twin.compilation.kernel import kernel
from twin.cutting.kernels.wall_distance import HALF, KNOWN, WallColumn, WallDistance
from twin.nc.canonical import BoolArray, FloatArray, IntArray

REACH = 32
"""How far sideways material is looked for [cells]; what has none as near counts as this far off."""
SAME_MM = 1e-3
"""Heights that differ by no more are the same: files of meshes hold single precision [mm]."""
_SIDEWAYS = 0.35
"""By the nearest middle behind it, a wall that is not along the grid seems up to this farther [cells]."""


class FoundBy(enum.IntEnum):
    """What a distance was found by."""

    HEIGHT = 0
    WALL = 1
    """A wall whose place is known."""
    CELLS = 2
    """Cells alone, of which one may be wrong."""


class MapSurface(NamedTuple):
    """A height map as distances see it.

    Attributes:
        heights: Shape (ny, nx) [mm].
        behind: How far the middles of cells are behind walls.
    """

    heights: FloatArray
    behind: WallDistance


@kernel
def surface_distances(
    part: MapSurface,
    nominal: MapSurface,
    cell: float,
    wanted: BoolArray,
    flat: BoolArray,
    found: FloatArray,
    found_by: IntArray,
) -> None:
    """Distances of a part's surface from the nominal one.

    Args:
        nominal: What it should be, on the same grid.
        cell: Side of a cell [mm].
        wanted: Cells to look at, shape (ny, nx).
        flat: Cells around which both are no steeper than 45 degrees, shape (ny, nx): a floor at the foot of
            walls that both have is held against the other's floor, not against the walls.
        found: Set there: positive where the part has more material [mm].
        found_by: Set there: ``FoundBy.HEIGHT``, ``FoundBy.WALL`` or ``FoundBy.CELLS``.
    """
    for row in range(wanted.shape[0]):
        for column in range(wanted.shape[1]):
            if not wanted[row, column]:
                continue
            above = part.heights[row, column] - nominal.heights[row, column]
            distance, how = 0.0, FoundBy.HEIGHT
            if above > SAME_MM:
                distance, how = _distance(part, nominal, cell, (row, column), flat[row, column])
            elif above < -SAME_MM:
                distance, how = _distance(nominal, part, cell, (row, column), flat[row, column])
                distance = -distance
            before, seen = _wall_difference(part, nominal, row, column)
            if seen and how != FoundBy.CELLS and abs(before * cell) >= abs(distance):
                distance, how = before * cell, FoundBy.WALL
            found[row, column], found_by[row, column] = distance, how


@inlined
def _known(surface, row, column, height):
    """Distance of a middle from the wall beside it, at a height [cells]; 0: not known."""
    wall = surface.behind[row, column]
    if wall[WallColumn.DISTANCE] <= KNOWN or wall[WallColumn.LOWEST] >= height - SAME_MM:
        return 0.0
    return wall[WallColumn.DISTANCE] - KNOWN


@kernel
def _wall_difference(
    one: MapSurface, other: MapSurface, row: int, column: int
) -> tuple[float, bool]:
    """How much farther before a cell that both hold the wall of one is than the other's [cells]."""
    height = min(one.heights[row, column], other.heights[row, column])
    here, there = _known(one, row, column, height), _known(other, row, column, height)
    return here - there, here > 0.0 and there > 0.0


@kernel
def _distance(
    higher: MapSurface, lower: MapSurface, cell: float, place: tuple[int, int], flat: bool
) -> tuple[float, int]:
    """Distance of the higher one's top over a cell from the lower one's material [mm]."""
    row, column = place
    rows, columns = lower.heights.shape
    top = higher.heights[row, column] - SAME_MM
    down = higher.heights[row, column] - lower.heights[row, column]
    nearest, how = min(down / cell, REACH + 0.0), FoundBy.HEIGHT
    compared, difference = math.inf, -math.inf
    for ring in range(1, REACH):
        if ring - 1.0 >= nearest:
            break
        for y in range(max(0, row - ring), min(rows, row + ring + 1)):
            step = 1 if abs(y - row) == ring else 2 * ring
            for x in range(column - ring, column + ring + 1, step):
                if x < 0 or x >= columns or lower.heights[y, x] < top:
                    continue
                if flat and higher.heights[y, x] > top + cell:
                    continue
                here, there = _known(higher, y, x, top), _known(lower, y, x, top)
                before = there if there > 0.0 else _slope_share(lower, y, x, (row, column), top)
                gap = math.hypot(y - row, x - column) - before
                if gap < nearest:
                    nearest, how = gap, FoundBy.WALL if there > 0.0 else FoundBy.CELLS
                if there > 0.0 and here > 0.0 and gap < compared:
                    compared, difference = gap, here - there
    if how == FoundBy.HEIGHT:
        return nearest * cell, FoundBy.HEIGHT
    outer = _known(higher, row, column, top)
    across = max(nearest, 0.0) + outer
    if difference >= across - _SIDEWAYS:
        # What both hold tells the same, and closer.
        across = max(outer, min(difference, across))
    return across * cell, how


@kernel
def _slope_share(lower: MapSurface, y: int, x: int, place: tuple[int, int], top: float) -> float:
    """How far before a middle material reaches up to a height, where no wall tells [cells]."""
    row, column = place
    toward_y, toward_x = y, x
    if abs(y - row) >= abs(x - column):
        toward_y -= 1 if y > row else -1
    if abs(x - column) >= abs(y - row):
        toward_x -= 1 if x > column else -1
    high, low = lower.heights[y, x], lower.heights[toward_y, toward_x]
    if high - low <= SAME_MM:
        return HALF
    return min(1.0, max(0.0, (high - top) / (high - low)))
