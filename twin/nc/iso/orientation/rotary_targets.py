"""Direction in which a rotary axis turns to an absolute angle, where a control does not go there as written.

The axis itself does not move for it: its start is given other coordinates, by whole turns, so that the plain difference is
the way that the control goes.
"""

import math
from collections.abc import Iterator

from twin.nc.control.control import Control
from twin.nc.geometry.arcs import TURN
from twin.nc.text.blocks import Word


def absolute_targets(control: Control) -> Iterator[tuple[int, Word, float]]:
    """Column, word and angle [deg] of each rotary axis that the block names in absolute coordinates."""
    for index, name in enumerate(control.settings.axes.names):
        word = control.words.get(name)
        if word is None or control.motion.linear[index] or word.incremental:
            continue
        if word.mark or not control.modal.incremental:
            yield index, word, control.number(word)


def start_at(control: Control, index: int, start: float) -> None:
    """Give the place where an axis is another coordinate."""
    programmed = list(control.motion.programmed)
    if programmed[index] != start:
        programmed[index] = start
        control.motion.set_position(programmed, "turns")


def go_shorter(control: Control, index: int, target: float, period: float = TURN) -> None:
    """Let an axis go the shorter way to a target; half a turn goes forwards (decision)."""
    here = control.motion.programmed[index]
    start_at(control, index, here + period * math.ceil((target - here) / period - 0.5))


def go_by_sign(control: Control, index: int, word: Word, value: float) -> None:
    """Let an axis go to the amount of a value, forwards or, where it has a minus, backwards, by less than a turn."""
    target, here = abs(value), control.motion.programmed[index] % TURN
    backwards = value < 0.0 or str(value).startswith("-")
    start = here
    if backwards and here < target:
        start = here + TURN
    elif not backwards and here > target:
        start = here - TURN
    start_at(control, index, start)
    control.words[control.settings.axes.names[index]] = word._replace(value=target)


def turn_by_sign(control: Control) -> None:
    """With ``module_rotary`` absolute rotary targets are reached in the direction of their sign, within a turn.

    Raises:
        ProgramError: The target is a turn or more.
    """
    if not control.settings.module_rotary:
        return
    for index, word, value in absolute_targets(control):
        if abs(value) >= TURN:
            control.fail("module-range", "the target of a module axis is below one turn", word)
        go_by_sign(control, index, word, value)
