"""The force of every tooth at every angle on a cutter that leans as it likes in a tri-dexel stock.

The edge is looked at in rings: those of its lower end, and slices of its side as far up as the part reaches. Between
``ANGLE_BINS`` directions about the axis it is found which length of each ring has material before it, and between two of
them where that begins and ends. Chips, forces and their sums are those of ``twin.cutting.kernels.teeth``, in
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
from twin.cutting.material import AIR_MM
from twin.cutting.tridexel.dexels import Dexels, Lattice
from twin.cutting.tridexel.inside import EdgePoint, Standing, inside
from twin.nc.canonical import FloatArray

MOST_SLICES = 24
"""Of the side."""
MOST_RINGS = 16
"""Of the lower end of any cutter."""
_SLICE_CELLS = 2.0
"""Height of a slice at least [cells]."""
_HALVINGS = 5
"""Halvings in search of where the material begins on a ring, or about the axis."""
_TOUCH = 0.5 ** (_HALVINGS + 2)
"""Share of a ring that is found where one of its ends alone is in material: a cutter that slides over a face cuts no chip."""
_CLEAR = 0.15
"""How far before the edge the material is looked at, along the normal [cells]: beyond what the planes of crossings
are off a round surface."""
_FARTHEST = 2.0
"""And at most, along its path [cells]."""
_FINER = 4
"""Places in each direction in which a tooth is looked at for the greatest force of a turn."""
_PARTS = 4.0
"""And parts of a slice whose edge falls back by a direction."""
_LEAST = 1e-9
"""Chips below this are the arithmetic's doing [mm]."""

_Place = tuple[float, float, float]


class Leaning(NamedTuple):
    """A cutter in a part, and how it goes on.

    Attributes:
        tip: Where its tip is in the part's frame, shape (3,) [mm].
        frame: Directions of the tool's X, Y and Z there, as rows, shape (3, 3); Z leads to the spindle.
        feed: Travel of the tip in the time between two teeth, in the tool's frame, shape (3,) [mm].
        lean: What the axis turns by in that time: how much farther a point goes that is a millimetre higher, in the
            tool's frame, shape (3,).
        sense: 1: it turns clockwise, seen from above; -1: counter-clockwise.
    """

    tip: FloatArray
    frame: FloatArray
    feed: FloatArray
    lean: FloatArray
    sense: float


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


class _Side(NamedTuple):
    """The slices of the side: how many, where the first begins [mm], their height [mm]."""

    slices: int
    begins: float
    height: float


class _Ring(NamedTuple):
    """One ring, by its number, and the share of its length from its lower end at which it is looked at."""

    number: int
    share: float


class _Edge(NamedTuple):
    """A cutter, how it goes on in what, and the slices of its side."""

    dexels: Dexels
    lattice: Lattice
    cutter: CutterForm
    leaning: Leaning
    side: _Side
    standing: Standing


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
    low, high = _heights(lattice, leaning)
    if low >= high or high <= 0.0 or low >= cutter.flute:
        return False
    standing = Standing(leaning.tip, leaning.frame[2], cutter.profile, cutter.side_from)
    side = _slices(lattice, cutter, low, high)
    edge = _Edge(dexels, lattice, cutter, leaning, side, standing)
    rings = len(cutter.radius) + edge.side.slices
    met = False
    for border in range(ANGLE_BINS + 1):
        now = border % 2
        _look_along(edge, border, found.length[now], found.middle[now])
        if border == 0:
            continue
        for number in range(rings):
            if found.length[0, number] > 0.0 or found.length[1, number] > 0.0:
                met |= _cut_ring(edge, law, number, border - 1, found, scratch)
    if met:
        _add_up(cutter, rings, found, scratch)
    return met


@arithmetic_kernel
def _heights(lattice: Lattice, leaning: Leaning) -> tuple[float, float]:
    """Between which heights above the tip the blank's box lies, seen along the axis [mm]."""
    low, high = 0.0, 0.0
    for d in range(3):
        slope = leaning.frame[2, d]
        near = lattice.origin[d] - 0.5 * lattice.cell - leaning.tip[d]
        far = near + lattice.cell * lattice.shape[d]
        low += min(near * slope, far * slope)
        high += max(near * slope, far * slope)
    return low, high


@arithmetic_kernel
def _slices(lattice: Lattice, cutter: CutterForm, low: float, high: float) -> _Side:
    begins, ends = max(low, cutter.side_from), min(high, cutter.flute)
    if begins >= ends:
        return _Side(0, begins, 0.0)
    count = int(min(math.ceil((ends - begins) / (_SLICE_CELLS * lattice.cell)), MOST_SLICES))
    return _Side(count, begins, (ends - begins) / count)


@arithmetic_kernel
def _point(edge: _Edge, ring: _Ring) -> tuple[float, float, float, float]:
    """Distance from the axis and height of a point of the edge [mm], and the normal's parts outwards and downwards."""
    cutter, number = edge.cutter, ring.number
    if number >= len(cutter.radius):
        height = edge.side.begins + (number - len(cutter.radius) + ring.share) * edge.side.height
        return cutter.profile.radius, height, 1.0, 0.0
    off = (ring.share - 0.5) * cutter.width[number]
    out, down = cutter.outwards[number], cutter.downwards[number]
    corner = cutter.profile.corner
    if corner > 0.0 and out > 0.0:
        lead = math.asin(out) + off / corner
        out, down = math.sin(lead), math.cos(lead)
        return cutter.profile.flat + corner * out, corner * (1.0 - down), out, down
    middle = cutter.height[number] + 0.5 * cutter.span[number]
    return cutter.radius[number] + off * down, middle + off * out, out, down


@arithmetic_kernel
def _chip(edge: _Edge, ring: _Ring, place: float) -> float:
    """Thickness of the chip at a place of the edge: its travel along its normal [mm]."""
    _, height, out, down = _point(edge, ring)
    cosine, sine = bin_direction(place)
    x, y, z = _feed_at(edge.leaning, height)
    return out * (x * cosine + y * sine) - down * z


@arithmetic_kernel
def _feed_at(leaning: Leaning, height: float) -> _Place:
    """Travel of a point at a height between two teeth, in the tool's frame [mm]."""
    feed, lean = leaning.feed, leaning.lean
    return feed[0] + height * lean[0], feed[1] + height * lean[1], feed[2] + height * lean[2]


@arithmetic_kernel
def _before(edge: _Edge, ring: _Ring, place: float) -> bool:
    """Whether there is material before a place of the edge, in its direction of travel."""
    radius, height, out, down = _point(edge, ring)
    cosine, sine = bin_direction(place)
    x, y, z = _feed_at(edge.leaning, height)
    speed = math.sqrt(x * x + y * y + z * z)
    chip = out * (x * cosine + y * sine) - down * z
    if chip <= _LEAST:
        return False
    cell, tip, frame = edge.lattice.cell, edge.leaning.tip, edge.leaning.frame
    ahead = min(_CLEAR * cell / chip, _FARTHEST * cell / speed)
    off = (radius * cosine + ahead * x, radius * sine + ahead * y, height + ahead * z)
    x, y, z = _in_part(frame, off)
    normal = _in_part(frame, (-out * cosine, -out * sine, down))
    point = EdgePoint((tip[0] + x, tip[1] + y, tip[2] + z), normal)
    return inside(edge.dexels, edge.lattice, edge.standing, point)


@arithmetic_kernel
def _in_part(frame: FloatArray, vector: _Place) -> _Place:
    """A vector of the tool's frame, seen from the part."""
    x, y, z = vector
    return (
        x * frame[0, 0] + y * frame[1, 0] + z * frame[2, 0],
        x * frame[0, 1] + y * frame[1, 1] + z * frame[2, 1],
        x * frame[0, 2] + y * frame[1, 2] + z * frame[2, 2],
    )


@arithmetic_kernel
def _look_along(edge: _Edge, border: int, length: FloatArray, middle: FloatArray) -> None:
    """What of each ring is in the material in one direction."""
    rings = len(edge.cutter.radius) + edge.side.slices
    for number in range(rings):
        total, moment = 0.0, 0.0
        last = _before(edge, _Ring(number, 0.0), border)
        for half in range(2):
            begin, end = 0.5 * half, 0.5 * half + 0.5
            now = _before(edge, _Ring(number, end), border)
            if now != last:
                place = _border_on_ring(edge, number, border, (begin, end), last)
                begin, end = (begin, place) if last else (place, end)
            if now or last:
                total += end - begin
                moment += 0.5 * (end - begin) * (end + begin)
            last = now
        side = number >= len(edge.cutter.radius)
        whole = edge.side.height if side else edge.cutter.width[number]
        length[number] = total if total > _TOUCH and total * whole > AIR_MM else 0.0
        middle[number] = moment / total if total > 0.0 else 0.5


@arithmetic_kernel
def _border_on_ring(
    edge: _Edge, number: int, place: float, between: tuple[float, float], first: bool
) -> float:
    """Share of a ring at which the material begins or ends."""
    begin, end = between
    for _ in range(_HALVINGS):
        middle = 0.5 * (begin + end)
        if _before(edge, _Ring(number, middle), place) == first:
            begin = middle
        else:
            end = middle
    return 0.5 * (begin + end)


@arithmetic_kernel
def _border_about(edge: _Edge, ring: _Ring, j: int, first: bool) -> float:
    """Where between two directions the material before a ring begins or ends, 0 to 1."""
    begin, end = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (begin + end)
        if _before(edge, ring, j + middle) == first:
            begin = middle
        else:
            end = middle
    return 0.5 * (begin + end)


@arithmetic_kernel
def _cut_ring(
    edge: _Edge,
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
        begin = _border_about(edge, _Ring(number, share), j, first=False)
    elif last <= 0.0:
        length, share = first, middles[0]
        end = _border_about(edge, _Ring(number, share), j, first=True)
    ring, arc = _Ring(number, share), (begin, end)
    place = j + 0.5 * (begin + end)
    x, y, upwards, chip = _push_at(edge, law, ring, place, length)
    if chip <= _LEAST:
        return False
    radius, height, _, _ = _point(edge, ring)
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
def _inwards(edge: _Edge, law: ForceLaw, ring: _Ring) -> float:
    """Level force inwards as a share of the tangential one."""
    _, _, out, down = _point(edge, ring)
    return law.radial * out + law.along * down


@arithmetic_kernel
def _push_at(
    edge: _Edge, law: ForceLaw, ring: _Ring, place: float, length: float
) -> tuple[float, float, float, float]:
    """Force on the tool while a tooth is at a place [N], along X, Y and Z of the tool, and its chip [mm].

    Args:
        ring: Which part of it, looked at in the middle of what is in the material.
        place: Direction about the axis [bins].
        length: How much of the ring is in the material, as a share of it.
    """
    chip = _chip(edge, ring, place)
    if chip <= _LEAST:
        return 0.0, 0.0, 0.0, 0.0
    _, _, out, down = _point(edge, ring)
    width = edge.side.height
    if ring.number < len(edge.cutter.radius):
        width = edge.cutter.width[ring.number]
    force = push(law, 1.0, chip) * width * length
    cosine, sine = bin_direction(place)
    inwards, around = force * _inwards(edge, law, ring), edge.leaning.sense * force
    upwards = force * (law.radial * down - law.along * out)
    return -sine * around - cosine * inwards, cosine * around - sine * inwards, upwards, chip


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
