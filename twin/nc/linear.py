"""Straight blocks."""

from twin.nc.control import Control


def rapid_line(control: Control) -> None:
    """G0: straight to the target at the machine's own speed."""
    control.line_to(control.target(), rapid=True)


def feed_line(control: Control) -> None:
    """G1: straight to the target with the feed."""
    control.line_to(control.target(), rapid=False)
