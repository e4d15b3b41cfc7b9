"""Tool radius and tool length: codes that most dialects share."""

from twin.nc.control.codes import Action, GCode
from twin.nc.control.compensation import NEEDS_TOOL, compensate, tool_numbered
from twin.nc.control.control import Control

LEFT, RIGHT = 1.0, -1.0


def _compensation_by_table(side: float) -> Action:
    """G41, G42: the radius is that of the corrector D, else of the tool in the spindle."""

    def action(control: Control) -> None:
        word = control.take("D")
        if word is None:
            compensate(control, side, radius_in_spindle(control))
            return
        tool = control.tools.data(tool_numbered(control, word))
        compensate(control, side, 0.0 if tool is None else tool.radius)

    return action


def radius_in_spindle(control: Control) -> float:
    """Radius of the tool in the spindle [mm]."""
    tool = control.tools.data(control.tools.spindle)
    if tool is None:
        message = "compensation needs a tool, and the job has none"
        control.fail("no-such-tool", message, hint=NEEDS_TOOL)
    return tool.radius


def end_compensation(control: Control) -> None:
    """G40: the next line leads out."""
    control.path.end_compensation()


def _length_by_table(sign: float) -> Action:
    """G43, G44: the difference of tool lengths moves Z; H names the tool, else the spindle's."""

    def action(control: Control) -> None:
        word = control.take("H")
        number = control.tools.spindle if word is None else tool_numbered(control, word)
        tool = control.tools.data(number)
        control.tools.length_call = number
        if tool is None:
            message = "tool length needs a tool, and the job has none"
            control.fail("no-such-tool", message, None, NEEDS_TOOL)
        set_length(control, sign * control.tools.length_difference(tool))

    return action


def set_length(control: Control, difference: float) -> None:
    """Move Z, or the tip that is led, by what the tool is longer than the first [mm]."""
    center = control.path.tool_center
    if center is not None:
        control.motion.lead_tip(center.with_length(difference))
        return
    axes = range(len(control.settings.axes))
    control.frame.set_shift("length", [difference if axis == 2 else 0.0 for axis in axes])
    control.motion.reframed()


COMPENSATION = {
    40: GCode(meaning="radius compensation off", group="compensation", action=end_compensation),
    41: GCode(
        meaning="radius compensation, tool left of the contour",
        group="compensation",
        action=_compensation_by_table(LEFT),
    ),
    42: GCode(
        meaning="radius compensation, tool right of the contour",
        group="compensation",
        action=_compensation_by_table(RIGHT),
    ),
}
LENGTH = {
    43: GCode(meaning="tool length compensation", group="length", action=_length_by_table(1.0)),
    44: GCode(
        meaning="tool length compensation, reversed",
        group="length",
        action=_length_by_table(-1.0),
    ),
    49: GCode(
        meaning="tool length compensation off",
        group="length",
        action=lambda control: set_length(control, 0.0),
    ),
}
