"""Planes, offsets and tools of the Fagor CNC 8070."""

import math

from twin.nc.control.codes import Action
from twin.nc.control.compensation import (
    change_side,
    compensate,
    side_in_force,
    tool_numbered,
)
from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.frames.machine_coordinates import (
    refuse_change,
    refuse_offset_change,
)
from twin.nc.dialects.fagor8070.memory import OFFSETS_BY_NUMBER, memory_of, offset_name
from twin.nc.dialects.fagor8070.polar import forget_polar
from twin.nc.geometry.planes import OWN_PLANE, Plane, Vector, cross
from twin.nc.iso import base
from twin.nc.iso.declared import refuse_compensated_plane
from twin.nc.iso.offsets import programmed_shift, select_offset, shift_by
from twin.nc.iso.tool_change import go_to_change_height
from twin.nc.iso.tool_compensation import radius_in_spindle, set_length
from twin.nc.path.compensation.stage import SideChange
from twin.nc.text.blocks import Word


def choose_plane(control: Control) -> None:
    """G17, G18, G19; one that compensation is in force in stays as it is."""
    if not control.path.compensation.acts_in(control.motion.part_plane):
        change_plane(control)


def change_plane(control: Control) -> None:
    """The plane becomes another, with part zero as polar origin."""
    refuse_compensated_plane(control)
    memory = memory_of(control)
    if not math.isnan(memory.rotation):
        message = "the plane cannot change while a rotation turns it"
        control.fail("rotation-active", message, hint="end it by G73 alone")
    memory.polar_origin = (0.0, 0.0)
    forget_polar(control)


def any_plane(control: Control) -> None:
    """G20 X1 Z2: abscissa (1), ordinate (2) and, if written, perpendicular axis (3).

    Decision: G03 turns from the abscissa towards the ordinate, whatever axes they are.
    """
    change_plane(control)
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


def offset_code(number: int) -> Action:
    """G54 to G59, by the number of the G code."""
    return lambda control: _select_offset(control, f"G{number}", control.code_word(number))


def numbered_offset(control: Control, word: Word) -> None:
    """G159=2: the work offset by its number; 1 to 6 are G54 to G59."""
    number = control.number(word)
    if number != int(number) or not 1 <= number <= OFFSETS_BY_NUMBER:
        control.fail("no-offset", f"there is no work offset {number:g}", word)
    refuse_offset_change(control)
    _select_offset(control, offset_name(int(number)), word)
    forget_polar(control)


def _select_offset(control: Control, name: str, word: Word | None) -> None:
    written = memory_of(control).offsets.get(name)
    if written is None:
        select_offset(control, name, word)
    else:
        shift_by(control, written)


def incremental_offset(control: Control) -> None:
    """G158 X Y: added to the work offset; without axes it ends."""
    refuse_offset_change(control)
    programmed_shift(control, "increment")
    forget_polar(control)


# --- tools and the rotary axis


def tool_offset(control: Control, word: Word) -> None:
    """D1: the tool's own length and radius; D0: none."""
    refuse_change(control)
    number = control.number(word)
    if number not in (0.0, 1.0):
        message = f"the job gives every tool one offset, D1, not D{number:g}"
        control.fail("tool-offset", message, word)
    _apply_offset(control, on=number == 1.0)


def next_tool(control: Control, word: Word) -> None:
    """T: the tool that M06 brings, known to the job; T0 leaves the spindle empty."""
    number = control.number(word)
    if control.tools.table and number not in control.tools.table and number != 0.0:
        tool_numbered(control, word)
    base.next_tool(control, word)


def change_tool(control: Control) -> None:
    """M06: the tool goes into the spindle with its offset D1; T0 has none."""
    refuse_change(control)
    go_to_change_height(control)
    control.tools.change()
    _apply_offset(control, on=True)


def _apply_offset(control: Control, *, on: bool) -> None:
    """The tool's length and radius count, or do not."""
    memory_of(control).offset_on = on
    tool = control.tools.data(control.tools.spindle) if on else None
    set_length(control, 0.0 if tool is None else control.tools.length_difference(tool))


def compensation_by_tool(side: float) -> Action:
    """G41, G42: compensation by the tool in the spindle, where it has its offset."""

    def action(control: Control) -> None:
        radius = radius_in_spindle(control)
        if control.path.compensation.in_force and side != side_in_force(control):
            word = control.code_word(41 if side > 0.0 else 42)
            change_side(control, side, radius, word, SideChange.CROSSING)
        else:
            compensate(control, side, radius if memory_of(control).offset_on else 0.0)

    return action
