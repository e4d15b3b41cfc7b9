"""Walls that the side of a tool has left, known closer than by whole cells.

A height map knows a wall to half a cell, which is most of a narrow cut. Of the cells beside a wall it
is therefore kept how far their middles are from it and in which direction: a vector that points into
the material, as long as that distance [cells] (negative: the middle lies in the free) plus ``BASE``;
no vector, no wall. A wall stays where a tool goes away: along a straight path, and around the place
where it turns or is drawn out.
"""

import enum
import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.compilation.kernel import kernel
from twin.cutting.kernels.covered_cells import Grid
from twin.nc.canonical import FloatArray

WallArray = npt.NDArray[np.float32]
"""Walls of a height map, shape (ny, nx, 2) [cells]."""

BASE = 2.0
"""Added to the distance of a middle from its wall, so that a vector always has a direction [cells]."""
REACH = 1.5
"""How far from a wall it is kept [cells]."""
_STEP = 0.5
"""A tool that has gone less than this has left nothing yet [cells]."""
_PIECE = 2.0
"""Length of a wall that is looked at together [cells]."""
_EQUAL = 1e-9
"""Heights that differ by less are the same [mm]."""


class _Trace(enum.IntEnum):
    """Where a tool was and from which direction it came: columns of ``no_trace``."""

    X = 0
    Y = 1
    Z = 2
    AHEAD_X = 3
    AHEAD_Y = 4
    KNOWN = 5


class WalledMap(NamedTuple):
    """What is cut.

    Attributes:
        heights: The height map, cut up to where the tool is, shape (ny, nx) [mm].
    """

    heights: FloatArray
    grid: Grid
    walls: WallArray


class _Tool(NamedTuple):
    """A tool where it leaves a wall: its radius [mm], and the height above which its side is [mm]."""

    radius: float
    level: float


def no_walls(heights: FloatArray) -> WallArray:
    """None yet, of a height map."""
    return np.zeros((*heights.shape, 2), np.float32)


def no_trace() -> FloatArray:
    """Of a tool that has been nowhere: see ``leave_walls``."""
    return np.zeros(len(_Trace))


@kernel
def lose_trace(trace: FloatArray) -> None:
    """Forget where a tool was: it leaves no wall on its path to where it is next."""
    trace[_Trace.KNOWN] = 0.0


@kernel
def leave_walls(
    material: WalledMap, trace: FloatArray, tip: FloatArray, radius: float, side_from: float
) -> None:
    """Keep the walls that a tool leaves along its path.

    Args:
        material: It has been cut up to ``tip``.
        trace: Where the tool was and from which direction it came, carried from call to call.
        tip: Where its tip is, shape (3,) [mm].
        radius: Of the tool [mm].
        side_from: Height above the tip at which its side begins [mm].
    """
    if trace[_Trace.KNOWN] <= 0.0:
        _note(trace, tip, 0.0, 0.0)
        return
    dx, dy, rise = tip[0] - trace[_Trace.X], tip[1] - trace[_Trace.Y], tip[2] - trace[_Trace.Z]
    length, least = math.hypot(dx, dy), _STEP * material.grid.cell
    level = max(tip[2], trace[_Trace.Z]) + side_from + _EQUAL
    if length >= least:
        ahead_x, ahead_y = dx / length, dy / length
        at_turn = _Tool(radius, trace[_Trace.Z] + side_from + _EQUAL)
        _leave_turn(material, trace, ahead_x, ahead_y, at_turn)
        _leave_sides(material, trace, tip, _Tool(radius, level))
        _note(trace, tip, ahead_x, ahead_y)
    elif rise > least:
        _leave_turn(material, trace, 0.0, 0.0, _Tool(radius, trace[_Trace.Z] + side_from + _EQUAL))
        _note(trace, tip, 0.0, 0.0)
    elif rise < -least:
        _note(trace, tip, 0.0, 0.0)


@kernel
def _note(trace: FloatArray, tip: FloatArray, ahead_x: float, ahead_y: float) -> None:
    trace[_Trace.X], trace[_Trace.Y], trace[_Trace.Z] = tip[0], tip[1], tip[2]
    trace[_Trace.AHEAD_X], trace[_Trace.AHEAD_Y], trace[_Trace.KNOWN] = ahead_x, ahead_y, 1.0


@kernel
def _leave_sides(material: WalledMap, begin: FloatArray, end: FloatArray, tool: _Tool) -> None:
    """The walls on both sides of a straight path."""
    grid, cell = material.grid, material.grid.cell
    dx, dy = end[0] - begin[0], end[1] - begin[1]
    length = math.hypot(dx, dy)
    ux, uy = dx / length, dy / length
    pieces = math.ceil(length / (_PIECE * cell))
    aside = 0.5 * length / pieces * max(abs(ux), abs(uy)) + REACH * cell
    for number in range(2 * pieces):
        side = 1.0 if number < pieces else -1.0
        middle = (number % pieces + 0.5) / pieces
        low, high = number % pieces * length / pieces, (number % pieces + 1) * length / pieces
        x = begin[0] + middle * dx - side * tool.radius * uy
        y = begin[1] + middle * dy + side * tool.radius * ux
        rows, columns = (
            _around(y - grid.origin[1], aside, cell),
            _around(x - grid.origin[0], aside, cell),
        )
        for row in range(max(0, rows[0]), min(material.heights.shape[0], rows[1])):
            for column in range(max(0, columns[0]), min(material.heights.shape[1], columns[1])):
                px = grid.origin[0] + column * cell - begin[0]
                py = grid.origin[1] + row * cell - begin[1]
                along = px * ux + py * uy
                off = (side * (py * ux - px * uy) - tool.radius) / cell
                if low < along <= high and abs(off) <= REACH:
                    _leave(material, row, column, off, (-side * uy, side * ux), tool.level)


@kernel
def _leave_turn(
    material: WalledMap, trace: FloatArray, ahead_x: float, ahead_y: float, tool: _Tool
) -> None:
    """The wall around a place at which a tool turns, begins (no path before) or ends (none ahead)."""
    came_x, came_y = trace[_Trace.AHEAD_X], trace[_Trace.AHEAD_Y]
    came, goes = came_x != 0.0 or came_y != 0.0, ahead_x != 0.0 or ahead_y != 0.0
    quarter = 0.5 * math.pi
    begin, arc = 0.0, 4.0 * quarter
    if came and goes:
        turn = math.atan2(came_x * ahead_y - came_y * ahead_x, came_x * ahead_x + came_y * ahead_y)
        # To the left the outer side is the right one.
        begin = math.atan2(came_y, came_x) + (-quarter if turn > 0.0 else quarter + turn)
        arc = abs(turn)
    elif came:
        begin, arc = math.atan2(came_y, came_x) - quarter, 2.0 * quarter
    elif goes:
        begin, arc = math.atan2(ahead_y, ahead_x) + quarter, 2.0 * quarter
    grid, cell = material.grid, material.grid.cell
    pieces = math.ceil(max(arc * tool.radius / (_PIECE * cell), arc / quarter))
    aside = 0.5 * arc * tool.radius / max(pieces, 1) + REACH * cell
    for number in range(pieces):
        low, high = begin + arc * number / pieces, begin + arc * (number + 1) / pieces
        middle = 0.5 * (low + high)
        low_x, low_y, high_x, high_y = math.cos(low), math.sin(low), math.cos(high), math.sin(high)
        x = trace[_Trace.X] + tool.radius * math.cos(middle) - grid.origin[0]
        y = trace[_Trace.Y] + tool.radius * math.sin(middle) - grid.origin[1]
        rows, columns = _around(y, aside, cell), _around(x, aside, cell)
        for row in range(max(0, rows[0]), min(material.heights.shape[0], rows[1])):
            for column in range(max(0, columns[0]), min(material.heights.shape[1], columns[1])):
                px = grid.origin[0] + column * cell - trace[_Trace.X]
                py = grid.origin[1] + row * cell - trace[_Trace.Y]
                distance = math.hypot(px, py)
                off = (distance - tool.radius) / cell
                within = low_x * py - low_y * px >= 0.0 > high_x * py - high_y * px
                if within and abs(off) <= REACH and distance > 0.0:
                    outwards = (px / distance, py / distance)
                    _leave(material, row, column, off, outwards, tool.level)


@kernel
def _around(place: float, aside: float, cell: float) -> tuple[int, int]:
    """The first cell around a place along an axis, and the one after the last."""
    return math.ceil((place - aside) / cell), math.floor((place + aside) / cell) + 1


@kernel
def _leave(
    material: WalledMap,
    row: int,
    column: int,
    off: float,
    outwards: tuple[float, float],
    level: float,
) -> None:
    """Keep that a cell's middle is so far behind a wall, if there is one above a level."""
    grid, cell = material.grid, material.grid.cell
    x, y = grid.origin[0] + column * cell, grid.origin[1] + row * cell
    behind = max(0.0, 1.0 - off) * cell if off <= 0.0 else 0.0
    if height_at(material, x + behind * outwards[0], y + behind * outwards[1]) <= level:
        return
    wall = material.walls[row, column]
    size = math.hypot(wall[0], wall[1])
    if 0.0 < size < off + BASE:
        # One that was cut further, and as deep, is where the material ends.
        before = (_BACK + size - BASE) * cell / size
        if height_at(material, x - before * wall[0], y - before * wall[1]) <= level:
            return
    wall[0], wall[1] = (off + BASE) * outwards[0], (off + BASE) * outwards[1]


_BACK = 0.75
"""So far before a wall lies a cell whose middle is before it, whatever its direction [cells]."""


@kernel
def height_by_wall(
    material: WalledMap, x: float, y: float, place: tuple[float, float], level: float
) -> float:
    """Height of the material at a place, as the walls of a cell beside it say.

    Args:
        x: Of the cell whose walls count [mm].
        place: X and Y of the place, so far from that cell that a wall may be taken for a plane [mm].
        level: Above which material is looked for; not below the grid's bottom [mm].

    Returns:
        Height [mm]; NaN where there is none above ``level``, and no wall that says why: it may be that
        this tool has cut it.
    """
    grid, cell = material.grid, material.grid.cell
    row, column = cell_number(y, grid.origin[1], cell), cell_number(x, grid.origin[0], cell)
    rows, columns = material.heights.shape
    if not (-1 <= row <= rows and -1 <= column <= columns):
        return math.nan
    # A side of the blank may lie beyond the grid, by less than a cell.
    row, column = min(max(row, 0), rows - 1), min(max(column, 0), columns - 1)
    wall, own = material.walls[row, column], material.heights[row, column]
    if wall[0] == 0.0 and wall[1] == 0.0:
        return own if own > level else math.nan
    size = math.hypot(wall[0], wall[1])
    nx, ny, off = wall[0] / size, wall[1] / size, (size - BASE) * cell
    middle_x, middle_y = grid.origin[0] + column * cell, grid.origin[1] + row * cell
    if off + nx * (place[0] - middle_x) + ny * (place[1] - middle_y) <= 0.0:
        before = _BACK * cell + off
        return min(own, height_at(material, middle_x - before * nx, middle_y - before * ny))
    behind = cell - off
    own = max(own, height_at(material, middle_x + behind * nx, middle_y + behind * ny))
    return own if own > level else math.nan


@kernel
def height_at(material: WalledMap, x: float, y: float) -> float:
    """Height of the cell that a place lies in [mm]; below everything where there is none."""
    grid = material.grid
    row = cell_number(y, grid.origin[1], grid.cell)
    return height_of(material, row, cell_number(x, grid.origin[0], grid.cell))


@kernel
def height_of(material: WalledMap, row: int, column: int) -> float:
    """Height of a cell [mm]; below everything where there is none."""
    heights = material.heights
    if row < 0 or column < 0 or row >= heights.shape[0] or column >= heights.shape[1]:
        return -math.inf
    height = heights[row, column]
    return height if height > material.grid.bottom else -math.inf


@kernel
def cell_number(place: float, origin: float, cell: float) -> int:
    """Number of the cell that a place lies in, along an axis."""
    return math.floor((place - origin) / cell + 0.5)
