"""Parameters of LinuxCNC: numbered and named, the program's own and those of the control."""

import math
import operator
import re
from collections.abc import Callable, Mapping

from twin.nc.control.control import Control
from twin.nc.dialects.linuxcnc.memory import SYSTEMS, CoordinateSystem, memory_of, written_feed
from twin.nc.dialects.linuxcnc.offsets import reframe, table_zeros
from twin.nc.iso.offsets import machine_zero, note_written
from twin.nc.path.feed_rates import FeedMode
from twin.nc.text.blocks import Assignment
from twin.nc.text.expressions import arithmetic
from twin.nc.text.expressions.expressions import (
    IN_DEGREES,
    ExpressionError,
    ExpressionSyntax,
    FunctionOf,
    Operator,
)

_SAME_NUMBER = 0.0001
"""Numbers that differ by less are equal for EQ and NE (LinuxCNC)."""
_VARIABLE = r"#[ \t]*(?:[0-9]+(?![0-9.])|<[^<>#]*>)"


def spelled(name: str) -> str:
    """One spelling of a variable: ``#5``, ``#<depth>``; blanks and capitals do not count."""
    name = re.sub(r"\s", "", name).lower()
    return name if name.startswith("#<") else f"#{int(name[1:])}"


EXPRESSIONS = ExpressionSyntax(
    operators={
        "**": Operator(6, math.pow),
        "*": Operator(5, operator.mul),
        "/": Operator(5, operator.truediv),
        "MOD": Operator(5, arithmetic.positive_remainder),
        "+": Operator(4, operator.add),
        "-": Operator(4, operator.sub),
        "EQ": Operator(3, lambda a, b: abs(a - b) < _SAME_NUMBER),
        "NE": Operator(3, lambda a, b: not abs(a - b) < _SAME_NUMBER),
        "GT": Operator(3, operator.gt),
        "GE": Operator(3, operator.ge),
        "LT": Operator(3, operator.lt),
        "LE": Operator(3, operator.le),
        "AND": Operator(2, arithmetic.both),
        "OR": Operator(2, arithmetic.either),
        "XOR": Operator(2, arithmetic.one_alone),
    },
    functions={
        **{name: each for name, each in IN_DEGREES.items() if name != "ATAN"},
        "FIX": FunctionOf(math.floor),
        "FUP": FunctionOf(math.ceil),
        "ROUND": FunctionOf(arithmetic.nearest_whole_away),
    },
    constants={},
    variable=_VARIABLE,
    brackets="[]",
    existence=("EXISTS",),
    spelled=spelled,
    indirect="#",
    quotients={"ATAN": arithmetic.direction_of_quotient},
    bracketed=True,
)
"""Angles are degrees."""


LOCAL_PARAMETERS = 30
"""#1 to #30 belong to the call of a subroutine, which gives the first of them their values."""
LAST_PARAMETER = 5601
_AXES = "XYZABCUVW"
"""Axes in the order of their parameters."""
_FIRST_SYSTEM, _SYSTEM_STEP, _ROTATION = 5221, 20, 9
_LAST_SYSTEM = _FIRST_SYSTEM + _SYSTEM_STEP * len(SYSTEMS) - 1
_READ_ONLY = (5400, *range(5420, 5429), *range(5599, 5602))


def is_local(name: str) -> bool:
    """Whether each call of a subroutine has a variable of this name again."""
    if name.startswith("#<"):
        return not name.startswith("#<_")
    return not name[1:].isdigit() or int(name[1:]) <= LOCAL_PARAMETERS


def given_variable(given: Mapping[str, float], name: str) -> float | None:
    """The job's value of a parameter; numbered ones that nobody has set are 0."""
    return given.get(name, 0.0 if name[1:].isdigit() else None)


def read_variable(control: Control, name: str, index: float | None) -> float:
    """Value of ``#5``, ``#[...]``, ``#<name>``, ``#<_name>``.

    Raises:
        ExpressionError: There is no such parameter, or it has no value.
    """
    if index is not None:
        name = f"#{_number(index)}"
    number = _numbered(name)
    if number is not None:
        _check_number(number)
        value = _read_live(control, number) if number >= 5000 else None
        if value is None:
            value = control.variables.read(name)
        return 0.0 if value is None else value
    named = _NAMED.get(name[3:-1]) if name.startswith("#<_") else None
    if named is not None:
        return named(control)
    value = control.variables.read(name)
    if value is None:
        hint = f'set it before, or in the job: [variables] "{name}" = 0.0'
        raise ExpressionError("unknown-variable", f"{name} has no value", None, hint)
    return value


def _number(index: float) -> int:
    number = round(index)
    if abs(index - number) > 0.0001:
        raise ExpressionError("parameter-number", f"there is no parameter #{index:g}")
    return number


def _numbered(name: str) -> int | None:
    """The number that a parameter has for a name, also where there is none such; None: it has a word."""
    return int(name[1:]) if name[1:].removeprefix("-").isdigit() else None


def _check_number(number: int) -> None:
    if not 1 <= number <= LAST_PARAMETER:
        message = f"there is no parameter #{number}: they are #1 to #{LAST_PARAMETER}"
        raise ExpressionError("parameter-number", message)


def write_variable(
    control: Control, name: str, index: float | None, value: float, assignment: Assignment
) -> None:
    """Give a parameter a value."""
    span = assignment.column, assignment.width
    try:
        if index is not None:
            name = f"#{_number(index)}"
        number = _numbered(name)
        if number is not None:
            _check_number(number)
    except ExpressionError as error:
        control.report.fail(error.code, str(error), *span)
    number = number or 0
    if number in _READ_ONLY or (name.startswith("#<_") and name[3:-1] in _NAMED):
        message = f"{name} is the control's own and cannot be set"
        control.report.fail("control-variable", message, *span)
    if number < 5000 or not _write_live(control, number, value):
        control.variables.write(name, value)


# --- numbered parameters of the control


def _axis(control: Control, place: int) -> int | None:
    """Column of the axis at a place of ``_AXES``; None where the machine lacks it."""
    return control.axis_index.get(_AXES[place]) if 0 <= place < len(_AXES) else None


def _of(control: Control, values: list[float], place: int) -> float:
    axis = _axis(control, place)
    return 0.0 if axis is None else values[axis]


_OF_MACHINE = "a parameter of machine coordinates"


def _read_live(control: Control, number: int) -> float | None:
    memory = memory_of(control)
    if 5061 <= number <= 5069:
        return _of(control, memory.probe, number - 5061)
    if 5161 <= number <= 5169 or 5181 <= number <= 5189:
        return _of(control, memory.homes[number > 5170], (number - 5161) % 20)
    if number == 5210:
        return float(memory.preset_on)
    if 5211 <= number <= 5219:
        return _of(control, memory.kept_preset, number - 5211)
    if number == 5220:
        return float(memory.system)
    if _FIRST_SYSTEM <= number <= _LAST_SYSTEM:
        return _read_system(control, number - _FIRST_SYSTEM)
    if number in (5400, 5410) or 5401 <= number <= 5409:
        return _read_tool(control, number)
    if 5420 <= number <= 5428:
        if memory_of(control).compensation is not None:
            message = f"#{number} cannot be read while radius compensation is in force"
            raise ExpressionError("compensation-change", message, None, "end it by G40 first")
        axis = _axis(control, number - 5420)
        return (
            0.0 if axis is None else control.motion.programmed[axis] / control.motion.unit_of(axis)
        )
    return None


def _read_system(control: Control, at: int) -> float | None:
    number, place = at // _SYSTEM_STEP + 1, at % _SYSTEM_STEP
    system = memory_of(control).systems.get(number)
    axis = _axis(control, place)
    if place == _ROTATION:
        return 0.0 if system is None else system.rotation
    if axis is None or system is None:
        return 0.0 if place < _ROTATION else None
    return system.origin[axis] - table_zeros(control, _OF_MACHINE)[axis]


def _read_tool(control: Control, number: int) -> float:
    """The tool in the spindle, as the tool table has it, whichever length is in force."""
    if number == 5400:
        return float(control.tools.spindle or 0)
    data = control.tools.data(control.tools.spindle)
    if data is None:
        return 0.0
    if number == 5410:
        return 2.0 * data.radius
    return data.length if _AXES[number - 5401] == "Z" else 0.0


def _write_live(control: Control, number: int, value: float) -> bool:
    """Set a parameter that the control keeps itself; False where it is none of them."""
    memory = memory_of(control)
    if 5161 <= number <= 5169 or 5181 <= number <= 5189:
        axis = _axis(control, (number - 5161) % 20)
        if axis is not None:
            memory.homes[number > 5170][axis] = value
        return axis is not None
    if _FIRST_SYSTEM <= number <= _LAST_SYSTEM:
        return _write_system(control, number - _FIRST_SYSTEM, value)
    if number in (5210, 5220) or 5211 <= number <= 5219 or 5401 <= number <= 5413:
        message = f"#{number} is set by the codes that it belongs to"
        control.fail("control-variable", message, hint="write G10, G92, G43 or the system's code")
    return False


def _write_system(control: Control, at: int, value: float) -> bool:
    number, place = at // _SYSTEM_STEP + 1, at % _SYSTEM_STEP
    axis, memory = _axis(control, place), memory_of(control)
    if axis is None and place != _ROTATION:
        return False
    if number == memory.system:
        message = "the coordinate system in force is changed by G10"
        control.fail("control-variable", message, hint=f"write G10 L2 P{number}")
    zero = table_zeros(control, _OF_MACHINE)
    system = memory.systems.setdefault(number, CoordinateSystem(zero))
    if axis is None:
        system.rotation = value
    else:
        note_written(control, control.settings.axes.names[axis], value)
        system.origin[axis] = value + zero[axis]
    reframe(control)
    return True


# --- named parameters of the control


def _code(group: str, default: float = 0.0) -> Callable[[Control], float]:
    """The code in force of a group, ten times its number as LinuxCNC counts."""
    return lambda control: round(10.0 * control.modal.active.get(group, default))


def _switched(name: str) -> Callable[[Control], float]:
    return lambda control: memory_of(control).functions.get(name, 0.0)


def _position(letter: str, *, of_machine: bool) -> Callable[[Control], float]:
    def value(control: Control) -> float:
        axis = control.axis_index.get(letter)
        if axis is None:
            return 0.0
        place = (
            control.motion.part[axis] - machine_zero(control, _OF_MACHINE).get(letter, 0.0)
            if of_machine
            else control.motion.programmed[axis]
        )
        return place / control.motion.unit_of(axis)

    return value


_NAMED: dict[str, Callable[[Control], float]] = {
    "vmajor": lambda _control: 2.9,
    "vminor": lambda _control: 0.0,
    "line": lambda control: float(control.block.line),
    "motion_mode": _code("motion", 80.0),
    "plane": _code("plane"),
    "ccomp": _code("compensation"),
    "metric": lambda control: float(control.modal.unit == 1.0),
    "imperial": lambda control: float(control.modal.unit != 1.0),
    "absolute": lambda control: float(not control.modal.incremental),
    "incremental": lambda control: float(control.modal.incremental),
    "inverse_time": lambda control: float(control.modal.feed_mode is FeedMode.BLOCKS_PER_MINUTE),
    "units_per_minute": lambda control: float(control.modal.feed_mode is FeedMode.PER_MINUTE),
    "units_per_rev": lambda control: float(control.modal.feed_mode is FeedMode.PER_REVOLUTION),
    "coord_system": lambda control: round(10.0 * float(SYSTEMS[memory_of(control).system - 1][1:])),
    "tool_offset": lambda control: float(any(memory_of(control).tool_offset or ())),
    "retract_r_plane": lambda control: float(control.modal.return_to_reference),
    "retract_old_z": lambda control: float(not control.modal.return_to_reference),
    "spindle_rpm_mode": lambda _control: 1.0,
    "spindle_css_mode": lambda _control: 0.0,
    "ijk_absolute_mode": lambda control: float(control.modal.center_absolute),
    "lathe_diameter_mode": lambda _control: 0.0,
    "lathe_radius_mode": lambda _control: 1.0,
    "spindle_on": lambda control: float(control.motion.spindle_turns),
    "spindle_cw": lambda control: float(
        control.motion.spindle_turns and memory_of(control).functions.get("spindle") == 3.0
    ),
    "mist": _switched("mist"),
    "flood": _switched("flood"),
    "speed_override": lambda _control: 1.0,
    "feed_override": lambda _control: 1.0,
    "adaptive_feed": lambda _control: 0.0,
    "feed_hold": lambda _control: 1.0,
    "feed": lambda control: written_feed(control) or 0.0,
    "rpm": lambda control: control.motion.spindle or 0.0,
    **{letter.lower(): _position(letter, of_machine=False) for letter in _AXES},
    **{f"abs_{letter.lower()}": _position(letter, of_machine=True) for letter in _AXES},
    "current_tool": lambda control: float(control.tools.spindle or 0),
    "current_pocket": lambda control: float(control.tools.spindle or 0),
    "selected_tool": lambda control: float(control.tools.selected or 0),
    "selected_pocket": lambda control: float(control.tools.selected or 0),
    "value": lambda control: memory_of(control).returned[0],
    "value_returned": lambda control: float(memory_of(control).returned[1]),
    "task": lambda _control: 1.0,
    "call_level": lambda control: float(control.program_counter.depth),
    "remap_level": lambda _control: 0.0,
}
"""What a program reads of the control by ``#<_name>``, without the underscore."""
