"""Arc geometry in a plane: centres from radii, tangents and points, and signed sweeps.

What is ``compilable`` must give the same bits compiled, which ``math.hypot`` does not.
"""

import math
from typing import NamedTuple

from twin.compilation.compilable import compilable

Point = tuple[float, float]

SAME_POINT = 1e-6
"""Points nearer than this are one point [mm]: far below any control's resolution."""

ROUNDING = 0.002
"""What two coordinates rounded to 0.001 can put between a radius and its chord [mm]."""

TURN = 360.0


@compilable
def distance(left: Point, right: Point) -> float:
    """Between two points [mm]."""
    x, y = right[0] - left[0], right[1] - left[1]
    return math.sqrt(x * x + y * y)


def direction(angle: float) -> Point:
    """Unit vector at an angle [deg]; exact at every quarter turn."""
    rest = abs(angle) % TURN
    angle = -rest if angle < 0.0 else rest
    quarter = angle / 90.0
    if quarter == int(quarter):
        return _QUARTERS[int(quarter) % 4]
    radians = math.radians(angle)
    return (math.cos(radians), math.sin(radians))


_QUARTERS = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))


def turned(point: Point, center: Point, angle: float) -> Point:
    """A point turned about a centre [deg]; exact at every quarter turn."""
    cosine, sine = direction(angle)
    x, y = point[0] - center[0], point[1] - center[1]
    return (center[0] + cosine * x - sine * y, center[1] + sine * x + cosine * y)


def angle_of(point: Point, center: Point) -> float:
    """Direction from a centre to a point, 0 to below 360 [deg]."""
    angle = math.degrees(math.atan2(point[1] - center[1], point[0] - center[0]))
    return angle if angle >= 0.0 else angle + TURN


@compilable
def sweep_between(start: Point, end: Point, center: Point, clockwise: bool) -> float:
    """Signed angle from start to end about the centre [deg]; a whole turn where they meet."""
    turn = -TURN if clockwise else TURN
    if distance(start, end) < SAME_POINT:
        return turn
    ux, uy = start[0] - center[0], start[1] - center[1]
    vx, vy = end[0] - center[0], end[1] - center[1]
    angle = math.degrees(math.atan2(ux * vy - uy * vx, ux * vx + uy * vy))
    if clockwise:
        return angle if angle < 0.0 else angle - TURN
    return angle if angle > 0.0 else angle + TURN


(
    FITS,
    ON_CENTER,
    UNEQUAL,
    FAR_CENTER,
    SAME_ENDS,
    SHORT_RADIUS,
    NEGATIVE_RADIUS,
    OVERDEFINED,
    WITHOUT_CENTER,
) = range(9)
"""What is wrong with an arc: nothing; the centre lies on its start or end; these are not equally far
from it; it would have to be moved far to be so; they are one point, which no radius tells a circle
through; the radius does not reach from one to the other; it is below 0, where that means nothing;
there are a radius and a centre; there is neither."""


class Bounds(NamedTuple):
    """How badly a centre may fit start and end of an arc; of each limit and its share the larger counts.

    Attributes:
        mismatch: How far its distances from start and end may differ [mm].
        mismatch_share: The same as a share of the larger distance.
        shift: How far it may be moved to fit [mm].
        shift_share: The same as a share of the larger distance.
    """

    mismatch: float
    mismatch_share: float
    shift: float
    shift_share: float


@compilable
def fitted_center(start: Point, end: Point, given: Point, bounds: Bounds) -> tuple[int, Point]:
    """What is wrong with a centre, and the nearest one that is as far from the start as from the end."""
    near, far = distance(start, given), distance(end, given)
    larger = max(near, far)
    if min(near, far) < SAME_POINT:
        return ON_CENTER, given
    if abs(near - far) > max(bounds.mismatch, bounds.mismatch_share * larger):
        return UNEQUAL, given
    center = equidistant(start, end, given)
    if distance(given, center) > max(bounds.shift, bounds.shift_share * larger):
        return FAR_CENTER, center
    return FITS, center


class ArcWords(NamedTuple):
    """The words of an arc, NaN where they are missing.

    Attributes:
        radius: R [mm].
        first: The centre word along the abscissa [mm].
        second: That along the ordinate [mm].
    """

    radius: float
    first: float
    second: float


class Sense(NamedTuple):
    """Sense of an arc, and what a radius means in it.

    Attributes:
        clockwise: Seen against the plane's normal.
        signed: A negative radius asks for the larger arc.
        fits: A centre found by its radius is fitted to both points like a given one.
    """

    clockwise: bool
    signed: bool
    fits: bool


@compilable
def center_of_words(
    start: Point, end: Point, words: ArcWords, absolute: bool, sense: Sense, bounds: Bounds
) -> tuple[int, Point]:
    """What is wrong with the words of an arc, and its centre."""
    has_center = words.first == words.first or words.second == words.second
    center = programmed_center(start, words.first, words.second, absolute)
    if words.radius == words.radius:
        if has_center:
            return OVERDEFINED, start
        finding, center = center_of_radius(start, end, words.radius, sense.clockwise, sense.signed)
        if finding != FITS or not sense.fits:
            return finding, center
    elif not has_center:
        return WITHOUT_CENTER, start
    return fitted_center(start, end, center, bounds)


@compilable
def programmed_center(start: Point, first: float, second: float, absolute: bool) -> Point:
    """The centre that two words give; a missing one is 0."""
    first = first if first == first else 0.0
    second = second if second == second else 0.0
    return (first, second) if absolute else (start[0] + first, start[1] + second)


@compilable
def center_of_radius(
    start: Point, end: Point, radius: float, clockwise: bool, signed: bool
) -> tuple[int, Point]:
    """What is wrong with the radius of an arc, and its centre; ``signed``: a negative one means the arc beyond 180° [mm]."""
    if distance(start, end) < SAME_POINT:
        return SAME_ENDS, start
    if radius < 0.0 and not signed:
        return NEGATIVE_RADIUS, start
    if radius == 0.0 or not reaches(start, end, abs(radius)):
        return SHORT_RADIUS, start
    return FITS, center_at_radius(start, end, abs(radius), clockwise, radius < 0.0)


@compilable
def reaches(start: Point, end: Point, radius: float) -> bool:
    """Whether an arc of a radius goes from one point to another [mm]."""
    chord = distance(start, end)
    return not (radius < chord / 2.0 - ROUNDING or chord < SAME_POINT)


@compilable
def center_at_radius(
    start: Point, end: Point, radius: float, clockwise: bool, larger: bool
) -> Point:
    """Centre of the arc of a positive radius that reaches [mm]; ``larger``: beyond 180° of the two that fit."""
    chord = distance(start, end)
    middle = ((start[0] + end[0]) / 2.0, (start[1] + end[1]) / 2.0)
    height = math.sqrt(max(0.0, radius * radius - chord * chord / 4.0))
    side = height / chord if clockwise == larger else -height / chord
    return (
        middle[0] - side * (end[1] - start[1]),
        middle[1] + side * (end[0] - start[0]),
    )


@compilable
def equidistant(start: Point, end: Point, center: Point) -> Point:
    """The point of the perpendicular bisector of start and end that is nearest to ``center``."""
    chord = distance(start, end)
    if chord < SAME_POINT:
        return center
    ux, uy = (end[0] - start[0]) / chord, (end[1] - start[1]) / chord
    along = (center[0] - start[0]) * ux + (center[1] - start[1]) * uy - chord / 2.0
    return (center[0] - along * ux, center[1] - along * uy)


def center_through(first: Point, second: Point, third: Point) -> Point | None:
    """Centre of the circle through three points; None where they lie on a line."""
    ax, ay = second[0] - first[0], second[1] - first[1]
    bx, by = third[0] - first[0], third[1] - first[1]
    area = 2.0 * (ax * by - ay * bx)
    if abs(area) < SAME_POINT * max(math.hypot(ax, ay), math.hypot(bx, by)):
        return None
    a2, b2 = ax * ax + ay * ay, bx * bx + by * by
    return (first[0] + (by * a2 - ay * b2) / area, first[1] + (ax * b2 - bx * a2) / area)


def center_tangent(start: Point, end: Point, direction: Point) -> Point | None:
    """Centre of the arc that leaves ``start`` along ``direction``; None where it is straight."""
    chord_x, chord_y = end[0] - start[0], end[1] - start[1]
    length = math.hypot(*direction)
    normal_x, normal_y = -direction[1] / length, direction[0] / length
    across = chord_x * normal_x + chord_y * normal_y
    if abs(across) < SAME_POINT:
        return None
    radius = (chord_x * chord_x + chord_y * chord_y) / (2.0 * across)
    return (start[0] + radius * normal_x, start[1] + radius * normal_y)
