"""Which continuous corners are passed faster by a stop than by a rounding.

A rounding must be driven slowly where it is narrow. At a stop the next move may begin before the
one before it has ended: both are then at most a tolerance away from the corner, so that the sum of
the two is within it too. Of a chain of corners that leave a choice that passage is taken which is the
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


class Choices(NamedTuple):
    """How the borders before n blocks can be passed.

    Attributes:
        passage: A ``Passage``, shape (n,).
        velocity: Without a stop, shape (n,).
        away: How far from a stop the moves may overlap, shape (n,).
        gain: How long they then do [s], shape (n,).
        ramps: What each block allows, where a border beside it is free; shape (n, 4).
        unevenness: How often the smallest jerk limit of an arc's axes goes into the largest; 1 for
            lines; shape (n,).
    """

    passage: IntArray
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

    Returns:
        Whether to stop, shape (n,); how far from there the moves may overlap, shape (n,).
    """
    count = len(blocks.length)
    choices = _find_choices(blocks, corners, machine)
    chosen, scratch = choices.passage.copy(), choices.passage.copy()
    back = np.zeros((count, 2), np.int64)
    for i in range(count):
        if choices.passage[i] == Passage.FREE and blocks.move[i] % ANCHOR == 0:
            first, last = max(0, i - SEEN), min(count - 1, i + SEEN)
            scratch[first : last + 1] = choices.passage[first : last + 1]
            _choose_between(blocks, corners, choices, first, last, scratch, back)
            chosen[i] = scratch[i]
    first = 0
    for i in range(1, count):
        if chosen[i] != Passage.FREE or i == count - 1:
            if i > first + 1 or chosen[i] == Passage.FREE:
                _choose_between(blocks, corners, choices, first, i, chosen, back)
            first = i
    stops = np.zeros(count, np.bool_)
    for i in range(1, count):
        stops[i] = corners.rounded[i] and chosen[i] == Passage.STOPPED
        if not stops[i]:
            choices.away[i] = 0.0
    return stops, choices.away


@array_arithmetic_kernel
def _find_choices(blocks: BlockMotion, corners: Corners, machine: MachineLimits) -> Choices:
    """The passages of each border, and what is needed to choose among them."""
    count = len(blocks.length)
    choices = Choices(
        np.full(count, Passage.PASSED.value), np.full(count, math.inf), np.zeros(count), np.zeros(count),
        np.zeros((count, 4)), np.ones(count),
    )  # fmt: skip
    known, after = -1, RampLimits(0.0, 0.0, 0.0, 0.0)
    for i in range(count):
        if i == 0 or not corners.rounded[i]:
            choices.passage[i] = Passage.STOPPED.value
            continue
        if blocks.length[i] == 0.0 or blocks.length[i - 1] == 0.0:
            continue
        if not np.any(corners.tangent_step[i]) and not np.any(corners.curvature_step[i]):
            continue
        if corners.width[i] > 0.0:
            choices.velocity[i] = rounding_velocity(corners, i, machine)
            if choices.velocity[i] >= min(blocks.limits.velocity[i - 1], blocks.limits.velocity[i]):
                continue
        before = after if known == i - 1 else block_limits(blocks, i - 1, machine)
        known, after = i, block_limits(blocks, i, machine)
        for block, limits in ((i - 1, before), (i, after)):
            choices.ramps[block, :] = limits
            choices.unevenness[block] = unevenness(blocks, block, machine)
        choices.away[i] = overlap_distance(blocks, corners, i, before, after, machine)
        lengths = blocks.length[i - 1], blocks.length[i]
        choices.gain[i] = overlap_time(choices.away[i], lengths[0], lengths[1], before, after)
        if corners.width[i] == 0.0:
            choices.passage[i] = Passage.STOPPED.value
        elif choices.velocity[i] < min(before.velocity, after.velocity):
            choices.passage[i] = Passage.FREE.value
    return choices


@array_arithmetic_kernel
def _choose_between(
    blocks: BlockMotion, corners: Corners, choices: Choices, first: int, last: int,
    chosen: IntArray, back: IntArray,
) -> None:  # fmt: skip
    """Choose the fastest passage of consecutive borders, in place.

    Args:
        chosen: How each is passed, where it is known; the others are written.
        back: Scratch, shape (n, 2).
    """
    passed = 0.0 if chosen[first] != Passage.STOPPED else math.inf
    stopped = -choices.gain[first] if chosen[first] != Passage.PASSED else math.inf
    for i in range(first + 1, last + 1):
        best = math.inf, math.inf
        for passage in _CHOICES:
            if chosen[i] == 1 - passage:
                continue
            least = math.inf
            for before in _CHOICES:
                time = passed if before == Passage.PASSED else stopped
                if time < math.inf:
                    time += _time_of_block(blocks, corners, choices, i - 1, before, passage)
                    if time < least:
                        least, back[i, passage] = time, before
            best = (
                (least, best[1])
                if passage == Passage.PASSED
                else (best[0], least - choices.gain[i])
            )
        passed, stopped = best
    if last + 1 == len(chosen):
        passed += _time_of_block(blocks, corners, choices, last, Passage.PASSED, Passage.STOPPED)
        stopped += _time_of_block(blocks, corners, choices, last, Passage.STOPPED, Passage.STOPPED)
    chosen[last] = Passage.STOPPED.value if stopped < passed else Passage.PASSED.value
    for i in range(last, first, -1):
        chosen[i - 1] = back[i, chosen[i]]


@array_arithmetic_kernel
def _time_of_block(
    blocks: BlockMotion, corners: Corners, choices: Choices, i: int, before: int, after: int
) -> float:
    """About how long a block takes that is entered and left by certain passages [s].

    Where no border beside it is free, it does not matter: 0.
    """
    limits = RampLimits(
        choices.ramps[i, 0], choices.ramps[i, 1], choices.ramps[i, 2], choices.ramps[i, 3]
    )
    if limits.velocity == 0.0:
        return 0.0
    length = blocks.length[i]
    slower = 1.0 + CERTAINTY * choices.unevenness[i]
    u, width = _end_of_block(corners, choices, i, before, after, length)
    v, next_width = _end_of_block(corners, choices, i + 1, after, before, length)
    u, v = min(u, limits.velocity), min(v, limits.velocity)
    rounded = width + next_width
    if rounded > length:
        # Roundings that reach over several blocks count where they are.
        width, next_width, rounded = width * length / rounded, next_width * length / rounded, length
    time = slower * (width / u if width > 0.0 else 0.0)
    time += slower * (next_width / v if next_width > 0.0 else 0.0)
    turns = (
        abs(blocks.curves.angle[i]) >= LEAST_TURN and limits.velocity < blocks.limits.velocity[i]
    )
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
    corners: Corners, choices: Choices, border: int, passage: int, other: int, length: float
) -> tuple[float, float]:
    """Velocity at an end of a block, and how far its rounding reaches.

    Args:
        border: At this end.
        other: How that at the other end is passed.
    """
    if passage == Passage.STOPPED:
        return 0.0, 0.0
    speed, width = choices.velocity[border], corners.width[border]
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
