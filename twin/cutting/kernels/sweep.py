"""Hot loops of cutting: sweep the tool along straight stretches."""

import math
from typing import NamedTuple

from twin.compilation.kernel import array_kernel
from twin.cutting.kernels.tool_height import below_capsule, lowest_height
from twin.nc.canonical import FloatArray

_FAR = 1e9
"""Farther than any stock reaches [mm]."""


class Grid(NamedTuple):
    """Where the cells of a height map lie.

    Attributes:
        origin: X and Y of the middle of cell ``[0, 0]`` [mm].
        cell: Side of a cell [mm].
        bottom: Z below which there is nothing to cut [mm].
    """

    origin: tuple[float, float]
    cell: float
    bottom: float


class Removal(NamedTuple):
    """What each of n lines took off.

    Attributes:
        volume: Material, shape (n,) [mm³].
        depth: Greatest depth of it, shape (n,) [mm].
        aside: How far left of the line it lay in the mean, shape (n,) [mm]; 0 for a line straight
            down.
    """

    volume: FloatArray
    depth: FloatArray
    aside: FloatArray


@array_kernel
def sweep(
    heights: FloatArray,
    grid: Grid,
    points: FloatArray,
    profile: tuple[float, float, float, float],
    removal: Removal,
    marks: FloatArray,
    mark: FloatArray,
) -> tuple[int, int, int, int]:
    """Cut the material that the tool meets on its way from point to point.

    Every cell's new height is exact for the straight sweep: the lowest height over its middle
    that the tool's profile has anywhere along the line.

    Args:
        heights: The height map, shape (ny, nx) [mm]; changed in place.
        grid: Where its cells lie.
        points: Tool tip positions, shape (n, 3) [mm].
        profile: Radius, flat, corner, slope of ``twin.cutting.tools.Profile``.
        removal: Set to what each line took off, n - 1 of them.
        marks: Set to the line's ``mark`` where it cut, shape (ny, nx); of no size, if nobody asks.
        mark: What each line leaves in ``marks``, shape (n - 1,).

    Returns:
        First and last-but-one row, first and last-but-one column of the cells that changed.
    """
    row_first, row_end, column_first, column_end = heights.shape[0], 0, heights.shape[1], 0
    radius, cell = profile[0], grid.cell
    for i in range(len(points) - 1):
        volume, deepest, across, along = 0.0, 0.0, 0.0, 0.0
        ax, ay = points[i, 0], points[i, 1]
        bx, by = points[i + 1, 0], points[i + 1, 1]
        low = max(0, math.ceil((min(ay, by) - radius - grid.origin[1]) / cell))
        high = min(heights.shape[0] - 1, math.floor((max(ay, by) + radius - grid.origin[1]) / cell))
        # What the tool stands in already, no stretch that does not sink can take off again.
        stands = i > 0 and points[i + 1, 2] >= points[i, 2]
        for row in range(low, high + 1):
            y = grid.origin[1] + row * cell
            left, right = chord(ax, ay, bx, by, radius, y)
            first = max(0, math.ceil((left - grid.origin[0]) / cell))
            end = min(heights.shape[1] - 1, math.floor((right - grid.origin[0]) / cell)) + 1
            done, done_end = end, end
            if stands:
                left, right = _done(ax, ay, bx, by, radius, profile[1], y)
                if left <= right:
                    done = math.ceil((max(left, -_FAR) - grid.origin[0]) / cell)
                    done = _within(done, first, end)
                    done_end = math.floor((min(right, _FAR) - grid.origin[0]) / cell) + 1
                    done_end = _within(done_end, done, end)
            for begin, stop in ((first, done), (done_end, end)):
                if begin >= stop:
                    continue
                line = heights[row, begin:stop]
                x = grid.origin[0] + begin * cell
                before = line.copy() if marks.size else line
                cut, most, moment = _cut_row(line, x, y, grid, points[i], points[i + 1], profile)
                if cut > 0.0:
                    volume += cut
                    across += cut * (x - ax) + moment * cell
                    along += cut * (y - ay)
                    deepest = max(deepest, most)
                    row_first, row_end = min(row_first, row), max(row_end, row + 1)
                    column_first, column_end = min(column_first, begin), max(column_end, stop)
                    if marks.size:
                        _mark_lowered(marks[row, begin:stop], line, before, mark[i])
        length = math.hypot(bx - ax, by - ay)
        removal.aside[i] = 0.0
        if volume > 0.0 and length > 0.0:
            removal.aside[i] = (along * (bx - ax) - across * (by - ay)) / (volume * length)
        removal.volume[i] = volume * cell * cell
        removal.depth[i] = deepest
    return row_first, row_end, column_first, column_end


@array_kernel
def _mark_lowered(marks: FloatArray, heights: FloatArray, before: FloatArray, mark: float) -> None:
    for k in range(len(heights)):
        if heights[k] < before[k]:
            marks[k] = mark


@array_kernel
def chord(
    ax: float, ay: float, bx: float, by: float, radius: float, y: float
) -> tuple[float, float]:
    """Where the row at ``y`` crosses the outline of a disc swept from a to b [mm]."""
    left, right = math.inf, -math.inf
    for cx, cy in ((ax, ay), (bx, by)):
        squared = radius * radius - (y - cy) * (y - cy)
        if squared >= 0.0:
            half = math.sqrt(squared)
            left, right = min(left, cx - half), max(right, cx + half)
    dx, dy = bx - ax, by - ay
    length = math.hypot(dx, dy)
    if length > 0.0 and dy != 0.0:
        for side in (-radius, radius):
            share = (y - (ay + side * dx / length)) / dy
            if 0.0 <= share <= 1.0:
                x = ax - side * dy / length + share * dx
                left, right = min(left, x), max(right, x)
    return left, right


@array_kernel
def _done(
    ax: float, ay: float, bx: float, by: float, radius: float, flat: float, y: float
) -> tuple[float, float]:
    """Where the row at ``y`` lies under a tool at a that will only rise or stay level [mm].

    A flat tool has taken off all that it stands over; of any other the tool at a reaches lowest
    behind it, seen in the direction of travel. Left above right: nowhere.
    """
    if flat >= radius:
        squared = radius * radius - (y - ay) * (y - ay)
        if squared < 0.0:
            return 1.0, 0.0
        half = math.sqrt(squared)
        return ax - half, ax + half
    dx, dy = bx - ax, by - ay
    if dx > 0.0:
        return -math.inf, ax - (y - ay) * dy / dx
    if dx < 0.0:
        return ax - (y - ay) * dy / dx, math.inf
    if (y - ay) * dy <= 0.0:
        return -math.inf, math.inf
    return 1.0, 0.0


@array_kernel
def _within(value: int, low: int, high: int) -> int:
    return min(max(value, low), high)


@array_kernel
def _cut_row(
    line: FloatArray,
    x: float,
    y: float,
    grid: Grid,
    a: FloatArray,
    b: FloatArray,
    profile: tuple[float, float, float, float],
) -> tuple[float, float, float]:
    """Lower one run of cells.

    Returns:
        The sum and the greatest of what was taken off [mm], and the sum weighted with the number
        of the cell.
    """
    volume, deepest, moment = 0.0, 0.0, 0.0
    if profile[1] >= profile[0] and a[2] == b[2]:
        z = max(a[2], grid.bottom)
        for i in range(len(line)):
            cut = max(line[i] - z, 0.0)
            line[i] = min(line[i], z)
            volume += cut
            moment += cut * i
            deepest = max(deepest, cut)
        return volume, deepest, moment
    lowest = max(min(a[2], b[2]), grid.bottom)
    ball = profile[1] == 0.0 and profile[2] == profile[0]
    for i in range(len(line)):
        if line[i] <= lowest:
            continue
        if ball and below_capsule(x + i * grid.cell, y, line[i], a, b, profile[0]):
            continue
        z = max(lowest_height(x + i * grid.cell, y, a, b, profile), grid.bottom)
        cut = line[i] - z
        if cut > 0.0:
            line[i] = z
            volume += cut
            moment += cut * i
            deepest = max(deepest, cut)
    return volume, deepest, moment
