"""The force of every tooth at every angle on a cutter that leans as it likes in a tri-dexel stock.

Between ``ANGLE_BINS`` directions about the axis it is found which length of each ring of the edge has material before it,
and between two of them where that begins and ends. Chips, forces and their sums are those of ``twin.cutting.kernels.teeth``, in
the tool's own frame.
"""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import arithmetic_kernel
from twin.cutting.kernels.teeth import (
    ANGLE_BINS,
    CutterForm,
    ForceLaw,
    ToothScratch,
    bin_direction,
    push,
    sum_teeth,
)
from twin.cutting.tridexel.dexels import Dexels, Lattice
from twin.cutting.tridexel.edge import (
    LEAST_CHIP,
    MOST_RINGS,
    MOST_SLICES,
    Edge,
    Leaning,
    Ring,
    border_about,
    chip_at,
    heights_of_part,
    look_along,
    ring_place,
    slices_of_side,
)
from twin.cutting.tridexel.inside import Standing
from twin.nc.canonical import FloatArray

_FINER = 4
"""Places in each direction in which a tooth is looked at for the greatest force of a turn."""
_PARTS = 4.0
"""And parts of a slice whose edge falls back by a direction."""


class EdgeScratch(NamedTuple):
    """What of each of m = ``MOST_RINGS`` + ``MOST_SLICES`` rings is in the material.

    Attributes:
        length: Share of the ring's length in two neighbouring directions, shape (2, m).
        middle: Where the middle of it is, as a share of the ring from its lower end, shape (2, m).
        arc: Where between two directions the material begins and ends, shape (m, ANGLE_BINS, 2) [bins]; equal: there is none.
        level: Level force on the tool while a tooth is there, at its beginning and its end, shape (m, ANGLE_BINS, 4) [N].
        lag: How far the edge falls back at the lower and the upper end of what is in the material, signed, shape (m, 2) [bins].
    """

    length: FloatArray
    middle: FloatArray
    arc: FloatArray
    level: FloatArray
    lag: FloatArray


def empty_scratch() -> EdgeScratch:
    """Nothing is known yet."""
    rings = MOST_RINGS + MOST_SLICES
    arc, level = np.zeros((rings, ANGLE_BINS, 2)), np.zeros((rings, ANGLE_BINS, 4))
    length, middle = np.zeros((2, 2, rings))
    return EdgeScratch(length, middle, arc, level, np.zeros((rings, 2)))


@arithmetic_kernel
def edge_forces(
    dexels: Dexels,
    lattice: Lattice,
    leaning: Leaning,
    cutter: CutterForm,
    law: ForceLaw,
    found: EdgeScratch,
    scratch: ToothScratch,
) -> bool:
    """Forces of a cutter that goes on as it does.

    Args:
        dexels: What is cut, up to where the cutter is.
        leaning: Where the cutter is, and how it goes on.
        found: Set to what is in the material.
        scratch: Set to the forces, in the tool's frame.

    Returns:
        Whether the cutter meets any material.
    """
    scratch.tooth[:] = 0.0
    scratch.mean[:] = 0.0
    scratch.figures[:] = 0.0
    found.arc[:] = 0.0
    low, high = heights_of_part(lattice, leaning)
    if low >= high or high <= 0.0 or low >= cutter.flute:
        return False
    standing = Standing(leaning.tip, leaning.frame[2], cutter.profile, cutter.side_from)
    side = slices_of_side(lattice, cutter, low, high)
    edge = Edge(dexels, lattice, cutter, leaning, side, standing)
    rings = len(cutter.radius) + edge.side.slices
    met = False
    for border in range(ANGLE_BINS + 1):
        now = border % 2
        look_along(edge, border, found.length[now], found.middle[now])
        if border == 0:
            continue
        for number in range(rings):
            if found.length[0, number] > 0.0 or found.length[1, number] > 0.0:
                met |= _cut_ring(edge, law, number, border - 1, found, scratch)
    if met:
        _add_up(cutter, rings, found, scratch)
    return met


@arithmetic_kernel
def _cut_ring(
    edge: Edge,
    law: ForceLaw,
    number: int,
    j: int,
    found: EdgeScratch,
    scratch: ToothScratch,
) -> bool:
    """Force of one ring between two directions, of which ``found`` knows what is in the material."""
    before, after = j % 2, (j + 1) % 2
    first, last = found.length[before, number], found.length[after, number]
    middles = found.middle[before, number], found.middle[after, number]
    begin, end, length, share = 0.0, 1.0, 0.5 * (first + last), 0.5 * (middles[0] + middles[1])
    if first <= 0.0:
        length, share = last, middles[1]
        begin = border_about(edge, Ring(number, share), j, first=False)
    elif last <= 0.0:
        length, share = first, middles[0]
        end = border_about(edge, Ring(number, share), j, first=True)
    ring, arc = Ring(number, share), (begin, end)
    place = j + 0.5 * (begin + end)
    x, y, upwards, chip = _push_at(edge, law, ring, place, length)
    if chip <= LEAST_CHIP:
        return False
    radius, height, _, _ = ring_place(edge, ring)
    behind = edge.leaning.sense / edge.cutter.rise
    lag = behind * max(height - edge.cutter.side_from, 0.0)
    spread = 0.5 * behind * length * edge.side.height if number >= len(edge.cutter.radius) else 0.0
    found.lag[number, 0], found.lag[number, 1] = lag - spread, lag + spread
    # Higher up the edge is in this direction when its tip has gone on.
    to = j - lag
    whole = math.floor(to)
    for step in range(2):
        part = (end - begin) * (to - whole if step == 1 else 1.0 - to + whole)
        at = (whole + step) % ANGLE_BINS
        scratch.tooth[at, 0] += part * x
        scratch.tooth[at, 1] += part * y
        scratch.tooth[at, 2] += part * upwards
    force = math.hypot(x, y) / math.hypot(1.0, _inwards(edge, law, ring))
    scratch.figures[1] += (end - begin) * force * radius
    scratch.figures[2] = max(scratch.figures[2], chip)
    for k in range(2):
        x, y, _, chip = _push_at(edge, law, ring, j + arc[k], length)
        found.arc[number, j, k] = arc[k]
        found.level[number, j, 2 * k], found.level[number, j, 2 * k + 1] = x, y
        scratch.figures[2] = max(scratch.figures[2], chip)
    return True


@arithmetic_kernel
def _inwards(edge: Edge, law: ForceLaw, ring: Ring) -> float:
    """Level force inwards as a share of the tangential one."""
    _, _, out, down = ring_place(edge, ring)
    return law.radial * out + law.along * down


class _Push(NamedTuple):
    """What a tooth does to the tool: a force along the tool's X, Y and Z [N], and the thickness of its chip [mm]."""

    x: float
    y: float
    z: float
    chip: float


@arithmetic_kernel
def _push_at(edge: Edge, law: ForceLaw, ring: Ring, place: float, length: float) -> _Push:
    """What a tooth does at a place.

    Args:
        ring: Which part of it, looked at in the middle of what is in the material.
        place: Direction about the axis [bins].
        length: How much of the ring is in the material, as a share of it.
    """
    chip = chip_at(edge, ring, place)
    if chip <= LEAST_CHIP:
        return _Push(0.0, 0.0, 0.0, 0.0)
    _, _, out, down = ring_place(edge, ring)
    width = edge.side.height
    if ring.number < len(edge.cutter.radius):
        width = edge.cutter.width[ring.number]
    force = push(law, 1.0, chip) * width * length
    cosine, sine = bin_direction(place)
    inwards, around = force * _inwards(edge, law, ring), edge.leaning.sense * force
    x, y = -sine * around - cosine * inwards, cosine * around - sine * inwards
    return _Push(x, y, force * (law.radial * down - law.along * out), chip)


@arithmetic_kernel
def _add_up(cutter: CutterForm, rings: int, found: EdgeScratch, scratch: ToothScratch) -> None:
    """The mean of a turn, the sums of a tooth, and the greatest level force."""
    share = cutter.teeth / ANGLE_BINS
    for j in range(ANGLE_BINS):
        for k in range(3):
            scratch.mean[k] += share * scratch.tooth[j, k]
    scratch.figures[1] *= share
    sum_teeth(cutter, scratch)
    scratch.figures[0] = 0.0
    for step in range(math.ceil(_FINER * ANGLE_BINS / cutter.teeth)):
        x, y = 0.0, 0.0
        for tooth in range(cutter.teeth):
            turned = step / _FINER + tooth * ANGLE_BINS / cutter.teeth
            for number in range(rings):
                spread = found.lag[number, 1] - found.lag[number, 0]
                parts = math.ceil(_PARTS * min(abs(spread), 1.0)) + 1
                for part in range(parts):
                    at = turned + found.lag[number, 0] + spread * (part + 0.5) / parts
                    push_x, push_y = _level_force(found, number, at)
                    x, y = x + push_x / parts, y + push_y / parts
        scratch.figures[0] = max(scratch.figures[0], math.hypot(x, y))


@arithmetic_kernel
def _level_force(found: EdgeScratch, number: int, at: float) -> tuple[float, float]:
    """Level force on a tooth whose ring is at a place about the axis [bins]."""
    whole = math.floor(at)
    j, within = whole % ANGLE_BINS, at - whole
    begin, end = found.arc[number, j, 0], found.arc[number, j, 1]
    if not begin <= within < end:
        return 0.0, 0.0
    far, level = (within - begin) / (end - begin), found.level[number, j]
    return (1.0 - far) * level[0] + far * level[2], (1.0 - far) * level[1] + far * level[3]
