"""Places of the plane as words say them: by a radius and an angle about a pole, or by one coordinate and an angle."""

from twin.nc.control.control import Control
from twin.nc.geometry.arcs import SAME_POINT, Point, direction
from twin.nc.geometry.polar import changed, point_at, seen_from
from twin.nc.text.blocks import Word


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
    """Aim a target of one coordinate, the abscissa or the ordinate, so that a line leaves the start at an angle.

    Raises:
        ProgramError: In that direction the coordinate is never reached.
    """
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
