"""Planes, offsets and tools of the Fagor CNC 8070."""

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import Assembler, UnsupportedError
from twin.nc.control.block_words import BlockWords
from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.machine_coordinates import refuse_change
from twin.nc.dialects.fagor8070.memory import memory_of
from twin.nc.dialects.fagor8070.polar import forget_polar, reset_polar_origin
from twin.nc.geometry.planes import Plane, Vector, cross
from twin.nc.iso.offsets import compile_programmed_shift
from twin.nc.iso.tool_compensation import refuse_plane_change, set_length, tool_numbered
from twin.nc.text.blocks import Word


def change_plane(control: Control) -> None:
    """G17, G18, G19: the polar origin goes back to part zero."""
    refuse_plane_change(control)
    if memory_of(control).rotation is not None:
        control.fail("rotation-active", "the plane cannot change while G73 turns it")
    reset_polar_origin(control)


def any_plane(control: Control) -> None:
    """G20 X1 Z2: abscissa (1), ordinate (2) and, if written, perpendicular axis (3).

    Decision: G03 turns from the abscissa towards the ordinate, whatever axes they are.
    """
    change_plane(control)
    roles: dict[int, Vector] = {}
    for index, word in control.take_axis_words():
        role = int(control.number(word))
        if role not in (1, 2, 3) or role in roles or index > 2:
            control.fail(
                "plane-axes", "1, 2 and 3 name abscissa, ordinate and the axis across", word
            )
        x, y, z = (1.0 if each == index else 0.0 for each in range(3))
        roles[role] = (x, y, z)
    if 1 not in roles or 2 not in roles:
        control.fail("plane-axes", "G20 needs abscissa and ordinate", hint="write G20 X1 Y2")
    normal = cross(roles[1], roles[2])
    control.modal.plane = Plane("G20", roles[1], roles[2], normal)


def incremental_offset(control: Control) -> None:
    """G158 X Y: added to the work offset; without axes it ends."""
    refuse_change(control)
    shift = [0.0] * len(control.settings.axes)
    for index, word in control.take_axis_words():
        shift[index] = control.axis_value(index, word)
    control.frame.set_shift("increment", shift)
    control.reframed()
    forget_polar(control)


# --- tools and the rotary axis


def tool_offset(control: Control, word: Word) -> None:
    """D1: the tool's own length and radius; D0: none."""
    refuse_change(control)
    number = control.number(word)
    if number not in (0.0, 1.0):
        message = f"the job gives every tool one offset, D1, not D{number:g}"
        control.fail("tool-offset", message, word)
    tool = control.tools.data(control.tools.spindle)
    longer = 0.0 if number == 0.0 or tool is None else control.tools.longer(tool)
    memory_of(control).offset_on = number == 1.0
    set_length(control, longer)


def select_tool(control: Control, word: Word) -> None:
    """T: the tool that M06 brings, known to the job; T0 leaves the spindle empty."""
    number = int(control.number(word))
    if control.tools.table and control.number(word) != 0.0:
        number = tool_numbered(control, word)
    control.tools.selected = number
    control.function(f"T{number}", {})


def compile_tool_offset(block: BlockWords, assembler: Assembler) -> None:
    """D0, D1, for the compiled tier.

    Raises:
        UnsupportedError: It is neither.
    """
    value = block.words.pop("D").value
    if value not in (0.0, 1.0):
        raise UnsupportedError
    assembler.emit(opcodes.OFFSET_ON, int(value == 1.0))
    assembler.emit(opcodes.TOOL_LENGTH)


def compile_tool(block: BlockWords, assembler: Assembler) -> None:
    """T, for the compiled tier."""
    assembler.word_value(block.words.pop("T"))
    assembler.emit(opcodes.TOOL, 1)


def compile_tool_change(_block: BlockWords, assembler: Assembler) -> None:
    """M06, for the compiled tier."""
    assembler.emit(opcodes.CHANGE_TOOL)
    assembler.emit(opcodes.OFFSET_ON, 1)
    assembler.emit(opcodes.TOOL_LENGTH)


def compile_increment(block: BlockWords, assembler: Assembler) -> None:
    """G158, for the compiled tier."""
    compile_programmed_shift("increment", block, assembler)
    assembler.emit(opcodes.REFRAME)
    assembler.emit(opcodes.FORGET_POLAR)


def change_tool(control: Control) -> None:
    """M06: the tool goes into the spindle with its offset D1; T0 has none."""
    refuse_change(control)
    control.tools.change()
    memory_of(control).offset_on = True
    tool = control.tools.data(control.tools.spindle)
    if control.tools.spindle == 0 and 0 not in control.tools.table:
        set_length(control, 0.0)
    elif tool is not None:
        set_length(control, control.tools.longer(tool))


def turn_in_commanded_direction(control: Control, _rapid: bool) -> None:
    """With ``module_rotary``: G90 turns in the direction of the sign, by less than a turn.

    Raises:
        ProgramError: The target is a turn or more.
    """
    if not control.settings.module_rotary or control.modal.incremental:
        return
    for index, name in enumerate(control.settings.axes.names):
        word = control.words.get(name)
        if word is None or control.linear[index] or word.incremental:
            continue
        value = control.number(word)
        if abs(value) >= 360.0:
            control.fail("module-range", "the target of a module axis is below one turn", word)
        target, here = abs(value), control.programmed[index] % 360.0
        backwards = value < 0.0 or str(value).startswith("-")
        start = here
        if backwards and here < target:
            start = here + 360.0
        elif not backwards and here > target:
            start = here - 360.0
        programmed = list(control.programmed)
        programmed[index] = start
        control.set_position(programmed, "turns")
        control.words[name] = word._replace(value=target)
