"""Splines, parabolas and ellipses of CODESYS SoftMotion, drawn as chords.

The canonical moves know lines and arcs; a curve becomes chords that leave it by at most
``CHORD_ERROR``.
"""

import math
from collections.abc import Callable

from twin.nc.control.codes import Interpolation
from twin.nc.control.control import Control
from twin.nc.geometry.arcs import Point, direction
from twin.nc.geometry.planes import XY
from twin.nc.iso.base import draw_curve
from twin.nc.iso.circular import start_and_end
from twin.nc.path.splines import CHORD_ERROR

_SAME_DISTANCE = 1e-6
"""Distances from an ellipse's axis that differ by less leave its shape open [mm]."""


def flat_spline(control: Control) -> None:
    """G5: the next point of a spline in X Y; Z goes linearly."""
    _refuse_switches(control)
    control.motion.spline_to(control.target(), control.block, flat=True)


def spatial_spline(control: Control) -> None:
    """G10: the next point of a spline in space."""
    _refuse_switches(control)
    _refuse_loops(control, "a spline in space")
    control.motion.spline_to(control.target(), control.block, flat=False)


def parabola(control: Control) -> None:
    """G6 X Y I J: from the start to X Y; I J is the vertex.

    There the tangent is parallel to the chord (manual): as a Bézier curve of degree 2 the parabola
    has its vertex at half its parameter, so that its middle control point follows.
    """
    _refuse_other_planes(control)
    target = control.target()
    start, end = start_and_end(control, target)
    vertex = _in_plane_point(control)
    apex = tuple(2.0 * v - 0.5 * (a + b) for v, a, b in zip(vertex, start, end, strict=False))

    def at(u: float) -> Point:
        a, b, c = (1.0 - u) ** 2, 2.0 * u * (1.0 - u), u * u
        return (a * start[0] + b * apex[0] + c * end[0], a * start[1] + b * apex[1] + c * end[1])

    second = math.hypot(start[0] - 2.0 * apex[0] + end[0], start[1] - 2.0 * apex[1] + end[1])
    _draw(control, target, at, math.sqrt(second / (4.0 * CHORD_ERROR)))


def ellipse(control: Control, *, clockwise: bool) -> None:
    """G8, G9 X Y I J K R: about I J, the main axis at angle K.

    Start and end fix the shape; where they are equally far from the main axis, R does, the short
    by the long half axis (manual). An ellipse that does not exist becomes a line.
    """
    _refuse_other_planes(control)
    _refuse_loops(control, "an ellipse")
    axis_angle, ratio = control.number(control.take("K")), control.take("R")
    if ratio is not None and not 0.0 < control.number(ratio) <= 1.0:
        control.fail("ellipse-ratio", "R of an ellipse lies above 0 and up to 1", ratio)
    target = control.target()
    start, end = start_and_end(control, target)
    center = _in_plane_point(control)
    cosine, sine = direction(axis_angle)

    def turned(point: Point) -> Point:
        x, y = point[0] - center[0], point[1] - center[1]
        return (cosine * x + sine * y, cosine * y - sine * x)

    first, last = turned(start), turned(end)
    if abs(abs(first[1]) - abs(last[1])) < _SAME_DISTANCE:
        if ratio is None:
            hint = "write R, the short by the long half axis"
            control.fail("ellipse-ratio", "these points leave the ellipse's shape open", None, hint)
        fits = abs(abs(first[0]) - abs(last[0])) < _SAME_DISTANCE
        flat = control.number(ratio) if fits else 0.0
    else:
        flat = _flatness(first, last)
    half = math.hypot(first[0], first[1] / flat) if flat > 0.0 else 0.0
    if half < _SAME_DISTANCE:
        message = "no ellipse about this centre passes start and end: a straight line instead"
        control.warn("arc-replaced", message)
        control.line_to(target, rapid=False)
        return
    before, behind = (first[0], first[1] / flat), (last[0], last[1] / flat)
    from_angle = math.atan2(before[1], before[0])
    turn = math.atan2(
        before[0] * behind[1] - before[1] * behind[0], before[0] * behind[0] + before[1] * behind[1]
    )
    if clockwise and turn >= -1e-9:
        turn -= 2.0 * math.pi
    elif not clockwise and turn <= 1e-9:
        turn += 2.0 * math.pi

    def at(u: float) -> Point:
        x = half * math.cos(from_angle + u * turn)
        y = half * flat * math.sin(from_angle + u * turn)
        return (center[0] + cosine * x - sine * y, center[1] + sine * x + cosine * y)

    largest = half * max(1.0, flat)
    _draw(control, target, at, abs(turn) * math.sqrt(largest / (8.0 * CHORD_ERROR)))


def _flatness(first: Point, last: Point) -> float:
    """Half axis across by half axis along of the ellipse through two points; 0 if there is none.

    From u² / a² + v² / b² = 1 for both: (b / a)² = (v_1² - v_2²) / (u_2² - u_1²).
    """
    along = last[0] ** 2 - first[0] ** 2
    square = (first[1] ** 2 - last[1] ** 2) / along if along else 0.0
    return math.sqrt(square) if square > 0.0 else 0.0


def _refuse_other_planes(control: Control) -> None:
    if control.modal.plane is not XY:
        message = "parabolas and ellipses lie in the plane X Y"
        control.fail("curve-plane", message, hint="write G15 or G17 before")


def _refuse_switches(control: Control) -> None:
    if control.series:
        message = "a switch point cannot lie on a curve that is drawn as chords"
        control.fail("switch-point", message, control.series[0])


def _refuse_loops(control: Control, what: str) -> None:
    if control.path.cutting_loops:
        control.fail("loops", f"{what} cannot stand where loops are cut out", hint="write G60")


def _in_plane_point(control: Control) -> Point:
    words = {letter: control.take(letter) for letter in "IJ"}
    if not any(words.values()):
        control.fail("arc-without-center", "the curve needs I and J")
    i, j = (control.length(words[letter]) for letter in "IJ")
    if control.modal.center_absolute:
        return (i, j)
    start = control.modal.plane.local(control.motion.programmed)
    return (start.abscissa + i, start.ordinate + j)


def _draw(
    control: Control, target: list[float], at: Callable[[float], Point], chords: float
) -> None:
    _refuse_switches(control)
    draw_curve(control, target, at, max(1, math.ceil(chords)))


FLAT_SPLINE = Interpolation(flat_spline)
SPATIAL_SPLINE = Interpolation(spatial_spline)
PARABOLA = Interpolation(parabola)
CLOCKWISE_ELLIPSE = Interpolation(lambda control: ellipse(control, clockwise=True))
COUNTER_CLOCKWISE_ELLIPSE = Interpolation(lambda control: ellipse(control, clockwise=False))
