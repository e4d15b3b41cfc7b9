"""Hot loops of the tri-dexel cut: a solid on its way from pose to pose, line by line."""

import math
from typing import NamedTuple

from twin.compilation.compilable import inlined
from twin.compilation.kernel import arithmetic_kernel
from twin.cutting.kernels.sweep import chord
from twin.cutting.tridexel.dexels import Dexels, Lattice
from twin.cutting.tridexel.intervals import (
    BEGINS_ABOVE,
    ENDS_BELOW,
    Node,
    meeting,
    overlap,
    subtract,
)
from twin.cutting.tridexel.normals import packed
from twin.cutting.tridexel.rays import Ray, crossing, greatest_radius, outwards
from twin.cutting.tridexel.solids import Solid
from twin.nc.canonical import FloatArray

VOLUME, LENGTH, MOMENT, LOWEST, HIGHEST, LONGEST, COLUMNS = 0, 1, 2, 5, 6, 7, 10
"""Columns of what is found out about a step: volume [mm³]; length of all that was taken off [mm]; that times
its place along X, Y, Z [mm²]; its lowest and highest place along the tool's axis, above the tip [mm]; its longest
piece along X, Y and Z, or how long what was met is [mm]."""

MEASURE = -1
"""In place of a tool's number: nothing is cut."""

FLAT_MM = 2e-4
"""Bend of a step's envelope that two poses are enough for [mm]."""


_LEVEL = 1e-9
"""Sine of the angle to a plane below which an axis is parallel to it."""


class Poses(NamedTuple):
    """Where the tool is at the ends of n steps.

    Attributes:
        tip: Its tip in the part's frame, shape (n + 1, 3) [mm].
        axis: Direction from the tip to the spindle, shape (n + 1, 3).
    """

    tip: FloatArray
    axis: FloatArray


class Step(NamedTuple):
    """A step of the tool: its poses, and which columns of the tally it writes."""

    number: int
    tool: int
    """Which is written beside what it cuts."""
    cuts: bool
    goes_on: bool
    """Whether the solid has cut already what it meets at the beginning."""
    bend: float
    """How far the envelope bends between its poses at most [mm]."""


@arithmetic_kernel
def sweep(
    dexels: Dexels,
    lattice: Lattice,
    poses: Poses,
    solids: FloatArray,
    tally: FloatArray,
    tool: int,
    first: int,
) -> int:
    """Bring solids along steps through the material.

    Args:
        dexels: The material.
        lattice: Where it lies.
        poses: Ends of n steps.
        solids: What moves: the fields of each ``Solid``, shape (m, 5).
        tally: What each step did is added to it, shape (n, COLUMNS).
        tool: Which it is; ``MEASURE``: it cuts nothing, and what it meets is measured.
        first: Step to begin with.

    Returns:
        The step at which memory ran out; n: none.
    """
    for number in range(first, len(poses.tip) - 1):
        cuts = tool != MEASURE
        for each in solids:
            solid = Solid(each[0], each[1], each[2], each[3], each[4])
            step = Step(number, tool, cuts, cuts and number > first, _bend(poses, solid, number))
            span = _within_box(lattice, poses, solid, number)
            if span[0] > span[1]:
                continue
            for direction in range(3):
                if not _sweep_lines(dexels, lattice, poses, solid, tally, step, span, direction):
                    return number
    return len(poses.tip) - 1


@arithmetic_kernel
def _bend(poses: Poses, solid: Solid, number: int) -> float:
    """How far what the solid touches is off the surfaces at both ends of a step, at most [mm]."""
    a, b = number, number + 1
    longest = 0.0
    for height in (solid.low, solid.high):
        way = 0.0
        for i in range(3):
            here = poses.tip[a, i] + height * poses.axis[a, i]
            way += (poses.tip[b, i] + height * poses.axis[b, i] - here) ** 2
        longest = max(longest, way)
    return longest / (8.0 * greatest_radius(solid))


@arithmetic_kernel
def _within_box(lattice: Lattice, poses: Poses, solid: Solid, number: int) -> tuple[float, float]:
    """Lowest and highest place on the axis about which the solid may be in the blank's box; or none [mm]."""
    begin, end = solid.low, solid.high
    if _is_ball(solid):
        begin = end = solid.low + solid.rounding
    lowest, highest = math.inf, -math.inf
    reach = greatest_radius(solid) + lattice.cell
    for pose in range(number, number + 2):
        low, high = begin, end
        for i in range(3):
            near = lattice.origin[i] - reach - poses.tip[pose, i]
            far = near + 2.0 * reach + lattice.cell * lattice.shape[i]
            slope = poses.axis[pose, i]
            if abs(slope) < _LEVEL:
                if near > 0.0 or far < 0.0:
                    low = math.inf
            else:
                low = max(low, min(near / slope, far / slope))
                high = min(high, max(near / slope, far / slope))
        if low <= high:
            lowest, highest = min(lowest, low), max(highest, high)
    return lowest, highest


@arithmetic_kernel
def _is_ball(solid: Solid) -> bool:
    return solid.rounding > 0.0 and solid.low_radius == 0.0


@arithmetic_kernel
def _sweep_lines(
    dexels: Dexels,
    lattice: Lattice,
    poses: Poses,
    solid: Solid,
    tally: FloatArray,
    step: Step,
    span: tuple[float, float],
    d: int,
) -> bool:
    """Look at all lines of one direction that may go through the solid; False: memory ran out."""
    u, v = (d + 1) % 3, (d + 2) % 3
    reach, cell, a = greatest_radius(solid), lattice.cell, step.number
    ball = _is_ball(solid)
    low, high = span
    corner = (
        _point(poses, a, low, u, v, d),
        _point(poses, a, high, u, v, d),
        _point(poses, a + 1, low, u, v, d),
        _point(poses, a + 1, high, u, v, d),
    )
    # Discs stand upright on the axis: along a direction they reach as far as they are across it.
    slant = math.sqrt(max(1.0 - min(poses.axis[a, d] ** 2, poses.axis[a + 1, d] ** 2), 0.0))
    deep = step.bend + (reach if solid.rounding > 0.0 else reach * slant)
    bottom = min(corner[0][2], corner[1][2], corner[2][2], corner[3][2]) - deep
    top = max(corner[0][2], corner[1][2], corner[2][2], corner[3][2]) + deep
    if top < lattice.origin[d] - cell or bottom > lattice.origin[d] + cell * lattice.shape[d]:
        return True
    least = min(corner[0][1], corner[1][1], corner[2][1], corner[3][1]) - reach
    most = max(corner[0][1], corner[1][1], corner[2][1], corner[3][1]) + reach
    first_row = max(0, math.ceil((least - lattice.origin[v]) / cell))
    last_row = min(lattice.shape[v] - 1, math.floor((most - lattice.origin[v]) / cell))
    for row in range(first_row, last_row + 1):
        y = lattice.origin[v] + row * cell
        left, right = _hull_chord(corner, reach, y, ball)
        if ball and step.goes_on:
            left, right = _ahead(corner[0], corner[2], reach, y, left, right)
        first = max(0, math.ceil((left - lattice.origin[u]) / cell))
        last = min(lattice.shape[u] - 1, math.floor((right - lattice.origin[u]) / cell))
        line = lattice.base[d] + row * lattice.shape[u]
        for column in range(first, last + 1):
            if not meeting(dexels, line + column, bottom, top):
                continue
            x = lattice.origin[u] + column * cell
            if not _meet(dexels, lattice, poses, solid, tally, step, (d, line + column, x, y)):
                return False
    return True


@inlined
def _point(
    poses: Poses, pose: int, height: float, u: int, v: int, d: int
) -> tuple[float, float, float]:
    """A place on the axis, along the two directions across the lines and along them [mm]."""
    tip, axis = poses.tip[pose], poses.axis[pose]
    return tip[u] + height * axis[u], tip[v] + height * axis[v], tip[d] + height * axis[d]


@arithmetic_kernel
def _hull_chord(
    corner: tuple[
        tuple[float, float, float],
        tuple[float, float, float],
        tuple[float, float, float],
        tuple[float, float, float],
    ],
    radius: float,
    y: float,
    ball: bool,
) -> tuple[float, float]:
    """Where a row crosses the hull of discs about both ends of both poses [mm]."""
    p, q, r, s = corner
    left, right = chord(p[0], p[1], r[0], r[1], radius, y)
    if not ball:
        for a, b in ((p, q), (r, s), (q, s), (p, s), (q, r)):
            begin, end = chord(a[0], a[1], b[0], b[1], radius, y)
            left, right = min(left, begin), max(right, end)
    return left, right


@arithmetic_kernel
def _ahead(
    a: tuple[float, float, float],
    b: tuple[float, float, float],
    radius: float,
    y: float,
    left: float,
    right: float,
) -> tuple[float, float]:
    """The part of a row in which a ball takes off more than it does at the beginning of a straight way.

    A line whose nearest place to the way, as a share of it, lies so far before its beginning that both
    ends within the ball (``_swept_ball``) are those at the beginning, is left out.
    """
    dx, dy, dz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    squared = dx * dx + dy * dy
    if dx == 0.0:
        return left, right
    shift = radius * abs(dz) * math.sqrt(squared / (squared + dz * dz))
    border = a[0] - ((y - a[1]) * dy + shift) / dx
    return (max(left, border), right) if dx > 0.0 else (left, min(right, border))


@inlined
def _meet(
    dexels: Dexels,
    lattice: Lattice,
    poses: Poses,
    solid: Solid,
    tally: FloatArray,
    step: Step,
    place: tuple[int, int, float, float],
) -> bool:
    """Find where one line goes through the swept solid and cut or measure it; False: memory ran out."""
    d, line, x, y = place
    if _is_ball(solid):
        low, high, low_share, high_share = _swept_ball(poses, solid, step.number, d, x, y)
    else:
        low, high, low_share, high_share = _swept(poses, solid, step, d, x, y)
    meets = meeting(dexels, line, low, high) if low < high else 0
    if not meets:
        return True
    row, a = tally[step.number], step.number
    if not step.cuts:
        row[LONGEST + d] = max(row[LONGEST + d], overlap(dexels, line, low, high))
        return True
    below = above = 0
    if meets & ENDS_BELOW:
        below = surface(poses, solid, (d, low, x, y), a, low_share, -1.0, step.tool)
    if meets & BEGINS_ABOVE:
        above = surface(poses, solid, (d, high, x, y), a, high_share, -1.0, step.tool)
    piece = subtract(
        dexels, line, (low, high), (below, above), Node(d, lattice.origin[d], lattice.cell)
    )
    if piece.length < 0.0:
        return False
    if piece.length == 0.0:
        return True
    area = lattice.cell * lattice.cell
    u, v = (d + 1) % 3, (d + 2) % 3
    row[VOLUME] += area * piece.volume
    row[LENGTH] += piece.length
    row[MOMENT + d] += piece.moment
    row[MOMENT + u] += piece.length * x
    row[MOMENT + v] += piece.length * y
    row[LONGEST + d] = max(row[LONGEST + d], piece.longest)
    for end in (piece.low, piece.high):
        height = _height(poses, a + 1, d, end, x, y)
        row[LOWEST] = min(row[LOWEST], height)
        row[HIGHEST] = max(row[HIGHEST], height)
    return True


@arithmetic_kernel
def _height(poses: Poses, pose: int, d: int, t: float, x: float, y: float) -> float:
    """How high above the tip a point is, along the axis [mm]."""
    tip, axis = poses.tip[pose], poses.axis[pose]
    u, v = (d + 1) % 3, (d + 2) % 3
    return (t - tip[d]) * axis[d] + (x - tip[u]) * axis[u] + (y - tip[v]) * axis[v]


@inlined
def _swept_ball(
    poses: Poses, solid: Solid, a: int, d: int, x: float, y: float
) -> tuple[float, float, float, float]:
    """Where a line is within a ball on a straight way, and at which shares of the way.

    The ends are where c(s) -+ sqrt(R² - q(s)) is least and greatest, c being the centre's place along the
    line and q its squared distance from it, a parabola in the share s of the way.
    """
    u, v = (d + 1) % 3, (d + 2) % 3
    height, radius = solid.low + solid.rounding, solid.rounding
    ax, ay, az = _point(poses, a, height, u, v, d)
    bx, by, bz = _point(poses, a + 1, height, u, v, d)
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
def _pose(poses: Poses, a: int, share: float) -> tuple[float, float, float, float, float, float]:
    """Tip and direction at a share of a step."""
    tip, axis = poses.tip, poses.axis
    b, rest = a + 1, 1.0 - share
    x = rest * axis[a, 0] + share * axis[b, 0]
    y = rest * axis[a, 1] + share * axis[b, 1]
    z = rest * axis[a, 2] + share * axis[b, 2]
    scale = 1.0 / math.sqrt(x * x + y * y + z * z)
    return (
        rest * tip[a, 0] + share * tip[b, 0],
        rest * tip[a, 1] + share * tip[b, 1],
        rest * tip[a, 2] + share * tip[b, 2],
        x * scale,
        y * scale,
        z * scale,
    )


@arithmetic_kernel
def within(
    poses: Poses, solid: Solid, a: int, share: float, d: int, x: float, y: float
) -> tuple[float, float]:
    """Where a line is within the solid at a share of a step."""
    pose = _pose(poses, a, share)
    u, v = (d + 1) % 3, (d + 2) % 3
    px, py, pz = x - pose[u], y - pose[v], -pose[d]
    height = px * pose[3 + u] + py * pose[3 + v] + pz * pose[3 + d]
    rise = pose[3 + d]
    ray = Ray(
        height,
        rise,
        px * px + py * py + pz * pz - height * height,
        pz - height * rise,
        1.0 - rise * rise,
    )
    return crossing(solid, ray)


@arithmetic_kernel
def _swept(
    poses: Poses, solid: Solid, step: Step, d: int, x: float, y: float
) -> tuple[float, float, float, float]:
    """Where a line is within a solid at any time of a step, and at which shares of it.

    Over a step that is short beside the solid both ends of the line within it move along curves of the
    share that are nearly parabolas: through begin, middle and end, it is looked where they are extreme, and the
    line there taken as it is. A line that a rim comes to within the step, or leaves, is within the solid for a part of it.
    """
    number = step.number
    begin, end = 0.0, 1.0
    a = within(poses, solid, number, begin, d, x, y)
    b = within(poses, solid, number, end, d, x, y)
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
    elif step.bend < FLAT_MM:
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


_SEARCH_STEPS = 10
"""Halvings of a share in which a rim is looked for: to a thousandth of the step."""


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


@arithmetic_kernel
def surface(
    poses: Poses,
    solid: Solid,
    point: tuple[int, float, float, float],
    number: int,
    share: float,
    side: float,
    tool: int,
) -> int:
    """Normal at a point of a solid's surface and the tool, as ``normals.packed`` has them.

    Args:
        poses: Ends of steps.
        solid: The solid.
        point: Direction of the line it is on, place along it, and across it in both directions.
        number: Of the step.
        share: Of the step.
        side: 1.0: the normal out of the solid; -1.0: into it.
        tool: Number of the tool.
    """
    d, t, x, y = point
    u, v = (d + 1) % 3, (d + 2) % 3
    if _is_ball(solid):
        ax, ay, az = _point(poses, number, solid.rounding + solid.low, u, v, d)
        bx, by, bz = _point(poses, number + 1, solid.rounding + solid.low, u, v, d)
        scale, rest = side / solid.rounding, 1.0 - share
        nu, nv = (x - rest * ax - share * bx) * scale, (y - rest * ay - share * by) * scale
        return _turned(nu, nv, (t - rest * az - share * bz) * scale, d, tool)
    pose = _pose(poses, number, share)
    px, py, pz = x - pose[u], y - pose[v], t - pose[d]
    au, av, ad = pose[3 + u], pose[3 + v], pose[3 + d]
    height = px * au + py * av + pz * ad
    px, py, pz = px - height * au, py - height * av, pz - height * ad
    distance = math.sqrt(px * px + py * py + pz * pz)
    aside, along = outwards(solid, distance, height)
    aside, along = side * aside / max(distance, 1e-12), side * along
    nu, nv, nd = px * aside + along * au, py * aside + along * av, pz * aside + along * ad
    return _turned(nu, nv, nd, d, tool)


@arithmetic_kernel
def _turned(nu: float, nv: float, nd: float, d: int, tool: int) -> int:
    """A normal told along a direction and the two across it, packed."""
    if d == 0:
        return packed(nd, nu, nv, tool)
    if d == 1:
        return packed(nv, nd, nu, tool)
    return packed(nu, nv, nd, tool)
