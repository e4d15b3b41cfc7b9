"""System variables of a Fanuc control that programs read and write: positions, offsets, modal codes.

Positions and offsets are in the unit in force, axes counted in the order of the machine's. What is not
listed here is refused unless the job gives it a value: [variables] "#1000" = 1.0.
"""

import re
from typing import NoReturn

from twin.nc.control.control import Control
from twin.nc.dialects.fanuc.frames import offsets
from twin.nc.dialects.fanuc.memory import memory_of
from twin.nc.dialects.fanuc.programs import lines_around
from twin.nc.dialects.fanuc.tools import tool_offsets
from twin.nc.geometry.frame import SHIFTS
from twin.nc.iso.offsets import machine_zero
from twin.nc.text.expressions.expressions import ExpressionError

_AXES = 20
"""Variables from one table of axes to the next."""
_INSTEAD = {4014: "the work offset of a Haas is #4012; "}
_MESSAGE = re.compile(r"\(([^()]*)\)")
_PASSED_OVER = {3003: "single block", 3004: "feed hold and override", 3005: "settings"}
_TIMERS = {3001: 1.0, 3002: 1.0 / 3_600_000.0}
"""Timers that programs set and read, milliseconds and hours, and how far each goes on when it is read."""
_FIXED = {
    3011: (20_000_101.0, "the date"),
    3012: (120_000.0, "the time of day"),
    3030: (0.0, "the switch of the single block"),
    3032: (0.0, "the switch of the block skip"),
    3033: (0.0, "the switch of the optional stop"),
    3901: (0.0, "the number of parts that were made"),
    3902: (0.0, "the number of parts that are wanted"),
}
"""A program must come to the same today and tomorrow."""
_LATEST_BLOCK = range(4201, 4400)
_SAME_AS = 200
"""#4201 says of the block that is run what #4001 says of the one before."""


def read(control: Control, number: int) -> float:
    """Value of a system variable."""
    if number in _LATEST_BLOCK:
        number -= _SAME_AS
    group = memory_of(control).variant.modal_groups.get(number - 4000)
    if group is not None:
        return control.modal.active.get(group, 0.0)
    if number in _TIMERS:
        return _time(control, number)
    if number in _FIXED:
        return _fixed(control, number)
    if 4100 <= number <= 4130:
        return _modal_word(control, number)
    if 5001 <= number <= 5100:
        return _position(control, number)
    row = tool_row(control, number)
    if row is not None:
        tool, field = row
        return tool_offsets.read_tool_offset(control, tool, field) / control.modal.unit
    found = _offset(control, number)
    if found is None:
        _refuse(number)
    name, axis = found
    value = offsets.read_offset(control, name, axis, f"#{number}")
    return value / control.motion.unit_of(control.axis_index[axis])


def write(control: Control, number: int, value: float) -> None:
    """Give a system variable a value.

    Raises:
        ExpressionError: Programs do not write it, or the twin does not know it.
        ProgramError: It raises an alarm (#3000).
    """
    if number == 3000:
        _alarm(control, value)
    if number == 3006:
        control.function("M0", {})
        return
    if number in _TIMERS:
        memory_of(control).clocks[number] = value
        return
    if number in _PASSED_OVER:
        control.report.notice(
            f"#{number}", f"#{number} changes nothing here: {_PASSED_OVER[number]}"
        )
        return
    if value != value:
        raise ExpressionError("control-variable", f"#{number} cannot become vacant")
    row = tool_row(control, number)
    if row is not None:
        tool_offsets.write_tool_offset(control, *row, value * control.modal.unit)
        return
    found = _offset(control, number)
    if found is None:
        _refuse(number)
    name, axis = found
    value *= control.motion.unit_of(control.axis_index[axis])
    offsets.write_offset(control, name, axis, value, f"#{number}")
    offsets.put_into_force(control)


def _time(control: Control, number: int) -> float:
    """A timer: it goes on by one each time that it is read, so that a program which waits for it ends."""
    clocks = memory_of(control).clocks
    shown = clocks.get(number, 0.0)
    clocks[number] = shown + _TIMERS[number]
    return shown


def _fixed(control: Control, number: int) -> float:
    """What depends on day and hour, or on what the machine has made before."""
    value, meaning = _FIXED[number]
    control.report.notice(f"#{number}", f"#{number}, {meaning}, is always {value:.0f} here")
    return value


def _refuse(number: int) -> NoReturn:
    if number == 0:
        raise ExpressionError("control-variable", "#0 is always vacant and takes no value")
    if number < 1000:
        message = f"there is no variable #{number}"
        hint = "#1 to #33 belong to the call, #100 to #199 and #500 to #999 to all programs"
        raise ExpressionError("unknown-variable", message, None, hint)
    message = f"#{number} belongs to the control, and the twin does not simulate it"
    hint = _INSTEAD.get(number, "") + f'the job can give its value: [variables] "#{number}" = 0.0'
    raise ExpressionError("control-variable", message, None, hint)


def _alarm(control: Control, value: float) -> NoReturn:
    """#3000=1(MESSAGE): the program raises an alarm."""
    line = control.program_counter.lines[control.block.line - 1]
    match = _MESSAGE.search(line)
    said = "" if match is None else f": {match[1].strip()}"
    first = memory_of(control).variant.first_alarm
    message = f"the program raises the alarm {first + value:g}{said}"
    column = max(line.find("#"), 0)
    control.report.fail("program-alarm", message, column, max(len(line) - column, 1))


def _axis(control: Control, place: int, number: int) -> int:
    if place >= len(control.settings.axes):
        raise ExpressionError("no-such-axis", f"#{number} is of an axis that this machine lacks")
    return place


def _position(control: Control, number: int) -> float:
    """Where an axis stands.

    #5001: where the last block ended; #5021: the same in machine coordinates; #5041: with the tool's
    length; #5061: where a probe would have touched; #5081: the tool's length.
    """
    table, place = divmod(number - 5001, _AXES)
    index = _axis(control, place, number)
    length = control.frame.shifts[SHIFTS.index("length")][index]
    if table == 0:
        value = control.motion.programmed[index]
    elif table == 1:
        name = control.settings.axes.names[index]
        value = control.motion.part[index] - machine_zero(control, f"#{number}").get(name, 0.0)
    elif table == 2:
        value = control.motion.programmed[index] + length
    elif table == 3:  # no probe has touched: where G31 would have ended
        value = control.motion.programmed[index]
    elif table == 4:
        value = length
    else:
        _refuse(number)
    return value / control.motion.unit_of(index)


def _modal_word(control: Control, number: int) -> float:
    memory, heading = memory_of(control), lines_around(control).start
    values = {
        4107: memory.radius_number or 0,
        4109: control.motion.feed or 0.0,
        4111: memory.length_number or 0,
        4114: max(control.block.number, 0),
        4115: _number_of_program(control, heading),
        4119: control.motion.spindle or 0.0,
        4120: control.tools.selected or 0,
        4130: memory.extended_number,
    }
    value = values.get(number)
    if value is None:
        _refuse(number)
    return float(value)


def _number_of_program(control: Control, heading: int) -> int:
    """The number of the program with a heading in this line, from 0; 0 where it has none."""
    programs = memory_of(control).programs
    here = (key for key, line in programs.items() if line - 1 == heading and isinstance(key, int))
    return next(here, 0)


def tool_row(control: Control, number: int) -> tuple[int, str] | None:
    """Row and value of the offset memory that a variable names, or None."""
    for first, last, field in memory_of(control).variant.tool_variables:
        if first <= number <= last:
            return number - first + 1, field
    return None


def _offset(control: Control, number: int) -> tuple[str | None, str] | None:
    """Work offset and axis that a variable names; the external offset has no name."""
    for first, last, begin in ((5201, 5340, -1), (7001, 7960, 6), (14001, 20000, 6)):
        if first <= number <= last:
            table, place = divmod(number - first, _AXES)
            axis = control.settings.axes.names[_axis(control, place, number)]
            row = begin + table
            if row < 0:
                return None, axis
            return (f"G{54 + row}" if row < 6 else offsets.further(control, row - 5)), axis
    return None
