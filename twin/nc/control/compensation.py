"""How a control begins radius compensation, and the tools that its words name."""

import math

from twin.nc.control.control import Control, integer_of
from twin.nc.geometry.matrices import handedness
from twin.nc.path.compensation.stage import LEADING_OUT, OFF, SideChange
from twin.nc.text.blocks import Word

NEEDS_TOOL = "give the job a tool with its radius and length: [[tools]]"
"""Hint where a code needs a tool that the job does not have."""


def tool_numbered(control: Control, word: Word) -> int:
    """The tool that a word names."""
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


def tool_named(control: Control, name: str, word: Word) -> int:
    """The number of the tool that a word calls by name, whose case does not count.

    Decision: where no tool of the job has a name they are called in the job's order.
    """
    tools, name = control.tools, name.upper()
    named = {tool.name.upper(): number for number, tool in tools.table.items() if tool.name}
    if name in named:
        return named[name]
    if name.isdigit():
        return int(name)
    known = tools.names
    if name not in known:
        order = list(tools.table)
        if tools.any is not None or not order:
            order = list(range(1, len(known) + 2))
        if named or len(known) >= len(order):
            message = f'the job has no tool named "{name}"'
            hint = f'give one of its [[tools]] name = "{name}"; named there: {", ".join(named) or "none"}'
            control.fail("no-such-tool", message, word, hint)
        known[name] = order[len(known)]
        measure = control.settings.tool_of_call
        tool = measure(name, control.block.line) if measure is not None else None
        if tool is not None:
            tools.table = {**tools.table, known[name]: tool}
        message = f'the job names no tools: "{name}" is taken for tool {known[name]}, by the order of the calls'
        hint = f'name = "{name}" in the [[tools]] of the job says it'
        control.warn("tool-name", message, word, hint)
    return known[name]


def side_in_force(control: Control) -> float:
    """The side of the compensation that is in force, as ``compensate`` takes it."""
    turned = handedness(control.motion.frame.matrix)
    return math.copysign(1.0, control.path.compensation.signed_offset * turned)


def change_radius(control: Control, radius: float, word: Word | None) -> None:
    """Another radius of the compensation that is in force, on the same side [mm]."""
    _change(control, side_in_force(control), radius, word, None)


def change_side(
    control: Control, side: float, radius: float, word: Word | None, change: SideChange
) -> None:
    """Compensation that is in force goes on on another side, or on the same with another radius [mm]."""
    same = side == side_in_force(control)
    _change(control, side, radius, word, None if same else change)


def _change(
    control: Control, side: float, radius: float, word: Word | None, change: SideChange | None
) -> None:
    if not radius > 0.0:
        message = f"compensation that is in force cannot take the radius {radius:g}"
        control.fail("compensation-change", message, word, "end it by G40")
    control.path.flush()
    signed = side * radius * handedness(control.motion.frame.matrix)
    control.path.compensation.change(signed, change)


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
        hint = "write a straight move in the plane before it starts again"
        control.fail("compensation-end", message, hint=hint)
    if stage is not OFF:
        hint = "end it by G40 before it starts on another side or with another radius"
        control.fail("compensation-change", "compensation is in force already", hint=hint)
    if radius == 0.0:
        return
    modal = control.modal
    path.compensate(
        control.motion.part_plane,
        side * radius * handedness(control.motion.frame.matrix),
        square=modal.square_corners,
        indirect=modal.indirect_leads,
        look_ahead=modal.look_ahead,
        led=led,
    )
