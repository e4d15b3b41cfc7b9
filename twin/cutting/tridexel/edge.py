"""The edge of a cutter that leans as it likes in a tri-dexel stock, and which of it has material before it.

The edge is looked at in rings: those of its lower end, and slices of its side as far up as the part reaches.
"""

import math
from typing import NamedTuple

from twin.compilation.kernel import arithmetic_kernel
from twin.cutting.kernels.teeth import CutterForm, bin_direction
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
LEAST_CHIP = 1e-9
"""Chips below this are the arithmetic's doing [mm]."""

_Place = tuple[float, float, float]


class Leaning(NamedTuple):
    """A cutter in a part, and how it goes on.

    Attributes:
        tip: Where its tip is in the part's frame, shape (3,) [mm].
        frame: Directions of the tool's X, Y and Z there, as rows, shape (3, 3); Z leads to the spindle.
        feed: Displacement of the tip in the time between two teeth, in the tool's frame, shape (3,) [mm].
        lean: What the axis turns by in that time: how much farther a point goes that is a millimetre higher, in the
            tool's frame, shape (3,).
        sense: 1: it turns clockwise, seen from above; -1: counter-clockwise.
    """

    tip: FloatArray
    frame: FloatArray
    feed: FloatArray
    lean: FloatArray
    sense: float


class SideSlices(NamedTuple):
    """The slices of the side: how many, where the first begins [mm], their height [mm]."""

    slices: int
    begins: float
    height: float


class RingPlace(NamedTuple):
    """A point of the edge.

    Attributes:
        radius: Its distance from the axis [mm].
        height: Above the tip [mm].
        out: What of its normal leads outwards.
        down: What of it leads down.
    """

    radius: float
    height: float
    out: float
    down: float


class Ring(NamedTuple):
    """One ring, by its number, and the share of its length from its lower end at which it is looked at."""

    number: int
    share: float


class Edge(NamedTuple):
    """A cutter, how it goes on in what, and the slices of its side."""

    dexels: Dexels
    lattice: Lattice
    cutter: CutterForm
    leaning: Leaning
    side: SideSlices
    standing: Standing


@arithmetic_kernel
def heights_of_part(lattice: Lattice, leaning: Leaning) -> tuple[float, float]:
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
def slices_of_side(lattice: Lattice, cutter: CutterForm, low: float, high: float) -> SideSlices:
    """The slices of a side of which the part reaches between two heights above the tip [mm]."""
    begins, ends = max(low, cutter.side_from), min(high, cutter.flute)
    if begins >= ends:
        return SideSlices(0, begins, 0.0)
    count = int(min(math.ceil((ends - begins) / (_SLICE_CELLS * lattice.cell)), MOST_SLICES))
    return SideSlices(count, begins, (ends - begins) / count)


@arithmetic_kernel
def ring_place(edge: Edge, ring: Ring) -> RingPlace:
    """Where a point of the edge is."""
    cutter, number = edge.cutter, ring.number
    if number >= len(cutter.radius):
        height = edge.side.begins + (number - len(cutter.radius) + ring.share) * edge.side.height
        return RingPlace(cutter.profile.radius, height, 1.0, 0.0)
    off = (ring.share - 0.5) * cutter.width[number]
    out, down = cutter.outwards[number], cutter.downwards[number]
    corner = cutter.profile.corner
    if corner > 0.0 and out > 0.0:
        lead = math.asin(out) + off / corner
        out, down = math.sin(lead), math.cos(lead)
        radius, height = cutter.profile.flat + corner * out, corner * (1.0 - down)
        return RingPlace(radius, height, out, down)
    middle = cutter.height[number] + 0.5 * cutter.span[number]
    return RingPlace(cutter.radius[number] + off * down, middle + off * out, out, down)


@arithmetic_kernel
def chip_at(edge: Edge, ring: Ring, place: float) -> float:
    """Thickness of the chip at a place of the edge: its displacement along its normal [mm]."""
    _, height, out, down = ring_place(edge, ring)
    cosine, sine = bin_direction(place)
    x, y, z = _displacement(edge.leaning, height)
    return out * (x * cosine + y * sine) - down * z


@arithmetic_kernel
def _displacement(leaning: Leaning, height: float) -> _Place:
    """Displacement of a point at a height between two teeth, in the tool's frame [mm]."""
    feed, lean = leaning.feed, leaning.lean
    return feed[0] + height * lean[0], feed[1] + height * lean[1], feed[2] + height * lean[2]


@arithmetic_kernel
def _before(edge: Edge, ring: Ring, place: float) -> bool:
    """Whether there is material before a place of the edge, on its path."""
    radius, height, out, down = ring_place(edge, ring)
    cosine, sine = bin_direction(place)
    x, y, z = _displacement(edge.leaning, height)
    pace = math.sqrt(x * x + y * y + z * z)
    chip = out * (x * cosine + y * sine) - down * z
    if chip <= LEAST_CHIP:
        return False
    cell, tip, frame = edge.lattice.cell, edge.leaning.tip, edge.leaning.frame
    ahead = min(_CLEAR * cell / chip, _FARTHEST * cell / pace)
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
def look_along(edge: Edge, border: int, length: FloatArray, middle: FloatArray) -> None:
    """What of each ring is in the material in one direction."""
    rings = len(edge.cutter.radius) + edge.side.slices
    for number in range(rings):
        total, moment = 0.0, 0.0
        last = _before(edge, Ring(number, 0.0), border)
        for half in range(2):
            begin, end = 0.5 * half, 0.5 * half + 0.5
            now = _before(edge, Ring(number, end), border)
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
    edge: Edge, number: int, place: float, between: tuple[float, float], first: bool
) -> float:
    """Share of a ring at which the material begins or ends."""
    begin, end = between
    for _ in range(_HALVINGS):
        middle = 0.5 * (begin + end)
        if _before(edge, Ring(number, middle), place) == first:
            begin = middle
        else:
            end = middle
    return 0.5 * (begin + end)


@arithmetic_kernel
def border_about(edge: Edge, ring: Ring, j: int, first: bool) -> float:
    """Where between two directions the material before a ring begins or ends, 0 to 1."""
    begin, end = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (begin + end)
        if _before(edge, ring, j + middle) == first:
            begin = middle
        else:
            end = middle
    return 0.5 * (begin + end)
