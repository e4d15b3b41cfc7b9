"""How fast moves go, by what F counts."""

import enum
import math
from collections.abc import Mapping
from typing import NamedTuple

from twin.compilation.compilable import inlined


class FeedMode(enum.IntEnum):
    """What F counts."""

    PER_MINUTE = 0
    """Millimetres, inches or degrees per minute."""
    PER_SECOND = 1
    """The same per second."""
    PER_REVOLUTION = 2
    """The same per revolution of the spindle."""
    SECONDS_PER_BLOCK = 3
    """Seconds that the block's move takes."""
    BLOCKS_PER_MINUTE = 4
    """The inverse of the minutes that it takes."""


_PER_SECOND, _PER_REVOLUTION = int(FeedMode.PER_SECOND), int(FeedMode.PER_REVOLUTION)
_SECONDS_PER_BLOCK = int(FeedMode.SECONDS_PER_BLOCK)
_BLOCKS_PER_MINUTE = int(FeedMode.BLOCKS_PER_MINUTE)

KNOWN_FEED, WITHOUT_FEED, WITHOUT_SPEED, STANDING = range(4)
"""What is wrong with the feed rate of a move: nothing; no F is programmed; F counts per revolution, and no S is
programmed; or the spindle is stopped."""


@inlined
def finding_of_feed(feed: float, mode: int, speed: float, turns: float) -> int:
    """What is wrong with the feed rate of a move.

    Args:
        feed: F, or NaN where none is programmed.
        mode: What it counts, as ``FeedMode`` numbers it.
        speed: S [1/min]; NaN where none is programmed.
        turns: 0 where the spindle is stopped.
    """
    if feed != feed:
        return WITHOUT_FEED
    if mode != _PER_REVOLUTION:
        return KNOWN_FEED
    if speed != speed or speed == 0.0:
        return WITHOUT_SPEED
    return STANDING if turns == 0.0 else KNOWN_FEED


@inlined
def feed_per_minute(
    feed: float,
    mode: int,
    length: float,
    turning: bool,
    unit: float,
    speed: float,
    otherwise: tuple[float, float],
) -> float:
    """Feed of a move [mm/min or deg/min].

    Args:
        feed: F, or NaN where none is programmed.
        mode: What it counts, as ``FeedMode`` numbers it.
        length: How far the move goes [mm or deg].
        turning: Only rotary axes move: F counts degrees.
        unit: Of programmed lengths [mm].
        speed: S [1/min]; it counts per revolution alone.
        otherwise: Feed where none is programmed, of other moves and of such that only turn.
    """
    if feed != feed:
        return otherwise[1] if turning else otherwise[0]
    if mode == _SECONDS_PER_BLOCK:
        return length / feed * 60.0
    if mode == _BLOCKS_PER_MINUTE:
        return length * feed
    counted = feed if turning else feed * unit
    if mode == _PER_SECOND:
        return counted * 60.0
    return counted * speed if mode == _PER_REVOLUTION else counted


class FeedRule(NamedTuple):
    """Which part of a move F counts, by the control and its parameters.

    Attributes:
        degree: What a degree of a rotary axis counts together with linear axes [programmed unit of length, or mm];
            0: nothing, rotary axes arrive with the others.
        surface: ``degree`` is the length on a surface that turns [mm]: F counts it also where only a rotary
            axis moves. Otherwise F then counts degrees.
        helix_by_arc: F of an arc counts the arc in its plane alone; all other axes arrive with it.
        arc_by_radius: With ``BLOCKS_PER_MINUTE`` F of an arc is speed by radius, not the inverse of its time.
    """

    degree: float = 0.0
    surface: bool = False
    helix_by_arc: bool = False
    arc_by_radius: bool = False


PATH_COUNTS = FeedRule()
"""F counts the path in X, Y and Z; where that rests, the other axes."""


class Displacement(NamedTuple):
    """How far a move goes.

    Attributes:
        length: As ``canonical`` measures it [mm, or deg where only rotary axes move].
        turned: Of the rotary axes together [deg].
        turning: Only rotary axes move.
        around: Of an arc in its plane [mm]; 0 of a line.
        radius: Of an arc [mm].
    """

    length: float
    turned: float
    turning: bool
    around: float = 0.0
    radius: float = 0.0


@inlined
def arc_displacement(length: float, turned: float, radius: float, sweep: float) -> Displacement:
    """That of an arc of a length and a radius [mm] with its sweep [deg]."""
    return Displacement(length, turned, False, radius * math.radians(abs(sweep)), radius)


@inlined
def feed_by_rule(rule: FeedRule, feed: float, move: Displacement, mode: int, unit: float) -> float:
    """Feed along the path of a move whose F counts another length [mm/min or deg/min]."""
    by_time = counts_blocks(mode)
    if by_time and not (rule.arc_by_radius and move.around > 0.0):
        return feed
    if move.turning:
        return feed * (unit / rule.degree) if rule.surface else feed
    counted = move.length
    if move.around > 0.0 and rule.helix_by_arc:
        counted = move.around
    elif move.turned > 0.0:
        degree = rule.degree if rule.surface else rule.degree * unit
        counted = math.hypot(move.length, move.turned * degree)
    return feed * ((move.radius if by_time else move.length) / counted)


FEED_FACTORS: Mapping[FeedMode, float] = {FeedMode.PER_MINUTE: 1.0, FeedMode.PER_SECOND: 60.0}
"""By what F is multiplied to count per minute, where it needs no more than that."""


@inlined
def needs_own_feed(mode: int) -> bool:
    """Whether F counts for its own block alone, so that every block that cuts must have one."""
    return mode == _BLOCKS_PER_MINUTE


@inlined
def counts_blocks(mode: int) -> bool:
    """Whether F counts blocks, so that the feed rate of a move follows from its length."""
    return mode >= _SECONDS_PER_BLOCK


@inlined
def rapid_feed(own: float, feed: float) -> float:
    """Feed of rapids [mm/min]: their own per second, where that is 0 F; NaN: the machine's."""
    return (own if own != 0.0 else feed) * 60.0
