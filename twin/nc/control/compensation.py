"""How a control begins radius compensation, and the tools that its words name."""

from twin.nc.control.control import Control, integer_of
from twin.nc.geometry.matrices import handedness
from twin.nc.path.compensation.stage import LEADING_OUT, OFF
from twin.nc.text.blocks import Word

NEEDS_TOOL = "give the job a tool with its radius and length: [[tools]]"
"""Hint where a code needs a tool that the job does not have."""


def tool_numbered(control: Control, word: Word) -> int:
    """The tool that a word names.

    Raises:
        ProgramError: The job has no such tool.
    """
    number = integer_of(control.number(word))
    tool = control.tools.data(number)
    if tool is None or number < 0:
        known = ", ".join(str(each) for each in control.tools.table) or "none"
        message = f"the job has no tool {control.number(word):g}"
        control.fail("no-such-tool", message, word, hint=f"tools of the job: {known}")
    if number not in control.tools.table:
        message = f"the job lists no tools: every number means one of {2.0 * tool.radius:g} mm"
        hint = "give the job its tools: [[tools]]"
        control.report.warn_once("default-tool", message, word.column, word.width, hint=hint)
    return number


def compensate(control: Control, side: float, radius: float, *, led: bool = False) -> None:
    """Start compensation on one side with a radius [mm]; ``led`` as ``Compensation.begin`` has it.

    Raises:
        ProgramError: It is in force already, or the radius is no radius.
    """
    path = control.path
    stage = path.compensation.stage
    if not radius >= 0.0:
        control.fail("compensation-radius", f"a tool cannot have the radius {radius:g}")
    if stage is LEADING_OUT:
        message = "compensation has ended, and no line has led out of it yet"
        hint = "write a straight move in the plane before it starts anew"
        control.fail("compensation-end", message, hint=hint)
    if stage is not OFF:
        hint = "end it by G40 before it starts on another side or with another radius"
        control.fail("compensation-change", "compensation is in force already", hint=hint)
    if radius == 0.0:
        return
    modal = control.modal
    path.compensate(
        control.motion.part_plane,
        side * radius * handedness(control.frame.matrix),
        square=modal.square_corners,
        indirect=modal.indirect_leads,
        led=led,
    )
