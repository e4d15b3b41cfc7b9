"""Lines and arcs of the Fagor CNC 8070: Cartesian, polar, radius, centre, helix.

The rule for R in an arc block: with a coordinate of the plane R is the circle's radius, without
one it is the polar radius.
"""

import dataclasses
import math

from twin.nc.arcs import (
    SAME_POINT,
    TURN,
    Point,
    angle_of,
    direction,
    distance,
    sweep_between,
    turned,
)
from twin.nc.blocks import Word
from twin.nc.circular import fitted_center, radius_center, start_and_end, take_center
from twin.nc.control import Control
from twin.nc.dialect import Interpolation

HELIX_ANGLE = 0.1
"""A helix whose pitch misses its end point by more than this earns a warning [deg]."""


@dataclasses.dataclass(slots=True)
class Polar:
    """What polar coordinates are measured from, and what was programmed last.

    Attributes:
        origin: In the working plane, from part zero [mm].
        radius: R of the last polar move while it still holds, or None [mm].
        angle: Its Q, or None [deg].
        temporary: G31: this block's origin is the arc's centre.
    """

    origin: Point = (0.0, 0.0)
    radius: float | None = None
    angle: float | None = None
    temporary: bool = False


@dataclasses.dataclass(frozen=True, slots=True)
class Goal:
    """Where a block goes.

    Attributes:
        target: Programmed position, shape (k,).
        in_plane: The block names a point of the plane.
        polar: It does so by R and Q.
    """

    target: list[float]
    in_plane: bool
    polar: bool


def polar_of(control: Control) -> Polar:
    """The dialect's memory."""
    assert isinstance(control.memory, Polar)
    return control.memory


def forget_polar(control: Control) -> None:
    """The last polar values no longer hold: they are seen anew from where the tool stands."""
    polar = polar_of(control)
    polar.radius = polar.angle = None


def reset_polar_origin(control: Control) -> None:
    """A change of plane puts the polar origin back to part zero."""
    polar_of(control).origin = (0.0, 0.0)
    forget_polar(control)


def set_polar_origin(control: Control) -> None:
    """G30: I abscissa and J ordinate of the polar origin; neither: where the tool stands.

    Raises:
        ProgramError: Only one of both is given.
    """
    abscissa, ordinate = control.take("I"), control.take("J")
    if (abscissa is None) != (ordinate is None):
        control.fail("polar-origin", "G30 needs both I and J, or neither", abscissa or ordinate)
    if abscissa is None:
        origin = control.modal.plane.local(control.programmed)[:2]
    else:
        origin = (control.length(abscissa), control.length(ordinate))
    polar_of(control).origin = origin
    forget_polar(control)


def temporary_polar_origin(control: Control) -> None:
    """G31: for this arc the polar origin is its centre."""
    polar_of(control).temporary = True


def current_polar(control: Control) -> tuple[float, float]:
    """R and Q of where the tool stands: as last programmed, else measured [mm, deg]."""
    polar = polar_of(control)
    here = control.modal.plane.local(control.programmed)[:2]
    radius = distance(polar.origin, here) if polar.radius is None else polar.radius
    angle = angle_of(here, polar.origin) if polar.angle is None else polar.angle
    return radius, angle


def take_goal(control: Control, *, arc: bool) -> Goal:
    """Take the words that say where the block goes."""
    names = control.settings.axes.names
    abscissa, ordinate, _ = (names[index] for index in control.modal.plane.axes)
    words = control.words
    cartesian = (abscissa in words) + (ordinate in words)
    if cartesian == 0 and ("R" in words or "Q" in words):
        return Goal(_polar_target(control, arc=arc), in_plane=True, polar=True)
    angle = control.take("Q") if cartesian == 1 else None
    has_abscissa = abscissa in words
    target = control.target()
    if angle is not None:
        _along_angle(control, target, angle, from_abscissa=has_abscissa)
    if cartesian:
        forget_polar(control)
    return Goal(target, in_plane=cartesian > 0, polar=False)


def _polar_target(control: Control, *, arc: bool) -> list[float]:
    polar, plane = polar_of(control), control.modal.plane
    radius, angle = current_polar(control)
    radius_word, angle_word = control.take("R"), control.take("Q")
    target = control.target()
    if radius_word is not None:
        value = control.length(radius_word)
        incremental = control.modal.incremental or radius_word.incremental
        radius = radius + value if incremental else value
        if radius < 0.0 or (arc and radius == 0.0):
            control.fail(
                "polar-radius",
                f"the polar radius {radius:g} must be positive" + ("" if arc else " or 0"),
                radius_word,
            )
    if angle_word is not None:
        value = control.number(angle_word)
        incremental = control.modal.incremental or angle_word.incremental
        angle = angle + value if incremental else value
    cosine, sine = direction(angle)
    end = (polar.origin[0] + radius * cosine, polar.origin[1] + radius * sine)
    start = plane.local(control.programmed)
    if distance(start[:2], end) < SAME_POINT / 1000.0:
        end = start[:2]
    target[:3] = plane.world(*end, plane.local(target).height)
    polar.radius, polar.angle = radius, angle
    return target


def _along_angle(control: Control, target: list[float], word: Word, *, from_abscissa: bool) -> None:
    """One coordinate and Q: the chord leaves the start in the direction Q."""
    plane = control.modal.plane
    cosine, sine = direction(control.number(word))
    along, across = (cosine, sine) if from_abscissa else (sine, cosine)
    if abs(along) < 1e-9:
        control.fail("chord-angle", "in this direction the coordinate is never reached", word)
    start, end = plane.local(control.programmed), plane.local(target)
    if from_abscissa:
        other = start.ordinate + (end.abscissa - start.abscissa) * across / along
        target[:3] = plane.world(end.abscissa, other, end.height)
    else:
        other = start.abscissa + (end.ordinate - start.ordinate) * across / along
        target[:3] = plane.world(other, end.ordinate, end.height)


def rapid_line(control: Control) -> None:
    """G00."""
    control.line_to(take_goal(control, arc=False).target, rapid=True)


def feed_line(control: Control) -> None:
    """G01."""
    control.line_to(take_goal(control, arc=False).target, rapid=False)


def _arc(control: Control, *, clockwise: bool) -> None:
    if polar_of(control).temporary:
        _arc_about_own_center(control, clockwise=clockwise)
        return
    plane = control.modal.plane
    names = control.settings.axes.names
    cartesian = any(names[index] in control.words for index in plane.axes[:2])
    circle = control.take("R") if cartesian else None
    letters = _center_letters(control)
    pitch = control.take(letters[2]) if names[plane.axes[2]] in control.words else None
    centre = take_center(control, letters[:2])
    goal = take_goal(control, arc=True)
    start, end = start_and_end(control, goal.target)
    if circle is not None:
        if centre.words:
            control.fail("arc-overdefined", "an arc has a centre or a radius", circle)
        center = radius_center(control, start[:2], end[:2], circle, clockwise=clockwise)
    elif centre.words:
        center = _given_center(control, centre.words, start[:2])
    elif goal.polar:
        center = polar_of(control).origin
    else:
        control.fail(
            "arc-without-center",
            "the arc has neither a centre nor a radius",
            hint=f"write {letters[0]} and {letters[1]}, or R",
        )
    if goal.in_plane or pitch is None:
        word = centre.words[0] if centre.words else None
        center = fitted_center(control, start[:2], end[:2], center, word)
    _sweep(control, goal, center, pitch, clockwise=clockwise)


def _sweep(
    control: Control, goal: Goal, center: Point, pitch: Word | None, *, clockwise: bool
) -> None:
    plane = control.modal.plane
    start, end = start_and_end(control, goal.target)
    sweep = sweep_between(start[:2], end[:2], center, clockwise=clockwise)
    if pitch is not None:
        wanted = _helix_sweep(control, end.height - start.height, pitch, clockwise=clockwise)
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
            sweep = wanted
            around = turned(start[:2], center, sweep)
            goal.target[:3] = plane.world(*around, end.height)
            forget_polar(control)
    control.arc_to(goal.target, plane.world(*center, start.height), sweep)


def _helix_sweep(control: Control, height: float, pitch: Word, *, clockwise: bool) -> float:
    size = abs(control.length(pitch))
    if size == 0.0:
        control.fail("helix-pitch-zero", "the pitch of a helix must not be 0", pitch)
    sweep = TURN * abs(height) / size
    return -sweep if clockwise else sweep


def _center_letters(control: Control) -> str:
    """Centre words along abscissa, ordinate and normal of the working plane."""
    return "".join("IJK"[index] for index in control.modal.plane.axes)


def _given_center(control: Control, words: tuple[Word, ...], start: Point) -> Point:
    letters = _center_letters(control)
    values = {word.address: control.length(word) for word in words}
    abscissa, ordinate = values.get(letters[0], 0.0), values.get(letters[1], 0.0)
    if control.modal.center_absolute:
        return (abscissa, ordinate)
    return (start[0] + abscissa, start[1] + ordinate)


def _arc_about_own_center(control: Control, *, clockwise: bool) -> None:
    """G31 G02/G03 Q I J: Q is seen from the arc's centre, the radius is the arc's."""
    polar_of(control).temporary = False
    radius, angle = control.take("R"), control.take("Q")
    letters = _center_letters(control)
    centre = take_center(control, letters[:2])
    if radius is not None:
        control.fail("temporary-origin", "with G31 the radius is the arc's own", radius)
    if angle is None or not centre.words:
        message = f"G31 needs Q and {letters[0]} or {letters[1]}"
        control.fail("temporary-origin", message, control.code_word(31))
    plane = control.modal.plane
    start = plane.local(control.programmed)
    center = _given_center(control, centre.words, start[:2])
    if distance(start[:2], center) < SAME_POINT:
        control.fail("arc-center", "the centre lies on the arc's start", centre.words[0])
    value = control.number(angle)
    incremental = control.modal.incremental or angle.incremental
    by = value if incremental else value - angle_of(start[:2], center)
    end = turned(start[:2], center, by)
    target = control.target()
    target[:3] = plane.world(*end, plane.local(target).height)
    forget_polar(control)
    sweep = sweep_between(start[:2], end, center, clockwise=clockwise)
    control.arc_to(target, plane.world(*center, start.height), sweep)


def clockwise_arc(control: Control) -> None:
    """G02."""
    _arc(control, clockwise=True)


def counter_clockwise_arc(control: Control) -> None:
    """G03."""
    _arc(control, clockwise=False)


RAPID = Interpolation(rapid_line, rapid=True)
FEED = Interpolation(feed_line)
CLOCKWISE = Interpolation(clockwise_arc)
COUNTER_CLOCKWISE = Interpolation(counter_clockwise_arc)
