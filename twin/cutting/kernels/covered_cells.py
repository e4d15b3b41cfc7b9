"""Which cells of a height map a tool covers along a straight line, row by row."""

import enum
import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.compilation.compilable import inlined
from twin.compilation.kernel import arithmetic_kernel
from twin.cutting.kernels.tool_height import Profile
from twin.nc.canonical import FloatArray, IntArray

_WHOLE = 1.5 * 2.0**52
"""Added to a number that is much smaller, it leaves no room for what is behind the point."""


class Grid(NamedTuple):
    """Where the cells of a height map lie.

    Attributes:
        origin: X and Y of the middle of cell ``[0, 0]`` [mm].
        cell: Side of a cell [mm].
        bottom: Z below which there is nothing to cut [mm].
        top: Z above which there is none.
    """

    origin: tuple[float, float]
    cell: float
    bottom: float
    top: float


class Cells(NamedTuple):
    """A height map as kernels have it.

    Attributes:
        heights: Of the material over each cell, shape (ny, nx) [mm].
        behind: How far the middles of cells are behind walls, shape (ny, nx, 7); see ``wall_distance``.
    """

    heights: FloatArray
    behind: npt.NDArray[np.float32]
    grid: Grid


class Marks(NamedTuple):
    """What each of n lines leaves where it cuts.

    Attributes:
        cells: Set to the line's mark, shape (ny, nx); of no size, if nobody asks.
        mark: Of each line, shape (n,).
    """

    cells: FloatArray
    mark: FloatArray


class LineColumn(enum.IntEnum):
    """What a line took off: columns of ``Scratch.sums``."""

    LOST = 0
    """Height [mm], of columns of which a wall has left a part by that part."""
    COLUMNS = 1
    """That times the number of the column."""
    ROWS = 2
    DEEPEST = 3
    """Greatest height [mm]."""


class Scratch(NamedTuple):
    """What is at hand while lines are swept.

    Attributes:
        heights: The height map, shape (ny, nx) [mm].
        behind: What is known of its walls.
        marks: As ``sweep`` has them.
        low: Row at which the disc that the tool covers begins, at either end of a line, shape (2,).
        spans: First column of that disc in each of its rows and the one after its last, shape (2, 2, m).
        lowest: Heights of the tool over a run of cells, shape (RUN,) [mm].
        sums: As ``sweep`` has it.
        changed: Row, row end, column, column end of the cells that changed, shape (4,).
    """

    heights: FloatArray
    behind: npt.NDArray[np.float32]
    grid: Grid
    profile: Profile
    marks: Marks
    low: IntArray
    spans: FloatArray
    lowest: FloatArray
    sums: FloatArray
    changed: IntArray


@arithmetic_kernel
def lay_disc(scratch: Scratch, center: FloatArray, which: int) -> None:
    """Note the columns of the disc that a tool covers; a row outside of it begins behind its end.

    Columns are counted as floating-point numbers, several at a time, and rounded by a sum whose last
    bit is one.
    """
    grid, columns = scratch.grid, float(scratch.heights.shape[1])
    radius, cell, first, end = (
        scratch.profile.radius, grid.cell, scratch.spans[which, 0], scratch.spans[which, 1],
    )  # fmt: skip
    low = math.ceil((center[1] - radius - grid.origin[1]) / cell)
    scratch.low[which] = low
    offset = grid.origin[1] - center[1]
    for k in range(len(first)):
        y = offset + (low + k) * cell
        squared = radius * radius - y * y
        half = math.sqrt(max(squared, 0.0))
        left = min(max((center[0] - half - grid.origin[0]) / cell, 0.0), columns)
        right = min(max((center[0] + half - grid.origin[0]) / cell, -1.0), columns - 1.0)
        begin, last = (left + _WHOLE) - _WHOLE, (right + _WHOLE) - _WHOLE
        begin = begin + 1.0 if begin < left else begin
        last = last if last > right else last + 1.0
        first[k] = begin if squared >= 0.0 else columns
        end[k] = last if squared >= 0.0 else 0.0


class Side(NamedTuple):
    """A side of the outline of a disc swept from a to b, as far as it is no part of the discs.

    Attributes:
        x: Where it begins [mm].
        rise: By how much X grows with Y.
        low: First row that it crosses; so on.
        high: Last one.
    """

    x: float
    y: float
    rise: float
    low: int
    high: int


class SweptOutline(NamedTuple):
    """The outline of the place that a tool covers along a line.

    Attributes:
        before: Which of the bench's discs is that at the beginning.
        after: Which is that at the end.
        right: The side to the right of the line.
        low: First row.
        high: The one after the last.
    """

    before: int
    after: int
    right: Side
    left: Side
    low: int
    high: int


@arithmetic_kernel
def outline_of(scratch: Scratch, a: FloatArray, b: FloatArray, line: int) -> SweptOutline:
    """The outline of what a tool covers from a to b."""
    before, after = line % 2, (line + 1) % 2
    low_a, low_b = scratch.low[before], scratch.low[after]
    low = max(0, min(low_a, low_b))
    high = min(scratch.heights.shape[0], max(low_a, low_b) + scratch.spans.shape[2])
    right, left = (
        side_of(scratch, a, b, scratch.profile.radius),
        side_of(scratch, a, b, -scratch.profile.radius),
    )
    return SweptOutline(before, after, right, left, low, high)


@arithmetic_kernel
def side_of(scratch: Scratch, a: FloatArray, b: FloatArray, right: float) -> Side:
    """The side of an outline that lies so far right of the line."""
    grid = scratch.grid
    dx, dy = b[0] - a[0], b[1] - a[1]
    if dy == 0.0:
        # It lies along the rows, which meet the discs at its ends.
        return Side(0.0, 0.0, 0.0, 0, -1)
    length = math.hypot(dx, dy)
    x, y, end = a[0] + right * dy / length, a[1] - right * dx / length, b[1] - right * dx / length
    low = math.ceil((min(y, end) - grid.origin[1]) / grid.cell)
    high = math.floor((max(y, end) - grid.origin[1]) / grid.cell)
    return Side(x, y, dx / dy, low, high)


@inlined
def columns_of(scratch: Scratch, outline: SweptOutline, row: int) -> tuple[int, int]:
    """Columns that the tool covers in a row: the first, and the one after the last."""
    grid, columns = scratch.grid, scratch.heights.shape[1]
    first_a, end_a = span_of(scratch, outline.before, row)
    first_b, end_b = span_of(scratch, outline.after, row)
    first, end = min(first_a, first_b), max(end_a, end_b)
    for side in (outline.right, outline.left):
        if side.low <= row <= side.high:
            x = side.x + (grid.origin[1] + row * grid.cell - side.y) * side.rise
            column = (x - grid.origin[0]) / grid.cell
            first = min(first, max(0, math.ceil(column)))
            end = max(end, min(columns, math.floor(column) + 1))
    return first, end


@inlined
def span_of(scratch: Scratch, disc: int, row: int) -> tuple[int, int]:
    """Columns of a disc in a row; where it has none, the first is beyond all that there are."""
    k = row - scratch.low[disc]
    if k < 0 or k >= scratch.spans.shape[2]:
        return scratch.heights.shape[1], 0
    return int(scratch.spans[disc, 0, k]), int(scratch.spans[disc, 1, k])


@arithmetic_kernel
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
