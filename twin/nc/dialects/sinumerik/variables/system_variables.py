"""Variables of the control that programs read and write: positions, work offsets, tools."""

import dataclasses
import math
import re

from twin.nc.control.control import Control
from twin.nc.control.settings import ToolData
from twin.nc.dialects.sinumerik import frames
from twin.nc.dialects.sinumerik.memory import VariableType, memory_of
from twin.nc.iso.offsets import note_written
from twin.nc.text.expressions.expressions import ExpressionError

_NAME = re.compile(r"(\$\w+)(?:\[([^\]]*)\])?")
_LENGTH, _RADIUS = "$TC_DP3", "$TC_DP6"
_TOLD_ONLY = re.compile(r"\$TC_(?:DP\d+|TP\d+|MOP\d+|TPG\d+|DPC.*)")
"""Tool data that move nothing here."""


def read(control: Control, name: str) -> float:
    """Value of a variable; its name with its brackets.

    Raises:
        ExpressionError: The twin does not simulate it.
    """
    key, indices = _split(name)
    if key == "$PI":
        return math.pi
    if key in ("$P_EP", "$AA_IW", "$AA_IB") and len(indices) == 1:
        return control.motion.programmed[_axis(control, indices[0])] / control.motion.unit_of(
            _axis(control, indices[0])
        )
    if (
        key in ("$AA_IM", "$AA_MM")
        and len(indices) == 1
        and control.settings.machine_zero is not None
    ):
        axis = _axis(control, indices[0])
        zero = control.settings.machine_zero.get(control.settings.axes.names[axis], 0.0)
        return (control.motion.part[axis] - zero) / control.motion.unit_of(axis)
    if key == "$P_UIFR" and len(indices) == 3 and indices[2] in ("TR", "FI"):
        number, axis = _number(control, indices[0]), _axis(control, indices[1])
        if indices[2] == "FI":
            return 0.0
        name = control.settings.axes.names[axis]
        value = _offset_values(control, number).get(name, 0.0) + _written_zero(control, name)
        return value / control.motion.unit_of(axis)
    tool = control.tools.data(control.tools.spindle)
    if key == "$P_TOOLNO":
        return float(control.tools.spindle or 0)
    if key == "$P_TOOLR" and tool is not None:
        return tool.radius if memory_of(control).tool_on else 0.0
    if key == "$P_TOOLL" and tool is not None:
        return tool.length if memory_of(control).tool_on and indices == ["1"] else 0.0
    if key in (_LENGTH, _RADIUS) and len(indices) == 2:
        tool = control.tools.data(_number(control, indices[0]))
        if tool is not None and _number(control, indices[1]) == 1:
            return tool.length if key == _LENGTH else tool.radius
    if key in ("$P_F", "$AC_F") and control.motion.feed is not None:
        return control.motion.feed
    if key in ("$P_S", "$AA_S") and control.motion.spindle is not None:
        return control.motion.spindle
    if key in ("$P_SEARCH", "$P_ISTEST", "$P_SIM"):
        return 0.0
    given = control.settings.variables.get(name)
    if given is not None:
        return given
    message = f"{name} belongs to the control, and the twin does not simulate it"
    hint = f'give it to the job: [variables] "{name}" = 0.0; known: $P_EP[X], $AA_IW[X], $P_UIFR[1,X,TR], $TC_DP6[1,1]'
    raise ExpressionError("control-variable", message, None, hint)


def write(control: Control, name: str, value: float) -> None:
    """Give a variable a value.

    Raises:
        ExpressionError: Programs cannot write it, or the twin does not simulate it.
    """
    key, indices = _split(name)
    if key == "$P_UIFR" and len(indices) == 3 and indices[2] == "TR":
        _write_offset(control, indices, value)
    elif key in (_LENGTH, _RADIUS) and len(indices) == 2 and _number(control, indices[1]) == 1:
        number = _number(control, indices[0])
        old = control.tools.data(number) or ToolData(0.0, 0.0)
        field = "length" if key == _LENGTH else "radius"
        control.tools.note_written(number, field, value)
        changed = dataclasses.replace(old, **{field: value})
        control.tools.table = {**control.tools.table, number: changed}
    elif _TOLD_ONLY.fullmatch(key) is None:
        message = f"{name} belongs to the control, and the twin does not simulate it"
        hint = "programs write $P_UIFR[1,X,TR], $TC_DP3[1,1] and $TC_DP6[1,1]"
        raise ExpressionError("control-variable", message, None, hint)


def _split(name: str) -> tuple[str, list[str]]:
    match = _NAME.fullmatch(name)
    assert match is not None
    return match[1], [] if match[2] is None else [each.strip() for each in match[2].split(",")]


def axis_named(control: Control, name: str) -> str | None:
    """An axis by its name or by a variable that holds it; None: there is none."""
    call = memory_of(control).calls[-1]
    if call.types.get(name) is VariableType.AXIS:
        name = call.texts[name]
    name = name.removesuffix("1") if len(name) == 2 else name
    return name if name in control.axis_index else None


def _axis(control: Control, name: str) -> int:
    axis = axis_named(control, name)
    if axis is None:
        raise ExpressionError("no-such-axis", f"this machine has no axis {name}")
    return control.axis_index[axis]


def _number(control: Control, text: str) -> int:
    """A number in the brackets, or a variable that holds it."""
    if not text:
        raise ExpressionError("parameter-number", "an index is missing")
    value = float(text) if text.isdigit() else control.read_variable(text, None)
    if value < 0.0 or value != int(value):
        raise ExpressionError("parameter-number", f"{text} is no index")
    return int(value)


def _offset_values(control: Control, number: int) -> dict[str, float]:
    name = frames.offset_name(number)
    written = memory_of(control).offsets.get(name)
    given = control.settings.offsets.get(name)
    if written is None and given is None and number > 1:
        message = f"the job gives no work offset {name}"
        raise ExpressionError("no-offset", message, None, f"write it under [offsets.{name}]")
    return dict(written if written is not None else given or {})


def _written_zero(control: Control, axis: str) -> float:
    """What the program writes for an axis of the work offset at part zero [mm or deg]."""
    return (control.settings.written_zero or {}).get(axis, 0.0)


def _write_offset(control: Control, indices: list[str], value: float) -> None:
    """It counts from the next G54 to G599 on (manual)."""
    number, axis = _number(control, indices[0]), _axis(control, indices[1])
    name, memory = frames.offset_name(number), memory_of(control)
    values = memory.offsets.get(name)
    if values is None:
        values = dict(control.settings.offsets.get(name, {}))
    written, named = value * control.motion.unit_of(axis), control.settings.axes.names[axis]
    note_written(control, named, written)
    values[named] = written - _written_zero(control, named)
    memory.offsets[name] = values
