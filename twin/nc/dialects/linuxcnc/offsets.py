"""Coordinate systems, presets and tool offsets of LinuxCNC.

A programmed position is shifted by G92, turned about Z by the system's rotation, and shifted to the
system's zero; a tool offset shifts it further.
"""

from twin.nc.control.codes import Action
from twin.nc.control.compensation import tool_numbered
from twin.nc.control.control import Control, integer_of
from twin.nc.control.settings import ToolData
from twin.nc.control.tools import LENGTH_ENDED
from twin.nc.dialects.linuxcnc.memory import SYSTEMS, CoordinateSystem, LinuxcncMemory, memory_of
from twin.nc.geometry.matrices import IDENTITY, Matrix, applied, rotated, transposed
from twin.nc.geometry.planes import XY
from twin.nc.iso.offsets import note_written, table_zero
from twin.nc.iso.orientation.tool_center import begin_tool_center, end_tool_center
from twin.nc.text.blocks import Word

FIXTURE = 9
"""Number of G59.3, from which G10 L11 counts."""


def begin(control: Control) -> None:
    """Take the job's coordinate systems over; the tool table becomes the program's own."""
    memory, names = memory_of(control), control.settings.axes.names
    zeros = [0.0] * len(names)
    memory.preset, memory.kept_preset = list(zeros), list(zeros)
    memory.homes, memory.probe = [list(zeros), list(zeros)], list(zeros)
    for number, system in enumerate(SYSTEMS, 1):
        values = control.settings.offsets.get(system, {} if number == 1 else None)
        if values is not None:
            memory.systems[number] = CoordinateSystem([values.get(name, 0.0) for name in names])
    control.tools.table = dict(control.tools.table)
    reframe(control)


def turned(system: CoordinateSystem) -> Matrix:
    """The rotation of a system."""
    if system.rotation == 0.0:
        return IDENTITY
    return rotated(IDENTITY, XY.directions, system.rotation, (0.0, 0.0))[0]


def _applied(matrix: Matrix, values: list[float]) -> list[float]:
    x, y, z = applied(matrix, (values[0], values[1], values[2]))
    return [x, y, z, *values[3:]]


def reframe(control: Control) -> None:
    """Put system, preset and tool offset into force; nothing moves."""
    memory = memory_of(control)
    system = memory.systems[memory.system]
    matrix = turned(system)
    control.frame.set_matrix(matrix)
    control.frame.set_shift("offset", list(system.origin))
    control.frame.set_shift("preset", _applied(matrix, _preset_of(memory)))
    shift, center = tool_shift(control), control.path.tool_center
    if center is None:
        control.frame.set_shift("length", shift)
    elif any(shift[:2]) or any(shift[3:]):
        message = "under M428 the offset of a tool is its length, along Z"
        control.fail("tool-center", message, hint="write M429 before it")
    elif center.length_difference != shift[2]:
        control.motion.lead_tip(center.with_length(shift[2]))
    control.motion.reframed()


def lead_tip(control: Control) -> None:
    """M428: X, Y and Z are those of the tip in the part (decision)."""
    if control.path.tool_center is None:
        begin_tool_center(control, "M428")


def lead_axes(control: Control) -> None:
    """M429: X, Y and Z are those of the axes."""
    end_tool_center(control, "M429", keeps_length=True)
    control.frame.set_shift("length", tool_shift(control))
    control.motion.reframed()


def _preset_of(memory: LinuxcncMemory) -> list[float]:
    """The preset that counts, shape (k,) [mm or deg]."""
    return list(memory.preset) if memory.preset_on else [0.0] * len(memory.preset)


def tool_shift(control: Control) -> list[float]:
    """How the tool offset in force moves positions, shape (k,) [mm or deg].

    Decision: lengths count against the job's first tool, whose tip the part zero was taken with.
    """
    offset = memory_of(control).tool_offset
    if offset is None:
        return [0.0] * len(control.settings.axes)
    reference = ToolData(0.0, 0.0)
    return [
        offset[0],
        offset[1],
        offset[2] + control.tools.length_difference(reference),
        *offset[3:],
    ]


def select_system(number: int) -> Action:
    """G54 to G59.3."""

    def action(control: Control) -> None:
        refuse_in_compensation(control)
        known_system(control, number)
        memory_of(control).system = number
        reframe(control)

    return action


def known_system(control: Control, number: int) -> CoordinateSystem:
    """A coordinate system that the job or the program has given values."""
    memory, name = memory_of(control), SYSTEMS[number - 1]
    if number not in memory.systems:
        known = ", ".join(SYSTEMS[each - 1] for each in sorted(memory.systems))
        message = f"neither the job nor the program gives a work offset {name}"
        key = f'"{name}"' if "." in name else name
        hint = f"write it under [offsets.{key}], or by G10 L2; known: {known}"
        control.fail("no-offset", message, control.code_word(float(name[1:])), hint)
    return memory.systems[number]


def refuse_in_compensation(control: Control, what: str = "coordinates cannot change") -> None:
    """What cannot be done while the tool's radius is compensated."""
    if memory_of(control).compensation is not None:
        message = f"{what} while radius compensation is in force"
        control.fail("compensation-change", message, hint="end it by G40 first")


def refuse_changed_unit(control: Control) -> None:
    """What counts with the tool length in force needs the unit in which it came into force.

    Raises:
        ProgramError: G20 or G21 has changed it: the control takes the length's number for one of the new
            unit then, and the axes jump with the next move.
    """
    memory = memory_of(control)
    if any(memory.tool_offset or ()) and memory.offset_unit != control.modal.unit:
        message = "G20 or G21 has changed the unit since a tool length came into force"
        hint = "write G49 before G20 and G21: the control loses where the axes stand otherwise"
        control.fail("tool-offset", message, hint=hint)


# --- G92, G52


def preset(control: Control) -> None:
    """G92: the place where the machine is gets the coordinates of the block."""
    memory, words = memory_of(control), _needed_axes(control, "G92")
    before = _preset_of(memory)
    for index, word in words:
        before[index] += control.motion.programmed[index] - control.axis_value(index, word)
    _set_preset(control, before)


def local_offset(control: Control) -> None:
    """G52: the zero moves by the words of the block; it shares its values with G92."""
    memory, words = memory_of(control), _needed_axes(control, "G52")
    values = _preset_of(memory)
    for index, word in words:
        values[index] = control.axis_value(index, word)
    _set_preset(control, values)


def _set_preset(control: Control, values: list[float]) -> None:
    memory = memory_of(control)
    memory.preset, memory.kept_preset, memory.preset_on = list(values), list(values), True
    reframe(control)


def _needed_axes(control: Control, code: str) -> list[tuple[int, Word]]:
    refuse_in_compensation(control)
    words = control.take_axis_words()
    if not words:
        control.fail("preset", f"{code} needs the axes that it acts on")
    return words


def change_preset(*, on: bool, forgets: bool = False) -> Action:
    """G92.1: no preset, and none to put back; G92.2: none until G92.3 puts it back."""

    def action(control: Control) -> None:
        refuse_in_compensation(control)
        memory = memory_of(control)
        if forgets:
            memory.kept_preset = [0.0] * len(memory.preset)
        if on or forgets:
            memory.preset = list(memory.kept_preset)
        memory.preset_on = on
        reframe(control)

    return action


# --- G10


def write_table(control: Control) -> None:
    """G10 L2, L20: coordinate systems; L1, L10, L11: the tool table."""
    refuse_in_compensation(control)
    kind = control.take("L")
    value = 0 if kind is None else integer_of(control.number(kind))
    if value not in (1, 2, 10, 11, 20):
        control.fail("code-words", "G10 needs L1, L2, L10, L11 or L20", kind)
    number = control.take("P")
    if number is None or control.number(number) != int(control.number(number)):
        message = "G10 needs P, a whole number"
        control.fail("code-words", message, number, "write the system or the tool")
    if value in (2, 20):
        _write_system(control, number, here=value == 20)
    else:
        _write_tool(control, number, value)


def _write_system(control: Control, number: Word, *, here: bool) -> None:
    memory, which = memory_of(control), integer_of(control.number(number))
    if not 0 <= which <= len(SYSTEMS):
        message = f"{number.text} is no coordinate system"
        control.fail("code-words", message, number, "P1 is G54, P9 is G59.3, P0 the one in force")
    which = which or memory.system
    zero = table_zeros(control, "G10 L2") if not here or which not in memory.systems else None
    system = memory.systems.get(which)
    if system is None:
        assert zero is not None
        system = CoordinateSystem(list(zero))
    turn, axes = control.take("R"), control.take_axis_words()
    if turn is not None:
        if here:
            control.fail("code-words", "a rotation R is set by G10 L2", turn)
        _turn(control, system, which, control.number(turn))
    if here:
        _set_origin_here(control, system, axes)
    else:
        assert zero is not None
        for index, word in axes:
            value = control.axis_value(index, word)
            note_written(control, control.settings.axes.names[index], value)
            system.origin[index] = value + zero[index]
    memory.systems[which] = system
    reframe(control)


def _turn(control: Control, system: CoordinateSystem, number: int, angle: float) -> None:
    """Give a system another rotation.

    Raises:
        ProgramError: It is in force under a preset: the control leaves that out when it turns the place
            where it is, and the axes jump with the next move.
    """
    memory = memory_of(control)
    in_force = number == memory.system and system.rotation != angle
    if in_force and memory.preset_on and any(memory.preset[:2]):
        message = "a system in force cannot be turned while G92 or G52 shifts X or Y"
        hint = "write G92.2 before: the control loses where the axes stand otherwise"
        control.fail("preset", message, hint=hint)
    system.rotation = angle


def _set_origin_here(
    control: Control, system: CoordinateSystem, axes: list[tuple[int, Word]]
) -> None:
    """Move a system so that the place where the machine is has new coordinates in it."""
    preset, matrix = _preset_of(memory_of(control)), turned(system)
    length = control.frame.shift("length")
    place = [value - shift for value, shift in zip(control.motion.part, length, strict=True)]
    relative = [a - b for a, b in zip(place, system.origin, strict=True)]
    there = _applied(transposed(matrix), relative)
    for index, word in axes:
        there[index] = control.axis_value(index, word) + preset[index]
    turned_there = _applied(matrix, there)
    system.origin[:] = [a - b for a, b in zip(place, turned_there, strict=True)]


def table_zeros(control: Control, code: str) -> list[float]:
    """Part coordinates of the point from which the coordinate systems count, shape (k,)."""
    zero = table_zero(control, code)
    return [zero.get(name, 0.0) for name in control.settings.axes.names]


def _write_tool(control: Control, number: Word, kind: int) -> None:
    """G10 L1: length Z and radius R of a tool; L10, L11: its length so that Z is where it is."""
    which = integer_of(control.number(number))
    tool = control.tools.data(which)
    if tool is None:
        known = ", ".join(map(str, control.tools.table)) or "none"
        message = f"the job has no tool {which}"
        control.fail("no-such-tool", message, number, f"tools of the job: {known}")
    others = [control.take(letter) for letter in "IJQ"]
    radius, length = control.take("R"), None
    axes = control.take_axis_words()
    if not axes and radius is None and not any(others):
        control.fail("code-words", "G10 for a tool needs Z, its length, or R, its radius", number)
    for index, word in axes:
        if index != 2:
            message = "the twin's tools have a length along Z and a radius"
            control.fail("tool-offset", message, word, "leave the other axes out")
        length = control.axis_value(index, word)
    if length is not None and kind != 1:
        length = _length_here(control, length, from_fixture=kind == 11)
    if radius is not None:
        control.tools.note_written(which, "radius", control.length(radius))
    if length is not None and kind == 1:
        control.tools.note_written(which, "length", length)
    changed = ToolData(
        tool.radius if radius is None else control.length(radius),
        tool.length if length is None else length,
    )
    control.tools.table = {**control.tools.table, which: changed}


def _length_here(control: Control, height: float, *, from_fixture: bool) -> float:
    """Length of a tool whose tip would be at a height where the machine is now [mm]."""
    memory = memory_of(control)
    number = FIXTURE if from_fixture else memory.system
    origin = known_system(control, number).origin[2]
    preset = 0.0 if from_fixture else _preset_of(memory)[2]
    reference = -control.tools.length_difference(ToolData(0.0, 0.0))
    spindle = (
        control.motion.part[2] + reference
        if memory.tool_offset is not None
        else control.motion.part[2]
    )
    return spindle - origin - preset - height


# --- G43, G49


def tool_length(control: Control) -> None:
    """G43: the length of tool H; without it, and with H0, of the tool in the spindle."""
    number = control.tools.length_call = _length_number(control, control.take("H"))
    set_length(control, _offset_of(control, number))


def _length_number(control: Control, word: Word | None) -> int | None:
    """Number of the tool whose length an H means."""
    if word is None or control.number(word) == 0.0:
        return control.tools.spindle
    return tool_numbered(control, word)


def further_tool_length(control: Control) -> None:
    """G43.2: the length of tool H, or the words of axes, in addition to the offset in force."""
    word, axes = control.take("H"), control.take_axis_words()
    if word is None and not axes:
        control.fail("tool-offset", "G43.2 needs H or words of axes")
    if word is not None and axes:
        control.fail("tool-offset", "G43.2 takes H or words of axes, not both", word)
    control.tools.length_call = control.tools.spindle
    offset = memory_of(control).tool_offset or [0.0] * len(control.settings.axes)
    more = [0.0] * len(offset)
    if word is not None:
        more = _offset_of(control, _length_number(control, word))
    for index, each in axes:
        more[index] += control.axis_value(index, each)
    set_length(control, [a + b for a, b in zip(offset, more, strict=True)])


def given_tool_length(control: Control) -> None:
    """G43.1: the words of axes are the tool's offset; alone it keeps the one in force (``rs274``)."""
    axes = control.take_axis_words()
    offset = list(memory_of(control).tool_offset or [0.0] * len(control.settings.axes))
    for index, word in axes:
        offset[index] = control.axis_value(index, word)
    control.tools.length_call = control.tools.spindle
    set_length(control, offset)


def end_tool_length(control: Control) -> None:
    """G49."""
    control.tools.length_call = LENGTH_ENDED
    set_length(control, None)


def set_length(control: Control, offset: list[float] | None) -> None:
    """Put a tool offset into force."""
    refuse_in_compensation(control)
    refuse_changed_unit(control)
    memory = memory_of(control)
    memory.tool_offset, memory.offset_unit = offset, control.modal.unit
    reframe(control)


def _offset_of(control: Control, number: int | None) -> list[float]:
    data, offset = control.tools.data(number), [0.0] * len(control.settings.axes)
    offset[2] = 0.0 if data is None else data.length
    return offset
