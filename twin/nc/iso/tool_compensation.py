"""Tool radius and tool length: codes that most dialects share."""

from twin.nc.bytecode import opcodes
from twin.nc.bytecode.assembler import Assembler
from twin.nc.bytecode.registers import OFFSET_ON, RADIUS_GIVEN
from twin.nc.control.codes import Effect, GCode
from twin.nc.control.compensation import NEEDS_TOOL, tool_numbered
from twin.nc.control.control import Control
from twin.nc.iso.findings import NO_TOOL
from twin.nc.iso.offsets import compile_shift
from twin.nc.text.arithmetic import multiply

LEFT, RIGHT = 1, -1


def _compensation_by_table(side: int) -> Effect:
    """G41, G42: the radius is that of the corrector D, else of the tool in the spindle."""

    def write(control: Control, assembler: Assembler) -> None:
        word = control.take("D")
        if word is None:
            _write_radius(assembler)
        else:
            assembler.known(word)
            tool = control.tools.data(tool_numbered(control, word))
            assembler.constant(0.0 if tool is None else tool.radius)
        assembler.emit(opcodes.COMPENSATE, side)

    return Effect(write)


def compensation_by_tool(side: int) -> Effect:
    """Compensation by the tool in the spindle, where it has its offset."""

    def write(_control: Control, assembler: Assembler) -> None:
        _write_radius(assembler)
        assembler.register(OFFSET_ON)
        assembler.compute(multiply)
        assembler.emit(opcodes.COMPENSATE, side)

    return Effect(write)


def _write_radius(assembler: Assembler) -> None:
    """Put the radius of the tool in the spindle on the stack."""
    assembler.emit(opcodes.TOOL_RADIUS)
    assembler.check(opcodes.PRESENT, NO_TOOL)


def compensation_by_radius(side: int) -> Effect:
    """Compensation by the radius D, else by the one that was given last."""

    def write(control: Control, assembler: Assembler) -> None:
        word = control.take("D")
        if word is not None:
            assembler.word_value(word)
            assembler.emit(opcodes.TO_MILLIMETRES)
            assembler.set_register(RADIUS_GIVEN)
        assembler.register(RADIUS_GIVEN)
        assembler.emit(opcodes.COMPENSATE, side)

    return Effect(write)


END_OF_COMPENSATION = Effect(lambda _, assembler: assembler.emit(opcodes.END_COMPENSATION))


def _length_by_table(sign: float) -> Effect:
    """G43, G44: the difference of tool lengths moves Z; H names the tool, else the spindle's."""

    def write(control: Control, assembler: Assembler) -> None:
        word = control.take("H")
        if word is None:
            assembler.interpreted(lambda: _length_in_spindle(control, sign))
            return
        assembler.known(word)
        tool = control.tools.data(tool_numbered(control, word))
        write_length(control, 0.0 if tool is None else sign * control.tools.longer(tool), assembler)

    return Effect(write)


def _length_in_spindle(control: Control, sign: float) -> None:
    tool = control.tools.data(control.tools.spindle)
    if tool is None:
        message = "tool length needs a tool, and the job has none"
        control.fail("no-such-tool", message, None, NEEDS_TOOL)
    set_length(control, sign * control.tools.longer(tool))


def set_length(control: Control, longer: float) -> None:
    """Move Z by what the tool is longer than the first [mm]."""
    control.perform(lambda assembler: write_length(control, longer, assembler))


def write_length(control: Control, longer: float, assembler: Assembler) -> None:
    """As ``set_length``, said as instructions."""
    axes = len(control.settings.axes)
    compile_shift("length", [longer if axis == 2 else 0.0 for axis in range(axes)], assembler)
    assembler.emit(opcodes.REFRAME)


COMPENSATION = {
    40: GCode(meaning="radius compensation off", group="compensation", action=END_OF_COMPENSATION),
    41: GCode(
        meaning="radius compensation, tool left of the contour",
        group="compensation",
        action=_compensation_by_table(LEFT),
    ),
    42: GCode(
        meaning="radius compensation, tool right of the contour",
        group="compensation",
        action=_compensation_by_table(RIGHT),
    ),
}
LENGTH = {
    43: GCode(meaning="tool length compensation", group="length", action=_length_by_table(1.0)),
    44: GCode(
        meaning="tool length compensation, reversed",
        group="length",
        action=_length_by_table(-1.0),
    ),
    49: GCode(
        meaning="tool length compensation off",
        group="length",
        action=Effect(lambda control, assembler: write_length(control, 0.0, assembler)),
    ),
}
