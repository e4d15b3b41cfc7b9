"""Feeds: F, FU, F AUTO, FMAX."""

from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.memory import INCH_FEEDS, memory_of
from twin.nc.iso import base
from twin.nc.path.feed_rates import FeedMode
from twin.nc.text.blocks import Word


def set_feed(control: Control, word: Word) -> None:
    """F: the feed per minute, or with M136 per revolution."""
    turning = memory_of(control).per_revolution
    control.modal.feed_mode = FeedMode.PER_REVOLUTION if turning else FeedMode.PER_MINUTE
    base.set_feed(control, word)
    assert control.motion.feed is not None
    if control.modal.unit != 1.0 and not turning:
        control.motion.feed *= INCH_FEEDS


def set_feed_per_turn(control: Control, word: Word) -> None:
    """FU: the feed per revolution of the spindle."""
    base.set_feed(control, word)
    control.modal.feed_mode = FeedMode.PER_REVOLUTION


def feed_of_tool(control: Control, word: Word) -> None:
    """F AUTO: the feed of the last TOOL CALL."""
    feed = memory_of(control).tool_feed
    if feed is None:
        hint = "write TOOL CALL 1 Z S3000 F500"
        control.fail("no-feed", "F AUTO needs the F of TOOL CALL, and it had none", word, hint)
    control.motion.feed = feed


def go_rapidly(control: Control, _word: Word) -> None:
    """FMAX: this block moves as fast as the machine can."""
    memory_of(control).rapid = True
