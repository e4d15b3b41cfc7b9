"""Lay a mesh's surface into a height map."""

import math

from twin.compilation.kernel import array_kernel
from twin.nc.canonical import FloatArray


@array_kernel
def drape(
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
