"""Places of the plane as words say them: by a radius and an angle about a pole, or by one coordinate and an angle."""

from twin.nc.control.control import Control
from twin.nc.geometry.arcs import SAME_POINT, Point, angle_of, direction, distance
from twin.nc.text.blocks import Word


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


def aim_by_polar(
    control: Control,
    target: list[float],
    pole: Point,
    last: tuple[float, float],
    words: tuple[Word | None, Word | None],
    *,
    incremental: bool = False,
) -> tuple[float, float]:
    """Aim a target at the place that a polar radius and a polar angle name; one that is missing stays as it was.

    Args:
        target: Programmed position, shape (k,); its place in the plane is put in.
        pole: In the plane [mm].
        last: Radius and angle as they were programmed last; NaN: they are measured [mm, deg].
        incremental: Both count from where the tool is; else each by its own word.

    Returns:
        The new radius and angle [mm, deg].

    Raises:
        ProgramError: The radius is below 0.
    """
    plane, (radius_word, angle_word) = control.modal.plane, words
    here = plane.point(control.motion.programmed)
    seen = (radius_word is not None) + 2 * (angle_word is not None)
    given = (control.length(radius_word), control.number(angle_word))
    first, second = (incremental or (word is not None and word.incremental) for word in words)
    radius, angle = changed(seen, seen_from(pole, here, *last), given, (first, second))
    if radius < 0.0:
        control.fail("polar-radius", f"the polar radius {radius:g} is below 0", radius_word)
    plane.aim(target, point_at(pole, here, radius, angle))
    return radius, angle


def aim_by_angle(control: Control, target: list[float], word: Word, *, from_abscissa: bool) -> None:
    """Aim a target of one coordinate, the abscissa or the ordinate, so that a line leaves the start at an angle."""
    plane = control.modal.plane
    cosine, sine = direction(control.number(word))
    along, across = (cosine, sine) if from_abscissa else (sine, cosine)
    if abs(along) < SAME_POINT:
        control.fail("chord-angle", "in this direction the coordinate is never reached", word)
    start, end = plane.point(control.motion.programmed), plane.point(target)
    if from_abscissa:
        plane.aim(target, (end[0], start[1] + (end[0] - start[0]) * across / along))
    else:
        plane.aim(target, (start[0] + (end[1] - start[1]) * across / along, end[1]))
