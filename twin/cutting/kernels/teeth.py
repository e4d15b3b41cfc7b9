"""The teeth of a cutter: what a material does to their edges, and what all of them add up to in a turn.

A tooth that cuts a chip of thickness h is pushed by Kienzle's force kc1.1 h^(1 - mc) a millimetre of edge
against its motion, by ``radial`` of that inwards along the normal, and by ``along`` of it along the edge
towards the tip. Which of its edges are in the material, in which of ``ANGLE_BINS`` directions about the axis, is found
by ``tooth_forces`` in a height map and by ``twin.cutting.tridexel.edge_forces`` in a part that is cut from any side.
"""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import kernel
from twin.cutting.kernels.tool_height import Profile
from twin.nc.canonical import FloatArray

THINNEST_CHIP_MM = 1e-3
"""Chips thinner than this are rubbed, not cut; the formula is not followed below [mm]."""
ANGLE_BINS = 72
"""Directions about the axis that are looked at: 5 degrees each."""


class CutterForm(NamedTuple):
    """A cutter as forces see it.

    Attributes:
        side_from: Height above the tip at which its side begins [mm].
        flute: Height above the tip at which its edges end [mm].
        rise: Height over which a helical edge falls back by one bin [mm]; infinite: it is straight.
        radius: Of each ring of the lower end, shape (m,) [mm]; so on.
        height: Above the tip of its lower edge [mm].
        span: How much higher its upper edge is [mm].
        width: Length of edge [mm].
        outwards: Share of the normal that points outwards.
        downwards: Share of it that points down.
    """

    profile: Profile
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


class ToothScratch(NamedTuple):
    """What ``tooth_forces`` leaves: of one tooth in each direction, and of all in the mean.

    Attributes:
        side: Force a millimetre of side, shape (ANGLE_BINS, 3) [N/mm].
        depth: How deep the side is in the material, shape (ANGLE_BINS,) [mm].
        tooth: Force on the tool when a tooth's tip is in that direction, shape (ANGLE_BINS, 3) [N].
        summed: ``tooth`` added up from the first direction on, shape (ANGLE_BINS + 1, 3).
        mean: Force on the tool in the mean of a turn, shape (3,) [N].
        figures: Greatest level force of a turn [N], torque in the mean [N mm], thickest chip [mm].
    """

    side: FloatArray
    depth: FloatArray
    tooth: FloatArray
    summed: FloatArray
    mean: FloatArray
    figures: FloatArray


def tooth_bench() -> ToothScratch:
    """Nothing is known yet."""
    shapes = ((ANGLE_BINS, 3), (ANGLE_BINS,), (ANGLE_BINS, 3), (ANGLE_BINS + 1, 3), (3,), (3,))
    return ToothScratch(*(np.zeros(shape) for shape in shapes))


@kernel
def push(law: ForceLaw, per_tooth: float, chip: float) -> float:
    """Tangential force a millimetre of edge, of a chip that is a share of the feed [N/mm]."""
    thickness = per_tooth * chip
    return law.kc * max(thickness, THINNEST_CHIP_MM) ** -law.mc * thickness


@kernel
def bin_direction(place: float) -> tuple[float, float]:
    """Cosine and sine of a place around the axis [bins]."""
    at = 2.0 * math.pi / ANGLE_BINS * place
    return math.cos(at), math.sin(at)


@kernel
def sum_teeth(cutter: CutterForm, scratch: ToothScratch) -> None:
    """Add up the force of a tooth from direction to direction; the greatest of all teeth in a turn."""
    for k in range(3):
        scratch.summed[0, k] = 0.0
        for j in range(ANGLE_BINS):
            scratch.summed[j + 1, k] = scratch.summed[j, k] + scratch.tooth[j, k]
    for j in range(math.ceil(ANGLE_BINS / cutter.teeth)):
        x, y = 0.0, 0.0
        for tooth in range(cutter.teeth):
            at = (j + tooth * ANGLE_BINS // cutter.teeth) % ANGLE_BINS
            x += scratch.tooth[at, 0]
            y += scratch.tooth[at, 1]
        scratch.figures[0] = max(scratch.figures[0], math.hypot(x, y))


@kernel
def add_force_between(
    cutter: CutterForm, scratch: ToothScratch, angle: float, turned: float, force: FloatArray
) -> None:
    """Force on the tool in the mean while it turns.

    Args:
        scratch: What ``tooth_forces`` found.
        angle: Direction of the first tooth's tip at the beginning [turns, counter-clockwise].
        turned: How far it turns, signed [turns]; at least a thousandth of a bin is counted.
        force: The force is added to it, shape (3,) [N].
    """
    width = max(abs(turned) * ANGLE_BINS, 1e-3)
    first = angle * ANGLE_BINS - (width if turned < 0.0 else 0.0)
    for tooth in range(cutter.teeth):
        low = first + tooth * ANGLE_BINS / cutter.teeth
        low -= ANGLE_BINS * math.floor(low / ANGLE_BINS)
        for k in range(3):
            force[k] += (_sum_up_to(scratch, low + width, k) - _sum_up_to(scratch, low, k)) / width


@kernel
def _sum_up_to(scratch: ToothScratch, place: float, k: int) -> float:
    """Sum of a tooth's force over the directions up to a place from 0 on, in bins."""
    turns = math.floor(place / ANGLE_BINS)
    rest = place - turns * ANGLE_BINS
    whole = min(int(rest), ANGLE_BINS - 1)
    part = (rest - whole) * scratch.tooth[whole, k]
    return turns * scratch.summed[ANGLE_BINS, k] + scratch.summed[whole, k] + part
