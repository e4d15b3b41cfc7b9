"""How deep something that must not cut reaches into the material."""

import math
from typing import NamedTuple

from twin.compilation.kernel import array_kernel
from twin.cutting.kernels.sweep import Grid, chord
from twin.cutting.kernels.tool_height import lowest_height, steepness
from twin.nc.canonical import FloatArray


class Overlap(NamedTuple):
    """What was found along each of n stretches.

    Attributes:
        reach: How far something reaches into the material, measured the shortest way out, which
            tells a crash from the brushing of a wall that was cut before, shape (n,) [mm].
        depth: How far its lower end is below the material's surface where it does, shape (n,) [mm].
    """

    reach: FloatArray
    depth: FloatArray


@array_kernel
def round_overlap(
    heights: FloatArray,
    grid: Grid,
    points: FloatArray,
    profile: tuple[float, float, float, float],
    above: float,
    overlap: Overlap,
) -> None:
    """Hold a body of revolution about the tool's axis against the material.

    Args:
        heights: The height map, shape (ny, nx) [mm].
        grid: Where its cells lie.
        points: Tool tip positions, shape (n + 1, 3) [mm].
        profile: Radius, flat, corner, slope of its lower end (``twin.cutting.tools.Profile``).
        above: Height of its lower end above the tip [mm].
        overlap: Set to what was found.
    """
    radius, cell = profile[0], grid.cell
    for i in range(len(points) - 1):
        overlap.reach[i] = 0.0
        overlap.depth[i] = 0.0
        ax, ay = points[i, 0], points[i, 1]
        bx, by = points[i + 1, 0], points[i + 1, 1]
        if min(points[i, 2], points[i + 1, 2]) + above >= grid.top:
            continue
        low = max(0, math.ceil((min(ay, by) - radius - grid.origin[1]) / cell))
        high = min(heights.shape[0] - 1, math.floor((max(ay, by) + radius - grid.origin[1]) / cell))
        for row in range(low, high + 1):
            y = grid.origin[1] + row * cell
            left, right = chord(ax, ay, bx, by, radius, y)
            first = max(0, math.ceil((left - grid.origin[0]) / cell))
            end = min(heights.shape[1] - 1, math.floor((right - grid.origin[0]) / cell)) + 1
            for column in range(first, end):
                x = grid.origin[0] + column * cell
                lower = lowest_height(x, y, points[i], points[i + 1], profile) + above
                depth = heights[row, column] - lower
                if depth <= 0.0 or heights[row, column] <= grid.bottom:
                    continue
                aside = _distance(x, y, ax, ay, bx, by)
                slope = steepness(aside, profile)
                reach = min(depth / math.sqrt(1.0 + slope * slope), radius - aside)
                if reach > overlap.reach[i]:
                    overlap.reach[i] = reach
                    overlap.depth[i] = max(overlap.depth[i], depth)


@array_kernel
def box_overlap(
    heights: FloatArray,
    grid: Grid,
    points: FloatArray,
    turn: FloatArray,
    half: tuple[float, float],
    overlap: Overlap,
) -> None:
    """Hold an upright box, such as the head, against the material.

    Args:
        heights: The height map, shape (ny, nx) [mm].
        grid: Where its cells lie.
        points: Middle of its lower face, shape (n + 1, 3) [mm].
        turn: Direction of its first side, shape (n + 1, 2).
        half: Half of its two level sides [mm].
        overlap: Set to what was found.
    """
    cell = grid.cell
    around = math.hypot(half[0], half[1])
    for i in range(len(points) - 1):
        overlap.reach[i] = 0.0
        overlap.depth[i] = 0.0
        if min(points[i, 2], points[i + 1, 2]) >= grid.top:
            continue
        way = math.hypot(points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1])
        way += around * math.hypot(turn[i + 1, 0] - turn[i, 0], turn[i + 1, 1] - turn[i, 1])
        steps = max(1, math.ceil(way / (0.5 * cell)))
        for step in range(1, steps + 1):
            t = step / steps
            x, y, z = points[i] + t * (points[i + 1] - points[i])
            ux, uy = turn[i] + t * (turn[i + 1] - turn[i])
            low = max(0, math.ceil((y - around - grid.origin[1]) / cell))
            high = min(heights.shape[0] - 1, math.floor((y + around - grid.origin[1]) / cell))
            first = max(0, math.ceil((x - around - grid.origin[0]) / cell))
            last = min(heights.shape[1] - 1, math.floor((x + around - grid.origin[0]) / cell))
            for row in range(low, high + 1):
                dy = grid.origin[1] + row * cell - y
                for column in range(first, last + 1):
                    depth = heights[row, column] - z
                    if depth <= 0.0 or heights[row, column] <= grid.bottom:
                        continue
                    dx = grid.origin[0] + column * cell - x
                    side = half[0] - abs(dx * ux + dy * uy)
                    front = half[1] - abs(dy * ux - dx * uy)
                    reach = min(depth, side, front)
                    if reach > overlap.reach[i]:
                        overlap.reach[i] = reach
                        overlap.depth[i] = max(overlap.depth[i], depth)


@array_kernel
def _distance(x: float, y: float, ax: float, ay: float, bx: float, by: float) -> float:
    """Distance of a place from a straight way, seen from above [mm]."""
    dx, dy = bx - ax, by - ay
    squared = dx * dx + dy * dy
    t = 0.0
    if squared > 0.0:
        t = min(1.0, max(0.0, ((x - ax) * dx + (y - ay) * dy) / squared))
    return math.hypot(x - ax - t * dx, y - ay - t * dy)
