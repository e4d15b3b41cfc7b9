"""What a drilling cycle does at a hole: where it lies, how the tool goes down by pecks or passes, and leaves."""

import enum
import math
from typing import NamedTuple

from twin.nc.path.drilling_cycle import (
    AXIS,
    BOTTOM,
    CLEARANCE,
    COUNT,
    DEPTH,
    DWELL,
    EVERY,
    FACTOR,
    FASTER,
    FIRST,
    LEAST,
    LIFT,
    PECK,
    REDUCTION,
    REFERENCE,
    START,
    SURFACE,
    VALUES,
    Cycle,
    Pecking,
    Retract,
    Values,
    either,
)

LEAST_REST = 1e-6
"""What a peck leaves of the way to the bottom at least: less is rounding [mm]."""
MOST_PECKS = 10_000
"""Pecks of one hole: more is a slip of the pen."""


class Act(enum.IntEnum):
    """What happens at a hole: moves to a height, a dwell, the spindle.

    The number of an M function is its own.
    """

    RAPID = 0
    FEED = 1
    DWELL = 2
    M3 = 3
    M4 = 4
    M5 = 5
    ACROSS = 6
    """Rapidly over the hole, at a height."""
    BACK = 7
    """With the feed, as many times as fast as the hole says."""


class Fault(enum.IntEnum):
    """What is wrong with the values of a cycle."""

    NONE = 0
    MISSING = 1
    PLANE = 2
    """It was called in another plane."""
    PECKS = 3
    MANY_PECKS = 4
    DEPTH = 5
    """It does not go down, or returns from below."""
    DWELL = 6
    PECK_WORDS = 7
    """It needs the depth of all pecks, or the first, the reduction and the least."""
    FASTER = 8
    """It comes back no faster than so many times, and no slower."""


_FEED, _REVERSED, _STOPPED = int(Retract.FEED), int(Retract.REVERSED), int(Retract.STOPPED)
_REVERSED_LEFT, _FEED_ALL = int(Retract.REVERSED_LEFT), int(Retract.FEED_ALL)
_STRAIGHT, _COUNTED = int(Pecking.NONE), int(Pecking.COUNTED)
_PASSES, _UNSIGNED_PASSES = int(Pecking.PASSES), int(Pecking.UNSIGNED_PASSES)
_MISSING, _PLANE, _PECKS = int(Fault.MISSING), int(Fault.PLANE), int(Fault.PECKS)
_MANY_PECKS, _DEPTH, _DWELL = int(Fault.MANY_PECKS), int(Fault.DEPTH), int(Fault.DWELL)
_PECK_WORDS, _FASTER = int(Fault.PECK_WORDS), int(Fault.FASTER)
_TO_BOTTOM = int(Pecking.TO_BOTTOM)
_FASTEST_RETURN = 9.0
_UP, _DOWN, _WAIT = float(Act.RAPID), float(Act.FEED), float(Act.DWELL)
_ACROSS, _BACK = float(Act.ACROSS), float(Act.BACK)
_M3, _M4, _M5 = float(Act.M3), float(Act.M4), float(Act.M5)
NO_MOVE = -1.0
"""Something happens at the hole."""


class Hole(NamedTuple):
    """What a cycle in force does at every hole.

    Attributes:
        fault: A ``Fault``; unless it is none, nothing else counts.
        reference: Height at which the feed begins, programmed coordinates [mm].
        bottom: Height of the hole's bottom [mm].
        back: Height to which the tool returns [mm].
        dwell: At the bottom [s].
        surface: Height at which the first peck begins [mm].
        stops: How often it withdraws to break or clear chips.
        passes: It does so as a tap, with the feed.
        peck: Depth of the first peck [mm].
        factor: By which each is deeper than the one before.
        reduction: By how much each is less deep than that [mm].
        least: No peck is less deep, except the last [mm].
        lift: How far it withdraws [mm].
        full_every: After how many stops it withdraws to the reference plane; 0: after none.
        clearance: It returns with rapid to this far above where it was [mm].
        retract: A ``Retract``.
        faster: How many times as fast as it went down a tap comes back.
        rest: Above the hole, where it withdraws to the reference plane [s].
    """

    fault: int
    reference: float
    bottom: float
    back: float
    dwell: float
    surface: float
    stops: int
    passes: bool
    peck: float
    factor: float
    reduction: float
    least: float
    lift: float
    full_every: int
    clearance: float
    retract: int
    faster: float
    rest: float = 0.0


def hole_of(cycle: Cycle, values: Values, axis: int, to_reference: bool) -> Hole:
    """What a cycle does at a hole.

    Args:
        cycle: The cycle.
        values: What it remembers.
        axis: The axis across the plane in force.
        to_reference: It returns to the reference plane, not to the height of its call.
    """
    fault = _fault_of_call(cycle, values, axis)
    reference, bottom = values[REFERENCE], values[BOTTOM]
    surface = reference - either(values[SURFACE], 0.0)
    peck, factor = either(values[FIRST], values[PECK]), either(values[FACTOR], 1.0)
    reduction, faster = either(values[REDUCTION], 0.0), either(values[FASTER], 1.0)
    least, lift = either(values[LEAST], 0.0), either(values[LIFT], cycle.lift)
    every, stops, full_every = either(values[EVERY], 0.0), 0, 1
    if fault == 0 and cycle.pecking == _TO_BOTTOM and not (cycle.needed >> PECK) & 1:
        fault = _fault_of_pecks(values)
    if cycle.pecking == _COUNTED:
        peck = abs(values[DEPTH])
        bottom = surface - peck * values[COUNT]
    passes = cycle.pecking in (_PASSES, _UNSIGNED_PASSES)
    if cycle.pecking == _UNSIGNED_PASSES:
        peck = abs(peck)
    if fault == 0 and cycle.pecking != _STRAIGHT and not (passes and peck != peck):
        if peck <= 0.0 or factor <= 0.0 or lift < 0.0 or every < 0.0 or every % 1.0 != 0.0:
            fault = _PECKS
        else:
            course = (factor, reduction, least)
            stops = count_stops(surface, bottom, peck, course)
            if passes:
                stops = count_passes(surface, bottom, peck) - 1
            full_every = 1 if lift == 0.0 else int(every)
            if stops + passes > MOST_PECKS:
                fault = _MANY_PECKS
    clearance = either(values[CLEARANCE], cycle.clearance)
    dwell = either(values[DWELL], 0.0) if cycle.dwells else 0.0
    if fault == 0:
        goes_down = bottom < reference and clearance >= 0.0
        fault = _fault_of_return(dwell, faster) if goes_down else _DEPTH
    back = reference if to_reference else max(values[START], reference)
    return Hole(
        fault,
        reference,
        bottom,
        back,
        dwell,
        surface,
        stops,
        passes,
        peck,
        factor,
        reduction,
        least,
        lift,
        full_every,
        clearance,
        cycle.retract,
        faster,
    )


def _fault_of_call(cycle: Cycle, values: Values, axis: int) -> int:
    """Whether it was called in the plane in force, with all that it needs."""
    if values[AXIS] != axis:
        return _PLANE
    needed = (value for value in range(VALUES) if (cycle.needed >> value) & 1)
    return _MISSING if any(values[value] != values[value] for value in needed) else 0


def _fault_of_return(dwell: float, faster: float) -> int:
    """Whether it can wait at the bottom so long and come back so fast."""
    if dwell < 0.0:
        return _DWELL
    whole = faster % 1.0 == 0.0 and 1.0 <= faster <= _FASTEST_RETURN
    return 0 if whole else _FASTER


def _fault_of_pecks(values: Values) -> int:
    """Whether either the depth of all pecks is there, or the first, the reduction and the least."""
    every, first = values[PECK] == values[PECK], values[FIRST] == values[FIRST]
    reduction, least = values[REDUCTION] == values[REDUCTION], values[LEAST] == values[LEAST]
    if every:
        return _PECK_WORDS if first or reduction or least else 0
    if not (first and reduction and least):
        return _PECK_WORDS
    return _PECKS if values[REDUCTION] < 0.0 or values[LEAST] <= 0.0 else 0


def next_peck(peck: float, factor: float, reduction: float, least: float) -> float:
    """Depth of the peck behind one [mm]."""
    return max(peck * factor - reduction, least)


def count_stops(
    surface: float, bottom: float, peck: float, course: tuple[float, float, float]
) -> int:
    """How often deep drilling stops above the bottom; more than ``MOST_PECKS`` are not counted.

    Args:
        surface: Where the first peck begins [mm].
        bottom: Where the last one ends [mm].
        peck: Depth of the first [mm].
        course: Factor, reduction [mm] and least depth [mm] of the next ones.
    """
    factor, reduction, least = course
    depth, stops = surface, 0
    while depth - peck > bottom + LEAST_REST and stops <= MOST_PECKS:
        depth -= peck
        peck = next_peck(peck, factor, reduction, least)
        stops += 1
    return stops


def count_passes(surface: float, bottom: float, depth: float) -> int:
    """How many passes of a depth lead to the bottom; more than ``MOST_PECKS`` are not counted."""
    return math.ceil(max(min((surface - bottom) / depth, MOST_PECKS + 1.0) - 1e-9, 1.0))


def most_acts(stops: int) -> int:
    """Room that ``write_acts`` needs."""
    return 5 * stops + 9


def next_place(
    act: float, amount: float, hole: Hole, over: Values, goal: Values, axis: int
) -> float:
    """How an act moves; the goal, where the tool is before, becomes its end.

    Args:
        act: An ``Act``.
        amount: Its height [mm].
        hole: Of which hole.
        over: The hole's place, shape (k,).
        goal: Shape (k,).
        axis: The axis across the plane.

    Returns:
        How many times as fast as F says, 0 for rapidly, or ``NO_MOVE``.
    """
    if act not in (_UP, _DOWN, _ACROSS, _BACK):
        return NO_MOVE
    if act == _ACROSS:
        for other in range(len(goal)):
            goal[other] = over[other]
    goal[axis] = amount
    if act == _BACK:
        return hole.faster
    return 1.0 if act == _DOWN else 0.0


def write_acts(hole: Hole, height: float, acts: Values, amounts: Values) -> int:
    """Write what happens at a hole; how many acts there are.

    Args:
        hole: The hole.
        height: Where the tool is [mm].
        acts: Filled with ``Act``.
        amounts: Filled with heights [mm] and seconds.
    """
    over = max(height, hole.reference)
    reverses = hole.retract in (_REVERSED, _REVERSED_LEFT)
    outwards, inwards = (_M3, _M4) if hole.retract == _REVERSED_LEFT else (_M4, _M3)
    acts[0], amounts[0] = _UP, over
    acts[1], amounts[1] = _ACROSS, over
    acts[2], amounts[2], at = _UP, hole.reference, 3
    depth, peck = hole.surface, hole.peck
    for number in range(1, hole.stops + 1):
        depth = hole.surface - number * peck if hole.passes else depth - peck
        full = hole.full_every > 0 and number % hole.full_every == 0
        up = hole.reference if full else min(depth + hole.lift, hole.reference)
        acts[at], amounts[at] = _DOWN, depth
        if hole.passes:
            acts[at + 1], amounts[at + 1] = outwards, 0.0
            acts[at + 2], amounts[at + 2] = _BACK, up
            acts[at + 3], amounts[at + 3] = inwards, 0.0
            at += 4
        else:
            peck = next_peck(peck, hole.factor, hole.reduction, hole.least)
            acts[at + 1], amounts[at + 1] = _UP, up
            at += 2
            if full and hole.rest > 0.0:
                acts[at], amounts[at] = _WAIT, hole.rest
                at += 1
            acts[at], amounts[at] = _UP, min(depth + hole.clearance, up)
            at += 1
    acts[at], amounts[at] = _DOWN, hole.bottom
    at += 1
    if hole.dwell > 0.0:
        acts[at], amounts[at] = _WAIT, hole.dwell
        at += 1
    if reverses or hole.retract == _STOPPED:
        acts[at], amounts[at] = outwards if reverses else _M5, 0.0
        at += 1
    if reverses or hole.retract in (_FEED, _FEED_ALL):
        out = hole.back if hole.retract == _FEED_ALL else hole.reference
        acts[at], amounts[at] = _BACK, out
        at += 1
    if reverses:
        acts[at], amounts[at] = inwards, 0.0
        at += 1
    acts[at], amounts[at] = _UP, hole.back
    at += 1
    if hole.retract == _STOPPED:
        acts[at], amounts[at] = _M3, 0.0
        acts[at + 1], amounts[at + 1] = _UP, hole.back
        at += 2
    return at
