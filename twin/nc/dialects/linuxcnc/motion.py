"""Straight motion of LinuxCNC: polar words, machine coordinates, stored positions, threads, probing."""

import math
from typing import NoReturn

from twin.nc.control.codes import Action, Interpolation
from twin.nc.control.control import Control
from twin.nc.control.modal import ArcRule
from twin.nc.dialects.linuxcnc.compensation import in_force
from twin.nc.dialects.linuxcnc.memory import memory_of
from twin.nc.dialects.linuxcnc.offsets import refuse_changed_unit, refuse_in_compensation
from twin.nc.geometry.arcs import Bounds
from twin.nc.geometry.planes import XY
from twin.nc.iso import base
from twin.nc.iso.circular import (
    arc_center,
    both_senses,
    plane_center_letters,
    refuse_missing_center,
    sweep_arc,
)
from twin.nc.iso.offsets import machine_zero, place_from_machine_zero
from twin.nc.path.feed_rates import FeedMode
from twin.nc.text.blocks import Word


def check_feed(control: Control, rapid: bool) -> None:
    """A move with a feed needs one; with G93 in its own block."""
    if rapid:
        return
    base.require_feed_of_block(control)
    if not control.motion.feed:
        message = "no feed is programmed, and the control moves nowhere without one"
        hint = "write F in this block or before"
        control.fail("no-feed", message, hint=hint)


def need_axes(control: Control) -> NoReturn:
    """A motion code that wants words of axes has none."""
    message = "the code moves where its block says, and no word of an axis is in it"
    control.fail("code-words", message, hint="write its axes in its block")


def require_axes(control: Control) -> None:
    """Refuse a block without words of axes."""
    if control.words.keys().isdisjoint({*control.axis_letters, "@", "^"}):
        need_axes(control)


def target(control: Control) -> list[float]:
    """Take the axis words and @ ^; the programmed position that they ask for, shape (k,)."""
    radius, angle = control.take("@"), control.take("^")
    if radius is None and angle is None:
        return control.target()
    _refuse_mixed(control, radius or angle)
    goal = control.target()
    x, y = goal[0], goal[1]
    at_origin = x == 0.0 and y == 0.0
    length, direction = math.hypot(x, y), math.atan2(y, x)
    incremental = control.modal.incremental
    if at_origin and (incremental or angle is None):
        message = "polar coordinates have no direction where the tool is at their origin"
        control.fail("code-words", message, radius or angle, "write both @ and ^, with G90")
    if radius is not None:
        length = control.length(radius) + (length if incremental else 0.0)
    if angle is not None:
        turn = math.radians(control.number(angle))
        direction = turn + (direction if incremental else 0.0)
    goal[0], goal[1] = length * math.cos(direction), length * math.sin(direction)
    return goal


def _refuse_mixed(control: Control, word: Word | None) -> None:
    if "X" in control.words or "Y" in control.words:
        control.fail("code-words", "a point has X and Y, or @ and ^", word)
    if control.modal.plane is not XY:
        control.fail("code-words", "@ and ^ count in the plane of X and Y", word, "write G17")


def _straight(control: Control, rapid: bool) -> None:
    goal, compensation = target(control), in_force(control)
    memory_of(control).leading_out = False
    if compensation is not None and compensation.radius > 0.0:
        compensation.line(goal, rapid=rapid)
    else:
        control.line_to(goal, rapid=rapid)


POSITIONING, LINEAR = base.straight(_straight, lambda control: check_feed(control, False))


def in_machine_coordinates(control: Control) -> None:
    """G53: G0 or G1 to a position in machine coordinates."""
    refuse_in_compensation(control)
    refuse_changed_unit(control)
    mode = control.modal.interpolation
    if mode not in (POSITIONING, LINEAR) or control.modal.cycle is not None:
        control.fail("machine-coordinates", "G53 moves with G0 or G1 only", hint="write G53 G0 Z0")
    if control.modal.incremental:
        message = "G53 counts from machine zero, not with G91"
        hint = "write G90 before"
        control.fail("machine-coordinates", message, hint=hint)
    words = control.take_axis_words()
    if not words:
        codes = [word.value for word in control.block.words if word.address == "G"]
        if 0.0 not in codes and 1.0 not in codes:
            message = "G53 needs G0 or G1 in its block, or words of axes"
            control.fail("machine-coordinates", message, hint="write G53 G0 Z0")
        return
    assert mode is not None
    check_feed(control, mode.rapid)
    zero, goal = machine_zero(control, "G53"), list(control.motion.part)
    for index, word in words:
        goal[index] = control.axis_value(index, word) + zero.get(word.address, 0.0)
    control.line_to(control.frame.to_programmed(goal), rapid=mode.rapid)


def go_home(place: int) -> Action:
    """G28, G30: by the words of the block, if any, to the stored position.

    Axes that the block does not name keep their programmed coordinates: in a turned system the stored
    position is turned back first, and X alone moves along the turned X (``rs274``).
    """

    def action(control: Control) -> None:
        refuse_in_compensation(control)
        refuse_changed_unit(control)
        zero = machine_zero(control, ("G28", "G30")[place])
        named = [control.axis_index.get(letter) for letter in control.words]
        axes = [axis for axis in named if axis is not None]
        if axes:
            control.line_to(target(control), rapid=True)
        stored, names = memory_of(control).homes[place], control.settings.axes.names
        home = control.frame.to_programmed(
            [at + zero.get(name, 0.0) for at, name in zip(stored, names, strict=True)]
        )
        goal = list(control.motion.programmed)
        for axis in axes or range(len(goal)):
            goal[axis] = home[axis]
        control.line_to(goal, rapid=True)

    return action


def store_home(place: int) -> Action:
    """G28.1, G30.1: where the axes are is the stored position from now on."""

    def action(control: Control) -> None:
        homes = memory_of(control).homes
        homes[place] = place_from_machine_zero(control, ("G28.1", "G30.1")[place])

    return action


# --- moves that follow the spindle


def _pitch_feed(control: Control, code: str) -> float:
    """Feed of a move that goes K further with each turn [mm/min]."""
    pitch = control.take("K")
    if pitch is None:
        control.fail("code-words", f"{code} needs K, the distance of each turn")
    if not control.motion.spindle_turns:
        message = f"{code} follows a spindle that turns"
        control.fail("spindle-needed", message, hint="write S and M3 before")
    if not control.motion.spindle:
        message = f"{code} follows the spindle, which stands at S0"
        control.fail("spindle-needed", message, hint="write S above 0 before")
    return abs(control.length(pitch)) * control.motion.spindle


def _line_with_feed(control: Control, goal: list[float], feed: float) -> None:
    modal, before = control.modal, (control.modal.feed_mode, control.motion.feed)
    modal.feed_mode, control.motion.feed = FeedMode.PER_MINUTE, feed / modal.unit
    control.line_to(goal, rapid=False)
    modal.feed_mode, control.motion.feed = before


def thread(control: Control) -> None:
    """G33: a straight move of K with each turn of the spindle."""
    refuse_in_compensation(control)
    require_axes(control)
    feed = _pitch_feed(control, "G33")
    _line_with_feed(control, target(control), feed)


def tap(control: Control) -> None:
    """G33.1: the same and back again, with the spindle reversed."""
    refuse_in_compensation(control)
    require_axes(control)
    feed, start = _pitch_feed(control, "G33.1"), list(control.motion.programmed)
    _line_with_feed(control, target(control), feed)
    forward = memory_of(control).functions.get("spindle", 3.0) == 3.0
    speed = {"S": control.motion.spindle or 0.0}
    control.function("M4" if forward else "M3", speed)
    _line_with_feed(control, start, feed)
    control.function("M3" if forward else "M4", speed)


THREAD = Interpolation(thread, without_words=need_axes)
TAP = Interpolation(tap, without_words=need_axes)


def probe(control: Control) -> None:
    """G38.3, G38.5: to the end of the probing path; nothing touches the twin's probe."""
    refuse_in_compensation(control)
    require_axes(control)
    check_feed(control, False)
    if control.modal.feed_mode is not FeedMode.PER_MINUTE:
        control.fail("code-words", "probing needs a feed per minute", hint="write G94 F")
    goal = target(control)
    control.function("G38", {})
    control.line_to(goal, rapid=False)
    memory_of(control).probe = [
        value / control.motion.unit_of(axis) for axis, value in enumerate(control.motion.programmed)
    ]


PROBE = Interpolation(probe, without_words=need_axes)


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
