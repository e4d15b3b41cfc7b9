"""Path functions: L, C, CR, CT, LP, CP, CTP and the pole CC."""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from twin.nc.control.codes import Interpolation, StatementAction
from twin.nc.control.control import Control
from twin.nc.control.modal import LineRule
from twin.nc.dialects.heidenhain.memory import memory_of
from twin.nc.dialects.heidenhain.paths.corners import refuse_chamfered_arc
from twin.nc.geometry.arcs import (
    SAME_POINT,
    Bounds,
    Point,
    angle_of,
    distance,
    turned,
)
from twin.nc.geometry.planes import PLANE_ORDER
from twin.nc.iso.circular import (
    center_of_radius,
    fitted_center,
    start_and_end,
    sweep_arc,
    tangent_arc_to,
)
from twin.nc.iso.machine_coordinates import machine_frame
from twin.nc.iso.offsets import offset_of_job
from twin.nc.iso.orientation.tool_center import point_by_words
from twin.nc.iso.polar_words import aim_by_polar
from twin.nc.text.blocks import Statement


def take_vector(control: Control) -> None:
    """TX, TY and TZ of LN point the tool; NX, NY and NZ are normals of the surface, which move nothing by themselves.

    Raises:
        ProgramError: The tool has another size than the program's, by which the normal would move it, or no tip is led.
    """
    normal, vector = ([control.take(f"{kind}{axis}") for axis in "XYZ"] for kind in "NT")
    deltas = memory_of(control).deltas
    if any(word is not None for word in normal) and (deltas.radius or deltas.length):
        message = "compensation along a surface normal (DR, DL of TOOL CALL) is not followed in LN"
        control.fail("tool-center", message, next(word for word in normal if word is not None))
    first = next((word for word in vector if word is not None), None)
    if first is None:
        return
    if control.path.tool_center is None:
        message = "a vector of the tool needs its tip led"
        control.fail("tool-center", message, first, "M128 or FUNCTION TCPM before")
    x, y, z = (control.number(word) for word in vector)
    point_by_words(control, (x, y, z), first)


MOTION_WORDS = frozenset("XYZABCUVW") | {"PR", "PA", "DR+", "DR-", "R"}
"""Addresses that make a block move."""

BOUNDS = Bounds(mismatch=0.016, mismatch_share=0.0, shift=0.1, shift_share=0.01)
"""Start and end of C lie on one circle but for 0.016 mm (manual, C).

Decision: the centre is moved to fit, as far as in the base.
"""

SAME_ANGLE = 1e-9
"""Angles nearer than this are one [deg]: rounding of what was computed."""

_MEASURED = (math.nan, math.nan)
"""A polar radius and an angle that are those of where the tool is."""
After = Callable[[Control, list[float]], None]


def path_function(interpolation: Interpolation, after: After) -> StatementAction:
    """A keyword whose block moves."""

    def action(control: Control, statement: Statement) -> None:
        memory, modal = memory_of(control), control.modal
        written = {word.address for word in control.block.words}
        if interpolation is not LINE and MOTION_WORDS.isdisjoint(written):
            message = f"{statement.keyword} needs the words of its move"
            control.fail("missing-words", message, statement)
        modal.interpolation, start = interpolation, list(control.motion.programmed)
        control.run(control.block._replace(statement=None))
        modal.interpolation = LINE
        memory.rapid, memory.machine = False, ""
        after(control, start)

    return action


# --- lines


def _line(control: Control) -> None:
    """L: also from machine zero, by M91, or from the datum of the machine's builder, by M92."""
    memory = memory_of(control)
    if not memory.machine:
        control.line_to(control.target(), rapid=memory.rapid)
        return
    zero = None
    if memory.machine == "M92":
        zero = offset_of_job(control, "M92", control.block.words[-1])
    with machine_frame(control, memory.machine, zero):
        control.line_to(control.target(), rapid=memory.rapid)


LINE = Interpolation(_line, rule=LineRule())


def _line_by_vectors(control: Control) -> None:
    """LN: L with the normal of the surface, and the direction of the tool."""
    take_vector(control)
    _line(control)


LINE_BY_VECTORS = Interpolation(_line_by_vectors)


def _polar_line(control: Control) -> None:
    """LP: to the point at PR and PA about the pole."""
    with circle_plane(control) as pole:
        control.line_to(polar_target(control, pole), rapid=memory_of(control).rapid)


POLAR_LINE = Interpolation(_polar_line)


def polar_target(control: Control, pole: Point) -> list[float]:
    """Take PR, PA and the other axes; missing ones of both stay as they are."""
    words = (control.take("PR"), control.take("PA"))
    target = control.target()
    aim_by_polar(control, target, pole, _MEASURED, words)
    return target


# --- the pole


def pole_alone(control: Control, _statement: Statement) -> None:
    """CC, in a block of its own."""
    memory, modal = memory_of(control), control.modal
    if not control.block.words:
        set_pole(control)
        return
    modal.interpolation = POLE
    control.run(control.block._replace(statement=None))
    modal.interpolation = LINE
    memory.rapid = False


def set_pole(control: Control) -> None:
    """CC: its axes name the plane; without any the pole is where the tool is.

    Decision: of one coordinate alone the other stays that of the last pole.
    """
    memory, given = memory_of(control), control.take_axis_words()
    if not given:
        memory.pole = dict(enumerate(control.motion.programmed[:3]))
        memory.circle_plane = None
        return
    columns = {index for index, _ in given}
    if not columns <= {0, 1, 2} or len(columns) > 2:
        control.fail("pole", "CC names two of the axes X, Y and Z", given[-1][1])
    for index, word in given:
        value = control.axis_value(index, word)
        memory.pole[index] = value + (control.motion.programmed[index] if word.incremental else 0.0)
    if len(columns) == 2:
        planes = (plane for plane in PLANE_ORDER if columns == set(plane.axes[:2]))
        memory.circle_plane = next(planes)


POLE = Interpolation(set_pole)


@contextmanager
def circle_plane(control: Control) -> Iterator[Point]:
    """Let the plane of CC be the working plane; the pole in it."""
    memory, kept = memory_of(control), control.modal.plane
    plane = memory.circle_plane or kept
    first, second, _ = plane.axes
    if first not in memory.pole or second not in memory.pole:
        names = control.settings.axes.names
        hint = f"write CC {names[first]}+0 {names[second]}+0 before"
        control.fail("pole", "no pole is set", hint=hint)
    control.modal.plane = plane
    yield memory.pole[first], memory.pole[second]
    control.modal.plane = kept


# --- arcs


def take_sense(control: Control) -> bool:
    """Take DR; whether the arc is clockwise."""
    left, right = control.take("DR+"), control.take("DR-")
    if (left is None) == (right is None):
        hint = "DR+ turns counter-clockwise, DR- clockwise"
        control.fail("arc-direction", "an arc needs its direction, DR+ or DR-", right, hint)
    return right is not None


def _begin_arc(control: Control) -> None:
    memory = memory_of(control)
    if memory.rapid:
        control.fail("rapid-arc", "an arc is not driven with FMAX", hint="write F and the feed")
    if memory.chamfered is not None and memory.chamfered is control.motion.last:
        refuse_chamfered_arc(control)


def _arc(control: Control) -> None:
    """C: about the pole to the end, or all around where it ends where it begins."""
    _begin_arc(control)
    with circle_plane(control) as pole:
        clockwise, target = take_sense(control), control.target()
        center = fitted_center(control, start_and_end(control, target), pole, BOUNDS, None)
        sweep_arc(control, target, center, clockwise=clockwise)


def _arc_by_radius(control: Control) -> None:
    """CR: of the radius R; a negative one draws the arc beyond 180°."""
    _begin_arc(control)
    word = control.take("R")
    if word is None:
        control.fail("arc-radius", "CR needs its radius R", hint="CR X+10 Y+20 R+5 DR-")
    clockwise, target = take_sense(control), control.target()
    ends = start_and_end(control, target)
    radius = control.length(word)
    center = center_of_radius(control, *ends, radius, word, clockwise=clockwise)
    sweep_arc(control, target, center, clockwise=clockwise)


def _tangent_arc_to(control: Control, name: str, target: list[float]) -> None:
    """An arc that goes on where the last move was going; a line where that leads to its end."""
    if control.path.leads is not None:
        message = f"{name} needs a move of the contour before it, which says where to"
        control.fail("tangent-arc", message)
    tangent_arc_to(control, target, name, or_straight=True)


def _tangent_arc(control: Control) -> None:
    """CT."""
    _begin_arc(control)
    _tangent_arc_to(control, "CT", control.target())


def _polar_tangent_arc(control: Control) -> None:
    """CTP."""
    _begin_arc(control)
    with circle_plane(control) as pole:
        _tangent_arc_to(control, "CTP", polar_target(control, pole))


def _polar_arc(control: Control) -> None:
    """CP: about the pole to the angle PA, or by IPA, also by more than a turn; a helix with the axis across."""
    _begin_arc(control)
    word = control.take("PA")
    if word is None:
        control.fail("missing-words", "CP needs PA or IPA", hint="CP IPA+360 IZ-2 DR+ is a helix")
    with circle_plane(control) as pole:
        clockwise, target = take_sense(control), control.target()
        plane = control.modal.plane
        start, value = plane.point(control.motion.programmed), control.number(word)
        if distance(start, pole) < SAME_POINT:
            control.fail("arc-center", "the arc begins in its pole", word)
        sweep = value
        if not word.incremental:
            ahead = (value - angle_of(start, pole)) % 360.0
            ahead = 0.0 if min(ahead, 360.0 - ahead) < SAME_ANGLE else ahead
            sweep = ahead - 360.0 if clockwise else ahead or 360.0
        elif value == 0.0 or (value < 0.0) is not clockwise:
            message = f"IPA and DR have the same sign, and {word.text} has not"
            control.fail("arc-direction", message, word, hint="IPA+90 DR+ or IPA-90 DR-")
        plane.aim(target, turned(start, pole, sweep))
        control.arc_to(target, pole, sweep)


ARC = Interpolation(_arc)
ARC_BY_RADIUS = Interpolation(_arc_by_radius)
TANGENT_ARC = Interpolation(_tangent_arc)
POLAR_ARC = Interpolation(_polar_arc)
POLAR_TANGENT_ARC = Interpolation(_polar_tangent_arc)

KEYWORDS: dict[str, Interpolation] = {
    "L": LINE,
    "LN": LINE_BY_VECTORS,
    "LP": POLAR_LINE,
    "C": ARC,
    "CR": ARC_BY_RADIUS,
    "CT": TANGENT_ARC,
    "CP": POLAR_ARC,
    "CTP": POLAR_TANGENT_ARC,
}
"""Path functions by their keyword."""
