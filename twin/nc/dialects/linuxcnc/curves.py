"""Splines of LinuxCNC, drawn as chords: cubic (G5), quadratic (G5.1), NURBS (G5.2, G5.3)."""

import itertools
import math
from collections.abc import Sequence

from twin.nc.control.codes import Interpolation
from twin.nc.control.control import Control
from twin.nc.dialects.linuxcnc.memory import ControlPoint, memory_of
from twin.nc.dialects.linuxcnc.motion import check_feed, need_axes, require_axes
from twin.nc.dialects.linuxcnc.offsets import refuse_in_compensation
from twin.nc.geometry.arcs import Point
from twin.nc.geometry.planes import XY
from twin.nc.iso.base import draw_curve
from twin.nc.path.splines import CHORD_ERROR, MOST_CHORDS

DEFAULT_ORDER = 3
"""Order of a NURBS without L."""
CHORDS_OF_A_PART = 60
"""A NURBS is drawn by so many chords for each of its control points."""


def _begin(control: Control, code: str) -> list[float]:
    """Check what all curves need; the programmed end, shape (k,)."""
    refuse_in_compensation(control)
    check_feed(control, False)
    if control.modal.plane is not XY:
        control.fail("curve-plane", f"{code} lies in the plane of X and Y", hint="write G17 before")
    for letter, word in control.words.items():
        if letter in control.axis_letters and letter not in "XY":
            control.fail("code-words", f"{code} moves X and Y only", word)
    return control.target()


def _bezier(control: Control, goal: list[float], inner: Sequence[Point]) -> None:
    """Draw a Bézier curve from here to the goal, given its control points between."""
    points = [
        (control.motion.programmed[0], control.motion.programmed[1]),
        *inner,
        (goal[0], goal[1]),
    ]
    degree = len(points) - 1
    bend = max(
        math.hypot(a[0] - 2.0 * b[0] + c[0], a[1] - 2.0 * b[1] + c[1])
        for a, b, c in zip(points, points[1:], points[2:], strict=False)
    )
    chords = math.sqrt(degree * (degree - 1) * bend / (8.0 * CHORD_ERROR))

    def at(u: float) -> Point:
        left = points
        while len(left) > 1:
            left = [
                ((1.0 - u) * a[0] + u * b[0], (1.0 - u) * a[1] + u * b[1])
                for a, b in itertools.pairwise(left)
            ]
        return left[0]

    draw_curve(control, goal, at, max(1, math.ceil(min(chords, MOST_CHORDS + 1.0))))


def cubic(control: Control) -> None:
    """G5 X Y I J P Q: I J from the start, P Q from the end; without I J on from the spline before."""
    memory, words = memory_of(control), {each: control.take(each) for each in "IJPQ"}
    x, y = control.motion.programmed[:2]
    require_axes(control)
    goal = _begin(control, "G5")
    if words["P"] is None or words["Q"] is None:
        control.fail("code-words", "G5 needs P and Q, from its end to the second control point")
    i, j = control.length(words["I"]), control.length(words["J"])
    if (words["I"] is None) != (words["J"] is None):
        control.fail("code-words", "G5 needs I and J, or neither behind another G5")
    if words["I"] is None:
        if memory.spline_end is None:
            control.fail("code-words", "the first G5 needs I and J")
        i, j = -memory.spline_end[0], -memory.spline_end[1]
    p, q = control.length(words["P"]), control.length(words["Q"])
    _bezier(control, goal, [(x + i, y + j), (goal[0] + p, goal[1] + q)])
    memory.spline_end = (p, q)
    _end_motion(control)


def quadratic(control: Control) -> None:
    """G5.1 X Y I J: I J from the start to the control point."""
    words = {each: control.take(each) for each in "IJ"}
    x, y = control.motion.programmed[:2]
    require_axes(control)
    goal = _begin(control, "G5.1")
    if words["I"] is None or words["J"] is None:
        control.fail("code-words", "G5.1 needs I and J, from its start to the control point")
    i, j = control.length(words["I"]), control.length(words["J"])
    _bezier(control, goal, [(x + i, y + j)])
    _end_motion(control)


def add_control_point(control: Control) -> None:
    """G5.2 X Y P L: a control point with its weight P; L is the order of the NURBS.

    The first control point is where the tool is. Its weight is 1, or P of a first G5.2 without X
    and Y, which adds no other point. An order below 3 counts as 3 (``Interp::convert_nurbs``).
    """
    memory = memory_of(control)
    weight, order = control.take("P"), control.take("L")
    is_point = "X" in control.words
    if is_point != ("Y" in control.words):
        message = "a control point needs both X and Y; G5.2 without them begins a NURBS"
        control.fail("code-words", message)
    goal = _begin(control, "G5.2")
    if memory.control_points and not is_point:
        message = "a NURBS has begun: each further control point needs X, Y and P"
        control.fail("code-words", message, weight)
    value = (0.0 if is_point else 1.0) if weight is None else control.number(weight)
    if value <= 0.0:
        message = "a control point needs its weight P, above 0"
        control.fail("code-words", message, weight, "write P1 where all weigh the same")
    if order is not None:
        memory.spline_order = max(int(control.number(order)), DEFAULT_ORDER)
    if not memory.control_points:
        x, y = control.motion.programmed[:2]
        memory.control_points = [(x, y, 1.0 if is_point else value)]
    if is_point:
        memory.control_points.append((goal[0], goal[1], value))
    memory.control_line = control.block.line


def end_nurbs(control: Control) -> None:
    """G5.3: draw the NURBS through its control points."""
    memory = memory_of(control)
    points, order = memory.control_points, memory.spline_order
    if not points:
        message = "G5.3 ends a NURBS, and none has begun"
        control.fail("code-words", message, hint="write G5.2 before")
    if len(points) < order or order < 1:
        message = f"a NURBS of order {order} needs {order} control points, and has {len(points)}"
        control.fail("code-words", message)
    memory.control_points, memory.spline_order = [], DEFAULT_ORDER
    goal = list(control.motion.programmed)
    goal[0], goal[1] = points[-1][:2]
    knots = _knots(len(points), order)
    count = CHORDS_OF_A_PART * len(points)
    draw_curve(control, goal, lambda u: _point_of(points, knots, order, u * knots[-1]), count)
    control.modal.interpolation = None


def _end_motion(control: Control) -> None:
    """Behind G5 and G5.1 axis words need a code again (``rs274``)."""
    control.modal.interpolation = None
    control.modal.active.put("motion", 80.0)


def _knots(points: int, order: int) -> list[float]:
    """Even knots, those of both ends as often as the order says."""
    parts = points - order + 1
    inner = [float(knot) for knot in range(1, parts)]
    return [0.0] * order + inner + [float(parts)] * order


def _point_of(points: list[ControlPoint], knots: list[float], order: int, u: float) -> Point:
    """A point of a NURBS, by de Boor's algorithm in homogeneous coordinates."""
    part = max(at for at in range(order - 1, len(points)) if knots[at] <= u)
    near = [(x * w, y * w, w) for x, y, w in (points[part - order + 1 + at] for at in range(order))]
    for level in range(1, order):
        for at in range(order - 1, level - 1, -1):
            knot = part - order + 1 + at
            span = knots[knot + order - level] - knots[knot]
            share = (u - knots[knot]) / span if span else 0.0
            x, y, w = (
                (1.0 - share) * a + share * b for a, b in zip(near[at - 1], near[at], strict=True)
            )
            near[at] = (x, y, w)
    x, y, w = near[-1]
    return x / w, y / w


CUBIC = Interpolation(cubic, without_words=need_axes)
QUADRATIC = Interpolation(quadratic, without_words=need_axes)
NURBS = Interpolation(add_control_point, without_words=add_control_point)
