"""Tool radius and tool length: codes that most dialects share, and what compiles them."""

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import Assembler, UnsupportedError
from twin.nc.control.block_words import BlockWords
from twin.nc.control.codes import Compiler, GCode
from twin.nc.control.control import Control
from twin.nc.control.state import integer_of
from twin.nc.iso.offsets import compile_shift
from twin.nc.text.blocks import Word
from twin.nc.text.expressions import Expression

LEFT, RIGHT = 1.0, -1.0

NO_TOOL = "give the job a tool with its radius and length: [[tools]]"


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


def compile_compensation(side: float) -> Compiler:
    """Compensation by the corrector D, else by the tool in the spindle."""

    def write(block: BlockWords, assembler: Assembler) -> None:
        word, table = block.take("D"), block.control.tools.table
        if word is None:
            assembler.emit(opcodes.TOOL_RADIUS)
        elif isinstance(word.value, Expression) or word.value not in table:
            raise UnsupportedError
        else:
            assembler.constant(table[int(word.value)].radius)
        assembler.emit(opcodes.COMPENSATE, int(side))

    return write


def compile_compensation_by_tool(side: float) -> Compiler:
    """Compensation by the tool in the spindle, where it has its offset."""

    def write(block: BlockWords, assembler: Assembler) -> None:
        del block
        assembler.emit(opcodes.TOOL_RADIUS, 1)
        assembler.emit(opcodes.COMPENSATE, int(side))

    return write


def compile_compensation_by_radius(side: float) -> Compiler:
    """Compensation by the radius D, else by the one that was given last."""

    def write(block: BlockWords, assembler: Assembler) -> None:
        word = block.take("D")
        if word is not None:
            assembler.word_value(word)
        assembler.emit(opcodes.PROGRAMMED_RADIUS, int(word is not None))
        assembler.emit(opcodes.COMPENSATE, int(side))

    return write


def compile_end_of_compensation(block: BlockWords, assembler: Assembler) -> None:
    """The next line leads out."""
    del block
    assembler.emit(opcodes.END_COMPENSATION)


def _compile_length(sign: float) -> Compiler:
    """G43 H, G44 H, for the compiled tier."""

    def write(block: BlockWords, assembler: Assembler) -> None:
        word, tools = block.take("H"), block.control.tools
        if word is None or isinstance(word.value, Expression) or word.value not in tools.table:
            raise UnsupportedError
        longer = sign * tools.longer(tools.table[int(word.value)])
        axes = len(block.control.settings.axes)
        compile_shift("length", [longer if axis == 2 else 0.0 for axis in range(axes)], assembler)
        assembler.emit(opcodes.REFRAME)

    return write


def _compile_no_length(block: BlockWords, assembler: Assembler) -> None:
    compile_shift("length", [0.0] * len(block.control.settings.axes), assembler)
    assembler.emit(opcodes.REFRAME)


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
