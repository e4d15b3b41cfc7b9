"""Arcs of CODESYS SoftMotion: radius, centre with the 10 % rule, opening angle, any plane."""

from twin.nc.control.codes import Interpolation
from twin.nc.control.control import Control
from twin.nc.control.interpolation import ArcRule
from twin.nc.geometry.arcs import (
    SAME_POINT,
    Point,
    center_by_radius,
    distance,
    equidistant,
    turned,
)
from twin.nc.iso.circular import start_and_end, sweep_arc, take_center
from twin.nc.text.blocks import Word

CENTER_SHARE = 0.1
"""Share by which start and end radius may differ before the arc becomes a line.

The page allows the centre to deviate by 10 %. Decision: measured as |r_start - r_end| against the
larger of both.
"""
SHIFT_WARNING = 1e-3
"""A centre that is corrected by more than this earns a warning [mm]."""

LARGEST_OPENING = 1080.0
"""Largest opening angle: three turns, as the page says [deg]."""


def _arc(control: Control, *, clockwise: bool) -> None:
    radius, opening = control.take("R"), control.take("T")
    if opening is not None:
        if radius is not None:
            control.fail("arc-overdefined", "an arc has an opening angle or a radius", radius)
        _opening_arc(control, opening, clockwise=clockwise)
        return
    if radius is not None:
        _radius_arc(control, radius, clockwise=clockwise)
        return
    _center_arc(control, clockwise=clockwise)


def _radius_arc(control: Control, word: Word, *, clockwise: bool) -> None:
    target = control.target()
    start, end = start_and_end(control, target)
    if take_center(control).words:
        control.fail("arc-overdefined", "an arc has a centre or a radius", word)
    if distance(start[:2], end[:2]) < SAME_POINT:
        control.fail(
            "arc-full-by-radius",
            "start and end are the same point: a radius leaves the centre undefined",
            word,
            hint="write the centre (I, J, K) of a full circle",
        )
    radius = abs(control.length(word))
    center = center_by_radius(start[:2], end[:2], radius, clockwise=clockwise, larger=False)
    if center is None:
        half = distance(start[:2], end[:2]) / 2.0
        message = (
            f"the radius is shorter than half the distance, {half:.4f}: a straight line instead"
        )
        _line_instead(control, target, message, word)
        return
    sweep_arc(control, target, center, clockwise=clockwise)


def _center_arc(control: Control, *, clockwise: bool) -> None:
    center, word = _programmed_center(control)
    target = control.target()
    start, end = start_and_end(control, target)
    if center is None:
        _line_instead(control, target, "the arc has no centre and no radius: a straight line", None)
        return
    first, last = distance(start[:2], center), distance(end[:2], center)
    unequal = abs(first - last) > CENTER_SHARE * max(first, last)
    if unequal or min(first, last) < SAME_POINT:
        message = (
            f"start and end are {first:.4f} and {last:.4f} from the centre, "
            "more than 10 % apart: a straight line instead"
        )
        _line_instead(control, target, message, word)
        return
    fitted = equidistant(start[:2], end[:2], center)
    moved = distance(center, fitted)
    if moved > SHIFT_WARNING:
        message = f"the centre is corrected by {moved:.4f} to fit start and end"
        control.warn("arc-center-corrected", message, word)
    sweep_arc(control, target, fitted, clockwise=clockwise)


def _opening_arc(control: Control, opening: Word, *, clockwise: bool) -> None:
    angle = control.number(opening)
    if not 0.0 < angle <= LARGEST_OPENING:
        control.fail(
            "arc-opening",
            f"the opening angle {opening.text} is not above 0 and up to {LARGEST_OPENING:g}",
            opening,
        )
    center, word = _programmed_center(control)
    if center is None:
        control.fail("arc-without-center", "an opening angle needs I, J or K", opening)
    plane = control.modal.plane
    names = (control.settings.axes.names[index] for index in plane.axes[:2])
    if any(name in control.words for name in names):
        message = "the opening angle decides where the arc ends; the target in the plane is ignored"
        control.warn("arc-opening-wins", message, opening)
    target = control.target()
    start = plane.local(control.programmed)
    if distance(start[:2], center) < SAME_POINT:
        control.fail("arc-center", "the centre lies on the arc's start", word)
    sweep = -angle if clockwise else angle
    end = turned(start[:2], center, sweep)
    target[:3] = plane.world(*end, plane.local(target).height)
    control.arc_to(target, plane.world(*center, start.height), sweep)


def _programmed_center(control: Control) -> tuple[Point | None, Word | None]:
    """The centre in the plane by I, J, K: relative to the start, or absolute with G98.

    A missing word is 0 when relative. Decision: when absolute, it is the start's coordinate.
    """
    words = take_center(control)
    if not words.words:
        return None, None
    plane = control.modal.plane
    start = control.programmed
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


def clockwise_arc(control: Control) -> None:
    """G2."""
    _arc(control, clockwise=True)


def counter_clockwise_arc(control: Control) -> None:
    """G3."""
    _arc(control, clockwise=False)


def _arc_rule(*, clockwise: bool) -> ArcRule:
    return ArcRule(
        clockwise=clockwise,
        mismatch_share=CENTER_SHARE,
        shift=SHIFT_WARNING,
        signed_radius=False,
    )


CLOCKWISE = Interpolation(clockwise_arc, rule=_arc_rule(clockwise=True))
COUNTER_CLOCKWISE = Interpolation(counter_clockwise_arc, rule=_arc_rule(clockwise=False))
