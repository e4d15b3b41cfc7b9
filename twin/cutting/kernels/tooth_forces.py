"""The force of every tooth at every angle, from the material that stands before the cutter.

The edges are looked at in ``BINS`` directions about the axis. In each, the side of the cutter meets
the material up to a depth that the height map tells, and the rings of its lower end meet it or do
not. A tooth that passes there cuts a chip as thick as the feed per tooth along the normal of the
surface that it sweeps, h = f·n, and is pushed by Kienzle's force kc1.1 h^(1 - mc) a millimetre of
edge against its motion, by ``radial`` of that inwards along the normal, and by ``along`` of it along
the edge towards the tip.
"""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import kernel
from twin.cutting.kernels.sweep import Grid
from twin.cutting.kernels.tool_height import profile_height
from twin.nc.canonical import FloatArray

THINNEST_CHIP_MM = 1e-3
"""Chips thinner than this are rubbed, not cut; the formula is not followed below [mm]."""
BINS = 72
"""Directions about the axis that are looked at: 5 degrees each."""
_ANGLES = (np.arange(BINS) + 0.5) * (2.0 * np.pi / BINS)
_COSINE, _SINE = np.cos(_ANGLES), np.sin(_ANGLES)
_PLACES = 3
"""Places in each direction at which the depth of the side is looked at."""
_FINE = (np.arange(BINS * _PLACES) + 0.5) * (2.0 * np.pi / (BINS * _PLACES))
_FINE_COSINE, _FINE_SINE = np.cos(_FINE), np.sin(_FINE)
_CLEAR = 0.75
"""How far before the cutter the material is looked at, in cells along the normal: beyond the corner
of a cell whose middle the cutter has passed."""
_FARTHEST = 4.0
"""And at most, in cells along the feed."""
_LEAST = 1e-9
"""Lengths below this are the arithmetic's doing [mm]."""


class CutterForm(NamedTuple):
    """A cutter as forces see it.

    Attributes:
        profile: Radius, flat, corner, slope of its lower end (``twin.cutting.tools.Profile``).
        side_from: Height above the tip at which its side begins [mm].
        flute: Height above the tip at which its edges end [mm].
        teeth: Number of edges, evenly spaced.
        rise: Height over which a helical edge falls back by one bin [mm]; infinite: it is straight.
        radius: Of each ring of the lower end, shape (m,) [mm]; so on.
        height: Above the tip of its lower edge [mm].
        span: How much higher its upper edge is [mm].
        width: Length of edge [mm].
        outwards: Share of the normal that points outwards.
        downwards: Share of it that points down.
    """

    profile: tuple[float, float, float, float]
    side_from: float
    flute: float
    teeth: int
    rise: float
    radius: FloatArray
    height: FloatArray
    span: FloatArray
    width: FloatArray
    outwards: FloatArray
    downwards: FloatArray


class ForceLaw(NamedTuple):
    """What a material does to an edge.

    Attributes:
        kc: Specific force of a chip 1 mm wide and 1 mm thick [N/mm²].
        mc: Its fall with the chip's thickness.
        radial: Force along the normal as a share of the tangential one.
        along: Force along the edge as a share of it.
    """

    kc: float
    mc: float
    radial: float
    along: float


class Material(NamedTuple):
    """What is cut.

    Attributes:
        heights: The height map, cut up to where the tool is, shape (ny, nx) [mm].
        grid: Where its cells lie.
    """

    heights: FloatArray
    grid: Grid


class Advance(NamedTuple):
    """How a cutter goes on.

    Attributes:
        tip: Where its tip is, shape (3,) [mm].
        way: Unit vector of its way.
        per_tooth: How far it goes in the time between two teeth [mm].
        sense: 1: it turns clockwise, seen from above; -1: counter-clockwise.
    """

    tip: FloatArray
    way: tuple[float, float, float]
    per_tooth: float
    sense: float


class ToothBench(NamedTuple):
    """What ``tooth_forces`` leaves: of one tooth in each direction, and of all in the mean.

    Attributes:
        side: Force a millimetre of side, shape (BINS, 3) [N/mm].
        depth: How deep the side is in the material, shape (BINS,) [mm].
        tooth: Force on the tool when a tooth's tip is in that direction, shape (BINS, 3) [N].
        summed: ``tooth`` added up from the first direction on, shape (BINS + 1, 3).
        mean: Force on the tool in the mean of a turn, shape (3,) [N].
        figures: Greatest level force of a turn [N], torque in the mean [N mm], thickest chip [mm].
    """

    side: FloatArray
    depth: FloatArray
    tooth: FloatArray
    summed: FloatArray
    mean: FloatArray
    figures: FloatArray


def tooth_bench() -> ToothBench:
    """A bench on which nothing lies."""
    shapes = ((BINS, 3), (BINS,), (BINS, 3), (BINS + 1, 3), (3,), (3,))
    return ToothBench(*(np.zeros(shape) for shape in shapes))


@kernel
def tooth_forces(
    material: Material,
    tip: FloatArray,
    feed: FloatArray,
    cutter: CutterForm,
    law: ForceLaw,
    sense: float,
    bench: ToothBench,
) -> bool:
    """Forces of a cutter that goes on as it does.

    Args:
        material: What is cut.
        tip: Tool tip, shape (3,) [mm].
        feed: Way of the tip in the time between two teeth, shape (3,) [mm].
        cutter: The cutter.
        law: What the material does.
        sense: 1: it turns clockwise, seen from above; -1: counter-clockwise.
        bench: Set to what was found.

    Returns:
        Whether the cutter meets any material.
    """
    per_tooth = math.sqrt(feed[0] * feed[0] + feed[1] * feed[1] + feed[2] * feed[2])
    bench.mean[:] = 0.0
    bench.figures[:] = 0.0
    if per_tooth < _LEAST:
        return False
    way = (feed[0] / per_tooth, feed[1] / per_tooth, feed[2] / per_tooth)
    advance = Advance(tip, way, per_tooth, sense)
    met = False
    for j in range(BINS):
        bench.depth[j] = 0.0
        for k in range(3):
            bench.tooth[j, k] = 0.0
        met |= _meet_side(material, advance, cutter, law, j, bench)
        met |= _meet_end(material, advance, cutter, law, j, bench)
    if met:
        _add_up(cutter, sense, bench)
    return met


@kernel
def _meet_side(
    material: Material,
    advance: Advance,
    cutter: CutterForm,
    law: ForceLaw,
    j: int,
    bench: ToothBench,
) -> bool:
    """Depth and force of the side in one direction."""
    way, sense = advance.way, advance.sense
    cosine, sine = _COSINE[j], _SINE[j]
    chip = way[0] * cosine + way[1] * sine
    if chip <= _LEAST:
        return False
    depth = 0.0
    for part in range(_PLACES):
        place = j * _PLACES + part
        depth += _side_depth(material, advance, cutter, place) / _PLACES
    if depth <= 0.0:
        return False
    thickness = advance.per_tooth * chip
    force = _push(law, advance.per_tooth, chip)
    bench.depth[j] = depth
    bench.side[j, 0] = force * (-sense * sine - law.radial * cosine)
    bench.side[j, 1] = force * (sense * cosine - law.radial * sine)
    bench.side[j, 2] = -force * law.along
    bench.figures[1] += force * depth * cutter.profile[0]
    bench.figures[2] = max(bench.figures[2], thickness)
    return True


@kernel
def _side_depth(
    material: Material,
    advance: Advance,
    cutter: CutterForm,
    place: int,
) -> float:
    """How deep the side is in the material at a place around the axis [mm]."""
    tip, way, grid = advance.tip, advance.way, material.grid
    level = math.hypot(way[0], way[1])
    ux, uy = way[0] / level, way[1] / level
    across = ux * _FINE_SINE[place] - uy * _FINE_COSINE[place]
    forwards = ux * _FINE_COSINE[place] + uy * _FINE_SINE[place]
    if forwards <= 0.0:
        return 0.0
    radius = cutter.profile[0]
    # The cell beside the way that the cutter leaves is not before it: stay a cell's corner off.
    most = max(0.0, radius - _CLEAR * grid.cell)
    aside = min(max(radius * across, -most), most)
    ahead = math.sqrt(radius * radius - aside * aside)
    ahead += grid.cell * min(_CLEAR / forwards, _FARTHEST)
    x, y = tip[0] + ahead * ux - aside * uy, tip[1] + ahead * uy + aside * ux
    row = _number(y, grid.origin[1], grid.cell)
    column = _number(x, grid.origin[0], grid.cell)
    depth = _height_of(material, row, column) - tip[2] - cutter.side_from
    return max(0.0, min(depth, cutter.flute - cutter.side_from))


@kernel
def _meet_end(
    material: Material,
    advance: Advance,
    cutter: CutterForm,
    law: ForceLaw,
    j: int,
    bench: ToothBench,
) -> bool:
    """Force of the rings of the lower end in one direction."""
    met, way, sense = False, advance.way, advance.sense
    cosine, sine = _COSINE[j], _SINE[j]
    outwards = way[0] * cosine + way[1] * sine
    for i in range(len(cutter.radius)):
        chip = outwards * cutter.outwards[i] - way[2] * cutter.downwards[i]
        if chip <= _LEAST:
            continue
        share = _ring_share(material, advance, cutter, i, j, chip)
        if share <= 0.0:
            continue
        met = True
        thickness = advance.per_tooth * chip
        force = _push(law, advance.per_tooth, chip) * share * cutter.width[i]
        inwards = force * (law.radial * cutter.outwards[i] + law.along * cutter.downwards[i])
        upwards = force * (law.radial * cutter.downwards[i] - law.along * cutter.outwards[i])
        bench.tooth[j, 0] += -sense * sine * force - cosine * inwards
        bench.tooth[j, 1] += sense * cosine * force - sine * inwards
        bench.tooth[j, 2] += upwards
        bench.figures[1] += force * cutter.radius[i]
        bench.figures[2] = max(bench.figures[2], thickness)
    return met


@kernel
def _ring_share(
    material: Material,
    advance: Advance,
    cutter: CutterForm,
    i: int,
    j: int,
    chip: float,
) -> float:
    """How much of a ring is in the material in one direction, 0 to 1."""
    tip, way, grid = advance.tip, advance.way, material.grid
    clear = grid.cell * min(_CLEAR / chip, _FARTHEST)
    row = _number(tip[1] + cutter.radius[i] * _SINE[j] + clear * way[1], grid.origin[1], grid.cell)
    column = _number(
        tip[0] + cutter.radius[i] * _COSINE[j] + clear * way[0], grid.origin[0], grid.cell
    )
    top = _height_of(material, row, column) - tip[2]
    low, span = cutter.height[i], cutter.span[i]
    if top <= low + min(0.0, clear * way[2]):
        return 0.0
    x = grid.origin[0] + column * grid.cell - tip[0]
    y = grid.origin[1] + row * grid.cell - tip[1]
    radius, flat, corner, slope = cutter.profile
    level = math.hypot(way[0], way[1])
    if level > abs(way[2]):
        # A wall that the cutter has left, or will pass at the height that it has, is not cut.
        aside, ahead = abs(x * way[1] - y * way[0]) / level, (x * way[0] + y * way[1]) / level
        lowest = profile_height(aside, radius, flat, corner, slope)
        if top <= lowest + min(0.0, way[2]) / level * max(0.0, ahead) + _LEAST:
            return 0.0
    if abs(top - profile_height(math.hypot(x, y), radius, flat, corner, slope)) <= _LEAST:
        # The cutter stands on what it has cut itself, and goes on into it.
        return 1.0
    if top <= low:
        return 0.0
    return 1.0 if top >= low + span else (top - low) / span


@kernel
def _push(law: ForceLaw, per_tooth: float, chip: float) -> float:
    """Tangential force a millimetre of edge, of a chip that is a share of the feed [N/mm]."""
    thickness = per_tooth * chip
    return law.kc * max(thickness, THINNEST_CHIP_MM) ** -law.mc * thickness


@kernel
def _number(place: float, origin: float, cell: float) -> int:
    """Number of the cell that a place lies in."""
    return math.floor((place - origin) / cell + 0.5)


@kernel
def _height_of(material: Material, row: int, column: int) -> float:
    """Height of a cell [mm]; below everything where there is none."""
    heights = material.heights
    if row < 0 or column < 0 or row >= heights.shape[0] or column >= heights.shape[1]:
        return -math.inf
    height = heights[row, column]
    return height if height > material.grid.bottom else -math.inf


@kernel
def _add_up(cutter: CutterForm, sense: float, bench: ToothBench) -> None:
    """Force of a tooth by the direction of its tip, their sums, and the mean and greatest of a turn."""
    share = cutter.teeth / BINS
    for j in range(BINS):
        for k in range(3):
            bench.mean[k] += share * (bench.tooth[j, k] + bench.side[j, k] * bench.depth[j])
    bench.figures[1] *= share
    behind = 1 if sense > 0.0 else BINS - 1
    for j in range(BINS):
        if bench.depth[j] <= 0.0:
            continue
        below, to = 0.0, j
        while below < bench.depth[j]:
            part = min(cutter.rise, bench.depth[j] - below)
            for k in range(3):
                bench.tooth[to, k] += part * bench.side[j, k]
            below += part
            # Higher up the edge is in this direction when its tip has gone on.
            to = (to + BINS - behind) % BINS
    for k in range(3):
        bench.summed[0, k] = 0.0
        for j in range(BINS):
            bench.summed[j + 1, k] = bench.summed[j, k] + bench.tooth[j, k]
    for j in range(math.ceil(BINS / cutter.teeth)):
        x, y = 0.0, 0.0
        for tooth in range(cutter.teeth):
            at = (j + tooth * BINS // cutter.teeth) % BINS
            x += bench.tooth[at, 0]
            y += bench.tooth[at, 1]
        bench.figures[0] = max(bench.figures[0], math.hypot(x, y))


@kernel
def add_force_between(
    cutter: CutterForm, bench: ToothBench, angle: float, turned: float, force: FloatArray
) -> None:
    """Force on the tool in the mean while it turns.

    Args:
        cutter: The cutter.
        bench: What ``tooth_forces`` found.
        angle: Direction of the first tooth's tip at the beginning [turns, counter-clockwise].
        turned: How far it turns, signed [turns]; at least a thousandth of a bin is counted.
        force: The force is added to it, shape (3,) [N].
    """
    width = max(abs(turned) * BINS, 1e-3)
    first = angle * BINS - (width if turned < 0.0 else 0.0)
    for tooth in range(cutter.teeth):
        low = first + tooth * BINS / cutter.teeth
        low -= BINS * math.floor(low / BINS)
        for k in range(3):
            force[k] += (_sum_up_to(bench, low + width, k) - _sum_up_to(bench, low, k)) / width


@kernel
def _sum_up_to(bench: ToothBench, place: float, k: int) -> float:
    """Sum of a tooth's force over the directions up to a place from 0 on, in bins."""
    turns = math.floor(place / BINS)
    rest = place - turns * BINS
    whole = min(int(rest), BINS - 1)
    part = (rest - whole) * bench.tooth[whole, k]
    return turns * bench.summed[BINS, k] + bench.summed[whole, k] + part
