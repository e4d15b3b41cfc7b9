"""Arc blocks: from end point and radius or centre to centre and sweep."""

import dataclasses

from twin.nc.control.control import Control
from twin.nc.control.interpolation import ArcRule
from twin.nc.geometry.arcs import (
    SAME_POINT,
    Point,
    center_by_radius,
    distance,
    equidistant,
    sweep_between,
)
from twin.nc.geometry.planes import Local, Vector
from twin.nc.text.blocks import Word

RADIUS_TOLERANCE = 0.01
"""How far start and end radius of an arc may differ [mm].

Decision: the Fagor 8070's default (CIRINERR) for every dialect that states none; programs rounded
to 0.001 mm stay far below it.
"""
RADIUS_SHARE = 0.001
"""How far they may differ as a share of the radius (the 8070's CIRINFACT, 0.1 %): the larger limit counts."""

CENTER_SHIFT = 0.1
"""How far a centre may be moved to fit both points [mm], or ten times ``RADIUS_SHARE``.

Decision: nearly full circles magnify a small mismatch; beyond this the arc is not what was drawn.
"""


@dataclasses.dataclass(frozen=True, slots=True)
class CenterWords:
    """The words I, J, K of a block.

    Attributes:
        words: Those that were written.
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
    normal = control.modal.plane.normal
    return "".join(letter for letter, along in zip("IJK", normal, strict=True) if abs(along) < 0.5)


def fitted_center(
    control: Control, start: Point, end: Point, center: Point, word: Word | None
) -> Point:
    """The centre moved so that both points lie on one circle.

    Raises:
        ProgramError: They are farther from one circle than rounding explains.
    """
    first, last = distance(start, center), distance(end, center)
    if min(first, last) < SAME_POINT:
        control.fail("arc-center", "the centre lies on the arc's start or end", word)
    if abs(first - last) > max(RADIUS_TOLERANCE, RADIUS_SHARE * first):
        control.fail(
            "arc-center",
            f"start and end are {first:.4f} and {last:.4f} mm from the centre",
            word,
            hint="give a centre that is as far from the start as from the end",
        )
    fitted = equidistant(start, end, center)
    if distance(center, fitted) > max(CENTER_SHIFT, 10.0 * RADIUS_SHARE * first):
        control.fail(
            "arc-center",
            f"the centre misses start and end by {abs(first - last):.4f} mm, "
            "too much for two points so near each other",
            word,
            hint="end a full circle exactly where it starts",
        )
    return fitted


def radius_center(
    control: Control, start: Point, end: Point, word: Word, *, clockwise: bool
) -> Point:
    """Centre of an arc given by a radius word; a negative radius asks for the larger arc.

    Raises:
        ProgramError: The radius does not fit.
    """
    return center_of_radius(control, start, end, control.length(word), word, clockwise=clockwise)


def center_of_radius(
    control: Control,
    start: Point,
    end: Point,
    value: float,
    word: Word | None,
    *,
    clockwise: bool,
) -> Point:
    """As ``radius_center``, for a radius that is in force [mm]."""
    if distance(start, end) < SAME_POINT:
        control.fail(
            "arc-full-by-radius",
            "start and end are the same point: a radius leaves the centre undefined",
            word,
            hint="write the centre (I, J, K) of a full circle",
        )
    center = center_by_radius(start, end, abs(value), clockwise=clockwise, larger=value < 0.0)
    if center is None or value == 0.0:
        half = distance(start, end) / 2.0
        control.fail(
            "arc-radius",
            f"the end cannot be reached with radius {abs(value):g} mm",
            word,
            hint=f"half the distance is {half:.4f} mm: no smaller radius reaches",
        )
    return center


def sweep_arc(
    control: Control,
    target: list[float],
    center: Point,
    *,
    clockwise: bool,
    turns: int = 0,
) -> None:
    """Move on the arc in the working plane from here to the target.

    Args:
        control: The control, standing at the start.
        target: Programmed position of the end, shape (k,).
        center: In the plane's coordinates [mm].
        clockwise: Seen against the plane's normal.
        turns: Whole turns besides the part from start to end.
    """
    plane = control.modal.plane
    start, end = plane.local(control.programmed), plane.local(target)
    sweep = sweep_between(start[:2], end[:2], center, clockwise=clockwise)
    sweep += -360.0 * turns if clockwise else 360.0 * turns
    control.arc_to(target, plane.world(*center, start.height), sweep)


def start_and_end(control: Control, target: list[float]) -> tuple[Local, Local]:
    """Where the arc begins and ends, as the plane sees it."""
    plane = control.modal.plane
    return plane.local(control.programmed), plane.local(target)


def iso_arc_center(control: Control, target: list[float], *, clockwise: bool) -> Point:
    """Take R or I, J, K (relative to the start) and find the centre by ISO 6983-1.

    Raises:
        ProgramError: There is no centre, or it does not fit.
    """
    start, end = start_and_end(control, target)
    radius = control.take("R")
    centre = take_center(control, plane_center_letters(control))
    if radius is not None:
        if centre.words:
            control.fail("arc-overdefined", "an arc has a centre or a radius", radius)
        return radius_center(control, start[:2], end[:2], radius, clockwise=clockwise)
    if not centre.words:
        control.fail(
            "arc-without-center",
            "the arc has neither a centre nor a radius",
            hint=f"write {', '.join(plane_center_letters(control))} or R; or G1 for a line",
        )
    offset = control.modal.plane.local(centre.vector)
    center = (start.abscissa + offset.abscissa, start.ordinate + offset.ordinate)
    return fitted_center(control, start[:2], end[:2], center, centre.words[0])


def clockwise_arc(control: Control) -> None:
    """G2 by ISO 6983-1."""
    _iso_arc(control, clockwise=True)


def counter_clockwise_arc(control: Control) -> None:
    """G3 by ISO 6983-1."""
    _iso_arc(control, clockwise=False)


def _iso_arc(control: Control, *, clockwise: bool) -> None:
    target = control.target()
    center = iso_arc_center(control, target, clockwise=clockwise)
    sweep_arc(control, target, center, clockwise=clockwise)


def arc_rule(*, clockwise: bool, fits_radius: bool = False) -> ArcRule:
    """The bounds within which ``fitted_center`` has nothing to refuse."""
    return ArcRule(
        clockwise=clockwise,
        mismatch=RADIUS_TOLERANCE,
        shift=CENTER_SHIFT,
        fits_radius=fits_radius,
    )
