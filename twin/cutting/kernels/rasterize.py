"""Lay a mesh's surface into a height map."""

import math

from twin.compilation.kernel import array_kernel
from twin.cutting.kernels.wall_distance import EQUAL_MM, FARTHEST, WallDistance, note_wall
from twin.nc.canonical import FloatArray

_UPRIGHT = 0.5
"""A face that goes sideways by more than this is a slope, which heights tell [cells]."""


@array_kernel
def rasterize(
    heights: FloatArray, origin: tuple[float, float], cell: float, triangles: FloatArray
) -> None:
    """Raise every cell to the highest triangle over its middle.

    Args:
        heights: The height map, shape (ny, nx) [mm]; changed in place.
        origin: X and Y of the middle of cell ``[0, 0]`` [mm].
        cell: Side of a cell [mm].
        triangles: Corners, shape (n, 3, 3) [mm].
    """
    rows, columns = heights.shape
    for i in range(len(triangles)):
        a, b, c = triangles[i, 0], triangles[i, 1], triangles[i, 2]
        area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
        if area == 0.0:
            continue
        low_y, high_y = min(a[1], b[1], c[1]), max(a[1], b[1], c[1])
        low_x, high_x = min(a[0], b[0], c[0]), max(a[0], b[0], c[0])
        for row in range(
            max(0, math.ceil((low_y - origin[1]) / cell)),
            min(rows - 1, math.floor((high_y - origin[1]) / cell)) + 1,
        ):
            y = origin[1] + row * cell
            for column in range(
                max(0, math.ceil((low_x - origin[0]) / cell)),
                min(columns - 1, math.floor((high_x - origin[0]) / cell)) + 1,
            ):
                x = origin[0] + column * cell
                u = ((x - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (y - a[1])) / area
                v = ((b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1])) / area
                if u >= 0.0 and v >= 0.0 and u + v <= 1.0:
                    z = a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2])
                    heights[row, column] = max(heights[row, column], z)


@array_kernel
def note_sides(
    heights: FloatArray,
    behind: WallDistance,
    origin: tuple[float, float],
    cell: float,
    triangles: FloatArray,
) -> None:
    """Note how far the middles of cells are behind the upright faces of a mesh, at their upper edges.

    Args:
        heights: The mesh as a height map, shape (ny, nx) [mm].
        behind: What is known of its walls; written.
        origin: X and Y of the middle of cell ``[0, 0]`` [mm].
        cell: Side of a cell [mm].
        triangles: Corners, counter-clockwise from outside, shape (n, 3, 3) [mm].
    """
    for i in range(len(triangles)):
        corners = triangles[i]
        ab, ac = corners[1] - corners[0], corners[2] - corners[0]
        out_x, out_y = ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2]
        level = math.hypot(out_x, out_y)
        upwards = abs(ab[0] * ac[1] - ab[1] * ac[0])
        low, high = corners[:, 2].min(), corners[:, 2].max()
        if level == 0.0 or upwards * (high - low) > _UPRIGHT * cell * level:
            continue
        out_x, out_y = out_x / level, out_y / level
        highest = corners[corners[:, 2].argmax()]
        wall = highest[0] * out_x + highest[1] * out_y
        along = corners[:, 1] * out_x - corners[:, 0] * out_y
        begin, end = along.min(), along.max()
        rows = _beside(corners[:, 1], origin[1], cell, heights.shape[0])
        columns = _beside(corners[:, 0], origin[0], cell, heights.shape[1])
        for row in range(rows[0], rows[1]):
            for column in range(columns[0], columns[1]):
                x, y = origin[0] + column * cell, origin[1] + row * cell
                inside, place = wall - x * out_x - y * out_y, y * out_x - x * out_y
                off = math.hypot(inside, max(begin - place, place - end, 0.0)) / cell
                if inside <= 0.0 or off > FARTHEST:
                    continue
                beyond = inside / cell + 1.0
                next_row, next_column = round(row + beyond * out_y), round(column + beyond * out_x)
                free = True
                if 0 <= next_row < heights.shape[0] and 0 <= next_column < heights.shape[1]:
                    # Faces between solids that touch each other are no walls.
                    free = heights[next_row, next_column] < heights[row, column] - EQUAL_MM
                if free:
                    note_wall(heights, behind, row, column, low + EQUAL_MM, off)


@array_kernel
def _beside(places: FloatArray, origin: float, cell: float, count: int) -> tuple[int, int]:
    """The first cell along an axis whose middle is as near to some places as walls are noted, and the one after the last."""
    first = math.ceil((places.min() - origin) / cell - FARTHEST)
    return max(0, first), min(count, math.floor((places.max() - origin) / cell + FARTHEST) + 1)
