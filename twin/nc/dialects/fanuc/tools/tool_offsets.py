"""Tool offsets of a Fanuc control: H and D, G43 to G49, and what programs write into the memory.

Geometry and wear of length and radius (memory C). The job's tools are the geometry of the rows of
their numbers; lengths count against the job's first tool. D holds radii (parameter 5004 #2 at 0).
"""

from typing import NoReturn

from twin.nc.control.codes import Action
from twin.nc.control.compensation import (
    NEEDS_TOOL,
    change_radius,
    change_side,
    compensate,
    tool_numbered,
)
from twin.nc.control.control import Control
from twin.nc.control.tools import LENGTH_ENDED
from twin.nc.dialects.fanuc.memory import ToolOffset, memory_of
from twin.nc.dialects.fanuc.programs import whole
from twin.nc.iso.orientation.tool_center import end_tool_center
from twin.nc.iso.tool_compensation import LEFT, RIGHT, set_length
from twin.nc.text.blocks import Word

LARGEST_OFFSET = 999
BLOCKS_AHEAD = 3
"""Among so many blocks of a contour the control finds an interference (parameter 19625)."""


def geometry_of(control: Control, number: int, field: str) -> float | None:
    """Geometry of a length or a radius [mm]; None: nobody has given it."""
    row = memory_of(control).tool_offsets.get(number)
    tool = control.tools.data(_tool_of(control, number))
    written = None if row is None else getattr(row, field)
    return getattr(tool, field, None) if written is None else written


def _tool_of(control: Control, number: int) -> int:
    """The number of the tool that a row of the memory is for."""
    return control.settings.offset_rows.get(number, number)


def set_length_number(control: Control, word: Word) -> None:
    """H: the row of the tool length; alone it changes the length in force."""
    memory_of(control).length_number = whole(control, word, "tool-offset", "offset number")
    if not any(code in (43.0, 43.4, 43.5, 44.0, 49.0, 234.0) for code in _codes(control)):
        sign = {43: 1.0, 44: -1.0}.get(int(control.modal.active.get("length", 49)))
        if sign is not None:
            apply_length(control, sign, word)


def set_radius_number(control: Control, word: Word) -> None:
    """D: the row of the radius; D0 ends compensation, and another D starts it again (manual)."""
    number = whole(control, word, "tool-offset", "offset number")
    memory = memory_of(control)
    changes = number != memory.radius_number
    memory.radius_number = number
    if not changes or any(code in (40.0, 41.0, 42.0) for code in _codes(control)):
        return
    side = {41: LEFT, 42: RIGHT}.get(int(control.modal.active.get("compensation", 40)))
    if control.path.compensation.in_force and number:
        change_radius(control, _radius(control, number), word)
    elif control.path.compensation.in_force:
        control.path.end_compensation()
    elif side is not None and number:
        compensate(control, side, _radius(control, number))


def _codes(control: Control) -> list[float]:
    return [control.number(word) for word, _ in control.codes]


def length_code(number: int, sign: float) -> Action:
    """G43, G44: the row H moves Z, also the Z of its own block in G91 (manual)."""

    def action(control: Control) -> None:
        end_tool_center_of_length(control)
        before, word = control.motion.programmed[2], control.code_word(number)
        apply_length(control, sign, word)
        if sign < 0.0:
            message = f"G{number} takes the length reversed: one that is above 0 in the control's table drives the tool into the part"
            control.warn("tool-offset", message, word, "write G43")
        if control.modal.incremental and "Z" in control.words:
            control.motion.programmed[2] = before

    return action


def end_length(control: Control) -> None:
    """G49."""
    memory_of(control).length_cancelled = ""
    end_tool_center_of_length(control)
    control.tools.length_call = LENGTH_ENDED
    set_length(control, 0.0)


def end_tool_center_of_length(control: Control) -> None:
    """G43, G44 and G49 end G43.4 and G234; in a tilted plane they change the length along it."""
    center = control.path.tool_center
    if center is not None and not center.tilted:
        end_tool_center(control, "the tool length")


def apply_length(control: Control, sign: float, word: Word | None) -> None:
    """Put the length of the row H into force, or with the sign -1 its reverse; ``word`` asks for it."""
    memory_of(control).length_cancelled = ""
    number = memory_of(control).length_number
    if number is None:
        code = "G43" if word is None else word.text
        control.fail("tool-offset", f"{code} needs H, the number of the length", word, "G43 H1")
    if number == 0:
        control.tools.length_call = LENGTH_ENDED
        set_length(control, 0.0)
        return
    control.tools.length_call = _tool_of(control, number)
    length = geometry_of(control, number, "length")
    row = memory_of(control).tool_offsets.get(number)
    if length is None:
        _refuse_row(control, number, "H")
    if row is None or row.length is None:
        _warn_of_default_tool(control, number, "H")
    wear = 0.0 if row is None else row.length_wear
    first = control.tools.data(next(iter(control.tools.table), None))
    set_length(control, sign * (length + wear - (0.0 if first is None else first.length)))


def _refuse_row(control: Control, number: int, letter: str) -> NoReturn:
    word = next((each for each in control.block.words if each.address == letter), None)
    word = Word(letter, float(number), 0, 1) if word is None else word
    known = ", ".join(f"{letter}{each}" for each in control.tools.table) or "none"
    message = f"nobody has given a value for {letter}{number}"
    hint = f"the job's tools give {known}; [offset_rows] {number} = 1 in the job lets it be tool 1's; or write it by G10"
    control.fail("no-such-tool", message, word, hint)


def _warn_of_default_tool(control: Control, number: int, letter: str) -> None:
    word = next((each for each in control.block.words if each.address == letter), None)
    tool = _tool_of(control, number)
    if word is not None and control.tools.data(tool) is not None:
        tool_numbered(control, word._replace(value=float(tool)))


def compensation_code(number: int, side: float) -> Action:
    """G41, G42: compensation by the row D."""

    def begin(control: Control) -> None:
        control.take("D")
        row_number = memory_of(control).radius_number
        if row_number is None:
            message = f"G{number} needs D, the number of the radius"
            control.fail("tool-offset", message, control.code_word(number), f"G{number} D1")
        radius = _radius(control, row_number)
        if not control.path.compensation.in_force:
            compensate(control, side, radius)
        elif row_number == 0:
            control.path.end_compensation()
        else:
            change = memory_of(control).variant.side_change
            change_side(control, side, radius, control.code_word(number), change)

    return begin


def _radius(control: Control, number: int) -> float:
    if number == 0:
        return 0.0
    radius = geometry_of(control, number, "radius")
    row = memory_of(control).tool_offsets.get(number)
    if radius is None:
        if not control.tools.table:
            message = "compensation needs a tool, and the job has none"
            control.fail("no-such-tool", message, hint=NEEDS_TOOL)
        _refuse_row(control, number, "D")
    if row is None or row.radius is None:
        _warn_of_default_tool(control, number, "D")
    return radius + (0.0 if row is None else row.radius_wear)


def radius_in_force(control: Control) -> float:
    """The radius of D in force, else of the tool in the spindle [mm]."""
    number = memory_of(control).radius_number
    if number is None:
        number = control.tools.spindle or 0
    return _radius(control, number)


def write_tool_offset(control: Control, number: int, field: str, value: float) -> None:
    """Write a value of a row, whose length holds at once where it is in force [mm]."""
    setattr(memory_of(control).tool_offsets.setdefault(number, ToolOffset()), field, value)
    if field in ("length", "radius"):
        control.tools.note_written(_tool_of(control, number), field, value)


def read_tool_offset(control: Control, number: int, field: str) -> float:
    """A value of a row, 0 where nobody has given it [mm]."""
    if field in ("length", "radius"):
        return geometry_of(control, number, field) or 0.0
    row = memory_of(control).tool_offsets.get(number, ToolOffset())
    return float(getattr(row, field))
