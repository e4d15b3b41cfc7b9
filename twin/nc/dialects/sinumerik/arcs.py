"""Lines and arcs of the SINUMERIK: centre, radius CR=, angle AR=, TURN=, three points (CIP), tangent (CT)."""

import math

from twin.nc.control.codes import Interpolation
from twin.nc.control.control import Control
from twin.nc.control.modal import ArcRule
from twin.nc.dialects.sinumerik.frames import refuse_uneven_arc
from twin.nc.dialects.sinumerik.memory import memory_of
from twin.nc.dialects.sinumerik.targets import POLAR_WORDS, forget_polar, take_target
from twin.nc.geometry import arcs
from twin.nc.geometry.arcs import (
    SAME_POINT,
    TURN,
    Point,
    distance,
    turned,
)
from twin.nc.geometry.planes import OWN_PLANE, Plane, Vector, along, cross
from twin.nc.iso import base
from twin.nc.iso.circular import (
    BOUNDS,
    both_senses,
    center_of_radius,
    fitted_center,
    plane_center_letters,
    refuse_arc,
    start_and_end,
    sweep_arc,
    tangent_arc_to,
)
from twin.nc.iso.polar_words import aim_by_angle
from twin.nc.text.blocks import Word

MOST_TURNS = 999
"""Further turns of one helix (manual)."""
_PARALLEL = 1e-12
"""How far the cosine between two normals may fall short of 1 where planes are parallel."""


def _line(control: Control, rapid: bool) -> None:
    angle = control.take("ANG")
    if angle is not None:
        _line_at_angle(control, angle, rapid=rapid)
    else:
        control.line_to(take_target(control), rapid=rapid)


def _line_at_angle(control: Control, angle: Word, *, rapid: bool) -> None:
    """ANG= and one coordinate of the plane: the line leaves the start in that direction."""
    plane, names = control.modal.plane, control.settings.axes.names
    given = [axis for axis in plane.axes[:2] if names[axis] in control.words]
    if len(given) != 1:
        message = "ANG= needs one coordinate of the plane, which says where the line ends"
        control.fail("chord-angle", message, angle, "write both coordinates, or one and ANG=")
    target = take_target(control)
    aim_by_angle(control, target, angle, from_abscissa=given[0] == plane.axes[0])
    control.line_to(target, rapid=rapid)


def _arc(control: Control, rule: ArcRule) -> None:
    refuse_uneven_arc(control)
    radius, opening, turns = control.take("CR"), control.take("AR"), _turns(control)
    start = control.modal.plane.point(control.motion.programmed)
    polar = not POLAR_WORDS.isdisjoint(control.words)
    center, word = _programmed_center(control, start)
    in_plane = polar or _names_plane(control)
    given = [each for each in (radius, opening, word) if each is not None]
    if len(given) > 1 and not (given == [opening, word] and not in_plane):
        control.fail("arc-overdefined", "an arc has one of a centre, CR= and AR=", given[1])
    if polar and not given:
        center = memory_of(control).pole
    target = take_target(control)
    ends = start_and_end(control, target)
    if radius is not None:
        value = control.length(radius)
        center = center_of_radius(control, *ends, value, radius, clockwise=rule.clockwise)
    elif opening is not None:
        center = _center_by_angle(control, target, opening, center, clockwise=rule.clockwise)
    elif center is None:
        letters = ", ".join(plane_center_letters(control))
        message = "the arc has neither a centre nor a radius"
        hint = f"write {letters}, CR= or AR=; or G1 for a line"
        control.fail("arc-without-center", message, hint=hint)
    center = fitted_center(
        control, start_and_end(control, target), center, rule.bounds, word or opening
    )
    sweep_arc(control, target, center, clockwise=rule.clockwise, turns=turns)


def _names_plane(control: Control) -> bool:
    names = control.settings.axes.names
    return any(names[axis] in control.words for axis in control.modal.plane.axes[:2])


def _turns(control: Control) -> int:
    word = control.take("TURN")
    if word is None:
        return 0
    value = control.number(word)
    if value != int(value) or not 0.0 <= value <= MOST_TURNS:
        control.fail("helix-turns", f"TURN= counts 0 to {MOST_TURNS} further turns", word)
    return int(value)


def _programmed_center(control: Control, start: Point) -> tuple[Point | None, Word | None]:
    """The centre by I, J, K: from the start of the arc, or with AC from zero."""
    letters, axes = "IJK", control.modal.plane.axes
    words = [control.take(letters[axis]) for axis in axes[:2]]
    across = letters[axes[2]]
    if across in control.words:
        message = f"{across} is no centre word of an arc in this plane"
        control.fail(
            "unused-word", message, control.words[across], "TURN= counts the turns of a helix"
        )
    if words[0] is None and words[1] is None:
        return None, None
    at = [
        here + control.length(word) if word is None or word.mark != "AC" else control.length(word)
        for here, word in zip(start, words, strict=True)
    ]
    return (at[0], at[1]), words[0] or words[1]


def _center_by_angle(
    control: Control, target: list[float], opening: Word, center: Point | None, *, clockwise: bool
) -> Point:
    """AR= with the end of the arc, or with its centre, which then says where it ends."""
    angle = control.number(opening)
    if not 0.0 < angle < TURN:
        message = f"the opening angle {angle:g} is not above 0 and below 360"
        control.fail("arc-opening", message, opening, "a full circle needs its centre: I, J or K")
    start, end = start_and_end(control, target)
    if center is not None:
        if distance(start, center) < SAME_POINT:
            refuse_arc(control, arcs.ON_CENTER, opening)
        control.modal.plane.aim(target, turned(start, center, -angle if clockwise else angle))
        forget_polar(control)
        return center
    chord = distance(start, end)
    if chord < SAME_POINT:
        message = "AR= needs the arc's end, another point than its start, or its centre"
        control.fail("arc-without-center", message, opening)
    radius = chord / (2.0 * math.sin(math.radians(angle) / 2.0))
    return arcs.center_at_radius(start, end, max(radius, chord / 2.0), clockwise, angle > 180.0)


def _tangent(control: Control) -> None:
    """CT: the arc that leaves the last move along its direction."""
    if POLAR_WORDS.isdisjoint(control.words) and not _names_plane(control):
        control.line_to(take_target(control), rapid=False)
        return
    tangent_arc_to(control, take_target(control), "CT")


def _three_points(control: Control) -> None:
    """CIP X Y Z I1= J1= K1=: the arc through a point between, in whatever plane the three lie."""
    start = control.motion.programmed
    via = list(start[:3])
    words = [control.take(letter) for letter in ("I1", "J1", "K1")]
    if not any(words):
        control.fail("three-point-arc", "CIP needs the point between: I1=, J1=, K1=")
    for axis, word in enumerate(words):
        if word is not None:
            counts_on = word.incremental or (control.modal.incremental and not word.mark)
            via[axis] = control.length(word) + (start[axis] if counts_on else 0.0)
    turns, target = _turns(control), take_target(control)
    plane = _plane_through(start, via, target, control.modal.plane)
    if plane is None:
        control.fail("three-point-arc", "the three points of CIP lie on a line")
    first, middle, last = (plane.point(place) for place in (start, via, target))
    center = arcs.center_through(first, middle, last)
    if center is None:
        control.fail("three-point-arc", "the three points of CIP lie on a line")
    clockwise = (middle[0] - first[0]) * (last[1] - first[1]) < (middle[1] - first[1]) * (
        last[0] - first[0]
    )
    kept, control.modal.plane = control.modal.plane, plane
    sweep_arc(control, target, center, clockwise=clockwise, turns=turns)
    control.modal.plane = kept


def _plane_through(
    start: list[float], via: list[float], end: list[float], working: Plane
) -> Plane | None:
    """The plane of three points: the working plane where they lie parallel to it; None: they are on a line."""

    def displacement(place: list[float]) -> Vector:
        return (place[0] - start[0], place[1] - start[1], place[2] - start[2])

    first, second = displacement(via), displacement(end)
    normal = cross(first, second)
    length, chord = math.hypot(*normal), math.hypot(*first)
    if length < SAME_POINT * max(chord, math.hypot(*second), SAME_POINT):
        return None
    abscissa = (first[0] / chord, first[1] / chord, first[2] / chord)
    unit = (normal[0] / length, normal[1] / length, normal[2] / length)
    if abs(along(unit, working.normal)) > 1.0 - _PARALLEL:
        return working
    return Plane(OWN_PLANE, abscissa, cross(unit, abscissa), unit)


POSITIONING, LINEAR = base.straight(_line)
CLOCKWISE, COUNTER_CLOCKWISE = both_senses(_arc, ArcRule(bounds=BOUNDS))
TANGENT = Interpolation(_tangent)
THREE_POINTS = Interpolation(_three_points)
