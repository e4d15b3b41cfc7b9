"""How far the middles of cells lie behind the walls that tools have cut.

Cutting takes a cell as a whole, by its middle. Of the cells that stand beside a wall the first may
therefore begin anywhere from nought to a whole cell behind it. Here it is kept how far, so that
what comes along later is held against the wall rather than against the cells.

No tool cuts under: what is free at some height is free above it. So of all that passed below a
cell's top the nearest tells how far before its middle the material begins at most, and who goes
only where tools have been is never said to reach into it.
"""

import math

import numpy as np
import numpy.typing as npt

from twin.compilation.compilable import inlined
from twin.compilation.kernel import kernel
from twin.cutting.kernels.covered_cells import Grid, chord
from twin.nc.canonical import FloatArray

WallDistance = npt.NDArray[np.float32]
"""By cell: distance of its middle from the nearest tool that passed [cells], plus ``KNOWN``, and the
lowest that one of these was [mm], shape (ny, nx, 2); 0: none has passed."""

KNOWN = 1.0
"""Added to distances, so that 0 can say that none is known [cells]."""
FARTHEST = 1.1
"""Distance up to which a wall is noted: a little more than to the row behind one that lies on a middle [cells]."""
HALF = 0.5
"""Distance that a height map is allowed not to know [cells]."""
_LEVEL_SHARE = 0.01
"""Rise of a path below which it counts as level."""
EQUAL_MM = 1e-3
"""What passed no deeper below a cell's top than this has not passed beside it [mm]."""


def no_walls_known(heights: FloatArray) -> WallDistance:
    """Of a height map that no tool has cut."""
    return np.zeros((*heights.shape, 2), np.float32)


@kernel
def note_walls(
    heights: FloatArray,
    behind: WallDistance,
    grid: Grid,
    points: FloatArray,
    radius: float,
    flat: float,
) -> None:
    """Note what a tool has passed by.

    Of a top that it has made a slope nothing is reported: deeper, it goes on before the cell's middle.

    Args:
        heights: The height map, cut along the path, shape (ny, nx) [mm].
        behind: What is known of its walls; written.
        points: Tool tip positions, shape (n, 3) [mm].
        radius: Of the tool [mm].
        flat: Radius of the level part of its lower end [mm].
    """
    cell, outer = grid.cell, radius + FARTHEST * grid.cell
    for i in range(len(points) - 1):
        a, b = points[i], points[i + 1]
        level = max(min(a[2], b[2]), grid.bottom) + EQUAL_MM
        if level >= grid.top:
            continue
        rise, run = abs(b[2] - a[2]), math.hypot(b[0] - a[0], b[1] - a[1])
        slopes = flat < radius or (run > 0.0 and rise > _LEVEL_SHARE * run)
        low = max(0, math.ceil((min(a[1], b[1]) - outer - grid.origin[1]) / cell))
        high = math.floor((max(a[1], b[1]) + outer - grid.origin[1]) / cell)
        for row in range(low, min(high, heights.shape[0] - 1) + 1):
            y = grid.origin[1] + row * cell
            left, right = chord(a[0], a[1], b[0], b[1], outer, y)
            first = max(0, math.ceil((left - grid.origin[0]) / cell))
            end = min(heights.shape[1], math.floor((right - grid.origin[0]) / cell) + 1)
            # From either side up to what the tool covers.
            while first < end:
                squared = _squared_distance(grid, first, y, a, b)
                if squared <= radius * radius:
                    break
                note_wall(heights, behind, row, first, level, (math.sqrt(squared) - radius) / cell)
                first += 1
            while end > first:
                squared = _squared_distance(grid, end - 1, y, a, b)
                if squared <= radius * radius:
                    break
                end -= 1
                note_wall(heights, behind, row, end, level, (math.sqrt(squared) - radius) / cell)
            if slopes:
                for column in range(first, end):
                    note_wall(heights, behind, row, column, level, 0.0)


@inlined
def _squared_distance(grid, column, y, a, b):
    """Of the middle of a cell from a path, seen from above [mm²]."""
    x = grid.origin[0] + column * grid.cell
    foot_x, foot_y = nearest_foot(x, y, a, b)
    return (x - foot_x) * (x - foot_x) + (y - foot_y) * (y - foot_y)


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
