"""Arcs of LinuxCNC: a centre from the start or absolute, a radius, several turns."""

from twin.nc.control.control import Control
from twin.nc.control.modal import ArcRule
from twin.nc.dialects.linuxcnc.compensation import in_force
from twin.nc.dialects.linuxcnc.memory import memory_of
from twin.nc.dialects.linuxcnc.motion import target
from twin.nc.geometry.arcs import Bounds
from twin.nc.iso.circular import (
    arc_center,
    both_senses,
    plane_center_letters,
    refuse_missing_center,
    sweep_arc,
)

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


def _refuse_half(control: Control) -> None:
    letters = plane_center_letters(control)
    given = [control.words[letter] for letter in letters if letter in control.words]
    if control.modal.center_absolute and len(given) == 1 and "R" not in control.words:
        message = f"with G90.1 the centre needs {' and '.join(letters)}"
        control.fail("arc-center", message, given[0])


def _arc(control: Control, rule: ArcRule) -> None:
    turns, goal = _turns(control), target(control)
    _refuse_half(control)
    center = arc_center(control, goal, rule)
    compensation = in_force(control)
    if memory_of(control).leading_out:
        message = "behind compensation a straight move must lead out, not an arc"
        control.fail("compensation-end", message)
    if compensation is not None and compensation.radius > 0.0:
        compensation.arc(goal, center, -turns if rule.clockwise else turns)
        return
    sweep_arc(control, goal, center, clockwise=rule.clockwise, turns=turns - 1)


CLOCKWISE, COUNTER_CLOCKWISE = both_senses(_arc, ArcRule(bounds=BOUNDS), refuse_missing_center)
