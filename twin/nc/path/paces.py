"""How fast moves go, by what F counts: for both tiers."""

import enum
from collections.abc import Mapping

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

PACED, WITHOUT_FEED, WITHOUT_SPEED, STANDING = range(4)
"""What is wrong with the pace of a move: nothing; no F is programmed; F counts per revolution, and no S is
programmed; or the spindle stands."""


@inlined
def finding_of_feed(feed: float, mode: int, speed: float, turns: float) -> int:
    """What is wrong with the pace of a move.

    Args:
        feed: F, or NaN where none is programmed.
        mode: What it counts, as ``FeedMode`` numbers it.
        speed: S [1/min]; NaN where none is programmed.
        turns: 0 where the spindle stands.
    """
    if feed != feed:
        return WITHOUT_FEED
    if mode != _PER_REVOLUTION:
        return PACED
    if speed != speed or speed == 0.0:
        return WITHOUT_SPEED
    return STANDING if turns == 0.0 else PACED


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


FEED_FACTORS: Mapping[FeedMode, float] = {FeedMode.PER_MINUTE: 1.0, FeedMode.PER_SECOND: 60.0}
"""By what F is multiplied to count per minute, where it needs no more than that."""


@inlined
def needs_own_feed(mode: int) -> bool:
    """Whether F counts for its own block alone, so that every block that cuts must have one."""
    return mode == _BLOCKS_PER_MINUTE


@inlined
def counts_blocks(mode: int) -> bool:
    """Whether F counts blocks, so that the pace of a move follows from its length."""
    return mode >= _SECONDS_PER_BLOCK


@inlined
def rapid_feed(own: float, feed: float) -> float:
    """Feed of rapids that the program paces [mm/min]: their own per second, where that is 0 F; or NaN."""
    return (own if own != 0.0 else feed) * 60.0
