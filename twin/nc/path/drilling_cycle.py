"""Drilling cycles as numbers: what they remember of their words, and what they do at a hole.

Both ways share these functions: the interpreter tier gives them lists, the compiled one columns. What is
not given is NaN.
"""

import enum
import math
from typing import NamedTuple, TypeAlias

from twin.compilation.compilable import compilable
from twin.nc.canonical import FloatArray

Values: TypeAlias = "list[float] | FloatArray | memoryview[float]"

(
    START,
    AXIS,
    REFERENCE,
    BOTTOM,
    DEPTH,
    DWELL,
    SURFACE,
    PECK,
    FACTOR,
    LEAST,
    LIFT,
    EVERY,
    COUNT,
    CLEARANCE,
    FIRST,
    REDUCTION,
    FASTER,
) = range(17)
"""What a cycle remembers: the height at which it was called; the axis across its plane; the heights
of the reference plane and of the bottom; the latter as it was written; seconds at the bottom; how
far the surface lies below the reference plane; the first peck, the factor of each next one, the
least; how far the tool lifts, and after how many pecks it clears; how many pecks there are; how far
above its last height a rapid return ends; the first peck where each next one is less deep, by how much
it is; how many times as fast a tap comes back."""
VALUES = 17
LENGTHS = (
    1 << REFERENCE
    | 1 << BOTTOM
    | 1 << SURFACE
    | 1 << PECK
    | 1 << LEAST
    | 1 << LIFT
    | 1 << CLEARANCE
    | 1 << FIRST
    | 1 << REDUCTION
)
"""Those whose words count in the unit in force, as bits."""
CHIP_CLEARANCE = 0.5
"""Deep drilling stops its rapid return this far above where it was [mm]."""
LEAST_REST = 1e-6
"""What a peck leaves of the way to the bottom at least: less is rounding [mm]."""
MOST_PECKS = 10_000
"""Pecks of one hole: more is a slip of the pen."""


class Retract(enum.IntEnum):
    """How a cycle leaves the hole."""

    RAPID = 0
    FEED = 1
    REVERSED = 2
    """With the feed, the spindle reversed."""
    STOPPED = 3
    """Rapidly, the spindle stopped."""
    REVERSED_LEFT = 4
    """As ``REVERSED``, of a spindle that turned counter-clockwise."""


class Pecking(enum.IntEnum):
    """How a cycle goes down."""

    NONE = 0
    TO_BOTTOM = 1
    """By pecks, from the first on, as far as the bottom."""
    COUNTED = 2
    """By so many equal pecks."""
    PASSES = 3
    """By passes of a tap, which breaks the chip in its thread: every way is made with the feed, and out with
    the spindle reversed. At once where nothing says how deep they are."""
    UNSIGNED_PASSES = 4
    """As ``PASSES``; their depth may be written with either sign."""


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
_REVERSED_LEFT = int(Retract.REVERSED_LEFT)
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


class Cycle(NamedTuple):
    """What is peculiar to one drilling cycle.

    Attributes:
        lasting: Its words stay in force from cycle to cycle, and every hole may change them; else
            its first block says all.
        across: Which value the word of the axis across the plane gives.
        needed: Values that must be there, as bits.
        pecking: A ``Pecking``.
        dwells: It waits at the bottom.
        clearance: Where its words give none [mm].
        retract: A ``Retract``.
        lift: How far the tool withdraws between pecks where its words do not say it; 0: to the
            reference plane [mm].
        repeats_only: The compiled tier drills the holes behind the call whose block names an axis, in absolute coordinates, from
            the reference plane or above; all else is for the interpreter tier.
    """

    lasting: bool
    across: int
    needed: int
    pecking: int = int(Pecking.NONE)
    dwells: bool = True
    clearance: float = CHIP_CLEARANCE
    retract: int = int(Retract.RAPID)
    lift: float = 0.0
    repeats_only: bool = False


@compilable
def cycle_of(column: FloatArray) -> Cycle:
    """The cycle that a column begins with, value by value."""
    return Cycle(
        column[0] != 0.0,
        int(column[1]),
        int(column[2]),
        int(column[3]),
        column[4] != 0.0,
        column[5],
        int(column[6]),
        column[7],
        column[8] != 0.0,
    )


class CycleBlock(NamedTuple):
    """A block, as a cycle sees it.

    Attributes:
        calls: It calls the cycle.
        axis: The axis across the plane in force.
        height: Where the tool stands on that [mm].
        unit: Of programmed lengths [mm].
        relative: Whether the reference plane counts from the height of the call, and whether the
            bottom counts from the reference plane.
    """

    calls: bool
    axis: int
    height: float
    unit: float
    relative: tuple[bool, bool]


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


NO_MOVE = -1.0
"""Something happens at the hole."""
MOST_STOPS = 500
"""Stops of a hole that the compiled tier drills: its moves must fit into a chunk."""


def no_values() -> list[float]:
    """The words of a block that has none."""
    return [math.nan] * VALUES


@compilable
def forget(values: Values) -> None:
    """No cycle has begun."""
    for value in range(VALUES):
        values[value] = math.nan


@compilable
def read_words(cycle: Cycle, values: Values, given: Values, block: CycleBlock) -> None:
    """Take the words of a block.

    Args:
        cycle: The cycle that it calls, or that is in force.
        values: What the cycle remembers; NaN all of it where none was in force.
        given: The block's words as they are written, in the same places; lengths become millimetres.
        block: The block.
    """
    if block.calls and not (cycle.lasting and values[START] == values[START]):
        forget(values)
        values[START], values[AXIS] = block.height, float(block.axis)
    elif not cycle.lasting:
        return
    for value in range(VALUES):
        if (LENGTHS >> value) & 1:
            given[value] *= block.unit
    from_start, from_reference = block.relative
    if given[REFERENCE] == given[REFERENCE]:
        values[REFERENCE] = given[REFERENCE] + (values[START] if from_start else 0.0)
    elif not cycle.lasting:
        values[REFERENCE] = values[START]
    if given[BOTTOM] == given[BOTTOM]:
        above = either(values[REFERENCE], 0.0) if from_reference else 0.0
        values[BOTTOM], values[DEPTH] = given[BOTTOM] + above, given[BOTTOM]
    for value in range(DWELL, VALUES):
        if given[value] == given[value]:
            values[value] = given[value]


@compilable
def hole_of(cycle: Cycle, values: Values, axis: int, to_reference: bool) -> Hole:
    """What a cycle does at a hole.

    Args:
        cycle: The cycle.
        values: What it remembers.
        axis: The axis across the plane in force.
        to_reference: It returns to the reference plane, not to the height of its call.
    """
    fault = 0
    for value in range(VALUES):
        if (cycle.needed >> value) & 1 and values[value] != values[value]:
            fault = _MISSING
    if values[AXIS] != axis:
        fault = _PLANE
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
    if fault == 0 and (bottom >= reference or clearance < 0.0):
        fault = _DEPTH
    if fault == 0 and dwell < 0.0:
        fault = _DWELL
    if fault == 0 and not (faster % 1.0 == 0.0 and 1.0 <= faster <= _FASTEST_RETURN):
        fault = _FASTER
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


@compilable
def _fault_of_pecks(values: Values) -> int:
    """Whether either the depth of all pecks is there, or the first, the reduction and the least."""
    every, first = values[PECK] == values[PECK], values[FIRST] == values[FIRST]
    reduction, least = values[REDUCTION] == values[REDUCTION], values[LEAST] == values[LEAST]
    if every:
        return _PECK_WORDS if first or reduction or least else 0
    if not (first and reduction and least):
        return _PECK_WORDS
    return _PECKS if values[REDUCTION] < 0.0 or values[LEAST] <= 0.0 else 0


@compilable
def either(value: float, default: float) -> float:
    """A value, or where there is none another one."""
    return value if value == value else default


@compilable
def next_peck(peck: float, factor: float, reduction: float, least: float) -> float:
    """Depth of the peck behind one [mm]."""
    return max(peck * factor - reduction, least)


@compilable
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


@compilable
def count_passes(surface: float, bottom: float, depth: float) -> int:
    """How many passes of a depth lead to the bottom; more than ``MOST_PECKS`` are not counted."""
    return math.ceil(max(min((surface - bottom) / depth, MOST_PECKS + 1.0) - 1e-9, 1.0))


@compilable
def most_acts(stops: int) -> int:
    """Room that ``write_acts`` needs."""
    return 4 * stops + 9


@compilable
def next_place(
    act: float, amount: float, hole: Hole, over: Values, goal: Values, axis: int
) -> float:
    """How an act moves; the goal, where the tool stands before, becomes its end.

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


@compilable
def write_acts(hole: Hole, height: float, acts: Values, amounts: Values) -> int:
    """Write what happens at a hole; how many acts there are.

    Args:
        hole: The hole.
        height: Where the tool stands [mm].
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
            acts[at + 2], amounts[at + 2] = _UP, min(depth + hole.clearance, up)
            at += 3
    acts[at], amounts[at] = _DOWN, hole.bottom
    at += 1
    if hole.dwell > 0.0:
        acts[at], amounts[at] = _WAIT, hole.dwell
        at += 1
    if reverses or hole.retract == _STOPPED:
        acts[at], amounts[at] = outwards if reverses else _M5, 0.0
        at += 1
    if reverses or hole.retract == _FEED:
        acts[at], amounts[at] = _BACK, hole.reference
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
