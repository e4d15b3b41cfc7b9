"""Moves of cycles: in the working plane and across it, programmed coordinates."""

from collections.abc import Iterator
from contextlib import contextmanager

from twin.nc.control.control import Control
from twin.nc.geometry.arcs import Point


def go(control: Control, point: Point, *, rapid: bool = False) -> None:
    """Go straight to a point of the plane [mm]."""
    control.line_to(_target(control, point), rapid=rapid)


def descend(control: Control, height: float, feed: float | None) -> None:
    """Go straight to a height with a feed; None: rapidly."""
    with at_feed(control, feed):
        go_to_height(control, height, rapid=feed is None)


@contextmanager
def at_feed(control: Control, feed: float | None) -> Iterator[None]:
    """Move with another feed for a while; None: with none, as rapids do."""
    kept, control.motion.feed = control.motion.feed, feed
    yield
    control.motion.feed = kept


def go_to_height(control: Control, height: float, *, rapid: bool = True) -> None:
    """Go straight to a height of the axis across the plane [mm]."""
    target = list(control.motion.programmed)
    target[control.modal.plane.axes[2]] = height
    control.line_to(target, rapid=rapid)


def turn(
    control: Control, center: Point, end: Point, sweep: float, height: float | None = None
) -> None:
    """Go on an arc, or on a helix to another height.

    Args:
        center: In the plane [mm].
        end: In the plane [mm].
        sweep: Signed angle with all turns [deg].
        height: At the end [mm]; None: as high as the tool stands.
    """
    target = _target(control, end)
    if height is not None:
        target[control.modal.plane.axes[2]] = height
    control.arc_to(target, center, sweep)


def _target(control: Control, point: Point) -> list[float]:
    target = list(control.motion.programmed)
    control.modal.plane.aim(target, point)
    return target
