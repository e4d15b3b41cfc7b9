"""G10 of a Fanuc control: work offsets and tool offsets from the program.

L2 P0 to P6 and L20 P write work offsets, which count from machine zero; L10 to L13 P R write geometry
and wear of the length (H) and of the radius (D). With G91 the values are added.
"""

from twin.nc.control.control import Control
from twin.nc.dialects.fanuc.frames import offsets
from twin.nc.dialects.fanuc.memory import memory_of
from twin.nc.dialects.fanuc.programs import whole
from twin.nc.dialects.fanuc.tools import tool_offsets

_FIELDS = {10: "length", 11: "length_wear", 12: "radius", 13: "radius_wear"}
_WORK, _EXTENDED = 2, 20
_REFUSED = {
    1: "the tool table has geometry and wear: L10 to L13",
    3: "tool life is not simulated",
    50: "parameters are the machine file's",
    51: "parameters are the machine file's",
    52: "parameters are the machine file's",
}


def set_data(control: Control) -> None:
    """G10 L P and the values."""
    kind = control.take("L")
    if kind is None:
        message = "G10 needs L, the kind of data"
        control.fail("data-setting", message, None, "G10 L2 P1 X0. Y0. Z0.")
    number = whole(control, kind, "data-setting", "kind of data")
    if number in (_WORK, _EXTENDED):
        _work_offset(control, extended=number == _EXTENDED)
    elif number in _FIELDS:
        _tool_offset(control, _FIELDS[number])
    else:
        known = "L2 and L20 for work offsets, L10 to L13 for tool offsets"
        hint = _REFUSED.get(number, known)
        control.fail("data-setting", f"G10 {kind.text} is not followed", kind, hint)


def _row(control: Control, least: int, most: int) -> int:
    word = control.take("P")
    if word is None:
        control.fail("data-setting", "G10 needs P, the number of the offset")
    number = whole(control, word, "data-setting", "number of an offset")
    if not least <= number <= most:
        control.fail("data-setting", f"there is no offset {word.text}", word)
    return number


def _work_offset(control: Control, *, extended: bool) -> None:
    number = _row(control, int(extended), offsets.LARGEST_EXTENDED if extended else 6)
    name = offsets.further(control, number) if extended else f"G{53 + number}" if number else None
    words = control.take_axis_words()
    if not words:
        control.fail("data-setting", "G10 needs the axes of the offset", None, "G10 L2 P1 X0.")
    for index, word in words:
        value = control.axis_value(index, word)
        if control.modal.incremental:
            value += offsets.read_offset(control, name, word.address, "G10")
        offsets.write_offset(control, name, word.address, value, "G10")
    if name is None or name == memory_of(control).offset:
        offsets.put_into_force(control)


def _tool_offset(control: Control, field: str) -> None:
    number = _row(control, 1, tool_offsets.LARGEST_OFFSET)
    word = control.take("R")
    if word is None:
        message = "G10 needs R, the value of the offset"
        control.fail("data-setting", message, None, "G10 L10 P1 R50.")
    value = control.length(word)
    if control.modal.incremental:
        value += tool_offsets.read_tool_offset(control, number, field)
    tool_offsets.write_tool_offset(control, number, field, value)
