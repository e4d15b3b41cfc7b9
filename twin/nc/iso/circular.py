"""Arc blocks: from end point and radius or centre to centre and sweep."""

import dataclasses
import functools
import math
from collections.abc import Callable
from typing import NoReturn

from twin.nc.control.codes import Action, Interpolation
from twin.nc.control.control import Control
from twin.nc.control.modal import ArcRule
from twin.nc.geometry import arcs
from twin.nc.geometry.arcs import (
    ArcWords,
    Bounds,
    Point,
    Sense,
    distance,
    programmed_center,
    sweep_between,
)
from twin.nc.geometry.planes import Vector
from twin.nc.text.blocks import Word

BOUNDS = Bounds(mismatch=0.01, mismatch_share=0.001, shift=0.1, shift_share=0.01)
"""How badly a centre may fit.

Decision: start and end radius differ by no more than the Fagor 8070 lets them (CIRINERR, CIRINFACT),
for every dialect that states nothing; programs rounded to 0.001 mm stay far below that. Nearly full
circles magnify a small mismatch: where the centre must be moved by more, the arc is not what was drawn.
"""


@dataclasses.dataclass(frozen=True, slots=True)
class CenterWords:
    """The words I, J, K of a block.

    Attributes:
        vector: Their values along X, Y, Z, missing ones 0 [mm].
    """

    words: tuple[Word, ...]
    vector: Vector


def take_center(control: Control, letters: str = "IJK") -> CenterWords:
    """Take the centre words of the block."""
    words = tuple(control.words.pop(letter) for letter in letters if letter in control.words)
    values = {word.address: control.length(word) for word in words}
    i, j, k = (values.get(letter, 0.0) for letter in "IJK")
    return CenterWords(words, (i, j, k))


def plane_center_letters(control: Control) -> str:
    """The centre words of the working plane: I along X, J along Y, K along Z."""
    return _letters_across(control.modal.plane.normal)


@functools.lru_cache
def _letters_across(normal: Vector) -> str:
    return "".join(letter for letter, along in zip("IJK", normal, strict=True) if abs(along) < 0.5)


def fitted_center(
    control: Control, ends: tuple[Point, Point], center: Point, bounds: Bounds, word: Word | None
) -> Point:
    """The centre moved so that both ends of an arc lie on one circle."""
    finding, fitted = arcs.fitted_center(*ends, center, bounds)
    if finding != arcs.FITS:
        refuse_arc(control, finding, word, *(distance(end, center) for end in ends))
    return fitted


def center_of_radius(
    control: Control,
    start: Point,
    end: Point,
    value: float,
    word: Word | None,
    *,
    clockwise: bool,
) -> Point:
    """Centre of an arc given by a radius [mm]; a negative one asks for the larger arc."""
    finding, center = arcs.center_of_radius(start, end, value, clockwise, signed=True)
    if finding != arcs.FITS:
        refuse_arc(control, finding, word, abs(value), distance(start, end) / 2.0)
    return center


_FINDINGS = {
    arcs.OVERDEFINED: ("arc-overdefined", "an arc has a centre or a radius", None),
    arcs.ON_CENTER: ("arc-center", "the centre lies on the arc's start or end", None),
    arcs.UNEQUAL: (
        "arc-center",
        "start and end are {0:.4f} and {1:.4f} mm from the centre",
        "give a centre that is as far from the start as from the end",
    ),
    arcs.FAR_CENTER: (
        "arc-center",
        "the centre misses start and end by {2:.4f} mm, too much for two points so near each other",
        "end a full circle exactly where it starts",
    ),
    arcs.SAME_ENDS: (
        "arc-full-by-radius",
        "start and end are the same point: a radius leaves the centre undefined",
        "write the centre (I, J, K) of a full circle",
    ),
    arcs.NEGATIVE_RADIUS: (
        "arc-radius",
        "R draws arcs below 180 degrees; what a negative one means is not known",
        "write the centre (I, J, K) of a larger arc",
    ),
    arcs.SHORT_RADIUS: (
        "arc-radius",
        "the end cannot be reached with radius {0:g} mm",
        "half the distance is {1:.4f} mm: no smaller radius reaches",
    ),
}
"""Code, message and hint of what is wrong with an arc."""


def refuse_arc(
    control: Control, finding: int, word: Word | None, first: float = 0.0, second: float = 0.0
) -> NoReturn:
    """Report what is wrong: of a centre with its distances, of a radius with itself and half the chord."""
    code, message, hint = _FINDINGS[finding]
    measured = (first, second, abs(first - second))
    control.fail(code, message.format(*measured), word, hint and hint.format(*measured))


def sweep_arc(
    control: Control,
    target: list[float],
    center: Point,
    *,
    clockwise: bool,
    turns: int = 0,
) -> None:
    """Move on the arc in the working plane from here to the target, about a centre in the plane's coordinates [mm]."""
    sweep = sweep_between(*start_and_end(control, target), center, clockwise=clockwise)
    sweep += -360.0 * turns if clockwise else 360.0 * turns
    control.arc_to(target, center, sweep)


def start_and_end(control: Control, target: list[float]) -> tuple[Point, Point]:
    """Abscissa and ordinate of where the arc begins and ends."""
    plane = control.modal.plane
    return plane.point(control.motion.programmed), plane.point(target)


def arc_center(control: Control, target: list[float], rule: ArcRule) -> Point:
    """Take R or I, J, K and find the centre by ISO 6983-1."""
    start, end = start_and_end(control, target)
    radius, centre = control.take("R"), take_center(control, plane_center_letters(control))
    words = ArcWords(math.nan, math.nan, math.nan)
    if centre.words:
        words = ArcWords(math.nan, *control.modal.plane.point(centre.vector))
    if radius is not None:
        words = words._replace(radius=control.length(radius))
    absolute = control.modal.center_absolute
    sense = Sense(rule.clockwise, rule.signed_radius, rule.fits_radius)
    finding, center = arcs.center_of_words(start, end, words, absolute, sense, rule.bounds)
    if finding == arcs.WITHOUT_CENTER:
        refuse_missing_center(control)
    if finding != arcs.FITS and radius is not None:
        refuse_arc(control, finding, radius, abs(words.radius), distance(start, end) / 2.0)
    if finding != arcs.FITS:
        given = programmed_center(start, words.first, words.second, absolute)
        refuse_arc(control, finding, centre.words[0], distance(start, given), distance(end, given))
    return center


def refuse_missing_center(control: Control) -> NoReturn:
    """An arc has no word that says where its centre lies."""
    letters = ", ".join(plane_center_letters(control))
    control.fail(
        "arc-without-center",
        "the arc has neither a centre nor a radius",
        hint=f"write {letters} or R; or G1 for a line",
    )


def iso_arc(control: Control, rule: ArcRule) -> None:
    """G2, G3 by ISO 6983-1."""
    target = control.target()
    sweep_arc(control, target, arc_center(control, target, rule), clockwise=rule.clockwise)


def tangent_arc_to(
    control: Control, target: list[float], name: str, *, or_straight: bool = False
) -> None:
    """Move to the target on the arc that leaves the last move along its direction.

    Args:
        target: Programmed position, shape (k,).
        or_straight: On a line where the target lies straight ahead.
    """
    direction = control.motion.direction
    if direction is None:
        control.fail("tangent-arc", f"{name} needs a move before it")
    start, end = start_and_end(control, target)
    tangent = control.modal.plane.local(direction)
    if math.hypot(tangent[0], tangent[1]) < arcs.SAME_POINT:
        message = f"the move before {name} has no direction in the plane"
        control.fail("tangent-arc", message)
    center = arcs.center_tangent(start, end, tangent[:2])
    if center is None and or_straight and arcs.distance(start, end) >= arcs.SAME_POINT:
        control.line_to(target, rapid=False)
        return
    if center is None:
        message = "the end lies straight ahead or at the start: no arc leads there"
        control.fail("tangent-arc", message)
    side = tangent[0] * (center[1] - start[1]) - tangent[1] * (center[0] - start[0])
    sweep_arc(control, target, center, clockwise=side < 0.0)


def both_senses(
    perform: Callable[[Control, ArcRule], None],
    rule: ArcRule,
    without_words: Action | None = None,
) -> tuple[Interpolation, Interpolation]:
    """Arcs clockwise and counter-clockwise, by a rule that both have alike but for the sense."""

    def sense(rule: ArcRule) -> Interpolation:
        return Interpolation(lambda control: perform(control, rule), without_words, rule=rule)

    return sense(rule), sense(dataclasses.replace(rule, clockwise=False))
