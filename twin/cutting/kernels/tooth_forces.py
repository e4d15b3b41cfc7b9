"""The force of every tooth at every angle, from the material that is before the cutter.

The edges are looked at in ``ANGLE_BINS`` directions about the axis. In each, the side of the cutter meets
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
from twin.cutting.kernels.teeth import (
    ANGLE_BINS,
    CutterForm,
    ForceLaw,
    ToothScratch,
    bin_direction,
    push,
    sum_teeth,
)
from twin.cutting.kernels.tool_height import profile_height
from twin.cutting.kernels.walls import (
    WalledMap,
    cell_number,
    height_at,
    height_by_wall,
    height_of,
)
from twin.nc.canonical import FloatArray

_ANGLES = (np.arange(ANGLE_BINS) + 0.5) * (2.0 * np.pi / ANGLE_BINS)
_COSINE, _SINE = np.cos(_ANGLES), np.sin(_ANGLES)
_PLACES = 2
"""Places in each direction at which the depth of the side is looked at."""
_BORDER_STEP = 2.0 * np.pi / (ANGLE_BINS * _PLACES)
_BORDER = np.arange(ANGLE_BINS * _PLACES + 1) * _BORDER_STEP
_BORDER_COSINE, _BORDER_SINE = np.cos(_BORDER), np.sin(_BORDER)
_HALVINGS = 6
"""Halvings between two places, in search of where the depth changes."""
_SLICES = 4
"""Slices of an edge that comes into the material, or leaves it."""
_SAME_DEPTH = 1e-6
"""Depths that differ by less are the same [mm]."""
_CLEAR = 0.75
"""How far before the cutter the material is looked at, in cells along the normal: beyond the corner
of a cell whose middle the cutter has passed."""
_AHEAD = 0.1
"""And of that so much, where it is the place of a wall that counts: a round one is not where it is farther on."""
_FARTHEST = 4.0
"""And at most, in cells along the feed."""
_LEAST = 1e-9
"""Lengths below this are the arithmetic's doing [mm]."""


class Advance(NamedTuple):
    """How a cutter goes on.

    Attributes:
        tip: Where its tip is, shape (3,) [mm].
        direction: Unit vector of its travel.
        per_tooth: How far it goes in the time between two teeth [mm].
        sense: 1: it turns clockwise, seen from above; -1: counter-clockwise.
    """

    tip: FloatArray
    direction: tuple[float, float, float]
    per_tooth: float
    sense: float


@kernel
def tooth_forces(
    material: WalledMap,
    tip: FloatArray,
    feed: FloatArray,
    cutter: CutterForm,
    law: ForceLaw,
    sense: float,
    scratch: ToothScratch,
) -> bool:
    """Forces of a cutter that goes on as it does.

    Args:
        tip: Tool tip, shape (3,) [mm].
        feed: Travel of the tip in the time between two teeth, shape (3,) [mm].
        sense: 1: it turns clockwise, seen from above; -1: counter-clockwise.
        scratch: Set to what was found.

    Returns:
        Whether the cutter meets any material.
    """
    per_tooth = math.sqrt(feed[0] * feed[0] + feed[1] * feed[1] + feed[2] * feed[2])
    scratch.mean[:] = 0.0
    scratch.figures[:] = 0.0
    if per_tooth < _LEAST:
        return False
    direction = (feed[0] / per_tooth, feed[1] / per_tooth, feed[2] / per_tooth)
    advance = Advance(tip, direction, per_tooth, sense)
    met = _meet_side(material, advance, cutter, law, scratch)
    for j in range(ANGLE_BINS):
        for k in range(3):
            scratch.tooth[j, k] = 0.0
        met |= _meet_end(material, advance, cutter, law, j, scratch)
    if met:
        _add_up(cutter, sense, scratch)
    return met


@kernel
def _meet_side(
    material: WalledMap, advance: Advance, cutter: CutterForm, law: ForceLaw, scratch: ToothScratch
) -> bool:
    """Depth and force of the side in all directions."""
    scratch.depth[:] = 0.0
    direction = advance.direction
    if math.hypot(direction[0], direction[1]) <= _LEAST:
        return False
    met, edge, begun, deepest = False, 0.0, 0.0, 0.0
    ahead = math.floor(math.atan2(direction[1], direction[0]) / (2.0 * math.pi) * ANGLE_BINS)
    last = 0.0
    # Behind the cutter there is nothing to meet.
    for turned in range(ahead - ANGLE_BINS // 4 - 1, ahead + ANGLE_BINS // 4 + 2):
        j = turned % ANGLE_BINS
        area, moment, share, begins, ends = 0.0, 0.0, 0.0, 1.0, 0.0
        for part in range(_PLACES):
            border = j * _PLACES + part + 1
            first = last
            last = _side_depth(
                material, advance, cutter, _BORDER_COSINE[border], _BORDER_SINE[border]
            )
            if first <= 0.0 and last <= 0.0:
                continue
            begin, end = part / _PLACES, (part + 1) / _PLACES
            middle = end
            if abs(last - first) > _SAME_DEPTH:
                middle = _step_between(material, advance, cutter, (j, begin, end), (first, last))
            for low, high, depth in ((begin, middle, first), (middle, end, last)):
                if depth > 0.0 and high > low:
                    begins, ends = min(begins, low), max(ends, high)
                    share += high - low
                    area += depth * (high - low)
                    moment += 0.5 * depth * (high - low) * (high + low)
            if first <= 0.0:
                begun, deepest = turned + middle, 0.0
            deepest = max(deepest, first, last)
            if last <= 0.0:
                edge = max(
                    edge, _edge_force(advance, cutter, law, (begun, turned + middle), deepest)
                )
        if share > 0.0:
            engaged = _Engaged(j, share, area / share, moment / area, begins, ends)
            met |= _enter_side(advance, cutter, law, engaged, scratch)
    scratch.figures[0] = edge
    return met


@kernel
def _edge_force(
    advance: Advance,
    cutter: CutterForm,
    law: ForceLaw,
    arc: tuple[float, float],
    depth: float,
) -> float:
    """Greatest level force where a tooth comes into an arc of material, or leaves it [N].

    Told for arcs that only one tooth meets at a time; else 0: more of them sum up.

    Args:
        arc: Where the material begins and ends [bins].
        depth: How deep the side is in it [mm].
    """
    begin, end = arc
    lag = depth / cutter.rise
    if end - begin + lag >= ANGLE_BINS / cutter.teeth:
        return 0.0
    within = min(lag, end - begin)
    height = depth * (within / lag if within < lag else 1.0) / _SLICES
    greatest, sense = 0.0, advance.sense
    for first in (begin, end - within):
        x, y = 0.0, 0.0
        for number in range(_SLICES):
            cosine, sine = bin_direction(first + within * (number + 0.5) / _SLICES)
            chip = advance.direction[0] * cosine + advance.direction[1] * sine
            force = height * push(law, advance.per_tooth, max(chip, 0.0))
            x += force * (-sense * sine - law.radial * cosine)
            y += force * (sense * cosine - law.radial * sine)
        greatest = max(greatest, math.hypot(x, y))
    return greatest


class _Engaged(NamedTuple):
    """Where the side meets material in one direction.

    Attributes:
        share: Of the bin in which it does.
        depth: How deep it is there, in the mean [mm].
        middle: Place within the bin, 0 to 1: in the mean of the material.
    """

    bin: int
    share: float
    depth: float
    middle: float
    begin: float
    end: float


@kernel
def _enter_side(
    advance: Advance, cutter: CutterForm, law: ForceLaw, engaged: _Engaged, scratch: ToothScratch
) -> bool:
    """Force of the side in one direction."""
    j, sense = engaged.bin, advance.sense
    cosine, sine = _COSINE[j], _SINE[j]
    ends = (_BORDER_COSINE[j * _PLACES], _BORDER_SINE[j * _PLACES])
    other = (_BORDER_COSINE[(j + 1) * _PLACES], _BORDER_SINE[(j + 1) * _PLACES])
    if engaged.share < 1.0:
        cosine, sine = bin_direction(j + engaged.middle)
        ends, other = bin_direction(j + engaged.begin), bin_direction(j + engaged.end)
    chip = advance.direction[0] * cosine + advance.direction[1] * sine
    if chip <= _LEAST:
        return False
    thickest = max(
        advance.direction[0] * ends[0] + advance.direction[1] * ends[1],
        advance.direction[0] * other[0] + advance.direction[1] * other[1],
        chip,
    )
    force = push(law, advance.per_tooth, chip) * engaged.share
    scratch.depth[j] = engaged.depth
    scratch.side[j, 0] = force * (-sense * sine - law.radial * cosine)
    scratch.side[j, 1] = force * (sense * cosine - law.radial * sine)
    scratch.side[j, 2] = -force * law.along
    scratch.figures[1] += force * scratch.depth[j] * cutter.profile.radius
    scratch.figures[2] = max(scratch.figures[2], advance.per_tooth * thickest)
    return True


@kernel
def _step_between(
    material: WalledMap,
    advance: Advance,
    cutter: CutterForm,
    place: tuple[int, float, float],
    depths: tuple[float, float],
) -> float:
    """Where the depth of the side changes from one value to another, within a bin."""
    j, begin, end = place
    for _ in range(_HALVINGS):
        middle = 0.5 * (begin + end)
        cosine, sine = bin_direction(j + middle)
        depth = _side_depth(material, advance, cutter, cosine, sine)
        if abs(depth - depths[0]) < abs(depth - depths[1]):
            begin = middle
        else:
            end = middle
    return 0.5 * (begin + end)


@kernel
def _side_depth(
    material: WalledMap, advance: Advance, cutter: CutterForm, cosine: float, sine: float
) -> float:
    """How deep the side is in the material in a direction [mm]."""
    tip, direction, radius = advance.tip, advance.direction, cutter.profile.radius
    clear = _CLEAR * material.grid.cell
    level = math.hypot(direction[0], direction[1])
    if direction[0] * cosine + direction[1] * sine <= 0.0:
        return 0.0
    x, y = tip[0] + radius * cosine, tip[1] + radius * sine
    # The walls beside the cutter are its own: they are looked at where it has not come to yet.
    x_before, y_before = x + clear * direction[0] / level, y + clear * direction[1] / level
    lowest = max(tip[2] + cutter.side_from, material.grid.bottom)
    place = x + _AHEAD * (x_before - x), y + _AHEAD * (y_before - y)
    height = height_by_wall(material, x_before, y_before, place, lowest)
    if math.isnan(height):
        height = height_at(material, x + clear * cosine, y + clear * sine)
    return max(0.0, min(height - tip[2], cutter.flute) - cutter.side_from)


@kernel
def _meet_end(
    material: WalledMap,
    advance: Advance,
    cutter: CutterForm,
    law: ForceLaw,
    j: int,
    scratch: ToothScratch,
) -> bool:
    """Force of the rings of the lower end in one direction."""
    met, direction, sense = False, advance.direction, advance.sense
    cosine, sine = _COSINE[j], _SINE[j]
    outwards = direction[0] * cosine + direction[1] * sine
    for i in range(len(cutter.radius)):
        chip = outwards * cutter.outwards[i] - direction[2] * cutter.downwards[i]
        if chip <= _LEAST:
            continue
        share = _ring_share(material, advance, cutter, i, j, chip)
        if share <= 0.0:
            continue
        met = True
        thickness = advance.per_tooth * chip
        force = push(law, advance.per_tooth, chip) * share * cutter.width[i]
        inwards = force * (law.radial * cutter.outwards[i] + law.along * cutter.downwards[i])
        upwards = force * (law.radial * cutter.downwards[i] - law.along * cutter.outwards[i])
        scratch.tooth[j, 0] += -sense * sine * force - cosine * inwards
        scratch.tooth[j, 1] += sense * cosine * force - sine * inwards
        scratch.tooth[j, 2] += upwards
        scratch.figures[1] += force * cutter.radius[i]
        scratch.figures[2] = max(scratch.figures[2], thickness)
    return met


@kernel
def _ring_share(
    material: WalledMap,
    advance: Advance,
    cutter: CutterForm,
    i: int,
    j: int,
    chip: float,
) -> float:
    """How much of a ring is in the material in one direction, 0 to 1."""
    tip, direction, grid = advance.tip, advance.direction, material.grid
    clear = grid.cell * min(_CLEAR / chip, _FARTHEST)
    row = cell_number(
        tip[1] + cutter.radius[i] * _SINE[j] + clear * direction[1], grid.origin[1], grid.cell
    )
    column = cell_number(
        tip[0] + cutter.radius[i] * _COSINE[j] + clear * direction[0], grid.origin[0], grid.cell
    )
    top = height_of(material, row, column) - tip[2]
    low, span = cutter.height[i], cutter.span[i]
    if top <= low + min(0.0, clear * direction[2]):
        return 0.0
    x = grid.origin[0] + column * grid.cell - tip[0]
    y = grid.origin[1] + row * grid.cell - tip[1]
    radius, flat, corner, slope = cutter.profile
    level = math.hypot(direction[0], direction[1])
    if level > abs(direction[2]):
        # A wall that the cutter has left, or will pass at the height that it has, is not cut.
        aside, ahead = (
            abs(x * direction[1] - y * direction[0]) / level,
            (x * direction[0] + y * direction[1]) / level,
        )
        lowest = profile_height(aside, radius, flat, corner, slope)
        if top <= lowest + min(0.0, direction[2]) / level * max(0.0, ahead) + _LEAST:
            return 0.0
    if abs(top - profile_height(math.hypot(x, y), radius, flat, corner, slope)) <= _LEAST:
        # The cutter stands on what it has cut itself, and goes on into it.
        return 1.0
    if top <= low:
        return 0.0
    return 1.0 if top >= low + span else (top - low) / span


@kernel
def _add_up(cutter: CutterForm, sense: float, scratch: ToothScratch) -> None:
    """Force of a tooth by the direction of its tip, their sums, and the mean and greatest of a turn."""
    share = cutter.teeth / ANGLE_BINS
    for j in range(ANGLE_BINS):
        for k in range(3):
            scratch.mean[k] += share * (scratch.tooth[j, k] + scratch.side[j, k] * scratch.depth[j])
    scratch.figures[1] *= share
    behind = 1 if sense > 0.0 else ANGLE_BINS - 1
    for j in range(ANGLE_BINS):
        if scratch.depth[j] <= 0.0:
            continue
        below, to = 0.0, j
        while below < scratch.depth[j]:
            part = min(cutter.rise, scratch.depth[j] - below)
            for k in range(3):
                scratch.tooth[to, k] += part * scratch.side[j, k]
            below += part
            # Higher up the edge is in this direction when its tip has gone on.
            to = (to + ANGLE_BINS - behind) % ANGLE_BINS
    sum_teeth(cutter, scratch)
