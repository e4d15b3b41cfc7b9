"""The tool change, and the height that Z goes to by itself for it."""

from twin.nc.control.codes import Action
from twin.nc.control.control import Control
from twin.nc.iso.machine_coordinates import machine_frame

_Z = 2


def change_tool_at(usual: float | None) -> Action:
    """M6: the selected tool goes into the spindle, Z at the height of the change before.

    The height is that of the machine file or the job (``[tool_change]``), else the control's own. Z goes
    there rapidly; where it is higher already it stays. Only a height that somebody wrote down asks for part
    zero: the control's own is left out where nobody says where the part is.

    Args:
        usual: Height that the control goes to of its own accord, machine coordinates [mm]; None: it changes
            the tool where it is.
    """

    def action(control: Control) -> None:
        go_to_change_height(control, usual)
        control.tools.change()

    return action


def go_to_change_height(control: Control, usual: float | None = None) -> None:
    """Rise to the height of the tool change.

    Raises:
        ProgramError: The job or the machine gives a height, and the job does not say where part zero is; or
            radius compensation is in force.
    """
    given, zero = control.settings.tool_change_height, control.settings.machine_zero
    height = usual if given is None else given
    if height is None or (given is None and zero is None):
        return
    with machine_frame(control, "the height of the tool change"):
        if control.motion.programmed[_Z] < height:
            there = list(control.motion.programmed)
            there[_Z] = height
            control.line_to(there, rapid=True)
