"""How far the middles of cells lie behind the walls that tools have cut.

Cutting takes a cell as a whole, by its middle. Of the cells that stand beside a wall the first may
therefore begin anywhere from nought to a whole cell behind it. Here it is kept how far, so that
what comes along later is held against the wall rather than against the cells.

No tool cuts under: what is free at some height is free above it. So of all that passed below a
cell's top the nearest tells how far before its middle the material begins at most, and who goes
only where tools have been is never said to reach into it.
"""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.compilation.compilable import inlined
from twin.compilation.kernel import kernel
from twin.cutting.kernels.covered_cells import Cells, chord
from twin.nc.canonical import FloatArray, IntArray

WallDistance = npt.NDArray[np.float32]
"""By cell: distance of its middle from the nearest tool that passed [cells], plus ``KNOWN``, and the
lowest that one of these was [mm], 0: none has passed. Then which share of the column is cut off by the nearest, how deep it
has passed [mm], which share is cut off by others below that, and the distance from the nearest of those that passed lowest, as
the first. Shape (ny, nx, 6)."""

KNOWN = 1.0
"""Added to distances, so that 0 can say that none is known [cells]."""
FARTHEST = 1.1
"""Distance up to which a wall is noted: a little more than to the row behind one that lies on a middle [cells]."""
HALF = 0.5
"""Distance that a height map is allowed not to know [cells]."""
_LEVEL_SHARE = 0.01
"""Rise of a way below which it counts as level."""
_DOUBT = 0.05
"""What paths that are simplified for cells and for walls may be off each other, and more [cells]."""
_SAME_SHARE = 0.005
"""Share of its column by which a wall has to come nearer to be cut again."""
EQUAL_MM = 1e-3
"""What passed no deeper below a cell's top than this has not passed beside it [mm]."""


def no_walls_known(heights: FloatArray) -> WallDistance:
    """Of a height map that no tool has cut."""
    return np.zeros((*heights.shape, 6), np.float32)


@inlined
def share_before(off, widest):
    """Share of a cell that lies before a wall; below 0 where the material goes on in front of the cell.

    The middles of a row of cells are ``widest`` apart across the wall. The first that stands answers for all that the
    count of whole cells is off, so that rows sum up to the very place of the wall.

    Args:
        off: How far the middle of the first cell that stands is behind the wall [cells].
        widest: The greater of the parts along X and Y of a unit vector across the wall.
    """
    return HALF - off / widest


@inlined
def cut_of_column(behind, row, column, height, lower):
    """What a column loses that is cut from a height to a lower one, as of a whole column [mm]."""
    told = behind[row, column]
    return height - lower - (cut_before(told, height) - cut_before(told, lower))


@inlined
def cut_before(told, height):
    """How much of a column that ends at a height walls have cut off before its middle, as of a whole column [mm]."""
    below = max(min(height, told[3]) - told[1], 0.0)
    return told[2] * max(height - told[3], 0.0) + told[4] * below


class _Passing(NamedTuple):
    """A tool that goes straight from one place of its tip to another.

    Attributes:
        side: How far above its tip its side begins [mm].
        lowest: Below which it has passed nothing [mm].
        highest: Of what it has cut [mm].
    """

    begin: FloatArray
    end: FloatArray
    radius: float
    side: float
    lowest: float
    highest: float


@kernel
def note_walls(
    cells: Cells,
    points: FloatArray,
    rows: IntArray,
    radius: float,
    flat: float,
    side: float,
    volume: FloatArray,
) -> None:
    """Note what a tool has passed by.

    Of a top that it has made a slope nothing is reported: deeper, it goes on before the cell's middle.

    Args:
        cells: The height map, cut along the way, whose walls are written.
        points: Tool tip positions, shape (n + 1, 3) [mm].
        rows: Those between which it went straight, the first and the last among them.
        radius: Of the tool [mm].
        flat: Radius of the level part of its lower end [mm].
        side: How far above its tip its side begins [mm].
        volume: What walls are off whole cells is added to that of each of the n stretches [mm³].
    """
    (heights, behind, grid), cell = cells, cells.grid.cell
    outer = radius + FARTHEST * cell
    for i in range(len(rows) - 1):
        a, b, stretches = points[rows[i]], points[rows[i + 1]], rows[i + 1] - rows[i]
        level = max(min(a[2], b[2]), grid.bottom) + EQUAL_MM
        if level >= grid.top:
            continue
        rise, way = abs(b[2] - a[2]), math.hypot(b[0] - a[0], b[1] - a[1])
        slopes = flat < radius or (way > 0.0 and rise > _LEVEL_SHARE * way)
        low = max(0, math.ceil((min(a[1], b[1]) - outer - grid.origin[1]) / cell))
        high = math.floor((max(a[1], b[1]) + outer - grid.origin[1]) / cell)
        passing = _Passing(a, b, radius, side, level, max(a[2], b[2]) + side + EQUAL_MM)
        for row in range(low, min(high, heights.shape[0] - 1) + 1):
            left, right = chord(a[0], a[1], b[0], b[1], outer, grid.origin[1] + row * cell)
            first = max(0, math.ceil((left - grid.origin[0]) / cell))
            end = min(heights.shape[1], math.floor((right - grid.origin[0]) / cell) + 1)
            # From either side up to what the tool covers.
            while first < end:
                off, gone, t = _pass_by(cells, row, first, passing)
                if off <= -_DOUBT:
                    break
                volume[rows[i] + min(int(t * stretches), stretches - 1)] += gone * cell * cell
                first += 1
            while end > first:
                off, gone, t = _pass_by(cells, row, end - 1, passing)
                if off <= -_DOUBT:
                    break
                volume[rows[i] + min(int(t * stretches), stretches - 1)] += gone * cell * cell
                end -= 1
            if slopes:
                for column in range(first, end):
                    note_wall(heights, behind, row, column, level, 0.0)


@kernel
def add_walls(
    volume: FloatArray, walls: FloatArray, path: FloatArray, reach: float, owed: float
) -> float:
    """Add what walls are off whole cells to what stretches took off by these.

    A wall is looked at while the tool comes towards it, comes by it and goes on: that it was taken for farther away at first
    is no chip, so each part of it is spread over what was cut within reach. Stretches that took off less than nothing have it
    from those that follow.

    Args:
        volume: Of n stretches that follow each other, by whole cells [mm³]; changed.
        walls: From ``note_walls``, shape (n,) [mm³].
        path: Length of each, shape (n,) [mm].
        reach: How far before and behind its place a part is spread [mm].
        owed: What stretches before them could not have, not above 0 [mm³].

    Returns:
        What these could not.
    """
    for i in range(len(walls)):
        if walls[i] == 0.0:
            continue
        first, last, before, behind = i, i, 0.5 * path[i], 0.5 * path[i]
        while first > 0 and before < reach:
            first -= 1
            before += path[first]
        while last < len(walls) - 1 and behind < reach:
            last += 1
            behind += path[last]
        length = 0.0
        for k in range(first, last + 1):
            if volume[k] != 0.0 or walls[k] != 0.0:
                length += path[k]
        if length == 0.0:
            volume[i] += walls[i]
            continue
        for k in range(first, last + 1):
            if volume[k] != 0.0 or walls[k] != 0.0:
                volume[k] += walls[i] * path[k] / length
    for i in range(len(volume)):
        owed += volume[i]
        volume[i] = max(owed, 0.0)
        owed = min(owed, 0.0)
    return owed


@inlined
def _pass_by(cells, row, column, passing):
    """Note a wall that a tool has passed along beside the middle of a cell, if it stands.

    Returns:
        How far the middle is from the tool's side [cells], what of the column is gone now, as of a whole one [mm],
        and at which share of its path it passed.
    """
    a, b, grid = passing.begin, passing.end, cells.grid
    x, y = grid.origin[0] + column * grid.cell - a[0], grid.origin[1] + row * grid.cell - a[1]
    dx, dy = b[0] - a[0], b[1] - a[1]
    squared, t, tip = dx * dx + dy * dy, 0.0, min(a[2], b[2])
    if squared > 0.0:
        t = min(1.0, max(0.0, (x * dx + y * dy) / squared))
        tip = a[2] + t * (b[2] - a[2])
    x, y = x - t * dx, y - t * dy
    apart = math.sqrt(x * x + y * y)
    off = (apart - passing.radius) / grid.cell
    if off <= -_DOUBT or cells.heights[row, column] <= passing.lowest:
        return off, 0.0, t
    widest = max(abs(x), abs(y)) / apart
    first = off <= widest - _DOUBT
    if not first and off < widest + _DOUBT:
        # Where the wall goes through the middles of cells, it is they that say which of them were cut.
        next_row = row - (0 if abs(x) >= abs(y) else 1 if y > 0.0 else -1)
        next_column = column - (0 if abs(x) < abs(y) else 1 if x > 0.0 else -1)
        rows, columns = cells.heights.shape
        inside = 0 <= next_row < rows and 0 <= next_column < columns
        first = inside and cells.heights[next_row, next_column] <= passing.highest
    share = share_before(off, widest) if first else 0.0
    foot = max(tip, grid.bottom) + EQUAL_MM + passing.side
    return off, _note_cut(cells, (row, column), passing.lowest, (off, share, foot)), t


@inlined
def _note_cut(cells, place, level, wall):
    """Note a wall before the middle of a cell that stands.

    Args:
        level: Below which the tool has not passed [mm].
        wall: How far the middle is behind it [cells], which share of the cell lies before it, and its foot [mm].

    Returns:
        What of the cell's column is gone now, as of a whole column [mm].
    """
    height, told, (off, share, foot) = cells.heights[place], cells.behind[place], wall
    before, lowest, down_to = cut_before(told, height), told[1], told[3]
    if told[0] == 0.0 or lowest >= height:
        before = 0.0
        told[2], told[3], told[4], told[5] = share, foot, 0.0, 0.0
    elif KNOWN + off < told[0] and abs(share - told[2]) > _SAME_SHARE:
        if foot > down_to:
            below = told[2] * (foot - down_to) + told[4] * (down_to - lowest)
            told[4] = below / (foot - lowest)
        told[2], told[3] = share, foot
    elif KNOWN + off < told[0] + _SAME_SHARE:
        # The same wall again: what the machine is off is no chip.
        told[3] = min(foot, down_to)
    elif foot < down_to:
        nearer = KNOWN + off < told[5]
        if nearer:
            # What came towards the cell comes by it now.
            below = share * (down_to - foot) + told[4] * max(foot - lowest, 0.0)
        else:
            below = told[4] * (down_to - lowest) + share * max(lowest - foot, 0.0)
        told[4] = below / (down_to - min(foot, lowest))
        if nearer or foot < lowest:
            told[5] = KNOWN + off
    note_wall(cells.heights, cells.behind, place[0], place[1], level, max(off, 0.0))
    return cut_before(told, height) - before


@inlined
def note_wall(heights, behind, row, column, level, off):
    """Note how far the middle of a cell is from a wall [cells] that goes down to a level, below its top."""
    height = heights[row, column]
    if height <= level:
        return
    told = behind[row, column]
    if told[0] == 0.0 or told[1] >= height:
        told[0], told[1] = KNOWN + off, level
    else:
        told[0], told[1] = min(told[0], KNOWN + off), min(told[1], level)


@inlined
def reach_before(stood, row, column, height):
    """How far before a cell's middle its material counts [mm]: what a wall is off by more than half a cell.

    Args:
        height: Its height [mm].
    """
    if stood.doubtful:
        return HALF * stood.grid.cell
    told = stood.behind[row, column]
    if told[0] == 0.0 or told[1] >= height:
        return 0.0
    return stood.grid.cell * min(max(told[0] - KNOWN - HALF, 0.0), HALF)


@inlined
def nearest_foot(x, y, a, b):
    """The place of a straight path from a to b that is nearest to another, seen from above [mm]."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    squared = dx * dx + dy * dy
    t = 0.0
    if squared > 0.0:
        t = min(1.0, max(0.0, ((x - a[0]) * dx + (y - a[1]) * dy) / squared))
    return a[0] + t * dx, a[1] + t * dy
