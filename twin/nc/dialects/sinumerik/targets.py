"""Where a block of the SINUMERIK goes: Cartesian or polar, each word as it counts.

``X=IC(5)`` counts from where the tool is, ``X=AC(5)`` from zero, ``C=DC(90)`` goes there the shorter way,
``C=ACP(90)`` and ``C=ACN(90)`` in one direction. A frame that has changed is made up for by the next
incremental word of an axis (setting data 42440 and 42442 in the state of delivery).
"""

import math

from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik.memory import memory_of
from twin.nc.geometry.arcs import TURN
from twin.nc.iso.polar_words import aim_by_polar, point_at
from twin.nc.text.blocks import Word

_WAYS = ("DC", "ACP", "ACN")
"""How a rotary axis finds its target within a turn."""
POLAR_WORDS = frozenset(("AP", "RP"))


def forget_polar(control: Control) -> None:
    """The last polar values no longer hold: they are computed again from where the tool is."""
    memory = memory_of(control)
    memory.polar_radius = memory.polar_angle = math.nan


def frame_changes(control: Control) -> list[float]:
    """A frame is about to change: where the tool is as programmed, for ``frame_changed``."""
    return list(control.motion.programmed)


def frame_changed(control: Control, before: list[float]) -> None:
    """It has changed: what the next incremental words make up for."""
    control.motion.reframed()
    memory = memory_of(control)
    carried = memory.carried or [0.0] * len(before)
    moved = [
        old + was - new
        for old, was, new in zip(carried, before, control.motion.programmed, strict=True)
    ]
    memory.carried = moved if any(moved) else None
    forget_polar(control)


def take_target(control: Control) -> list[float]:
    """Take the words of axes, or AP and RP with those of other axes; the programmed position, shape (k,)."""
    if not POLAR_WORDS.isdisjoint(control.words):
        return _polar_target(control)
    memory = memory_of(control)
    names = control.settings.axes.names
    words = [each for name in names if (each := control.words.get(name)) is not None]
    target = control.target()
    for word in words:
        index = control.axis_index[word.address]
        if memory.carried is not None and (
            word.incremental or (control.modal.incremental and not word.mark)
        ):
            target[index] += memory.carried[index]
        if word.mark in _WAYS:
            target[index] = _as_word_counts(control, index, word)
    if words and memory.carried is not None:
        for word in words:
            memory.carried[control.axis_index[word.address]] = 0.0
        if not any(memory.carried):
            memory.carried = None
    if any(control.axis_index[word.address] in control.modal.plane.axes[:2] for word in words):
        forget_polar(control)
    return target


def _as_word_counts(control: Control, index: int, word: Word) -> float:
    """Target of a rotary axis that is reached within a turn."""
    value = control.number(word)
    if control.motion.linear[index]:
        message = f"{word.mark} chooses the direction of a rotary axis, and {word.address} is none"
        control.fail("rotary-direction", message, word, f"write {word.address}=AC(...) or IC(...)")
    if not 0.0 <= value < TURN:
        message = f"{word.mark} goes to an angle from 0 to below 360, not to {value:g}"
        control.fail("rotary-direction", message, word)
    here = control.motion.programmed[index]
    forwards = (value - here) % TURN
    if word.mark == "ACN":
        return here - (here - value) % TURN
    if word.mark == "DC" and forwards > TURN / 2.0:
        return here + forwards - TURN
    return here + forwards


def shows_within_turn(control: Control) -> None:
    """Behind DC, ACP and ACN a rotary axis shows its angle within a turn."""
    for word in control.block.words:
        if word.mark in _WAYS:
            programmed, index = list(control.motion.programmed), control.axis_index[word.address]
            programmed[index] %= TURN
            control.motion.set_position(programmed, "turns")


# --- polar coordinates


def _polar_target(control: Control) -> list[float]:
    """Take AP and RP, which do not heed G91 (manual)."""
    memory, plane = memory_of(control), control.modal.plane
    names = control.settings.axes.names
    for axis in plane.axes[:2]:
        if names[axis] in control.words:
            word = control.words[names[axis]]
            message = (
                f"{word.text} and polar coordinates both say where the block goes in the plane"
            )
            control.fail(
                "polar-mixed", message, word, "write AP= and RP=, or both axes of the plane"
            )
    words = (control.take("RP"), control.take("AP"))
    target = take_target(control)
    last = (memory.polar_radius, memory.polar_angle)
    memory.polar_radius, memory.polar_angle = aim_by_polar(
        control, target, memory.pole, last, words
    )
    return target


def set_pole(number: int, control: Control) -> None:
    """G110, G111, G112: the pole from where the tool is, from zero, or from the pole before.

    The pole is given by axes of the plane, or by AP and RP. A coordinate that is missing is 0.
    """
    memory, plane = memory_of(control), control.modal.plane
    base = {110: plane.point(control.motion.programmed), 111: (0.0, 0.0), 112: memory.pole}[number]
    radius, angle = control.take("RP"), control.take("AP")
    words = dict(control.take_axis_words())
    shift = [
        control.axis_value(axis, words[axis]) if axis in words else 0.0 for axis in plane.axes[:2]
    ]
    if radius is not None or angle is not None:
        if words or radius is None or angle is None:
            message = f"G{number} takes the axes of the plane, or AP= and RP= together"
            control.fail("polar-mixed", message, radius or angle)
        shift = list(
            point_at((0.0, 0.0), (math.inf, 0.0), control.length(radius), control.number(angle))
        )
    memory.pole = (base[0] + shift[0], base[1] + shift[1])
    forget_polar(control)
