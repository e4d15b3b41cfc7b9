"""#CS, #ACS and #TOOL ORI of the Fagor CNC 8070: coordinate systems in space, and the tool perpendicular to them.

Sources: programming manual of the CNC 8070 (Refs. 0504 and 1709, "Coordinate systems", as far as it is public), that of
the CNC 8055 for the same turns (G49), and the manual of the ISG kernel for the order of deactivation. Every system that
is activated is added to those in force; all of #ACS come before all of #CS.

Decisions:

* MODE 3 to 5 are refused: which sense an angle between the plane and an axis has is in a figure alone.
* #CS NEW alone ends the systems of its kind. Work offsets and presets wait for #CS OFF and #ACS OFF.
* #TOOL ORI turns the rotary axes during the next straight block, while the tip goes straight; without FIRST or SECOND
  to the nearest solution.
* A table takes the systems along: they are fixed to the part.
"""

import re

from twin.nc.control.codes import StatementAction
from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070 import arcs
from twin.nc.dialects.fagor8070.frames.machine_coordinates import refuse_change
from twin.nc.dialects.fagor8070.frames.transformations import update
from twin.nc.dialects.fagor8070.memory import KINDS, SpatialSystem, memory_of
from twin.nc.geometry.matrices import Matrix, product, transposed
from twin.nc.iso.orientation.tilted_plane import (
    about,
    count_in_plane,
    plane_of_axes,
    rotary_axes_across,
)
from twin.nc.iso.orientation.tool_center import aim_words, begin_tool_center, end_tool_center
from twin.nc.text.blocks import Statement

MOST_SYSTEMS = 5
"""That are stored, of each kind (manual)."""
MOST_ACTIVE = 10
"""Of both kinds together (manual)."""

_FORM = re.compile(
    r"[ \t]*(?P<verb>DEF|ON|NEW|OFF)\b[ \t]*(?P<extra>ALL\b|ACT\b)?[ \t]*"
    r"(?:\[(?![ \t]*MODE\b)(?P<number>[^\[\]]*)\])?[ \t]*"
    r"(?:\[[ \t]*MODE\b(?P<mode>.*)\])?[ \t]*",
    re.IGNORECASE,
)
_SOLUTION = re.compile(r"(?P<values>.*?),[ \t]*(?P<solution>FIRST|SECOND)[ \t]*", re.IGNORECASE)
_SOLUTIONS = {"FIRST": 1.0, "SECOND": -1.0}
_BY_TOOL = 6
_VALUES = {1: 6, 2: 6, _BY_TOOL: 4}
"""Values behind each mode that is followed: the origin, and angles."""
_HINT = "#CS ON [1] [MODE 1, 0, 0, 20, 30, 0, 0]"


def _coordinate_system(control: Control, statement: Statement) -> None:
    """#CS, #ACS: define, store, activate and end coordinate systems.

    Raises:
        ProgramError: It has another form, or compensation is in force.
    """
    match, kind = _FORM.fullmatch(statement.text), statement.keyword.upper()
    if match is None:
        message = f"{kind} defines (DEF), activates (ON, NEW) or ends (OFF) a coordinate system"
        control.fail("tilted-plane", message, statement, _HINT.replace("#CS", kind))
    verb, extra = match["verb"].upper(), (match["extra"] or "").upper()
    given, memory = match["number"] is not None or match["mode"] is not None, memory_of(control)
    allowed = {"OFF": "ALL", "DEF": "ACT"}.get(verb, "")
    if extra not in ("", allowed) or (verb == "OFF" and given):
        message = f"{kind} {verb} {extra or '[...]'} is no form of the control that is followed"
        control.fail("tilted-plane", message, statement, f"{kind} ON [1], {kind} OFF ALL")
    if verb == "DEF":
        _define(control, statement, match, current=extra == "ACT")
        return
    _refuse_fixed_frame(control, statement)
    active = memory.active[kind]
    if verb == "OFF":
        del active[0 if extra else -1 :]
    elif verb == "NEW":
        active.clear()
    if match["mode"]:
        active.append(_define(control, statement, match))
    elif verb == "ON" or (verb == "NEW" and given):
        active.append(_stored(control, statement, match))
    if sum(map(len, memory.active.values())) > MOST_ACTIVE:
        message = f"{MOST_ACTIVE} coordinate systems may be active at once"
        control.fail("tilted-plane", message, statement, f"{kind} OFF, or {kind} NEW")
    memory.orients = False
    _leave_plane(control, kind)
    update(control, statement)


def _define(
    control: Control, statement: Statement, match: re.Match[str], *, current: bool = False
) -> SpatialSystem:
    """A system as it is written, or the ones of its kind in force (``current``); stored where it has a number."""
    memory, kind = memory_of(control), statement.keyword.upper()
    number = _number(control, statement, match)
    if current is (match["mode"] is not None):
        message = f"{kind} DEF takes a MODE and its values, {kind} DEF ACT a number alone"
        control.fail("tilted-plane", message, statement, _HINT.replace("#CS ON", f"{kind} DEF"))
    if current:
        system = SpatialSystem(*memory.combined(kind))
    else:
        system = _written(control, statement, match)
    if number is not None:
        memory.systems[kind].pop(number, None)
        memory.systems[kind][number] = system
    elif match["verb"].upper() == "DEF":
        control.fail("tilted-plane", f"{kind} DEF needs a number: [1]", statement)
    return system


def _stored(control: Control, statement: Statement, match: re.Match[str]) -> SpatialSystem:
    """The system of a number, or the one that was stored last."""
    kind = statement.keyword.upper()
    systems, number = memory_of(control).systems[kind], _number(control, statement, match)
    if number is None and systems:
        number = next(reversed(systems))
    if number is None or number not in systems:
        which = "one" if number is None else f"number {number}"
        message = f"no coordinate system {which} of {kind} is stored"
        control.fail("tilted-plane", message, statement, _HINT.replace("#CS ON", f"{kind} DEF"))
    return systems[number]


def _number(control: Control, statement: Statement, match: re.Match[str]) -> int | None:
    if match["number"] is None:
        return None
    column = statement.text_column + match.start("number")
    value = control.compute(control.statements.expression(match["number"], column), column)
    if value not in range(1, MOST_SYSTEMS + 1):
        message = f"coordinate systems have the numbers 1 to {MOST_SYSTEMS}"
        control.fail("tilted-plane", message, statement)
    return int(value)


def _written(control: Control, statement: Statement, match: re.Match[str]) -> SpatialSystem:
    """The system that a MODE says."""
    text, column = match["mode"], statement.text_column + match.start("mode")
    chosen = _SOLUTION.fullmatch(text)
    solution = 0.0 if chosen is None else _SOLUTIONS[chosen["solution"].upper()]
    inner = text if chosen is None else chosen["values"]
    values = [
        control.compute(each, column)
        for each in control.statements.expressions(inner, column, None)
    ]
    mode = values[0] if values else 0.0
    if mode not in _VALUES:
        message = "of the modes of a coordinate system 1, 2 and 6 are followed"
        hint = "MODE 1 turns about X, the new Y and the new Z, MODE 2 about Z, Y and Z"
        control.fail("tilted-plane", message, statement, hint)
    if len(values) != 1 + _VALUES[int(mode)]:
        message = f"MODE {mode:g} takes the origin and {_VALUES[int(mode)] - 3} angles"
        control.fail("tilted-plane", message, statement, _HINT)
    x, y, z = (value * control.modal.unit for value in values[1:4])
    return SpatialSystem(
        _directions(control, statement, int(mode), values[4:]), (x, y, z), solution
    )


def _directions(control: Control, statement: Statement, mode: int, angles: list[float]) -> Matrix:
    """Of the axes of a system, as columns: by angles [deg], or perpendicular to the tool where it is now (MODE 6)."""
    if mode == _BY_TOOL:
        if control.settings.setup is None:
            message = "MODE 6 takes the plane from the tool's direction, and no axis turns here"
            control.fail("tilted-plane", message, statement)
        kinds = KINDS[: KINDS.index(statement.keyword.upper()) + 1]
        before, _ = memory_of(control).combined(*kinds)
        return product(transposed(before), product(plane_of_axes(control, {}), about(2, angles[0])))
    first, second, third = angles
    inner = product(about(1, second), about(2, third))
    return product(about(0 if mode == 1 else 2, first), inner)


def _refuse_fixed_frame(control: Control, statement: Statement) -> None:
    refuse_change(control)
    if control.path.compensation.in_force:
        message = "a coordinate system cannot change while radius compensation is in force"
        control.fail("compensation-change", message, statement, "end it by G40 first")


def _leave_plane(control: Control, name: str) -> None:
    """The tool is no longer taken to be perpendicular to a plane; the length of the tool stays."""
    center = control.path.tool_center
    if center is not None and center.tilted:
        end_tool_center(control, name, keeps_length=True)


def _orient_tool(control: Control, statement: Statement) -> None:
    """#TOOL ORI: the next motion block sets the tool perpendicular to the plane."""
    if statement.text.strip():
        control.fail("unreadable-statement", "#TOOL ORI takes no values", statement)
    memory = memory_of(control)
    memory.orients = True


def before_motion(control: Control) -> None:
    """A block is about to move: the tool turns with it, or must be perpendicular to the plane already.

    Raises:
        ProgramError: It is not, or cannot be.
    """
    memory = memory_of(control)
    if memory.part_frame is not None:
        return
    if memory.orients:
        _turn_with_block(control)
    elif memory.is_tilted:
        count_in_plane(control, "#CS", "#TOOL ORI before, or #RTCP ON")


def _turn_with_block(control: Control) -> None:
    """Let the block's rotary axes be those that set the tool perpendicular, the tip led meanwhile."""
    memory, name, modal = memory_of(control), "#TOOL ORI", control.modal
    turning = next((control.words[each] for each in "ABC" if each in control.words), None)
    if turning is not None:
        message = "the block behind #TOOL ORI turns the rotary axes, and names none"
        control.fail("tilted-plane", message, turning)
    if modal.cycle is not None or modal.interpolation not in (arcs.POSITIONING, arcs.LINEAR):
        message = "the block behind #TOOL ORI goes straight: the tool turns meanwhile"
        control.fail("tilted-plane", message, hint="G0 or G1 and where to go")
    _leave_plane(control, name)
    solutions = [system.solution for each in memory.active.values() for system in each]
    axes = rotary_axes_across(control, name, main=solutions[-1] if solutions else 0.0)
    memory.led = control.path.tool_center is not None
    begin_tool_center(control, name)
    aim_words(control, axes, next(iter(control.words.values())))


def after_motion(control: Control) -> None:
    """Behind the block that has turned the tool, coordinates count in the plane."""
    memory = memory_of(control)
    if not memory.orients or memory.part_frame is not None:
        return
    memory.orients = False
    if memory.led:
        return
    if memory.is_tilted:
        begin_tool_center(control, "#TOOL ORI", tilted=True)
    else:
        end_tool_center(control, "#TOOL ORI", keeps_length=True)


STATEMENTS: dict[str, StatementAction] = {
    "#CS": _coordinate_system,
    "#ACS": _coordinate_system,
    "#TOOL ORI": _orient_tool,
}
