"""How low a tool that moves straight comes over a run of cells, several cells at a time.

``tool_height.lowest_height`` has the rule for one place. Here each loop is for one kind of path and
one shape of tool, without a branch, so that the compiler takes several cells in one instruction.
"""

import math

from twin.compilation.kernel import arithmetic_kernel
from twin.cutting.kernels.tool_height import Profile, cone_turning_point, lowest_height
from twin.nc.canonical import FloatArray


@arithmetic_kernel
def lowest_in_run(
    lowest: FloatArray,
    place: tuple[float, float],
    cell: float,
    a: FloatArray,
    b: FloatArray,
    profile: Profile,
) -> None:
    """Lowest height of a tool that moves straight from a to b, over cells that lie along X.

    Args:
        lowest: Set to it; infinite where the tool misses the cell, shape (n,) [mm].
        place: X and Y of the middle of the first cell [mm].
        cell: From one cell to the next [mm].
        a: Tool tip at the beginning, shape (3,) [mm].
        b: At the end.
    """
    radius, flat, corner, _ = profile
    standing = a[0] == b[0] and a[1] == b[1]
    level = a[2] == b[2] or standing
    ball = flat == 0.0 and corner == radius
    if standing and flat >= radius:
        lowest[:] = min(a[2], b[2])
    elif level and ball:
        _level_ball(lowest, place, cell, a, b, radius)
    elif level and corner > 0.0:
        _level_corner(lowest, place, cell, a, b, profile)
    elif level:
        _level_cone(lowest, place, cell, a, b, profile)
    elif ball:
        _inclined_ball(lowest, place, cell, a, b, radius)
    elif corner == 0.0 and flat < radius:
        _inclined_cone(lowest, place, cell, a, b, profile)
    else:
        for k in range(len(lowest)):
            lowest[k] = lowest_height(place[0] + k * cell, place[1], a, b, profile)


@arithmetic_kernel
def _level_ball(
    lowest: FloatArray,
    place: tuple[float, float],
    cell: float,
    a: FloatArray,
    b: FloatArray,
    radius: float,
) -> None:
    dx, dy, inverse = _seen_from_above(a, b)
    center, reach = min(a[2], b[2]) + radius, radius * radius
    for k in range(len(lowest)):
        squared = _squared_distance(place[0] + k * cell - a[0], place[1] - a[1], dx, dy, inverse)
        height = center - math.sqrt(max(reach - squared, 0.0))
        lowest[k] = height if squared <= reach else math.inf


@arithmetic_kernel
def _level_corner(
    lowest: FloatArray,
    place: tuple[float, float],
    cell: float,
    a: FloatArray,
    b: FloatArray,
    profile: Profile,
) -> None:
    radius, flat, corner, _ = profile
    dx, dy, inverse = _seen_from_above(a, b)
    center = min(a[2], b[2]) + corner
    for k in range(len(lowest)):
        squared = _squared_distance(place[0] + k * cell - a[0], place[1] - a[1], dx, dy, inverse)
        beyond = max(math.sqrt(squared) - flat, 0.0)
        height = center - math.sqrt(max(corner * corner - beyond * beyond, 0.0))
        lowest[k] = height if squared <= radius * radius else math.inf


@arithmetic_kernel
def _level_cone(
    lowest: FloatArray,
    place: tuple[float, float],
    cell: float,
    a: FloatArray,
    b: FloatArray,
    profile: Profile,
) -> None:
    radius, flat, _, slope = profile
    dx, dy, inverse = _seen_from_above(a, b)
    tip = min(a[2], b[2])
    for k in range(len(lowest)):
        squared = _squared_distance(place[0] + k * cell - a[0], place[1] - a[1], dx, dy, inverse)
        height = tip + slope * max(math.sqrt(squared) - flat, 0.0)
        lowest[k] = height if squared <= radius * radius else math.inf


@arithmetic_kernel
def _seen_from_above(a: FloatArray, b: FloatArray) -> tuple[float, float, float]:
    """A displacement seen from above, and one over its squared length; 0 where there is none."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    squared = dx * dx + dy * dy
    return dx, dy, 1.0 / squared if squared > 0.0 else 0.0


@arithmetic_kernel
def _squared_distance(px: float, py: float, dx: float, dy: float, inverse: float) -> float:
    """Squared distance of a place from a path that begins at zero, seen from above [mm²]."""
    t = min(max((px * dx + py * dy) * inverse, 0.0), 1.0)
    qx, qy = px - t * dx, py - t * dy
    return qx * qx + qy * qy


@arithmetic_kernel
def _inclined_ball(
    lowest: FloatArray,
    place: tuple[float, float],
    cell: float,
    a: FloatArray,
    b: FloatArray,
    radius: float,
) -> None:
    dx, dy, inverse = _seen_from_above(a, b)
    dz = b[2] - a[2]
    length, reach = dx * dx + dy * dy, radius * radius
    steepest = dz * math.sqrt(inverse / (length + dz * dz))
    center = a[2] + radius
    for k in range(len(lowest)):
        px, py = place[0] + k * cell - a[0], place[1] - a[1]
        nearest = (px * dx + py * dy) * inverse
        aside = px * dy - py * dx
        offset = aside * aside * inverse
        t = nearest - steepest * math.sqrt(max(reach - offset, 0.0))
        t = min(max(t, 0.0), 1.0)
        along = t - nearest
        squared = offset + length * along * along
        height = center + t * dz - math.sqrt(max(reach - squared, 0.0))
        lowest[k] = height if squared <= reach else math.inf


@arithmetic_kernel
def _inclined_cone(
    lowest: FloatArray,
    place: tuple[float, float],
    cell: float,
    a: FloatArray,
    b: FloatArray,
    profile: Profile,
) -> None:
    radius, flat, _, slope = profile
    dx, dy, inverse = _seen_from_above(a, b)
    dz = b[2] - a[2]
    length, reach = dx * dx + dy * dy, radius * radius
    for k in range(len(lowest)):
        px, py = place[0] + k * cell - a[0], place[1] - a[1]
        nearest = (px * dx + py * dy) * inverse
        aside = px * dy - py * dx
        offset = aside * aside * inverse
        # Where it stops falling, but not beyond the cutter's edge.
        half = math.sqrt(max(reach - offset, 0.0) * inverse)
        turning = cone_turning_point(length, offset, dz, flat, slope)
        t = min(max(nearest + min(max(turning, -half), half), 0.0), 1.0)
        along = t - nearest
        distance = min(math.sqrt(offset + length * along * along), radius)
        height = a[2] + t * dz + slope * max(distance - flat, 0.0)
        met = offset <= reach and nearest - half <= 1.0 and nearest + half >= 0.0
        lowest[k] = height if met else math.inf
