"""Planes, offsets and tools of the Fagor CNC 8070."""

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import Assembler
from twin.nc.bytecode.registers import OFFSET_ON
from twin.nc.control.compensation import tool_numbered
from twin.nc.control.control import Control
from twin.nc.control.performer import refuse
from twin.nc.dialects.fagor8070.machine_coordinates import refuse_change
from twin.nc.dialects.fagor8070.polar import write_forgotten_polar
from twin.nc.geometry.planes import OWN_PLANE, Plane, Vector, cross
from twin.nc.iso import base
from twin.nc.iso.declared import write_plane
from twin.nc.iso.findings import PLANE_COMPENSATED
from twin.nc.iso.offsets import programmed_shift
from twin.nc.text.blocks import Word


def any_plane(control: Control) -> None:
    """G20 X1 Z2: abscissa (1), ordinate (2) and, if written, perpendicular axis (3).

    Decision: G03 turns from the abscissa towards the ordinate, whatever axes they are.
    """
    if control.path.compensating:
        refuse(control, PLANE_COMPENSATED)
    control.perform(lambda assembler: write_plane(0, assembler))
    roles: dict[int, Vector] = {}
    for index, word in control.take_axis_words():
        role = int(control.number(word))
        if role not in (1, 2, 3) or role in roles or index > 2:
            message = "1, 2 and 3 name abscissa, ordinate and the axis across"
            control.fail("plane-axes", message, word)
        x, y, z = (1.0 if each == index else 0.0 for each in range(3))
        roles[role] = (x, y, z)
    if 1 not in roles or 2 not in roles:
        control.fail("plane-axes", "G20 needs abscissa and ordinate", hint="write G20 X1 Y2")
    normal = cross(roles[1], roles[2])
    control.modal.plane = Plane(OWN_PLANE, roles[1], roles[2], normal)


def incremental_offset(control: Control, assembler: Assembler) -> None:
    """G158 X Y: added to the work offset; without axes it ends."""
    assembler.disturbed(lambda: refuse_change(control))
    programmed_shift("increment", control, assembler)
    write_forgotten_polar(assembler)


# --- tools and the rotary axis


def tool_offset(control: Control, word: Word, assembler: Assembler) -> None:
    """D1: the tool's own length and radius; D0: none."""
    assembler.disturbed(lambda: refuse_change(control))
    number = assembler.known(word)
    if number not in (0.0, 1.0):
        message = f"the job gives every tool one offset, D1, not D{number:g}"
        control.fail("tool-offset", message, word)
    _apply_offset(number, assembler)


def next_tool(control: Control, word: Word, assembler: Assembler) -> None:
    """T: the tool that M06 brings, known to the job; T0 leaves the spindle empty."""
    assembler.word_value(word)
    if control.tools.table:
        assembler.check(opcodes.LISTED_TOOL, lambda: _look_for_tool(control, word))
    base.select_tool(assembler)


def change_tool(control: Control, assembler: Assembler) -> None:
    """M06: the tool goes into the spindle with its offset D1; T0 has none."""
    assembler.disturbed(lambda: refuse_change(control))
    base.change_tool(control, assembler)
    _apply_offset(1.0, assembler)


def _look_for_tool(control: Control, word: Word) -> None:
    if control.number(word) != 0.0:
        tool_numbered(control, word)


def _apply_offset(number: float, assembler: Assembler) -> None:
    """The tool's length and radius count, or (0) do not."""
    assembler.constant(number)
    assembler.set_register(OFFSET_ON)
    assembler.emit(opcodes.TOOL_LENGTH)


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
