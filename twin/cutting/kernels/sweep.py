"""Hot loops of cutting: sweep the tool along straight stretches."""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.compilable import inlined
from twin.compilation.kernel import arithmetic_kernel, threaded_kernel
from twin.cutting.kernels.covered_cells import (
    Cells,
    Grid,
    LineColumn,
    Marks,
    Scratch,
    columns_of,
    lay_disc,
    outline_of,
    span_of,
)
from twin.cutting.kernels.run_heights import lowest_in_run
from twin.cutting.kernels.tool_height import Profile
from twin.cutting.kernels.wall_distance import cut_of_column, note_walls
from twin.nc.canonical import BoolArray, FloatArray

RUN = 128
"""Cells that are looked at together."""


class Removal(NamedTuple):
    """What each of n lines took off.

    Attributes:
        volume: Material, shape (n,) [mm³].
        depth: Greatest depth of it, shape (n,) [mm].
        aside: How far left of the line it lay in the mean, shape (n,) [mm]; 0 for a line straight
            down.
        thickness: How thick it was across the line at most, shape (n,) [mm]: a chip is no thicker.
    """

    volume: FloatArray
    depth: FloatArray
    aside: FloatArray
    thickness: FloatArray


@threaded_kernel
def sweep(
    cells: Cells,
    points: FloatArray,
    profile: Profile,
    sums: FloatArray,
    marks: Marks,
    stood: bool,
    walls: bool,
) -> tuple[int, int, int, int]:
    """Cut the material that the tool meets along its path from point to point.

    Every cell's new height is exact for the straight sweep: the lowest height over its middle
    that the tool's profile has anywhere along the line.

    Args:
        cells: The height map, whose heights are changed.
        points: Tool tip positions, shape (n, 3) [mm].
        sums: What each line took off is added to it, shape (n - 1, 4); see ``LineColumn``. ``removal_of_sums`` reads it.
        marks: What each leaves where it cut.
        stood: Whether the tool has been at the first point, and has cut what it meets there.
        walls: Whether the walls that it leaves are noted, and what they are off whole cells counts.

    Returns:
        First and last-but-one row, first and last-but-one column of the cells that changed.
    """
    count = int(2.0 * profile.radius / cells.grid.cell) + 2
    scratch = Scratch(
        cells.heights, cells.behind, cells.grid, profile, marks, np.zeros(2, np.int64),
        np.zeros((2, 2, count)), np.zeros(RUN), sums, np.zeros(4, np.int64),
    )  # fmt: skip
    scratch.changed[0], scratch.changed[2] = cells.heights.shape
    _sweep_lines(scratch, points, stood, walls)
    return scratch.changed[0], scratch.changed[1], scratch.changed[2], scratch.changed[3]


@arithmetic_kernel
def removal_of_sums(sums: FloatArray, points: FloatArray, grid: Grid, removal: Removal) -> None:
    """Say what each line took off.

    Args:
        sums: Of ``sweep``, shape (n - 1, 4).
        points: Tool tip positions, shape (n, 3) [mm].
        removal: Set to it.
    """
    for i in range(len(sums)):
        lost = sums[i, LineColumn.LOST]
        removal.volume[i] = lost * grid.cell * grid.cell
        removal.depth[i] = sums[i, LineColumn.DEEPEST]
        removal.aside[i] = 0.0
        dx, dy = points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1]
        length, rise = math.hypot(dx, dy), points[i + 1, 2] - points[i, 2]
        # Beside a wall a line takes a cell's share more or less than its own.
        area = (math.hypot(length, rise) + grid.cell) * removal.depth[i]
        removal.thickness[i] = (
            min(removal.volume[i] / area, removal.depth[i]) if area > 0.0 else 0.0
        )
        if lost > 0.0 and length > 0.0:
            x = grid.origin[0] + sums[i, LineColumn.COLUMNS] / lost * grid.cell - points[i, 0]
            y = grid.origin[1] + sums[i, LineColumn.ROWS] / lost * grid.cell - points[i, 1]
            removal.aside[i] = (y * dx - x * dy) / length


@arithmetic_kernel
def settle(volume: FloatArray, cuts: BoolArray, least: float, owed: float) -> float:
    """Let stretches that only cut the grid leave what they took to those that follow.

    Args:
        volume: Of n stretches that follow each other [mm³]; changed.
        cuts: Which of them cut, shape (n,).
        least: Nor does one cut that takes no more than this [mm³].
        owed: What stretches before them have left [mm³].

    Returns:
        What these leave.
    """
    for i in range(len(volume)):
        owed += volume[i]
        volume[i] = owed if cuts[i] and owed > least else 0.0
        owed -= volume[i]
    return owed


@arithmetic_kernel
def _sweep_lines(scratch: Scratch, points: FloatArray, stood: bool, walls: bool) -> None:
    cells = Cells(scratch.heights, scratch.behind, scratch.grid)
    known, flat = False, scratch.profile.flat >= scratch.profile.radius
    for i in range(len(points) - 1):
        a, b = points[i], points[i + 1]
        if min(a[2], b[2]) >= scratch.grid.top:
            known = False
            continue
        if not known:
            lay_disc(scratch, a, i % 2)
        lay_disc(scratch, b, (i + 1) % 2)
        known = True
        # What the tool is in already, no line that does not sink can take off again.
        done = (stood or i > 0) and b[2] >= a[2]
        if done and flat and a[2] == b[2] and not scratch.marks.cells.size:
            _sweep_level(scratch, a, b, i)
        else:
            _sweep_line(scratch, a, b, i, done)
        if walls:
            note_walls(cells, a, b, scratch.profile, done, scratch.sums[i])


@arithmetic_kernel
def _sweep_level(scratch: Scratch, a: FloatArray, b: FloatArray, line: int) -> None:
    """Cut along a level line with a flat tool that has cut all it is in at its beginning.

    Only the crescents before and beside it are left: in most rows a cell or two. They are taken in
    pairs, because the processor cannot guess of how many cells a row's crescent will be.
    """
    heights, z = scratch.heights, max(a[2], scratch.grid.bottom)
    outline = outline_of(scratch, a, b, line)
    for row in range(outline.low, outline.high):
        first, end = columns_of(scratch, outline, row)
        done, done_end = span_of(scratch, outline.before, row)
        if done >= done_end:
            done = done_end = end
        left = max(done - first, 0)
        count, skipped = left + max(end - done_end, 0), done_end - left
        lost, moment, deepest = 0.0, 0.0, 0.0
        for pair in range(0, count, 2):
            for k in range(pair, pair + 2):
                column = k + (first if k < left else skipped)
                column = column if k < count else 0
                height = heights[row, column]
                lower = min(height, z) if k < count else height
                heights[row, column] = lower
                taken = cut_of_column(scratch.behind, row, column, height, lower)
                lost += taken
                moment += taken * column
                deepest = max(deepest, height - lower)
        if lost > 0.0:
            _add(scratch, line, row, (first, end), (lost, moment, deepest))


@arithmetic_kernel
def _sweep_line(scratch: Scratch, a: FloatArray, b: FloatArray, line: int, done: bool) -> None:
    """Cut along one line.

    Args:
        scratch: With the discs at both ends.
        a: Tool tip at its beginning, shape (3,) [mm].
        b: At its end.
        done: Whether nothing is left of what the tool at the beginning meets, or behind it.
    """
    flat, outline = scratch.profile.flat >= scratch.profile.radius, outline_of(scratch, a, b, line)
    begins_lower = a[2] <= b[2]
    lower = a if begins_lower else b
    for row in range(outline.low, outline.high):
        first, end = columns_of(scratch, outline, row)
        if first >= end:
            continue
        inner, inner_end = end, end
        if flat:
            # All that the tool covers where it is lowest comes down to there.
            inner, inner_end = span_of(
                scratch, outline.before if begins_lower else outline.after, row
            )
            if inner >= inner_end:
                inner, inner_end = end, end
            elif not (done and begins_lower):
                _lower_run(scratch, lower, lower, row, (inner, inner_end), line)
        elif done:
            inner, inner_end = _behind(scratch, a, b, row, (first, end))
        for begin, stop in ((first, inner), (inner_end, end)):
            if begin < stop:
                _lower_run(scratch, a, b, row, (begin, stop), line)


@arithmetic_kernel
def _behind(
    scratch: Scratch, a: FloatArray, b: FloatArray, row: int, run: tuple[int, int]
) -> tuple[int, int]:
    """Columns of a run over which a tool that comes from a, and does not sink, is lowest at a."""
    grid = scratch.grid
    dx, dy = b[0] - a[0], b[1] - a[1]
    y = grid.origin[1] + row * grid.cell - a[1]
    if dx == 0.0:
        return run if y * dy <= 0.0 else (run[1], run[1])
    column = min(max((a[0] - y * dy / dx - grid.origin[0]) / grid.cell, run[0] - 1.0), run[1] + 0.0)
    if dx > 0.0:
        return run[0], math.floor(column) + 1 if column < run[1] else run[1]
    return math.ceil(column) if column > run[0] else run[0], run[1]


@arithmetic_kernel
def _lower_run(
    scratch: Scratch, a: FloatArray, b: FloatArray, row: int, run: tuple[int, int], line: int
) -> None:
    """Lower a run of cells to the height of the tool over each."""
    grid = scratch.grid
    tip = max(min(a[2], b[2]), grid.bottom)
    for begin in range(run[0], run[1], RUN):
        cells = scratch.heights[row, begin : min(begin + RUN, run[1])]
        first, count = 0, len(cells)
        while first < count and cells[first] <= tip:
            first += 1
        while count > first and cells[count - 1] <= tip:
            count -= 1
        if first == count:
            continue
        cells, lowest = cells[first:count], scratch.lowest[: count - first]
        x = grid.origin[0] + (begin + first) * grid.cell
        y = grid.origin[1] + row * grid.cell
        lowest_in_run(lowest, (x, y), grid.cell, a, b, scratch.profile)
        lost, moment, deepest = 0.0, 0.0, 0.0
        for k in range(len(cells)):
            lower = min(cells[k], max(lowest[k], grid.bottom))
            cut = cells[k] - lower
            taken = cut_of_column(scratch.behind, row, begin + first + k, cells[k], lower)
            cells[k] = lower
            lost += taken
            moment += taken * (begin + first + k)
            deepest = max(deepest, cut)
            if scratch.marks.cells.size and cut > 0.0:
                scratch.marks.cells[row, begin + first + k] = scratch.marks.mark[line]
        if lost > 0.0:
            _add(scratch, line, row, (begin + first, begin + count), (lost, moment, deepest))


@inlined
def _add(
    scratch: Scratch, line: int, row: int, run: tuple[int, int], cut: tuple[float, float, float]
) -> None:
    """Add what a run of cells lost: in all, that times the columns' numbers, and at most [mm]."""
    sums, changed = scratch.sums[line], scratch.changed
    sums[LineColumn.LOST] += cut[0]
    sums[LineColumn.COLUMNS] += cut[1]
    sums[LineColumn.ROWS] += cut[0] * row
    sums[LineColumn.DEEPEST] = max(sums[LineColumn.DEEPEST], cut[2])
    changed[0], changed[1] = min(changed[0], row), max(changed[1], row + 1)
    changed[2], changed[3] = min(changed[2], run[0]), max(changed[3], run[1])
