"""Coordinate systems of Grbl, what shifts them, and moves that count from machine zero.

A programmed position is shifted by G92, by G43.1 along Z, and to the zero of the coordinate system.
"""

from collections.abc import Mapping

from twin.nc.control.codes import Action
from twin.nc.control.control import Control, integer_of
from twin.nc.dialects.grbl.memory import SYSTEMS, memory_of
from twin.nc.iso.base import require_feed_of_block
from twin.nc.iso.offsets import (
    machine_zero,
    note_written,
    place_from_machine_zero,
    refuse_empty_preset,
    table_zero,
)
from twin.nc.text.blocks import Statement, Word

_Z = 2


def begin(control: Control) -> None:
    """Take the job's coordinate systems over."""
    memory, names = memory_of(control), control.settings.axes.names
    zeros = [0.0] * len(names)
    memory.preset, memory.homes = list(zeros), [list(zeros), list(zeros)]
    for number, system in enumerate(SYSTEMS, 1):
        values = control.settings.offsets.get(system, {} if number == 1 else None)
        if values is not None:
            memory.systems[number] = [values.get(name, 0.0) for name in names]
    reframe(control)


def reframe(control: Control) -> None:
    """Put coordinate system, preset and tool length into force; nothing moves."""
    memory = memory_of(control)
    lengths = [memory.length if axis == _Z else 0.0 for axis in range(len(memory.preset))]
    control.frame.set_shift("offset", list(memory.systems[memory.system]))
    control.frame.set_shift("preset", list(memory.preset))
    control.frame.set_shift("length", lengths)
    control.motion.reframed()


def select_system(number: int) -> Action:
    """G54 to G59."""

    def action(control: Control) -> None:
        memory, name = memory_of(control), SYSTEMS[number - 1]
        if number not in memory.systems:
            known = ", ".join(SYSTEMS[each - 1] for each in sorted(memory.systems))
            message = f"neither the job nor the program gives a work offset {name}"
            hint = f"write it under [offsets.{name}], or by G10 L2 P{number}; known: {known}"
            control.fail("no-offset", message, control.code_word(float(name[1:])), hint)
        memory.system = number
        reframe(control)

    return action


def write_system(control: Control) -> None:
    """G10 L2 P: the zero of a system in machine coordinates; L20: the place where it is gets coordinates."""
    kind, number, words = control.take("L"), control.take("P"), control.take_axis_words()
    if kind is None or number is None or control.number(kind) not in (2.0, 20.0):
        message = "G10 needs L2 or L20, and P, the number of a coordinate system"
        control.fail(
            "code-words", message, kind, "write G10 L2 P1 X0: P1 is G54, P0 the one in force"
        )
    which = integer_of(control.number(number))
    if not 0 <= which <= len(SYSTEMS):
        message = f"{number.text} is no coordinate system"
        control.fail("code-words", message, number, "P1 is G54, P6 is G59, P0 the one in force")
    if not words:
        control.fail("code-words", "G10 needs the coordinates that it writes")
    memory = memory_of(control)
    which = which or memory.system
    here = control.number(kind) == 20.0
    machine, names = table_zero(control, "G10"), control.settings.axes.names
    zero = memory.systems.setdefault(which, [machine.get(name, 0.0) for name in names])
    for index, word in words:
        value = control.axis_value(index, word)
        if here:
            length = memory.length if index == _Z else 0.0
            zero[index] = control.motion.part[index] - memory.preset[index] - length - value
        else:
            note_written(control, names[index], value)
            zero[index] = value + machine.get(names[index], 0.0)
    reframe(control)


def preset(control: Control) -> None:
    """G92: the place where the machine is gets the coordinates of the block."""
    memory, words = memory_of(control), control.take_axis_words()
    if not words:
        refuse_empty_preset(control)
    for index, word in words:
        memory.preset[index] += control.motion.programmed[index] - control.axis_value(index, word)
    reframe(control)


def end_preset(control: Control) -> None:
    """G92.1."""
    memory = memory_of(control)
    memory.preset = [0.0] * len(memory.preset)
    reframe(control)


def tool_length(control: Control) -> None:
    """G43.1 Z: how much longer the tool is than the one that zero was taken with."""
    words = control.take_axis_words()
    if [index for index, _ in words] != [_Z]:
        message = "G43.1 takes Z alone, the length of the tool"
        control.fail("code-words", message, words[0][1] if words else None, "write G43.1 Z12.5")
    memory_of(control).length = control.axis_value(*words[0])
    reframe(control)


def end_tool_length(control: Control) -> None:
    """G49."""
    memory_of(control).length = 0.0
    reframe(control)


def in_machine_coordinates(control: Control) -> None:
    """G53: G0 or G1 to a position in machine coordinates, whatever G90 and G91 say."""
    if control.modal.active.get("motion") not in (0.0, 1.0):
        control.fail("machine-coordinates", "G53 moves with G0 or G1 only", hint="write G53 G0 Z0")
    mode = control.modal.interpolation
    assert mode is not None
    words = control.take_axis_words()
    if not words:
        message = "G53 needs words of axes"
        control.fail("machine-coordinates", message, hint="write G53 G0 Z0")
    check_feed(control, mode.rapid)
    zero, goal = machine_zero(control, "G53"), list(control.motion.part)
    for index, word in words:
        goal[index] = control.axis_value(index, word) + zero.get(word.address, 0.0)
    control.line_to(control.frame.to_programmed(goal), rapid=mode.rapid)


def check_feed(control: Control, rapid: bool) -> None:
    """A move with a feed needs one; with G93 in its own block."""
    if rapid:
        return
    require_feed_of_block(control)
    if not control.motion.feed:
        message = "no feed is programmed, and the control moves nowhere without one"
        control.fail("no-feed", message, hint="write F in this block or before")


def go_home(place: int) -> Action:
    """G28, G30: by the words of the block, if any, to the stored position; axes not named stay."""

    def action(control: Control) -> None:
        zero = machine_zero(control, ("G28", "G30")[place])
        named = [control.axis_index.get(letter) for letter in control.words]
        axes = [axis for axis in named if axis is not None]
        if axes:
            control.line_to(control.target(), rapid=True)
        _go_to_stored(control, memory_of(control).homes[place], zero, axes)

    return action


def _go_to_stored(
    control: Control, stored: list[float], zero: Mapping[str, float], axes: list[int]
) -> None:
    goal, names = list(control.motion.part), control.settings.axes.names
    for axis in axes or range(len(goal)):
        goal[axis] = stored[axis] + zero.get(names[axis], 0.0)
    control.line_to(control.frame.to_programmed(goal), rapid=True)


def store_home(place: int) -> Action:
    """G28.1, G30.1: where the axes are is the stored position from now on."""

    def action(control: Control) -> None:
        homes = memory_of(control).homes
        homes[place] = place_from_machine_zero(control, ("G28.1", "G30.1")[place])

    return action


def run_command(control: Control, statement: Statement) -> None:
    """A line that begins with $: ``$H`` drives the axes to machine zero, Z first; ``$X`` unlocks what is not locked."""
    command = statement.text.strip().upper()
    if command == "X":
        return
    if command != "H":
        message = f"${command} is a command to Grbl's console, and no part of a program"
        control.fail(
            "unknown-word", message, statement, "leave it out: a program may hold $H and $X"
        )
    zero, names = machine_zero(control, "$H"), control.settings.axes.names
    for letters in ("Z", "XY"):
        goal = list(control.motion.part)
        for axis, name in enumerate(names):
            if name in letters:
                goal[axis] = zero.get(name, 0.0)
        control.line_to(control.frame.to_programmed(goal), rapid=True)


def refuse_axis(control: Control, word: Word) -> None:
    """A, B, C, U, V, W: Grbl moves three axes."""
    message = f"'{word.text}': Grbl 1.1 moves X, Y and Z alone"
    control.fail("no-such-axis", message, word, "another control's dialect moves further axes")
