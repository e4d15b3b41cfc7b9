"""How deep something that must not cut reaches into the material."""

import math
from typing import NamedTuple

from twin.compilation.kernel import array_kernel
from twin.cutting.kernels.covered_cells import Grid, chord
from twin.cutting.kernels.tool_height import Profile, lowest_height, steepness
from twin.cutting.kernels.wall_distance import HALF, WallDistance, nearest_foot, reach_before
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

    def part(self, rows: slice) -> "Overlap":
        """Views of what was found along some of them."""
        return Overlap(self.reach[rows], self.depth[rows])


class Stood(NamedTuple):
    """What is on the table.

    Attributes:
        heights: The height map, shape (ny, nx) [mm].
        provisional: Whether walls may be cut before the last of the stretches that are looked at: every
            one is then taken to be as near as it can be.
    """

    heights: FloatArray
    behind: WallDistance
    grid: Grid
    provisional: bool


@array_kernel
def round_overlap(
    stood: Stood,
    points: FloatArray,
    profile: Profile,
    above: float,
    overlap: Overlap,
) -> None:
    """Hold a body of revolution about the tool's axis against the material.

    Args:
        points: Tool tip positions, shape (n + 1, 3) [mm].
        above: Height of its lower end above the tip [mm].
        overlap: Set to what was found.
    """
    heights, grid = stood.heights, stood.grid
    cell, radius = grid.cell, profile.radius
    outer = radius + HALF * cell
    for i in range(len(points) - 1):
        overlap.reach[i] = 0.0
        overlap.depth[i] = 0.0
        a, b = points[i], points[i + 1]
        level = max(min(a[2], b[2]) + above, grid.bottom)
        if level >= grid.top:
            continue
        low = max(0, math.ceil((min(a[1], b[1]) - outer - grid.origin[1]) / cell))
        high = min(
            heights.shape[0] - 1, math.floor((max(a[1], b[1]) + outer - grid.origin[1]) / cell)
        )
        for row in range(low, high + 1):
            y = grid.origin[1] + row * cell
            left, right = chord(a[0], a[1], b[0], b[1], outer, y)
            first = max(0, math.ceil((left - grid.origin[0]) / cell))
            end = min(heights.shape[1] - 1, math.floor((right - grid.origin[0]) / cell)) + 1
            for column in range(first, end):
                height = heights[row, column]
                if height <= level:
                    continue
                x = grid.origin[0] + column * cell
                foot_x, foot_y = nearest_foot(x, y, a, b)
                middle = math.hypot(x - foot_x, y - foot_y)
                before = min(reach_before(stood, row, column, height), middle)
                aside = middle - before
                if aside > radius:
                    continue
                share = before / middle if before > 0.0 else 0.0
                near_x, near_y = x + share * (foot_x - x), y + share * (foot_y - y)
                depth = height - lowest_height(near_x, near_y, a, b, profile) - above
                if depth <= 0.0:
                    continue
                slope = steepness(aside, profile)
                reach = min(depth / math.sqrt(1.0 + slope * slope), radius - aside)
                if reach > overlap.reach[i]:
                    overlap.reach[i] = reach
                    overlap.depth[i] = max(overlap.depth[i], depth)


@array_kernel
def box_overlap(
    stood: Stood,
    points: FloatArray,
    turn: FloatArray,
    half: tuple[float, float],
    overlap: Overlap,
) -> None:
    """Hold an upright box, such as the head, against the material.

    Args:
        points: Middle of its lower face, shape (n + 1, 3) [mm].
        turn: Direction of its first side, shape (n + 1, 2).
        half: Half of its two level sides [mm].
        overlap: Set to what was found.
    """
    heights, grid = stood.heights, stood.grid
    cell = grid.cell
    around = math.hypot(half[0], half[1]) + HALF * cell
    for i in range(len(points) - 1):
        overlap.reach[i] = 0.0
        overlap.depth[i] = 0.0
        if min(points[i, 2], points[i + 1, 2]) >= grid.top:
            continue
        distance = math.hypot(points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1])
        distance += around * math.hypot(turn[i + 1, 0] - turn[i, 0], turn[i + 1, 1] - turn[i, 1])
        steps = max(1, math.ceil(distance / (0.5 * cell)))
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
                    inside = min(side, front)
                    if inside < 0.0:
                        inside = -math.hypot(min(side, 0.0), min(front, 0.0))
                    before = reach_before(stood, row, column, depth + z)
                    reach = min(depth, inside + before)
                    if reach > overlap.reach[i]:
                        overlap.reach[i] = reach
                        overlap.depth[i] = max(overlap.depth[i], depth)
