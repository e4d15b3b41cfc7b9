"""Lines and arcs of the Fagor CNC 8070: Cartesian, polar, radius, centre, helix.

The rule for R in an arc block: with a coordinate of the plane R is the circle's radius, without
one it is the polar radius.
"""

import math

from twin.nc.control.codes import Interpolation
from twin.nc.control.control import Control
from twin.nc.control.modal import ArcRule
from twin.nc.dialects.fagor8070.memory import memory_of
from twin.nc.dialects.fagor8070.polar import Goal, forget_polar, take_goal
from twin.nc.geometry import arcs
from twin.nc.geometry.arcs import SAME_POINT, TURN, Point, distance, sweep_between, turned
from twin.nc.geometry.planes import OWN_PLANE
from twin.nc.iso import base
from twin.nc.iso.circular import (
    BOUNDS,
    both_senses,
    center_of_radius,
    fitted_center,
    refuse_arc,
    start_and_end,
    sweep_arc,
    take_center,
    tangent_arc_to,
)
from twin.nc.text.blocks import Word

HELIX_ANGLE = 0.1
"""A helix whose pitch misses its end point by more than this earns a warning [deg]."""

MOST_TURNS = 1000
"""Turns of one helix: a thread has a hundred, and a pitch that asks for more is a slip of the pen."""


def _line(control: Control, rapid: bool) -> None:
    control.line_to(take_goal(control, arc=False).target, rapid=rapid)


def _arc(control: Control, rule: ArcRule) -> None:
    clockwise = rule.clockwise
    if memory_of(control).temporary:
        _arc_about_own_center(control, clockwise=clockwise)
        return
    plane = control.modal.plane
    names = control.settings.axes.names
    cartesian = any(names[index] in control.words for index in plane.axes[:2])
    circle = _circle_radius(control, cartesian=cartesian)
    letters = _center_letters(control)
    pitch = control.take(letters[2]) if names[plane.axes[2]] in control.words else None
    centre = take_center(control, letters[:2])
    goal = take_goal(control, arc=True)
    start, end = start_and_end(control, goal.target)
    memory = memory_of(control)
    if circle is not None:
        if centre.words:
            refuse_arc(control, arcs.OVERDEFINED, circle)
        value = control.length(circle)
        center = center_of_radius(control, start, end, value, circle, clockwise=clockwise)
    elif memory.circle_radius is not None and not centre.words and not goal.polar:
        center = center_of_radius(
            control, start, end, memory.circle_radius, None, clockwise=clockwise
        )
    elif centre.words:
        center = _given_center(control, centre.words, start)
    elif goal.polar:
        center = memory_of(control).polar_origin
    else:
        message = "the arc has neither a centre nor a radius"
        hint = f"write {letters[0]} and {letters[1]}, or R"
        control.fail("arc-without-center", message, hint=hint)
    if centre.words or goal.polar:
        memory.circle_radius = None
    if goal.in_plane or pitch is None:
        word = centre.words[0] if centre.words else None
        fitted = fitted_center(control, (start, end), center, rule.bounds, word)
        if control.modal.correct_center:
            center = fitted
        else:
            _end_on_circle(control, goal, center)
    _sweep(control, goal, center, pitch, clockwise=clockwise)


def _end_on_circle(control: Control, goal: Goal, center: Point) -> None:
    """G264: the centre stays, the radius is the start's, and the end moves onto this circle."""
    start, end = start_and_end(control, goal.target)
    far = distance(start, center) / distance(end, center)
    onto = (center[0] + (end[0] - center[0]) * far, center[1] + (end[1] - center[1]) * far)
    if onto != end:
        control.modal.plane.aim(goal.target, onto)
        forget_polar(control)


def _circle_radius(control: Control, *, cartesian: bool) -> Word | None:
    """R with a coordinate of the plane, or R1, which stays in force as G263 does."""
    modal = control.take("R1")
    if modal is not None:
        if not cartesian:
            control.fail("polar-radius", "a polar radius is written R, not R1", modal)
        memory_of(control).circle_radius = control.length(modal)
        return modal
    return control.take("R") if cartesian else None


def set_circle_radius(control: Control, word: Word) -> None:
    """G263=50: the radius of the arcs that follow, until a centre or a polar move."""
    memory_of(control).circle_radius = control.length(word)


def tangent_arc(control: Control) -> None:
    """G08: the arc that leaves the last move along its direction."""
    if control.motion.direction is None:
        control.fail("tangent-arc", "G08 needs a move before it")
    tangent_arc_to(control, take_goal(control, arc=True).target, "G08")


def three_point_arc(control: Control) -> None:
    """G09 X Y I J: the arc through the point I J, given as coordinates by G90 or G91."""
    letters = _center_letters(control)
    words = [control.take(letter) for letter in letters[:2]]
    if None in words:
        message = f"G09 needs the point {letters[0]} {letters[1]} that the arc passes"
        control.fail("three-point-arc", message)
    goal = take_goal(control, arc=True)
    start, end = start_and_end(control, goal.target)
    abscissa, ordinate = (control.length(word) for word in words)
    via = (abscissa, ordinate)
    if control.modal.incremental:
        via = (start[0] + abscissa, start[1] + ordinate)
    center = arcs.center_through(start, via, end)
    if center is None:
        control.fail("three-point-arc", "the three points lie on a line", words[0])
    side = (via[0] - start[0]) * (end[1] - start[1]) - (via[1] - start[1]) * (end[0] - start[0])
    sweep_arc(control, goal.target, center, clockwise=side < 0.0)


def _sweep(
    control: Control, goal: Goal, center: Point, pitch: Word | None, *, clockwise: bool
) -> None:
    plane = control.modal.plane
    start, end = start_and_end(control, goal.target)
    sweep = sweep_between(start, end, center, clockwise=clockwise)
    if pitch is not None:
        height = plane.local(goal.target).height - plane.local(control.motion.programmed).height
        wanted = _helix_sweep(control, height, pitch, clockwise=clockwise)
        if goal.in_plane:
            turns = max(0, round((abs(wanted) - abs(sweep)) / TURN))
            sweep = math.copysign(abs(sweep) + turns * TURN, sweep)
            if abs(abs(sweep) - abs(wanted)) > HELIX_ANGLE:
                control.warn(
                    "helix-pitch",
                    f"the pitch asks for {abs(wanted) / TURN:.4f} turns, end point and height for "
                    f"{abs(sweep) / TURN:.4f}: these win",
                    pitch,
                )
        else:
            if wanted == 0.0:
                control.fail("helix-height", "a helix by its pitch alone needs a height", pitch)
            sweep = wanted
            plane.aim(goal.target, turned(start, center, sweep))
            forget_polar(control)
    control.arc_to(goal.target, center, sweep)


def _helix_sweep(control: Control, height: float, pitch: Word, *, clockwise: bool) -> float:
    size = abs(control.length(pitch))
    if size == 0.0:
        control.fail("helix-pitch-zero", "the pitch of a helix must not be 0", pitch)
    sweep = TURN * abs(height) / size
    if sweep > MOST_TURNS * TURN:
        message = f"the pitch asks for {sweep / TURN:.0f} turns; {MOST_TURNS} are possible"
        control.fail("helix-turns", message, pitch, "write the height in several blocks")
    return -sweep if clockwise else sweep


def _center_letters(control: Control) -> str:
    """Centre words along abscissa, ordinate and normal of the working plane."""
    plane = control.modal.plane
    return "IJK" if plane.name == OWN_PLANE else "".join("IJK"[index] for index in plane.axes)


def _given_center(control: Control, words: tuple[Word, ...], start: Point) -> Point:
    letters = _center_letters(control)
    values = {word.address: control.length(word) for word in words}
    first, second = (values.get(letter, math.nan) for letter in letters[:2])
    return arcs.programmed_center(start, first, second, control.modal.center_absolute)


def _arc_about_own_center(control: Control, *, clockwise: bool) -> None:
    """G31 G02/G03 Q I J: Q is seen from the arc's centre, the radius is the arc's."""
    memory_of(control).temporary = False
    radius, angle = control.take("R"), control.take("Q")
    letters = _center_letters(control)
    centre = take_center(control, letters[:2])
    if radius is not None:
        control.fail("temporary-origin", "with G31 the radius is the arc's own", radius)
    if angle is None or not centre.words:
        message = f"G31 needs Q and {letters[0]} or {letters[1]}"
        control.fail("temporary-origin", message, control.code_word(31))
    plane = control.modal.plane
    start = plane.point(control.motion.programmed)
    center = _given_center(control, centre.words, start)
    if distance(start, center) < SAME_POINT:
        control.fail("arc-center", "the centre lies on the arc's start", centre.words[0])
    value = control.number(angle)
    incremental = control.modal.incremental or angle.incremental
    by = value if incremental else value - arcs.angle_of(start, center)
    end = turned(start, center, by)
    target = control.target()
    plane.aim(target, end)
    forget_polar(control)
    sweep = sweep_between(start, end, center, clockwise=clockwise)
    control.arc_to(target, center, sweep)


POSITIONING, LINEAR = base.straight(_line)
CLOCKWISE, COUNTER_CLOCKWISE = both_senses(_arc, ArcRule(bounds=BOUNDS, fits_radius=True))
TANGENT = Interpolation(tangent_arc)
THREE_POINTS = Interpolation(three_point_arc)
