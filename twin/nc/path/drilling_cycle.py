"""Drilling cycles as numbers: what is peculiar to each, and what they remember of their words.

What is not given is NaN.
"""

import enum
import math
from typing import NamedTuple, TypeAlias

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
    FEED_ALL = 5
    """With the feed, as far as it goes back."""


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
        as_written: It remembers heights as they are written, and at each hole they count from what is in
            force there.
    """

    lasting: bool
    across: int
    needed: int
    pecking: int = int(Pecking.NONE)
    dwells: bool = True
    clearance: float = CHIP_CLEARANCE
    retract: int = int(Retract.RAPID)
    lift: float = 0.0
    as_written: bool = False


class CycleBlock(NamedTuple):
    """A block, as a cycle sees it.

    Attributes:
        calls: It calls the cycle.
        axis: The axis across the plane in force.
        height: Where the tool is on that [mm].
        unit: Of programmed lengths [mm].
        relative: Whether the reference plane counts from the height of the call, and whether the
            bottom counts from the reference plane.
    """

    calls: bool
    axis: int
    height: float
    unit: float
    relative: tuple[bool, bool]


def no_values() -> list[float]:
    """The words of a block that has none."""
    return [math.nan] * VALUES


def forget(values: Values) -> None:
    """No cycle has begun."""
    for value in range(VALUES):
        values[value] = math.nan


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


def either(value: float, default: float) -> float:
    """A value, or where there is none another one."""
    return value if value == value else default
