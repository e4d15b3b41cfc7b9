"""Where one line is within a solid at any time of a step, in closed form or by a search."""

import math

from twin.compilation.compilable import inlined
from twin.compilation.kernel import arithmetic_kernel
from twin.cutting.tridexel.solids.moving_solid import Pose, Poses, point_on_axis, within, within_at
from twin.cutting.tridexel.solids.solids import Solid

FLAT_MM = 2e-4
"""Bend of a step's envelope that two poses are enough for [mm]."""

_SEARCH_STEPS = 10
"""Halvings of a share in which a rim is looked for: to a thousandth of the step."""


@inlined
def within_swept_ball(
    poses: Poses, solid: Solid, a: int, d: int, x: float, y: float
) -> tuple[float, float, float, float]:
    """Where a line is within a ball on a straight path, and at which shares of it.

    The ends are where c(s) -+ sqrt(R² - q(s)) is least and greatest, c being the centre's place along the
    line and q its squared distance from it, a parabola in the share s of the path.
    """
    u, v = (d + 1) % 3, (d + 2) % 3
    height, radius = solid.low + solid.rounding, solid.rounding
    ax, ay, az = point_on_axis(poses, a, height, u, v, d)
    bx, by, bz = point_on_axis(poses, a + 1, height, u, v, d)
    dx, dy, dz = bx - ax, by - ay, bz - az
    px, py = x - ax, y - ay
    squared = dx * dx + dy * dy
    if squared < 1e-24:
        inside = radius * radius - px * px - py * py
        if inside <= 0.0:
            return math.inf, -math.inf, 0.0, 0.0
        root = math.sqrt(inside)
        share = 1.0 if dz > 0.0 else 0.0
        return min(az, bz) - root, max(az, bz) + root, 1.0 - share, share
    nearest = (px * dx + py * dy) / squared
    aside = px * dy - py * dx
    inside = radius * radius - aside * aside / squared
    if inside <= 0.0:
        return math.inf, -math.inf, 0.0, 0.0
    half = math.sqrt(inside / squared)
    first, last = max(nearest - half, 0.0), min(nearest + half, 1.0)
    if first >= last:
        return math.inf, -math.inf, 0.0, 0.0
    shift = half * dz / math.sqrt(squared + dz * dz)
    low_share = min(max(nearest - shift, first), last)
    high_share = min(max(nearest + shift, first), last)
    low = az + low_share * dz - math.sqrt(max(inside - squared * (low_share - nearest) ** 2, 0.0))
    high = (
        az + high_share * dz + math.sqrt(max(inside - squared * (high_share - nearest) ** 2, 0.0))
    )
    return low, high, low_share, high_share


@arithmetic_kernel
def within_swept(
    poses: Poses,
    solid: Solid,
    number: int,
    ends: tuple[Pose, Pose],
    bend: float,
    d: int,
    x: float,
    y: float,
) -> tuple[float, float, float, float]:
    """Where a line is within a solid at any time of a step, and at which shares of it.

    Over a step that is short compared with the solid both ends of the line within it move along curves of the
    share that are nearly parabolas: through begin, middle and end, it is looked where they are extreme, and the
    line there taken as it is. A line that a rim comes to within the step, or leaves, is within the solid for a part of it.
    """
    begin, end = 0.0, 1.0
    a = within_at(ends[0], solid, d, x, y)
    b = within_at(ends[1], solid, d, x, y)
    if a[0] >= a[1] or b[0] >= b[1]:
        m = within(poses, solid, number, 0.5, d, x, y)
        if solid.rounding > 0.0:
            return _union(a, m, b, begin, end)
        middle = _touching(poses, solid, number, (a[1] - a[0], m[1] - m[0], b[1] - b[0]), d, x, y)
        if middle < 0.0:
            return math.inf, -math.inf, 0.0, 0.0
        if a[0] >= a[1]:
            begin = _rim(poses, solid, number, middle, 0.0, d, x, y)
            a = within(poses, solid, number, begin, d, x, y)
        if b[0] >= b[1]:
            end = _rim(poses, solid, number, middle, 1.0, d, x, y)
            b = within(poses, solid, number, end, d, x, y)
    elif bend < FLAT_MM:
        return _union(a, a, b, begin, end)
    m = within(poses, solid, number, 0.5 * (begin + end), d, x, y)
    low, high, low_share, high_share = _union(a, m, b, begin, end)
    share = begin + _extreme(-a[0], -m[0], -b[0]) * (end - begin)
    if begin < share < end:
        lowest = within(poses, solid, number, share, d, x, y)
        if lowest[0] < min(low, lowest[1]):
            low, low_share = lowest[0], share
    share = begin + _extreme(a[1], m[1], b[1]) * (end - begin)
    if begin < share < end:
        highest = within(poses, solid, number, share, d, x, y)
        if highest[1] > max(high, highest[0]):
            high, high_share = highest[1], share
    return low, high, low_share, high_share


@arithmetic_kernel
def _union(
    a: tuple[float, float],
    m: tuple[float, float],
    b: tuple[float, float],
    begin: float,
    end: float,
) -> tuple[float, float, float, float]:
    """From the lowest to the highest place of those of three intervals that are not empty."""
    low, high, low_share, high_share = math.inf, -math.inf, begin, begin
    middle = 0.5 * (begin + end)
    for each, share in ((a, begin), (m, middle), (b, end)):
        if each[0] < each[1]:
            if each[0] < low:
                low, low_share = each[0], share
            if each[1] > high:
                high, high_share = each[1], share
    return low, high, low_share, high_share


@arithmetic_kernel
def _touching(
    poses: Poses,
    solid: Solid,
    number: int,
    gap: tuple[float, float, float],
    d: int,
    x: float,
    y: float,
) -> float:
    """A share of a step at which a line is within a frustum; negative: there is none.

    How far the line is within, or is missing, is concave in the share while the axis keeps its direction: from its
    values at begin, middle and end follows what it is at most.
    """
    first, middle, last = gap
    if first > 0.0 or last > 0.0:
        if first > 0.0 and first >= last:
            return 0.0
        return 1.0
    if middle > 0.0:
        return 0.5
    if not middle > -math.inf or 2.0 * middle < min(first, last):
        return -1.0
    center, half = 0.5, 0.25
    for _ in range(_SEARCH_STEPS):
        best, place = middle, center
        for share in (center - half, center + half):
            low, high = within(poses, solid, number, share, d, x, y)
            if high - low > best:
                best, place = high - low, share
        if best > 0.0:
            return place
        middle, center, half = best, place, 0.5 * half
    return -1.0


@arithmetic_kernel
def _rim(
    poses: Poses,
    solid: Solid,
    number: int,
    inside: float,
    outside: float,
    d: int,
    x: float,
    y: float,
) -> float:
    """The last share towards another at which a line is within a solid."""
    for _ in range(_SEARCH_STEPS):
        middle = 0.5 * (inside + outside)
        low, high = within(poses, solid, number, middle, d, x, y)
        if low < high:
            inside = middle
        else:
            outside = middle
    return inside


@arithmetic_kernel
def _extreme(first: float, middle: float, last: float) -> float:
    """The share at which a parabola through three evenly spaced places is greatest; 0: not between them."""
    bend = 2.0 * (first + last - 2.0 * middle)
    slope = 4.0 * middle - 3.0 * first - last
    if bend >= 0.0 or slope <= 0.0 or slope >= -2.0 * bend:
        return 0.0
    return -0.5 * slope / bend
