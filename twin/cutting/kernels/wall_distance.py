"""How far the middles of cells lie behind the walls that tools have cut.

Cutting takes a cell as a whole, by its middle. Of the cells that stand beside a wall the first may
therefore begin anywhere from nought to a whole cell behind it. Here it is kept how far, so that
what comes along later is held against the wall rather than against the cells.

No tool cuts under: what is free at some height is free above it. So of all that passed below a
cell's top the nearest tells how far before its middle the material begins at most, and who goes
only where tools have been is never said to reach into it.
"""

import enum
import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.compilation.compilable import inlined
from twin.compilation.kernel import kernel
from twin.cutting.kernels.covered_cells import Cells, LineColumn, chord
from twin.cutting.kernels.tool_height import Profile, profile_height
from twin.nc.canonical import FloatArray

WallDistance = npt.NDArray[np.float32]
"""What is known of the walls beside the cells of a height map, shape (ny, nx, len(WallColumn))."""


class WallColumn(enum.IntEnum):
    """What is known of the walls beside a cell: columns of ``WallDistance``."""

    DISTANCE = 0
    """Of the cell's middle from the nearest tool that passed [cells], plus ``KNOWN``; 0: none has passed."""
    LOWEST = 1
    """The lowest that any was that passed [mm]."""
    SHARE = 2
    """Share of the cell's column that the nearest has cut off."""
    FOOT = 3
    """How deep the nearest has passed [mm]."""
    SHARE_BELOW = 4
    """Share of the column that others have cut off below ``FOOT``."""
    LOWEST_DISTANCE = 5
    """As ``DISTANCE``, from the nearest of those that passed lowest."""
    DISTANCE_BELOW = 6
    """As ``DISTANCE``, from the nearest of all that passed below ``FOOT``."""


DISTANCE, LOWEST, SHARE, FOOT, SHARE_BELOW, LOWEST_DISTANCE, DISTANCE_BELOW = WallColumn

KNOWN = 1.0
"""Added to distances, so that 0 can say that none is known [cells]."""
FARTHEST = 1.1
"""Distance up to which a wall is noted: a little more than to the row behind one that lies on a middle [cells]."""
HALF = 0.5
"""Distance that a height map is allowed not to know [cells]."""
_LEVEL_SHARE = 0.01
"""Rise per length below which a path counts as level."""
_DOUBT = 0.05
"""What a tool may be off when it comes along a wall again [cells]."""
_SAME_SHARE = 0.005
"""Share of its column by which a wall has to come nearer to be cut again."""
EQUAL_MM = 1e-3
"""What passed no deeper below a cell's top than this has not passed beside it [mm]."""


def no_walls_known(heights: FloatArray) -> WallDistance:
    """Of a height map that no tool has cut."""
    return np.zeros((*heights.shape, len(WallColumn)), np.float32)


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
    """What a column loses that is cut from a height to a lower one, as of a whole column [mm].

    With what the nearest wall has passed gone, the walls below it are the nearest, if there are any.
    """
    wall = behind[row, column]
    gone = height - lower - (cut_before(wall, height) - cut_before(wall, lower))
    if lower < height and wall[DISTANCE] > 0.0:
        if lower <= wall[LOWEST]:
            wall[DISTANCE], wall[LOWEST], wall[SHARE], wall[FOOT] = 0.0, 0.0, 0.0, 0.0
            wall[SHARE_BELOW], wall[LOWEST_DISTANCE], wall[DISTANCE_BELOW] = 0.0, 0.0, 0.0
        elif wall[DISTANCE_BELOW] > 0.0 and lower <= wall[FOOT]:
            wall[DISTANCE], wall[SHARE], wall[FOOT] = (
                wall[DISTANCE_BELOW],
                wall[SHARE_BELOW],
                wall[LOWEST],
            )
            wall[SHARE_BELOW], wall[LOWEST_DISTANCE], wall[DISTANCE_BELOW] = 0.0, 0.0, 0.0
    return gone


@inlined
def cut_before(wall, height):
    """How much of a column that ends at a height walls have cut off before its middle, as of a whole column [mm]."""
    below = max(min(height, wall[FOOT]) - wall[LOWEST], 0.0)
    return wall[SHARE] * max(height - wall[FOOT], 0.0) + wall[SHARE_BELOW] * below


class _Passing(NamedTuple):
    """A tool that goes straight from one place of its tip to another.

    Attributes:
        side: How far above its tip its side begins [mm].
        lowest: Below which it has passed nothing [mm].
        highest: Of what it has cut [mm].
        done: Whether what it is beside at the beginning has been noted.
    """

    begin: FloatArray
    end: FloatArray
    radius: float
    side: float
    lowest: float
    highest: float
    done: bool


@kernel
def note_walls(
    cells: Cells,
    begin: FloatArray,
    end: FloatArray,
    profile: Profile,
    done: bool,
    sums: FloatArray,
) -> None:
    """Note what a tool has passed by on a straight path, as far as walls are off whole cells.

    Of a top that it has made a slope nothing is reported: deeper, it goes on before the cell's middle.

    Args:
        cells: The height map, cut up to the end of the path, whose walls are written.
        begin: Tool tip at its beginning, shape (3,) [mm].
        end: At its end.
        done: Whether what it is beside at the beginning has been noted.
        sums: What walls are off whole cells is added to it, shape (4,); see ``LineColumn``.
    """
    (heights, behind, grid), cell, (radius, flat, corner, slope) = cells, cells.grid.cell, profile
    outer = radius + FARTHEST * cell
    level = max(min(begin[2], end[2]), grid.bottom) + EQUAL_MM
    if level >= grid.top:
        return
    rise, length = abs(end[2] - begin[2]), math.hypot(end[0] - begin[0], end[1] - begin[1])
    slopes = flat < radius or (length > 0.0 and rise > _LEVEL_SHARE * length)
    low = max(0, math.ceil((min(begin[1], end[1]) - outer - grid.origin[1]) / cell))
    high = math.floor((max(begin[1], end[1]) + outer - grid.origin[1]) / cell)
    side = profile_height(radius, radius, flat, corner, slope)
    highest = max(begin[2], end[2]) + side + EQUAL_MM
    passing = _Passing(begin, end, radius, side, level, highest, done)
    middle_x, middle_y = 0.5 * (begin[0] + end[0]), 0.5 * (begin[1] + end[1])
    around = (outer + 0.5 * length) ** 2
    for row in range(low, min(high, heights.shape[0] - 1) + 1):
        y = grid.origin[1] + row * cell
        if length > cell:
            left, right = chord(begin[0], begin[1], end[0], end[1], outer, y)
        else:
            half = math.sqrt(max(around - (y - middle_y) ** 2, 0.0))
            left, right = middle_x - half, middle_x + half
        first = max(0, math.ceil((left - grid.origin[0]) / cell))
        last = min(heights.shape[1] - 1, math.floor((right - grid.origin[0]) / cell))
        # From either side up to what the tool covers.
        while first <= last and _pass_by(cells, row, first, passing, sums):
            first += 1
        while first <= last and _pass_by(cells, row, last, passing, sums):
            last -= 1
        if slopes:
            dx, before = end[0] - begin[0], (y - begin[1]) * (end[1] - begin[1])
            for column in range(first, last + 1):
                along = (grid.origin[0] + column * cell - begin[0]) * dx + before
                if along > 0.0 or not done:
                    note_wall(heights, behind, row, column, level, 0.0)
                    if behind[row, column, DISTANCE_BELOW] > 0.0:
                        behind[row, column, DISTANCE_BELOW] = KNOWN


@inlined
def _pass_by(cells, row, column, passing, sums):
    """Note a wall that a tool has passed along beside the middle of a cell, if it stands.

    Returns:
        Whether the tool does not cover the middle.
    """
    a, b, grid = passing.begin, passing.end, cells.grid
    x, y = grid.origin[0] + column * grid.cell - a[0], grid.origin[1] + row * grid.cell - a[1]
    dx, dy = b[0] - a[0], b[1] - a[1]
    squared, along, t, tip = dx * dx + dy * dy, x * dx + y * dy, 0.0, min(a[2], b[2])
    if squared > 0.0:
        t = 0.0 if along <= 0.0 else 1.0 if along >= squared else along / squared
        tip = a[2] + t * (b[2] - a[2])
    x, y = x - t * dx, y - t * dy
    apart, covered = x * x + y * y, passing.radius - _DOUBT * grid.cell
    if apart <= covered * covered:
        return False
    if (passing.done and along <= 0.0) or cells.heights[row, column] <= passing.lowest:
        return True
    apart = math.sqrt(apart)
    off = (apart - passing.radius) / grid.cell
    if off > FARTHEST:
        return True
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
    gone, depth = _note_cut(cells, (row, column), passing.lowest, (off, share, foot))
    if passing.lowest < foot - passing.side - EQUAL_MM:
        # It goes down, or has come up.
        _note_below(cells.behind[row, column], KNOWN + max(off, 0.0))
    sums[LineColumn.LOST] += gone
    sums[LineColumn.COLUMNS] += gone * column
    sums[LineColumn.ROWS] += gone * row
    if gone > 0.0:
        sums[LineColumn.DEEPEST] = max(sums[LineColumn.DEEPEST], depth)
    return True


@inlined
def _note_cut(cells, place, level, passed):
    """Note a wall before the middle of a cell that stands.

    Args:
        level: Below which the tool has not passed [mm].
        passed: How far the middle is behind it [cells], which share of the cell lies before it, and its foot [mm].

    Returns:
        What of the cell's column is gone now, as of a whole column, and how deep it is gone at most [mm].
    """
    height, wall, (off, share, foot) = cells.heights[place], cells.behind[place], passed
    before, lowest, down_to = cut_before(wall, height), wall[LOWEST], wall[FOOT]
    below = height
    if wall[DISTANCE] == 0.0 or lowest >= height:
        before = 0.0
        wall[SHARE], wall[FOOT], wall[SHARE_BELOW], wall[LOWEST_DISTANCE], wall[DISTANCE_BELOW] = (
            share,
            foot,
            0.0,
            0.0,
            0.0,
        )
    elif KNOWN + off < wall[DISTANCE] and abs(share - wall[SHARE]) > _SAME_SHARE:
        if foot > down_to:
            cut = wall[SHARE] * (foot - down_to) + wall[SHARE_BELOW] * (down_to - lowest)
            wall[SHARE_BELOW] = cut / (foot - lowest)
            if foot > down_to + EQUAL_MM:
                _note_below(wall, wall[DISTANCE])
        wall[SHARE], wall[FOOT] = share, foot
    elif KNOWN + off < wall[DISTANCE] + _SAME_SHARE:
        # The same wall again: what the machine is off is no chip.
        wall[FOOT], below = min(foot, down_to), min(height, down_to)
    elif foot < down_to:
        nearer, below = KNOWN + off < wall[LOWEST_DISTANCE], min(height, down_to)
        _note_below(wall, KNOWN + off)
        if nearer:
            # What came towards the cell comes by it now.
            cut = share * (down_to - foot) + wall[SHARE_BELOW] * max(foot - lowest, 0.0)
        else:
            cut = wall[SHARE_BELOW] * (down_to - lowest) + share * max(lowest - foot, 0.0)
        wall[SHARE_BELOW] = cut / (down_to - min(foot, lowest))
        if nearer or foot < lowest:
            wall[LOWEST_DISTANCE] = KNOWN + off
    note_wall(cells.heights, cells.behind, place[0], place[1], level, max(off, 0.0))
    return cut_before(wall, height) - before, below - foot


@inlined
def _note_below(wall, distance):
    """Note the distance of one that has passed below the nearest wall's foot."""
    wall[DISTANCE_BELOW] = (
        distance if wall[DISTANCE_BELOW] == 0.0 else min(wall[DISTANCE_BELOW], distance)
    )


@inlined
def note_wall(heights, behind, row, column, level, off):
    """Note how far the middle of a cell is from a wall [cells] that goes down to a level, below its top."""
    height = heights[row, column]
    if height <= level:
        return
    wall = behind[row, column]
    if wall[DISTANCE] == 0.0 or wall[LOWEST] >= height:
        wall[DISTANCE], wall[LOWEST], wall[SHARE_BELOW] = KNOWN + off, level, 0.0
        return
    wall[DISTANCE] = min(wall[DISTANCE], KNOWN + off)
    if level < wall[LOWEST]:
        # What is cut off below the nearest reaches farther down, and is no more for that.
        down_to = min(height, wall[FOOT])
        wall[SHARE_BELOW] *= max(down_to - wall[LOWEST], 0.0) / max(down_to - level, EQUAL_MM)
        wall[LOWEST] = level


@inlined
def reach_before(stood, row, column, height):
    """How far before a cell's middle its material counts [mm]: what a wall is off by more than half a cell.

    Args:
        height: Its height [mm].
    """
    if stood.provisional:
        return HALF * stood.grid.cell
    wall = stood.behind[row, column]
    if wall[DISTANCE] == 0.0 or wall[LOWEST] >= height:
        return 0.0
    return stood.grid.cell * min(max(wall[DISTANCE] - KNOWN - HALF, 0.0), HALF)


@inlined
def nearest_foot(x, y, a, b):
    """The place of a straight path from a to b that is nearest to another, seen from above [mm]."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    squared = dx * dx + dy * dy
    t = 0.0
    if squared > 0.0:
        t = min(1.0, max(0.0, ((x - a[0]) * dx + (y - a[1]) * dy) / squared))
    return a[0] + t * dx, a[1] + t * dy
