"""Arcs of LinuxCNC: a centre from the start or absolute, a radius, several turns."""

from typing import NoReturn

from twin.nc.control.codes import Interpolation
from twin.nc.control.control import Control
from twin.nc.control.interpolation import ArcRule
from twin.nc.dialects.linuxcnc.compensation import in_force
from twin.nc.dialects.linuxcnc.memory import memory_of
from twin.nc.dialects.linuxcnc.motion import target
from twin.nc.geometry import arcs
from twin.nc.geometry.arcs import Bounds, Point, distance
from twin.nc.iso.circular import (
    CenterWords,
    center_of_radius,
    plane_center_letters,
    refuse_arc,
    start_and_end,
    sweep_arc,
    take_center,
)
from twin.nc.text.blocks import Word

BOUNDS = Bounds(mismatch=0.0254, mismatch_share=0.001, shift=5.0, shift_share=0.1)
"""How far start and end may differ in their distance from the centre (``rs274``). LinuxCNC draws a
spiral between them, the twin an arc about a centre that is moved to fit."""


def _turns(control: Control) -> int:
    """P: how many turns the arc has, the one to its end included."""
    word = control.take("P")
    if word is None:
        return 1
    value = control.number(word)
    if value != int(value) or value < 1.0:
        control.fail("arc-turns", f"{word.text} must count the turns of the arc, 1 or more", word)
    return int(value)


def refuse_alone(control: Control) -> NoReturn:
    """G2 or G3 without a word of the arc.

    Raises:
        ProgramError: Always.
    """
    letters = plane_center_letters(control)
    hint = f"write {', '.join(letters)} or R; or G1 for a line"
    control.fail("arc-without-center", "the arc has neither a centre nor a radius", hint=hint)


def _center(control: Control, goal: list[float], *, clockwise: bool) -> Point:
    start, end = start_and_end(control, goal)
    letters = plane_center_letters(control)
    radius, centre = control.take("R"), take_center(control, letters)
    if radius is not None:
        if centre.words:
            control.fail("arc-overdefined", "an arc has a centre or a radius", radius)
        value = control.length(radius)
        return center_of_radius(control, start[:2], end[:2], value, radius, clockwise=clockwise)
    if not centre.words:
        refuse_alone(control)
    offset = control.modal.plane.local(centre.vector)
    center = (offset.abscissa, offset.ordinate)
    if control.modal.center_absolute:
        _refuse_half(control, letters, centre)
    else:
        center = (start.abscissa + center[0], start.ordinate + center[1])
    return _fitted(control, (start[:2], end[:2]), center, centre.words[0])


def _refuse_half(control: Control, letters: str, centre: CenterWords) -> None:
    if len(centre.words) < len(letters):
        message = f"with G90.1 the centre needs {' and '.join(letters)}"
        control.fail("arc-center", message, centre.words[0])


def _fitted(control: Control, ends: tuple[Point, Point], center: Point, word: Word) -> Point:
    finding, fitted = arcs.fitted_center(*ends, center, BOUNDS)
    if finding != arcs.FITS:
        refuse_arc(control, finding, word, *(distance(each, center) for each in ends))
    return fitted


def _arc(control: Control, *, clockwise: bool) -> None:
    turns, goal = _turns(control), target(control)
    center = _center(control, goal, clockwise=clockwise)
    compensation = in_force(control)
    if memory_of(control).leading_out:
        message = "behind compensation a straight move must lead out, not an arc"
        control.fail("compensation-end", message)
    if compensation is not None and compensation.radius > 0.0:
        compensation.arc(goal, center, -turns if clockwise else turns)
        return
    sweep_arc(control, goal, center, clockwise=clockwise, turns=turns - 1)


def clockwise_arc(control: Control) -> None:
    """G2."""
    _arc(control, clockwise=True)


def counter_clockwise_arc(control: Control) -> None:
    """G3."""
    _arc(control, clockwise=False)


CLOCKWISE = Interpolation(
    clockwise_arc, rule=ArcRule(clockwise=True, bounds=BOUNDS), without_words=refuse_alone
)
COUNTER_CLOCKWISE = Interpolation(
    counter_clockwise_arc,
    rule=ArcRule(clockwise=False, bounds=BOUNDS),
    without_words=refuse_alone,
)
