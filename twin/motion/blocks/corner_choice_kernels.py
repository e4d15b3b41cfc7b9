"""Which continuous corners are passed faster by a stop than by a rounding.

A rounding must be driven slowly where it is narrow. At a stop the next move may begin before the
one before it has ended: both are then at most a tolerance away from the corner, so that the sum of
the two is within it too. Of a chain of corners that leave a choice that way is taken which is the
fastest as a whole. What is chosen at a corner must not depend on how far the program is known: at
every ``ANCHOR``-th move the choice is made for itself, from the corners nearby, and the chains
between are chosen to fit.
"""

import enum
import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import array_arithmetic_kernel
from twin.motion.blocks.blocks import BoolArray
from twin.motion.blocks.corner_kernels import BESIDE_STOP, MAX_NEIGHBOURS, NARROWEST
from twin.motion.limits import MachineLimits
from twin.motion.ramp_kernels import RampLimits, travel_time
from twin.nc.canonical import FloatArray, IntArray
from twin.toolpath.geometry_kernels import Curves, bend_of, is_curve

CURVE_SHARE = 0.5
"""Of the limits of an axis that a rounding may use at constant velocity."""

CERTAINTY = 0.15
"""Share of the time through a rounding by which it must be faster than the stop: the limits along
its parts are a little stricter than those of the whole. Beside an arc they change the more, the more
the limits of its axes differ: there it is taken as often as the one jerk goes into the other."""


class BlockMotion(NamedTuple):
    """n blocks and what the program asks of them.

    Attributes:
        move: Number of the move in the whole program, shape (n,).
        length: In path parameter x, 0 for dwells, shape (n,).
        velocity: Highest v that is asked for, shape (n,).
        acceleration: Highest a, shape (n,).
        deceleration: Highest -a, shape (n,).
        parameter_scale: Path parameter per what the feed counts, shape (n,).
        rotary_alone: Whether only rotary axes move, shape (n,).
    """

    move: IntArray
    curves: Curves
    length: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    deceleration: FloatArray
    parameter_scale: FloatArray
    rotary_alone: BoolArray


class Corners(NamedTuple):
    """The borders before each of n blocks.

    Attributes:
        tangent_step: Step of dq/dx, shape (n, k).
        curvature_step: Step of d²q/dx², shape (n, k).
        rounded: Whether the path goes on without a stop, shape (n,).
        width: Of the rounding, shape (n,); 0: there is no room for one.
        tolerance: Of X Y Z, shape (n,) [mm].
        further_tolerance: Of the other axes [mm or deg].
    """

    tangent_step: FloatArray
    curvature_step: FloatArray
    rounded: BoolArray
    width: FloatArray
    tolerance: FloatArray
    further_tolerance: float


LEAST_TURN = 1.5 * math.pi
"""What a run of arcs turns by at least to get a time law of its own (``twin.motion.retiming``) [rad]."""

RUN_SHARE = 0.8
"""Share of the time under an arc's bounds that such a run takes from stop to stop. Shorter ones take less
too; where that makes the stop faster, the plan tells (``twin.motion.corner_candidates``)."""


class Passage(enum.IntEnum):
    """How a border is passed."""

    FREE = -1
    """To be chosen."""
    PASSED = 0
    """Without a stop."""
    STOPPED = 1
    """At rest."""


_CHOICES = Passage.PASSED.value, Passage.STOPPED.value
"""What a border that is free may become, as columns of arrays."""

ANCHOR = 16
"""Moves between two corners whose choice is made for itself."""

SEEN = 8
"""Borders to either side that such a choice looks at."""


class Ways(NamedTuple):
    """How the borders before n blocks can be passed.

    Attributes:
        way: A ``Passage``, shape (n,).
        velocity: Without a stop, shape (n,).
        away: How far from a stop the moves may overlap, shape (n,).
        gain: How long they then do [s], shape (n,).
        ramps: What each block allows, where a border beside it is free; shape (n, 4).
        unevenness: How often the smallest jerk limit of an arc's axes goes into the largest; 1 for
            lines; shape (n,).
    """

    way: IntArray
    velocity: FloatArray
    away: FloatArray
    gain: FloatArray
    ramps: FloatArray
    unevenness: FloatArray


@array_arithmetic_kernel
def choose_stops(
    blocks: BlockMotion, corners: Corners, machine: MachineLimits
) -> tuple[BoolArray, FloatArray]:
    """Choose the corners at which the path had better stop.

    Args:
        corners: The borders before them.

    Returns:
        Whether to stop, shape (n,); how far from there the moves may overlap, shape (n,).
    """
    count = len(blocks.length)
    ways = _find_ways(blocks, corners, machine)
    chosen, scratch = ways.way.copy(), ways.way.copy()
    back = np.zeros((count, 2), np.int64)
    for i in range(count):
        if ways.way[i] == Passage.FREE and blocks.move[i] % ANCHOR == 0:
            first, last = max(0, i - SEEN), min(count - 1, i + SEEN)
            scratch[first : last + 1] = ways.way[first : last + 1]
            _choose_between(blocks, corners, ways, first, last, scratch, back)
            chosen[i] = scratch[i]
    first = 0
    for i in range(1, count):
        if chosen[i] != Passage.FREE or i == count - 1:
            if i > first + 1 or chosen[i] == Passage.FREE:
                _choose_between(blocks, corners, ways, first, i, chosen, back)
            first = i
    stops = np.zeros(count, np.bool_)
    for i in range(1, count):
        stops[i] = corners.rounded[i] and chosen[i] == Passage.STOPPED
        if not stops[i]:
            ways.away[i] = 0.0
    return stops, ways.away


@array_arithmetic_kernel
def _find_ways(blocks: BlockMotion, corners: Corners, machine: MachineLimits) -> Ways:
    """The ways through each border, and what is needed to choose among them."""
    count = len(blocks.length)
    ways = Ways(
        np.full(count, Passage.PASSED.value), np.full(count, math.inf), np.zeros(count), np.zeros(count),
        np.zeros((count, 4)), np.ones(count),
    )  # fmt: skip
    known, after = -1, RampLimits(0.0, 0.0, 0.0, 0.0)
    for i in range(count):
        if i == 0 or not corners.rounded[i]:
            ways.way[i] = Passage.STOPPED.value
            continue
        if blocks.length[i] == 0.0 or blocks.length[i - 1] == 0.0:
            continue
        if not np.any(corners.tangent_step[i]) and not np.any(corners.curvature_step[i]):
            continue
        if corners.width[i] > 0.0:
            ways.velocity[i] = _rounding_velocity(corners, i, machine)
            if ways.velocity[i] >= min(blocks.velocity[i - 1], blocks.velocity[i]):
                continue
        before = after if known == i - 1 else _block_limits(blocks, i - 1, machine)
        known, after = i, _block_limits(blocks, i, machine)
        for block, limits in ((i - 1, before), (i, after)):
            ways.ramps[block, :] = limits
            ways.unevenness[block] = _unevenness(blocks, block, machine)
        ways.away[i] = _overlap_distance(blocks, corners, i, before, after, machine)
        lengths = blocks.length[i - 1], blocks.length[i]
        ways.gain[i] = _overlap_time(ways.away[i], lengths[0], lengths[1], before, after)
        if corners.width[i] == 0.0:
            ways.way[i] = Passage.STOPPED.value
        elif ways.velocity[i] < min(before.velocity, after.velocity):
            ways.way[i] = Passage.FREE.value
    return ways


@array_arithmetic_kernel
def _choose_between(
    blocks: BlockMotion, corners: Corners, ways: Ways, first: int, last: int,
    chosen: IntArray, back: IntArray,
) -> None:  # fmt: skip
    """Choose the fastest way through consecutive borders, in place.

    Args:
        corners: The borders before them.
        chosen: How each is passed, where it is known; the others are written.
        back: Scratch, shape (n, 2).
    """
    passed = 0.0 if chosen[first] != Passage.STOPPED else math.inf
    stopped = -ways.gain[first] if chosen[first] != Passage.PASSED else math.inf
    for i in range(first + 1, last + 1):
        best = math.inf, math.inf
        for way in _CHOICES:
            if chosen[i] == 1 - way:
                continue
            least = math.inf
            for before in _CHOICES:
                time = passed if before == Passage.PASSED else stopped
                if time < math.inf:
                    time += _time_of_block(blocks, corners, ways, i - 1, before, way)
                    if time < least:
                        least, back[i, way] = time, before
            best = (least, best[1]) if way == Passage.PASSED else (best[0], least - ways.gain[i])
        passed, stopped = best
    if last + 1 == len(chosen):
        passed += _time_of_block(blocks, corners, ways, last, Passage.PASSED, Passage.STOPPED)
        stopped += _time_of_block(blocks, corners, ways, last, Passage.STOPPED, Passage.STOPPED)
    chosen[last] = Passage.STOPPED.value if stopped < passed else Passage.PASSED.value
    for i in range(last, first, -1):
        chosen[i - 1] = back[i, chosen[i]]


@array_arithmetic_kernel
def _time_of_block(
    blocks: BlockMotion, corners: Corners, ways: Ways, i: int, before: int, after: int
) -> float:
    """About how long a block takes that is entered and left in certain ways [s].

    Where no border beside it is free, it does not matter: 0.
    """
    limits = RampLimits(ways.ramps[i, 0], ways.ramps[i, 1], ways.ramps[i, 2], ways.ramps[i, 3])
    if limits.velocity == 0.0:
        return 0.0
    length = blocks.length[i]
    slower = 1.0 + CERTAINTY * ways.unevenness[i]
    u, width = _end_of_block(corners, ways, i, before, after, length)
    v, next_width = _end_of_block(corners, ways, i + 1, after, before, length)
    u, v = min(u, limits.velocity), min(v, limits.velocity)
    rounded = width + next_width
    if rounded > length:
        # Roundings that reach over several blocks count where they are.
        width, next_width, rounded = width * length / rounded, next_width * length / rounded, length
    time = slower * (width / u if width > 0.0 else 0.0)
    time += slower * (next_width / v if next_width > 0.0 else 0.0)
    turns = abs(blocks.curves.angle[i]) >= LEAST_TURN and limits.velocity < blocks.velocity[i]
    if turns and before == Passage.STOPPED and after == Passage.STOPPED:
        return RUN_SHARE * travel_time(length, 0.0, 0.0, limits)
    room = length - rounded
    ramps = travel_time(room, u, v, limits)
    if ramps == math.inf:
        # Too short for the change: the slower end counts for both.
        low = min(u, v)
        ramps = travel_time(room, low, low, limits)
    return time + ramps


@array_arithmetic_kernel
def _end_of_block(
    corners: Corners, ways: Ways, border: int, way: int, other: int, length: float
) -> tuple[float, float]:
    """Velocity at an end of a block, and how far its rounding reaches.

    Args:
        border: At this end.
        other: How that at the other end is passed.
    """
    if way == Passage.STOPPED:
        return 0.0, 0.0
    speed, width = ways.velocity[border], corners.width[border]
    if other == Passage.STOPPED and width > BESIDE_STOP * length:
        # A rounding beside a stop is made narrower, and is driven more slowly.
        narrower = BESIDE_STOP * length / width
        width, speed = narrower * width, speed * np.cbrt(narrower * narrower)
    return speed, width


@array_arithmetic_kernel
def clip_widths(place: FloatArray, stops: BoolArray, width: FloatArray) -> None:
    """Narrow roundings beside stops, in place; a narrower rounding is also a flatter one.

    Args:
        place: Where each block begins and, last, where the last one ends, shape (n + 1,).
        stops: Whether the path stops after all, shape (n,).
        width: Of the roundings, shape (n,).
    """
    count = len(stops)
    for i in range(count):
        if not stops[i]:
            continue
        width[i] = 0.0
        for sense in (-1, 1):
            other = i + sense
            while 0 <= other < count and abs(other - i) <= MAX_NEIGHBOURS and not stops[other]:
                room = BESIDE_STOP * abs(place[other] - place[i])
                if width[other] > room:
                    width[other] = room if room >= NARROWEST else 0.0
                other += sense


@array_arithmetic_kernel
def _block_limits(blocks: BlockMotion, i: int, machine: MachineLimits) -> RampLimits:
    """What a block allows along the path; of an arc, what its curvature leaves at any place."""
    scale, rotary = blocks.parameter_scale[i], blocks.rotary_alone[i]
    acceleration = scale * (machine.path[2] if rotary else machine.path[0])
    jerk = scale * (machine.path[3] if rotary else machine.path[1])
    velocity = blocks.velocity[i]
    per_length = 1.0 / blocks.length[i]
    turn = abs(blocks.curves.angle[i]) * per_length
    curve, bends = is_curve(blocks.curves.bend, i), blocks.curves.bend
    for axis in range(len(machine.jerk)):
        slope = abs(blocks.curves.drift[i, axis]) * per_length
        if curve:
            end = blocks.curves.drift[i, axis] + bend_of(bends, i, axis, 1.0, 1)
            slope = max(slope, abs(end) * per_length)
            bend = abs(bend_of(bends, i, axis, 0.0, 2))
            bend = max(bend, abs(bend_of(bends, i, axis, 1.0, 2)))
            if bend > 0.0:
                bend *= per_length * per_length
                velocity = min(velocity, math.sqrt(machine.acceleration[axis] / bend))
        if turn > 0.0 and axis < 3:
            radius = math.hypot(blocks.curves.cosine[i, axis], blocks.curves.sine[i, axis])
            slope += turn * radius
            bend = turn * turn * radius
            if bend > 0.0:
                velocity = min(velocity, math.sqrt(machine.acceleration[axis] / bend))
                velocity = min(velocity, np.cbrt(CURVE_SHARE * machine.jerk[axis] / (turn * bend)))
        if slope > 0.0:
            velocity = min(velocity, machine.velocity[axis] / slope)
            acceleration = min(acceleration, machine.acceleration[axis] / slope)
            jerk = min(jerk, machine.jerk[axis] / slope)
    if turn > 0.0:
        jerk *= CURVE_SHARE
    speeding = min(acceleration, scale * blocks.acceleration[i])
    braking = min(acceleration, scale * blocks.deceleration[i])
    return RampLimits(velocity, speeding, braking, jerk)


@array_arithmetic_kernel
def _unevenness(blocks: BlockMotion, i: int, machine: MachineLimits) -> float:
    """How often the smallest jerk limit of an arc's axes goes into the largest; 1 for lines."""
    least, most = math.inf, 0.0
    for axis in range(3):
        if blocks.curves.cosine[i, axis] != 0.0 or blocks.curves.sine[i, axis] != 0.0:
            least, most = min(least, machine.jerk[axis]), max(most, machine.jerk[axis])
    return most / least if most > 0.0 else 1.0


@array_arithmetic_kernel
def _rounding_velocity(corners: Corners, i: int, machine: MachineLimits) -> float:
    """How fast a rounding may be passed, as if it were alone on straight blocks."""
    per_width = 1.0 / corners.width[i]
    velocity, bends = math.inf, 0.0
    for axis in range(len(machine.jerk)):
        tangent = abs(corners.tangent_step[i, axis]) * per_width
        curvature = abs(corners.curvature_step[i, axis])
        # The largest values of the polynomials' second and third derivatives.
        second = 0.75 * tangent + curvature
        third = (1.5 * tangent + 1.125 * curvature) * per_width
        if second > 0.0:
            velocity = min(velocity, math.sqrt(machine.acceleration[axis] / second))
            velocity = min(velocity, np.cbrt(CURVE_SHARE * machine.jerk[axis] / third))
        if axis < 3:
            bends += second * second
    if bends > 0.0:
        velocity = min(velocity, math.sqrt(machine.path[0] / math.sqrt(bends)))
    return velocity


@array_arithmetic_kernel
def _overlap_distance(
    blocks: BlockMotion, corners: Corners, i: int, before: RampLimits, after: RampLimits,
    machine: MachineLimits,
) -> float:  # fmt: skip
    """How far from the corner both moves may be while they overlap; 0 where they must not.

    Both begin or end with their full jerk, so the sum of the two must be within the axes' limits.
    The sum of the accelerations goes evenly from that of the one to that of the other.
    """
    curves = blocks.curves
    if curves.angle[i - 1] != 0.0 or curves.angle[i] != 0.0:
        return 0.0
    if is_curve(curves.bend, i - 1) or is_curve(curves.bend, i):
        return 0.0
    per_length, next_per_length = 1.0 / blocks.length[i - 1], 1.0 / blocks.length[i]
    squares, next_squares, away = 0.0, 0.0, math.inf
    for axis in range(len(machine.jerk)):
        slope = curves.drift[i - 1, axis] * per_length
        next_slope = curves.drift[i, axis] * next_per_length
        if abs(slope * before.jerk + next_slope * after.jerk) > machine.jerk[axis]:
            return 0.0
        if axis < 3:
            squares += slope * slope
            next_squares += next_slope * next_slope
        else:
            largest = max(abs(slope), abs(next_slope))
            if largest > 0.0:
                away = min(away, corners.further_tolerance / largest)
    largest = math.sqrt(max(squares, next_squares))
    return min(away, corners.tolerance[i] / largest) if largest > 0.0 else away


@array_arithmetic_kernel
def _overlap_time(
    away: float, length: float, next_length: float, before: RampLimits, after: RampLimits
) -> float:
    """How long two moves overlap that may both be so far from the corner."""
    if away <= 0.0:
        return 0.0
    time = np.cbrt(6.0 * away / before.jerk) + np.cbrt(6.0 * away / after.jerk)
    # The last phase of the one and the first of the other; of a short block, a quarter of its time.
    for distance, limits, hardest in (
        (length, before, before.deceleration),
        (next_length, after, after.acceleration),
    ):
        time = min(time, math.sqrt(limits.velocity / limits.jerk), hardest / limits.jerk)
        time = min(time, np.cbrt(0.5 * distance / limits.jerk))
    return time
