"""Tool centre point control and tilted planes, as several dialects have them.

Decisions:

* Programmed X, Y and Z count in a frame that is fixed to the part, and parallel to the machine's axes while the
  rotary axes that carry the part are at the zero of their work offset.
* F counts the way of the tip in the part; where it rests, the degrees of the rotary axes.
* Rotary axes go evenly between the angles of two blocks; the tip goes straight or on its arc also in rapids.
"""

from twin.nc.control.control import Control
from twin.nc.path.tool_center import ToolCenter


def begin_tool_center(control: Control, name: str, *, tilted: bool = False) -> None:
    """Lead the tip of the tool from now on.

    Args:
        control: The control.
        name: What the program calls it, for diagnostics.
        tilted: The tool stands across a tilted plane, and no rotary axis moves.

    Raises:
        ProgramError: No axis of the machine turns, or radius compensation is in force.
    """
    setup = control.settings.setup
    if setup is None:
        message = f"{name} leads the tip while axes turn, and no axis of this machine does"
        control.fail(
            "tool-center", message, hint="leave it out, or run it on a machine with rotary axes"
        )
    _refuse_compensation(control, name)
    longer = length_in_force(control)
    control.frame.set_shift("length", [0.0] * len(control.settings.axes))
    control.motion.lead_tip(ToolCenter(setup, longer, control.frame.zero(), tilted=tilted))


def end_tool_center(control: Control, name: str, *, keeps_length: bool = False) -> None:
    """Programmed positions are those of the axes again; nothing moves.

    Args:
        control: The control.
        name: What the program calls it, for diagnostics.
        keeps_length: The length of the tool stays in force, along Z.
    """
    center = control.path.tool_center
    if center is None:
        return
    _refuse_compensation(control, name)
    if keeps_length:
        axes = range(len(control.settings.axes))
        control.frame.set_shift("length", [center.longer if axis == 2 else 0.0 for axis in axes])
    control.motion.lead_tip(None)


def length_in_force(control: Control) -> float:
    """How much longer than the first the tool in force is [mm]."""
    center = control.path.tool_center
    return control.frame.shift("length")[2] if center is None else center.longer


def _refuse_compensation(control: Control, name: str) -> None:
    if control.path.compensation.in_force:
        message = f"{name} cannot change while radius compensation is in force"
        control.fail("compensation-change", message, hint="end it before")
