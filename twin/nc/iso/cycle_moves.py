"""Places and moves of cycles in the working plane and across it, in programmed coordinates."""

from collections.abc import Iterator
from contextlib import contextmanager

from twin.nc.control.control import Control
from twin.nc.geometry.arcs import Point, direction


def row(start: Point, angle: float, spacing: float, count: int) -> list[Point]:
    """Places so far apart on a line that leaves the first at an angle [deg]."""
    return grid(start, (angle, 0.0), (spacing, 0.0), (count, 1))


def circle(center: Point, radius: float, angle: float, step: float, count: int) -> list[Point]:
    """Places on a circle from an angle on, a step apart [deg]."""
    return [along(center, angle + number * step, radius) for number in range(count)]


def along(start: Point, angle: float, distance: float) -> Point:
    """The place that lies so far from another one at an angle [deg]."""
    cosine, sine = direction(angle)
    return (start[0] + distance * cosine, start[1] + distance * sine)


def grid(
    start: Point,
    angles: tuple[float, float],
    spacing: tuple[float, float],
    counts: tuple[int, int],
    *,
    frame: bool = False,
) -> list[Point]:
    """Columns and lines, every other line backwards.

    Args:
        start: The first place.
        angles: Of the lines against the abscissa, of the columns against the ordinate [deg].
        spacing: Between columns and between lines [mm].
        frame: Only those at the edge.
    """
    (cosine, sine), (up, aside) = direction(angles[0]), direction(angles[1])
    columns, lines = counts
    places = list[Point]()
    for line in range(lines):
        order = range(columns) if line % 2 == 0 else range(columns - 1, -1, -1)
        for column in order:
            if frame and 0 < line < lines - 1 and 0 < column < columns - 1:
                continue
            across, high = column * spacing[0], line * spacing[1]
            x = start[0] + across * cosine - high * aside
            places.append((x, start[1] + across * sine + high * up))
    return places


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
