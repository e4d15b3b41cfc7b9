"""How a control begins radius compensation, and the tools that its words name."""

from collections.abc import Mapping

from twin.nc.bytecode.compensation import BEGINS, IN_FORCE, LEADS_OUT, NO_RADIUS, begin, may_begin
from twin.nc.control.control import Control
from twin.nc.control.state import integer_of
from twin.nc.text.blocks import Word

NEEDS_TOOL = "give the job a tool with its radius and length: [[tools]]"
"""Hint where a code needs a tool that the job does not have."""
_FINDINGS: Mapping[int, tuple[str, str, str | None]] = {
    NO_RADIUS: ("compensation-radius", "a tool cannot have the radius {radius:g}", None),
    IN_FORCE: (
        "compensation-change",
        "compensation is in force already",
        "end it by G40 before it starts on another side or with another radius",
    ),
    LEADS_OUT: (
        "compensation-end",
        "compensation has ended, and no line has led out of it yet",
        "write a straight move in the plane before it starts anew",
    ),
}
"""Code, message and hint of why compensation cannot begin."""


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


def compensate(control: Control, side: float, radius: float) -> None:
    """Start compensation on one side with a radius [mm].

    Raises:
        ProgramError: It is in force already, or the radius is no radius.
    """
    path = control.path
    answer = may_begin(radius, path.contour)
    if answer < 0:
        code, message, hint = _FINDINGS[answer]
        control.fail(code, message.format(radius=radius), hint=hint)
    if answer == BEGINS:
        path.flush()
        begin(side, radius, control.constants, control.state, path.contour)
