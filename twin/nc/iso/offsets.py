"""Work offsets, presets, tool length and tool radius: codes that most dialects share.

Decisions, for every dialect: a work offset counts from the job's part zero; G54 is part zero itself
where the job gives it no values; a work offset ends a preset (G92). G53 puts coordinates back to
machine zero until the next work offset.
"""

from collections.abc import Iterable, Mapping

from twin.nc.bytecode.assembler import Assembler, UnsupportedError
from twin.nc.bytecode.opcodes import Opcode
from twin.nc.control.block_words import BlockWords
from twin.nc.control.codes import Compiler, GCode
from twin.nc.control.control import Control
from twin.nc.control.state import integer_of
from twin.nc.geometry.frame import SHIFTS
from twin.nc.iso.compensation_words import compile_compensation, compile_end_of_compensation
from twin.nc.text.blocks import Word
from twin.nc.text.expressions import Expression

LEFT, RIGHT = 1.0, -1.0

NO_TOOL = "give the job a tool with its radius and length: [[tools]]"


def select_offset(control: Control, name: str, word: Word | None) -> None:
    """Put a work offset of the job into force.

    Raises:
        ProgramError: The job gives it no values.
    """
    values = control.settings.offsets.get(name)
    if values is None and name != "G54":
        known = ", ".join(sorted(control.settings.offsets)) or "none"
        control.fail(
            "no-offset",
            f"the job gives no work offset {name}",
            word,
            hint=f"write it under [offsets.{name}]; the job has: {known}",
        )
    _shift_by(control, values or {})


def cancel_offset(control: Control) -> None:
    """G53: coordinates count from machine zero.

    Raises:
        ProgramError: Nobody said where machine zero is.
    """
    zero = control.settings.machine_zero
    if zero is None:
        control.fail(
            "no-machine-zero",
            "G53 counts from machine zero, and the job does not say where that lies",
            hint="write part_zero with its Z into the job file",
        )
    _shift_by(control, zero)


def _shift_by(control: Control, values: Mapping[str, float]) -> None:
    names = control.settings.axes.names
    control.frame.set_shift("offset", [values.get(name, 0.0) for name in names])
    control.frame.set_shift("preset", [0.0] * len(names))
    control.reframed()


def compile_shift(name: str, values: Iterable[float], assembler: Assembler) -> None:
    """A shift with fixed values, for the compiled tier."""
    for value in values:
        assembler.constant(value)
    assembler.emit(Opcode.SHIFT, SHIFTS.index(name))


def compile_programmed_shift(name: str, block: BlockWords, assembler: Assembler) -> None:
    """A shift with the block's values, 0 for the axes that it leaves out, for the compiled tier."""
    words = dict(block.take_axes())
    for index in range(len(block.control.settings.axes)):
        if index in words:
            assembler.word_value(words[index])
            assembler.emit(Opcode.TO_MILLIMETRES, index)
        else:
            assembler.constant(0.0)
    assembler.emit(Opcode.SHIFT, SHIFTS.index(name))


def compile_offset(name: str) -> Compiler:
    """A work offset of the job, for the compiled tier."""

    def write(block: BlockWords, assembler: Assembler) -> None:
        settings = block.control.settings
        values = settings.offsets.get(name)
        if values is None and name != "G54":
            raise UnsupportedError
        names = settings.axes.names
        compile_shift("offset", [(values or {}).get(axis, 0.0) for axis in names], assembler)
        compile_shift("preset", [0.0] * len(names), assembler)
        assembler.emit(Opcode.REFRAME)

    return write


def compile_set_position(shift: str) -> Compiler:
    """New coordinates for where the machine stands, for the compiled tier."""

    def write(block: BlockWords, assembler: Assembler) -> None:
        words = block.take_axes()
        if not words or any(word.incremental for _, word in words):
            raise UnsupportedError
        assembler.emit(Opcode.BEGIN_TARGET)
        for index, word in words:
            assembler.word_value(word)
            assembler.emit(Opcode.TO_MILLIMETRES, index)
            assembler.emit(Opcode.TARGET, index)
        assembler.emit(Opcode.SET_POSITION, SHIFTS.index(shift))

    return write


def _compile_length(sign: float) -> Compiler:
    """G43 H, G44 H, for the compiled tier."""

    def write(block: BlockWords, assembler: Assembler) -> None:
        word, tools = block.take("H"), block.control.tools
        if word is None or isinstance(word.value, Expression) or word.value not in tools.table:
            raise UnsupportedError
        longer = sign * tools.longer(tools.table[int(word.value)])
        axes = len(block.control.settings.axes)
        compile_shift("length", [longer if axis == 2 else 0.0 for axis in range(axes)], assembler)
        assembler.emit(Opcode.REFRAME)

    return write


def _compile_no_length(block: BlockWords, assembler: Assembler) -> None:
    compile_shift("length", [0.0] * len(block.control.settings.axes), assembler)
    assembler.emit(Opcode.REFRAME)


def preset(control: Control) -> None:
    """G92: the place where the machine stands gets the coordinates of the block."""
    programmed = list(control.programmed)
    words = control.take_axis_words()
    if not words:
        control.fail("preset", "G92 needs the coordinates that this place shall have")
    for index, word in words:
        programmed[index] = control.axis_value(index, word)
    control.relabel(programmed, "preset")


def _work_offset(number: int) -> GCode:
    name = f"G{number}"
    return GCode(
        meaning=f"work offset {name} of the job",
        group="offset",
        action=lambda control: select_offset(control, name, control.code_word(number)),
        compiler=compile_offset(name),
    )


OFFSETS = {
    53: GCode(
        meaning="offsets cancelled: machine coordinates", group="offset", action=cancel_offset
    ),
    **{number: _work_offset(number) for number in range(54, 60)},
}
PRESET = {
    92: GCode(
        meaning="preset the position", perform=preset, compiler=compile_set_position("preset")
    )
}


# --- tools


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
        side * control.frame.handedness,
        radius,
        square=control.modal.square_corners,
        indirect=control.modal.indirect_leads,
    )


def _compensation_by_table(control: Control, side: float) -> None:
    """G41, G42: the radius is that of the corrector D, else of the tool in the spindle."""
    word = control.take("D")
    number = control.tools.spindle if word is None else tool_numbered(control, word)
    data = control.tools.data(number)
    if data is None:
        control.fail(
            "no-such-tool", "compensation needs a tool, and the job has none", word, NO_TOOL
        )
    compensate(control, side, data.radius)


def end_compensation(control: Control) -> None:
    """G40."""
    control.path.end_compensation()


def length_by_table(control: Control, sign: float) -> None:
    """G43, G44: the difference of tool lengths moves Z; H names the tool, else the spindle's."""
    word = control.take("H")
    number = control.tools.spindle if word is None else tool_numbered(control, word)
    data = control.tools.data(number)
    if data is None:
        control.fail(
            "no-such-tool", "tool length needs a tool, and the job has none", word, NO_TOOL
        )
    set_length(control, sign * control.tools.longer(data))


def set_length(control: Control, longer: float) -> None:
    """Move Z by what the tool is longer than the first [mm]."""
    shift = [0.0] * len(control.settings.axes)
    shift[2] = longer
    control.frame.set_shift("length", shift)
    control.reframed()


def refuse_plane_change(control: Control) -> None:
    """A new plane while compensation is in force.

    Raises:
        ProgramError: It is.
    """
    if control.path.compensating:
        message = "the plane cannot change while compensation is in force"
        control.fail("compensation-plane", message, hint="end it by G40 first")


COMPENSATION = {
    40: GCode(
        meaning="radius compensation off",
        group="compensation",
        action=end_compensation,
        compiler=compile_end_of_compensation,
    ),
    41: GCode(
        meaning="radius compensation, tool left of the contour",
        group="compensation",
        action=lambda control: _compensation_by_table(control, LEFT),
        compiler=compile_compensation(LEFT),
    ),
    42: GCode(
        meaning="radius compensation, tool right of the contour",
        group="compensation",
        action=lambda control: _compensation_by_table(control, RIGHT),
        compiler=compile_compensation(RIGHT),
    ),
}
LENGTH = {
    43: GCode(
        meaning="tool length compensation",
        group="length",
        action=lambda control: length_by_table(control, 1.0),
        compiler=_compile_length(1.0),
    ),
    44: GCode(
        meaning="tool length compensation, reversed",
        group="length",
        action=lambda control: length_by_table(control, -1.0),
        compiler=_compile_length(-1.0),
    ),
    49: GCode(
        meaning="tool length compensation off",
        group="length",
        action=lambda control: set_length(control, 0.0),
        compiler=_compile_no_length,
    ),
}
