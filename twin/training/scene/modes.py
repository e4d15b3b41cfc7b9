"""What can be set at a panel: the modes, and the ends of the override dials."""

from typing import Literal

Mode = Literal["auto", "single", "jog", "mdi"]
"""Automatic, single block, manual jog, manual data input."""

MODES: tuple[Mode, ...] = ("auto", "single", "jog", "mdi")

FEED_OVERRIDES = (0, 120)
"""Ends of the feed override dial [%]."""
RAPID_OVERRIDES = (0, 100)
"""Ends of the rapid override dial [%]."""
