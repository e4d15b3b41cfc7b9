"""How a control begins radius compensation, and the tools that its words name."""

from twin.nc.control.control import Control
from twin.nc.control.state import integer_of
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
        control.report.warn_once(
            "default-tool",
            f"the job lists no tools: every number means one of {2.0 * tool.radius:g} mm",
            word.column,
            word.width,
            hint="give the job its tools: [[tools]]",
        )
    return number


def compensate(control: Control, side: float, radius: float) -> None:
    """Start compensation on one side with a radius [mm].

    Raises:
        ProgramError: It is in force already, or the radius is no radius.
    """
    if radius < 0.0:
        control.fail("compensation-radius", f"a tool cannot have the radius {radius:g}")
    if control.path.compensating:
        control.fail(
            "compensation-change",
            "compensation is in force already",
            hint="end it by G40 before it starts on another side or with another radius",
        )
    if control.path.leading_out:
        control.fail(
            "compensation-end",
            "compensation has ended, and no line has led out of it yet",
            hint="write a straight move in the plane before it starts anew",
        )
    if radius == 0.0:
        return
    plane = control.part_plane()
    control.path.start_compensation(
        plane,
        side * control.frame.handedness * radius,
        square=control.modal.square_corners,
        indirect=control.modal.indirect_leads,
    )
