"""Polar coordinates in a plane: R and Q as they were programmed last, and where they lead."""

from twin.nc.geometry.arcs import SAME_POINT, Point, angle_of, direction, distance


def seen_from(origin: Point, here: Point, radius: float, angle: float) -> tuple[float, float]:
    """R and Q of a point: as programmed last, else (NaN) measured from the origin [mm, deg]."""
    if radius != radius:
        radius = distance(origin, here)
    if angle != angle:
        angle = angle_of(here, origin)
    return radius, angle


def changed(
    seen: int, old: tuple[float, float], words: tuple[float, float], relative: tuple[bool, bool]
) -> tuple[float, float]:
    """R and Q of where a block goes.

    Args:
        seen: 1 where it has R, 2 with Q, 3 with both.
        old: R and Q of where the tool is [mm, deg].
        words: The values of both words [mm, deg].
        relative: Whether they count from there.
    """
    radius, angle = old
    if seen & 1:
        radius = radius + words[0] if relative[0] else words[0]
    if seen & 2:
        angle = angle + words[1] if relative[1] else words[1]
    return radius, angle


def point_at(origin: Point, here: Point, radius: float, angle: float) -> Point:
    """Where R and Q lead [mm]: to where the tool is already, if that is the same but for rounding."""
    cosine, sine = direction(angle)
    end = (origin[0] + radius * cosine, origin[1] + radius * sine)
    return here if distance(here, end) < SAME_POINT / 1000.0 else end
