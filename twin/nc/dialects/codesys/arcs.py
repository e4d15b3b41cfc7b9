"""Arcs of CODESYS SoftMotion: radius, centre with the 10 % rule, opening angle, any plane."""

from twin.nc.control.control import Control
from twin.nc.control.modal import ArcRule
from twin.nc.geometry import arcs
from twin.nc.geometry.arcs import SAME_POINT, Bounds, Point, distance, turned
from twin.nc.iso.circular import both_senses, refuse_arc, start_and_end, sweep_arc, take_center
from twin.nc.text.blocks import Word

BOUNDS = Bounds(mismatch=0.0, mismatch_share=0.1, shift=1e-3, shift_share=0.0)
"""Beyond these an arc becomes a line, or its corrected centre earns a warning.

The page allows the centre to deviate by 10 %. Decision: measured as |r_start - r_end| against the
larger of both.
"""

LARGEST_OPENING = 1080.0
"""Largest opening angle: three turns, as the page says [deg]."""


def _arc(control: Control, rule: ArcRule) -> None:
    radius, opening = control.take("R"), control.take("T")
    if opening is not None:
        if radius is not None:
            control.fail("arc-overdefined", "an arc has an opening angle or a radius", radius)
        _opening_arc(control, opening, clockwise=rule.clockwise)
        return
    if radius is not None:
        _radius_arc(control, radius, clockwise=rule.clockwise)
        return
    _center_arc(control, rule)


def _radius_arc(control: Control, word: Word, *, clockwise: bool) -> None:
    target = control.target()
    start, end = start_and_end(control, target)
    if take_center(control).words:
        refuse_arc(control, arcs.OVERDEFINED, word)
    radius = abs(control.length(word))
    finding, center = arcs.center_of_radius(start, end, radius, clockwise, signed=False)
    if finding == arcs.SHORT_RADIUS:
        half = distance(start, end) / 2.0
        message = (
            f"the radius is shorter than half the distance, {half:.4f}: a straight line instead"
        )
        _line_instead(control, target, message, word)
        return
    if finding != arcs.FITS:
        refuse_arc(control, finding, word)
    sweep_arc(control, target, center, clockwise=clockwise)


def _center_arc(control: Control, rule: ArcRule) -> None:
    center, word = _programmed_center(control)
    target = control.target()
    start, end = start_and_end(control, target)
    if center is None:
        _line_instead(control, target, "the arc has no centre and no radius: a straight line", None)
        return
    finding, fitted = arcs.fitted_center(start, end, center, rule.bounds)
    if finding in (arcs.ON_CENTER, arcs.UNEQUAL):
        first, last = distance(start, center), distance(end, center)
        message = (
            f"start and end are {first:.4f} and {last:.4f} from the centre, "
            "more than 10 % apart: a straight line instead"
        )
        _line_instead(control, target, message, word)
        return
    if finding == arcs.FAR_CENTER:
        moved = distance(center, fitted)
        message = f"the centre is corrected by {moved:.4f} to fit start and end"
        control.warn("arc-center-corrected", message, word)
    sweep_arc(control, target, fitted, clockwise=rule.clockwise)


def _opening_arc(control: Control, opening: Word, *, clockwise: bool) -> None:
    angle = control.number(opening)
    if not 0.0 < angle <= LARGEST_OPENING:
        message = f"the opening angle {opening.text} is not above 0 and up to {LARGEST_OPENING:g}"
        control.fail("arc-opening", message, opening)
    center, word = _programmed_center(control)
    if center is None:
        control.fail("arc-without-center", "an opening angle needs I, J or K", opening)
    plane = control.modal.plane
    names = (control.settings.axes.names[index] for index in plane.axes[:2])
    if any(name in control.words for name in names):
        message = "the opening angle decides where the arc ends; the target in the plane is ignored"
        control.warn("arc-opening-wins", message, opening)
    target = control.target()
    start = plane.point(control.motion.programmed)
    if distance(start, center) < SAME_POINT:
        control.fail("arc-center", "the centre lies on the arc's start", word)
    sweep = -angle if clockwise else angle
    end = turned(start, center, sweep)
    plane.aim(target, end)
    control.arc_to(target, center, sweep)


def _programmed_center(control: Control) -> tuple[Point | None, Word | None]:
    """The centre in the plane by I, J, K: relative to the start, or absolute with G98.

    A missing word is 0 when relative. Decision: when absolute, it is the start's coordinate.
    """
    words = take_center(control)
    if not words.words:
        return None, None
    plane = control.modal.plane
    start = control.motion.programmed
    if control.modal.center_absolute:
        given = {word.address for word in words.words}
        x, y, z = (
            value if letter in given else start[index]
            for index, (letter, value) in enumerate(zip("IJK", words.vector, strict=True))
        )
    else:
        x, y, z = (start[index] + value for index, value in enumerate(words.vector))
    return plane.local((x, y, z))[:2], words.words[0]


def _line_instead(control: Control, target: list[float], message: str, word: Word | None) -> None:
    control.warn("arc-replaced", message, word)
    control.line_to(target, rapid=False)


CLOCKWISE, COUNTER_CLOCKWISE = both_senses(_arc, ArcRule(bounds=BOUNDS, signed_radius=False))
