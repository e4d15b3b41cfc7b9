"""Parabolas and ellipses of CODESYS SoftMotion, drawn as chords.

The canonical moves know lines and arcs; a curve becomes chords that leave it by at most
``CHORD_ERROR``. Decision: parabola and ellipse as the manual's words suggest; see each function.
"""

import math
from collections.abc import Callable

from twin.nc.arcs import Point, direction
from twin.nc.circular import start_and_end
from twin.nc.control import Control
from twin.nc.dialect import Interpolation

CHORD_ERROR = 5e-4
"""Largest distance of a chord from its curve [mm]: half a micrometre, below what a mill resolves."""

_MOST_CHORDS = 20_000


def parabola(control: Control) -> None:
    """G6 X Y I J: from the start to X Y with the tangents of both ends meeting at I J.

    Decision: I J (relative to the start, or absolute with G98) is the point where the tangents
    meet, which defines a parabola through both ends uniquely.
    """
    target = control.target()
    start, end = start_and_end(control, target)
    apex = _in_plane_point(control)

    def at(u: float) -> Point:
        a, b, c = (1.0 - u) ** 2, 2.0 * u * (1.0 - u), u * u
        return (
            a * start[0] + b * apex[0] + c * end[0],
            a * start[1] + b * apex[1] + c * end[1],
        )

    second = math.hypot(start[0] - 2.0 * apex[0] + end[0], start[1] - 2.0 * apex[1] + end[1])
    _draw(control, target, at, math.sqrt(second / (4.0 * CHORD_ERROR)))


def _ellipse(control: Control, *, clockwise: bool) -> None:
    """G8, G9 X Y I J K R: about I J, the main axis at angle K, R = short by long half axis.

    Raises:
        ProgramError: The end does not lie on the ellipse through the start.
    """
    axis_angle, ratio = control.take_number("K"), control.take("R")
    if ratio is None or not 0.0 < control.number(ratio) <= 1.0:
        control.fail("ellipse-ratio", "an ellipse needs R, above 0 and up to 1", ratio)
    target = control.target()
    start, end = start_and_end(control, target)
    center = _in_plane_point(control)
    cosine, sine = direction(axis_angle)
    flat = control.number(ratio)

    def squeezed(point: Point) -> Point:
        x, y = point[0] - center[0], point[1] - center[1]
        return (cosine * x + sine * y, (cosine * y - sine * x) / flat)

    first, last = squeezed(start[:2]), squeezed(end[:2])
    half = math.hypot(*first)
    if half < 1e-6 or abs(half - math.hypot(*last)) > 0.01:
        control.fail("ellipse-end", "start and end do not lie on one ellipse about this centre")
    from_angle = math.atan2(first[1], first[0])
    turn = math.atan2(
        first[0] * last[1] - first[1] * last[0], first[0] * last[0] + first[1] * last[1]
    )
    if clockwise and turn >= -1e-9:
        turn -= 2.0 * math.pi
    elif not clockwise and turn <= 1e-9:
        turn += 2.0 * math.pi

    def at(u: float) -> Point:
        x = half * math.cos(from_angle + u * turn)
        y = half * flat * math.sin(from_angle + u * turn)
        return (center[0] + cosine * x - sine * y, center[1] + sine * x + cosine * y)

    _draw(control, target, at, abs(turn) * math.sqrt(half / (8.0 * CHORD_ERROR)))


def _in_plane_point(control: Control) -> Point:
    words = {letter: control.take(letter) for letter in "IJ"}
    if not any(words.values()):
        control.fail("arc-without-center", "the curve needs I and J")
    i, j = (control.length(words[letter]) for letter in "IJ")
    if control.modal.center_absolute:
        return (i, j)
    start = control.modal.plane.local(control.programmed)
    return (start.abscissa + i, start.ordinate + j)


def _draw(
    control: Control, target: list[float], at: Callable[[float], Point], chords: float
) -> None:
    count = max(1, math.ceil(chords))
    if count > _MOST_CHORDS:
        control.fail("curve-size", f"the curve would need {count} chords")
    plane, before = control.modal.plane, list(control.programmed)
    for number in range(1, count):
        u = number / count
        point = [a + u * (b - a) for a, b in zip(before, target, strict=True)]
        point[:3] = plane.world(*at(u), plane.local(point).height)
        control.line_to(point, rapid=False)
    control.line_to(target, rapid=False)


def clockwise_ellipse(control: Control) -> None:
    """G8."""
    _ellipse(control, clockwise=True)


def counter_clockwise_ellipse(control: Control) -> None:
    """G9."""
    _ellipse(control, clockwise=False)


PARABOLA = Interpolation(parabola)
CLOCKWISE_ELLIPSE = Interpolation(clockwise_ellipse)
COUNTER_CLOCKWISE_ELLIPSE = Interpolation(counter_clockwise_ellipse)
