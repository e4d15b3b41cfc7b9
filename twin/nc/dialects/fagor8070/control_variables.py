"""Variables of the Fagor CNC 8070 that the control itself knows: tool, polar origin, zero offsets.

User variables are ``V.P.name`` and ``V.S.name``; every other one belongs to the control. Decisions:
``V.A.ORGT[n].X`` is the zero offset table, n from 1 as in G159 and values from machine zero; what a
program writes there holds when that offset is selected the next time. Other variables of the
control are never written, because they may move the machine, and are read where the job gives
their value.
"""

import re
from collections.abc import Callable, Mapping

from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.memory import OFFSETS_BY_NUMBER, memory_of, offset_name
from twin.nc.iso.offsets import note_written, table_zero
from twin.nc.text.expressions.expressions import ExpressionError

POLAR_ABSCISSA, POLAR_ORDINATE = "V.G.PORGF", "V.G.PORGS"

_OFFSET = re.compile(r"V\.A\.ORGT\[[ \t]*(P?)([0-9]+)[ \t]*\]\.([A-Z])1?")

_READ: Mapping[str, Callable[[Control], float]] = {
    POLAR_ABSCISSA: lambda control: memory_of(control).polar_origin[0],
    POLAR_ORDINATE: lambda control: memory_of(control).polar_origin[1],
    "V.TM.TOOL": lambda control: float(control.tools.spindle or 0),
    "V.TM.NXTOOL": lambda control: float(control.tools.selected or 0),
    "V.G.TOOL": lambda control: float(control.tools.spindle or 0),
    "V.G.NXTOOL": lambda control: float(control.tools.selected or 0),
    "V.G.TOD": lambda control: float(memory_of(control).offset_on),
}


def is_live(name: str) -> bool:
    """Whether the control knows a variable, which no memory holds."""
    return name.startswith("V.") and not name.startswith(("V.P.", "V.S."))


def read_live(control: Control, name: str) -> float | None:
    """The value of a variable of the control; None where it is not simulated.

    Raises:
        ExpressionError: It is a cell of a table that does not exist.
        ProgramError: Nobody said where machine zero is.
    """
    if (read := _READ.get(name)) is not None:
        return read(control)
    cell = _cell(control, name)
    if cell is None:
        return None
    offset, axis = cell
    values = memory_of(control).offsets.get(offset, control.settings.offsets.get(offset, {}))
    zero = table_zero(control, "V.A.ORGT").get(axis, 0.0)
    return (values.get(axis, 0.0) - zero) / control.motion.unit_of(control.axis_index[axis])


def write_live(control: Control, name: str, value: float) -> bool:
    """Write a variable of the control; False where it cannot be written.

    Raises:
        ExpressionError: It is a cell of a table that does not exist.
        ProgramError: Nobody said where machine zero is.
    """
    cell = _cell(control, name)
    if cell is None:
        return False
    offset, axis = cell
    zero = table_zero(control, "V.A.ORGT").get(axis, 0.0)
    given = dict(control.settings.offsets.get(offset, {}))
    values = memory_of(control).offsets.setdefault(offset, given)
    written = value * control.motion.unit_of(control.axis_index[axis])
    note_written(control, axis, written)
    values[axis] = zero + written
    return True


def _cell(control: Control, name: str) -> tuple[str, str] | None:
    """Name and axis of a cell of the table of offsets; None where a variable is none."""
    match = _OFFSET.fullmatch(name)
    if match is None:
        return None
    number = float(match[2])
    if match[1]:
        parameter = control.variables.read(f"P{match[2]}")
        if parameter is None:
            raise ExpressionError("unknown-variable", f"P{match[2]} has no value")
        number = parameter
    if number != int(number) or not 1 <= number <= OFFSETS_BY_NUMBER:
        message = f"there is no work offset {number:g}"
        raise ExpressionError("no-offset", message, None, f"1 to {OFFSETS_BY_NUMBER}; 1 is G54")
    if match[3] not in control.settings.axes.names:
        axes = ", ".join(control.settings.axes.names)
        message = f"this machine has no axis {match[3]}"
        raise ExpressionError("no-such-axis", message, None, f"axes: {axes}")
    return offset_name(int(number)), match[3]
