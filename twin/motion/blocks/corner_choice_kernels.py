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
from twin.motion.blocks.corner_limit_kernels import (
    BlockMotion,
    Corners,
    block_limits,
    overlap_distance,
    overlap_time,
    rounding_velocity,
    unevenness,
)
from twin.motion.limits import MachineLimits
from twin.motion.ramp_kernels import RampLimits, travel_time
from twin.nc.canonical import FloatArray, IntArray

CERTAINTY = 0.15
"""Share of the time through a rounding by which it must be faster than the stop: the limits along
its parts are a little stricter than those of the whole. Beside an arc they change the more, the more
the limits of its axes differ: there it is taken as often as the one jerk goes into the other."""


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
            ways.velocity[i] = rounding_velocity(corners, i, machine)
            if ways.velocity[i] >= min(blocks.velocity[i - 1], blocks.velocity[i]):
                continue
        before = after if known == i - 1 else block_limits(blocks, i - 1, machine)
        known, after = i, block_limits(blocks, i, machine)
        for block, limits in ((i - 1, before), (i, after)):
            ways.ramps[block, :] = limits
            ways.unevenness[block] = unevenness(blocks, block, machine)
        ways.away[i] = overlap_distance(blocks, corners, i, before, after, machine)
        lengths = blocks.length[i - 1], blocks.length[i]
        ways.gain[i] = overlap_time(ways.away[i], lengths[0], lengths[1], before, after)
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
