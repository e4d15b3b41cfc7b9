"""Tool centre point control and tilted planes, as several dialects have them.

Decisions:

* Programmed X, Y and Z count in a frame that is fixed to the part, and parallel to the machine's axes while the
  rotary axes that carry the part are at the zero of their work offset.
* F counts the path of the tip in the part; where it rests, the degrees of the rotary axes.
* Rotary axes go evenly between the angles of two blocks, or turn the tool in the plane of both directions where the
  control says so (``path.tool_center.great_circle``); the tip goes straight or on its arc also in rapids.
"""

import math

from twin.nc.control.control import Control
from twin.nc.geometry.matrices import applied
from twin.nc.geometry.planes import Vector
from twin.nc.path.tool_center.tool_center import ToolCenter
from twin.nc.text.blocks import Word


def begin_tool_center(
    control: Control, name: str, *, tilted: bool = False, in_plane: bool = False
) -> None:
    """Lead the tip of the tool from now on.

    Args:
        tilted: The tool stands across a tilted plane, and no rotary axis moves.
        in_plane: The tool turns in the plane of both directions; else the rotary axes go evenly.
    """
    setup = control.settings.setup
    if setup is None:
        message = f"{name} leads the tip while axes turn, and no axis of this machine does"
        control.fail(
            "tool-center", message, hint="leave it out, or run it on a machine with rotary axes"
        )
    _refuse_compensation(control, name)
    length_difference = length_in_force(control)
    control.frame.set_shift("length", [0.0] * len(control.settings.axes))
    control.motion.lead_tip(
        ToolCenter(setup, length_difference, control.frame.zero(), tilted=tilted)
    )
    control.motion.in_plane = in_plane


def end_tool_center(control: Control, name: str, *, keeps_length: bool = False) -> None:
    """Programmed positions are those of the axes again; nothing moves.

    Args:
        keeps_length: The length of the tool stays in force, along Z.
    """
    center = control.path.tool_center
    if center is None:
        return
    _refuse_compensation(control, name)
    if keeps_length:
        axes = range(len(control.settings.axes))
        control.frame.set_shift(
            "length", [center.length_difference if axis == 2 else 0.0 for axis in axes]
        )
    control.motion.lead_tip(None)


def point_by_words(control: Control, direction: Vector, at: Word, *, in_frame: bool = True) -> None:
    """Let the block's words of rotary axes be those that point the tool, whose tip is led, in a direction.

    Args:
        direction: From the tip to the spindle, programmed coordinates, of any length above 0.
        in_frame: The frame turns it; else it counts in the part as it is.
    """
    center = control.path.tool_center
    assert center is not None
    turned = applied(control.frame.matrix, direction) if in_frame else direction
    length = math.hypot(*turned)
    if length == 0.0:
        control.fail("tool-center", "the direction of the tool has no length", at)
    x, y, z = turned
    try:
        there = center.pointing((x / length, y / length, z / length), control.motion.part)
    except ValueError as error:
        control.fail("tool-center", str(error), at)
    aim_words(control, [a - b for a, b in zip(there, control.frame.total, strict=True)], at)


def aim_words(control: Control, axes: list[float], at: Word) -> None:
    """Let the block's words of rotary axes lead to a programmed position, shape (k,), as absolute ones.

    Args:
        axes: The position; X, Y and Z are not looked at.
        at: Which word says it.
    """
    for column, name in enumerate(control.settings.axes.names):
        if column > 2 and axes[column] != control.motion.programmed[column]:
            control.words[name] = Word(name, axes[column], at.column, at.width, mark="AC")


def length_in_force(control: Control) -> float:
    """How much longer than the first the tool in force is [mm]."""
    center = control.path.tool_center
    return control.frame.shift("length")[2] if center is None else center.length_difference


def _refuse_compensation(control: Control, name: str) -> None:
    if control.path.compensation.in_force:
        message = f"{name} cannot change while radius compensation is in force"
        control.fail("compensation-change", message, hint="end it before")
