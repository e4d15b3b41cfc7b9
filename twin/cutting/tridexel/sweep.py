"""Bring solids along steps through a tri-dexel stock, line by line."""

import enum
import math
from typing import NamedTuple

from twin.compilation.compilable import inlined
from twin.compilation.kernel import arithmetic_kernel, threaded_kernel
from twin.cutting.kernels.covered_cells import chord
from twin.cutting.tridexel.dexels import Dexels, Lattice
from twin.cutting.tridexel.intervals import (
    BEGINS_ABOVE,
    ENDS_BELOW,
    Node,
    meeting,
    overlap,
    subtract,
)
from twin.cutting.tridexel.solids.moving_solid import (
    Pose,
    Poses,
    is_ball,
    point_on_axis,
    pose_at,
    surface,
)
from twin.cutting.tridexel.solids.rays import greatest_radius
from twin.cutting.tridexel.solids.solids import Solid
from twin.cutting.tridexel.solids.swept import within_swept, within_swept_ball
from twin.nc.canonical import FloatArray


class StepColumn(enum.IntEnum):
    """Columns of what is found out about a step."""

    VOLUME = 0
    """[mm³]"""
    LENGTH = 1
    """Of all that was taken off [mm]."""
    MOMENT = 2
    """First of three: that length times its place along X, Y and Z [mm²]."""
    LOWEST = 5
    """Lowest place along the tool's axis, above the tip [mm]."""
    HIGHEST = 6
    LONGEST = 7
    """First of three: the longest piece along X, Y and Z, or how long what was met is [mm]."""
    COLUMNS = 10
    """How many there are."""


MEASURE = -1
"""In place of a tool's number: nothing is cut."""

_LEVEL = 1e-9
"""Sine of the angle to a plane below which an axis is parallel to it."""


class SweepStep(NamedTuple):
    """A step of the tool: its poses, and which columns of the result it writes."""

    number: int
    tool: int
    """Which is written beside what it cuts."""
    cuts: bool
    goes_on: bool
    """Whether the solid has cut already what it meets at the beginning."""
    bend: float
    """How far the envelope bends between its poses at most [mm]."""
    ends: tuple[Pose, Pose]
    """Where the tool is at both."""


@threaded_kernel
def sweep(
    dexels: Dexels,
    lattice: Lattice,
    poses: Poses,
    solids: FloatArray,
    sums: FloatArray,
    tool: int,
    first: int,
) -> int:
    """Bring solids along steps through the material.

    Args:
        poses: Ends of n steps.
        solids: What moves: the fields of each ``Solid``, shape (m, 5).
        sums: What each step did is added to it, shape (n, COLUMNS).
        tool: Which it is; ``MEASURE``: it cuts nothing, and what it meets is measured.
        first: Step to begin with.

    Returns:
        The step at which memory ran out; n: none.
    """
    for number in range(first, len(poses.tip) - 1):
        cuts = tool != MEASURE
        ends = pose_at(poses, number, 0.0), pose_at(poses, number, 1.0)
        for each in solids:
            solid = Solid(each[0], each[1], each[2], each[3], each[4])
            goes_on, bend = cuts and number > first, _bend(poses, solid, number)
            step = SweepStep(number, tool, cuts, goes_on, bend, ends)
            span = _within_box(lattice, poses, solid, number)
            if span[0] > span[1]:
                continue
            for direction in range(3):
                if not _sweep_lines(dexels, lattice, poses, solid, sums, step, span, direction):
                    return number
    return len(poses.tip) - 1


@arithmetic_kernel
def _bend(poses: Poses, solid: Solid, number: int) -> float:
    """How far what the solid touches is off the surfaces at both ends of a step, at most [mm]."""
    a, b = number, number + 1
    longest = 0.0
    for height in (solid.low, solid.high):
        squared = 0.0
        for i in range(3):
            here = poses.tip[a, i] + height * poses.axis[a, i]
            squared += (poses.tip[b, i] + height * poses.axis[b, i] - here) ** 2
        longest = max(longest, squared)
    return longest / (8.0 * greatest_radius(solid))


@arithmetic_kernel
def _within_box(lattice: Lattice, poses: Poses, solid: Solid, number: int) -> tuple[float, float]:
    """Lowest and highest place on the axis about which the solid may be in the blank's box; or none [mm]."""
    begin, end = solid.low, solid.high
    if is_ball(solid):
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
def _sweep_lines(
    dexels: Dexels,
    lattice: Lattice,
    poses: Poses,
    solid: Solid,
    sums: FloatArray,
    step: SweepStep,
    span: tuple[float, float],
    d: int,
) -> bool:
    """Look at all lines of one direction that may go through the solid; False: memory ran out."""
    u, v = (d + 1) % 3, (d + 2) % 3
    reach, cell, a = greatest_radius(solid), lattice.cell, step.number
    ball = is_ball(solid)
    low, high = span
    corner = (
        point_on_axis(poses, a, low, u, v, d),
        point_on_axis(poses, a, high, u, v, d),
        point_on_axis(poses, a + 1, low, u, v, d),
        point_on_axis(poses, a + 1, high, u, v, d),
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
            if not _meet(dexels, lattice, poses, solid, sums, step, (d, line + column, x, y)):
                return False
    return True


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
    """The part of a row in which a ball takes off more than it does at the beginning of a straight path.

    A line whose nearest place to the path, as a share of it, lies so far before its beginning that both
    ends within the ball (``within_swept_ball``) are those at the beginning, is left out.
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
    sums: FloatArray,
    step: SweepStep,
    place: tuple[int, int, float, float],
) -> bool:
    """Find where one line goes through the swept solid and cut or measure it; False: memory ran out."""
    d, line, x, y = place
    if is_ball(solid):
        low, high, low_share, high_share = within_swept_ball(poses, solid, step.number, d, x, y)
    else:
        low, high, low_share, high_share = within_swept(
            poses, solid, step.number, step.ends, step.bend, d, x, y
        )
    meets = meeting(dexels, line, low, high) if low < high else 0
    if not meets:
        return True
    row, a = sums[step.number], step.number
    if not step.cuts:
        row[StepColumn.LONGEST + d] = max(
            row[StepColumn.LONGEST + d], overlap(dexels, line, low, high)
        )
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
    row[StepColumn.VOLUME] += area * piece.volume
    row[StepColumn.LENGTH] += piece.length
    row[StepColumn.MOMENT + d] += piece.moment
    row[StepColumn.MOMENT + u] += piece.length * x
    row[StepColumn.MOMENT + v] += piece.length * y
    row[StepColumn.LONGEST + d] = max(row[StepColumn.LONGEST + d], piece.longest)
    for end in (piece.low, piece.high):
        height = _height(poses, a + 1, d, end, x, y)
        row[StepColumn.LOWEST] = min(row[StepColumn.LOWEST], height)
        row[StepColumn.HIGHEST] = max(row[StepColumn.HIGHEST], height)
    return True


@arithmetic_kernel
def _height(poses: Poses, pose: int, d: int, t: float, x: float, y: float) -> float:
    """How high above the tip a point is, along the axis [mm]."""
    tip, axis = poses.tip[pose], poses.axis[pose]
    u, v = (d + 1) % 3, (d + 2) % 3
    return (t - tip[d]) * axis[d] + (x - tip[u]) * axis[u] + (y - tip[v]) * axis[v]
