"""Breaking a machine, at the start of a scene or by the trainer while it runs."""

from typing import Any

from twin.errors import ConfigError
from twin.machine.config import AxisTable
from twin.training.scene.fault_table import FaultTable
from twin.training.session.observed import Observed


def inject(room: Observed, fault: FaultTable) -> None:
    """Break something.

    Raises:
        ConfigError: The machine cannot have this fault.
    """
    names = room.machine.machine.axes.names
    if fault.kind == "alarm":
        room.raise_alarm("external", "the machine's own safety circuit has tripped")
        return
    if fault.axis not in names:
        raise ConfigError(f"no axis '{fault.axis}': the machine has {', '.join(names)}")
    if fault.kind == "lost_offset":
        room.tables.zero[names.index(fault.axis)] += fault.value
        return
    axis = room.machine.machine.axis(fault.axis)
    room.machine.change(fault.axis, **_axis_change(fault, axis))


def _axis_change(fault: FaultTable, axis: AxisTable) -> dict[str, Any]:
    """The keys of the axis's table that a fault of the machine changes."""
    if fault.kind == "friction":
        return {"dry_friction": fault.value}
    if fault.kind == "backlash":
        return {"backlash": fault.value}
    return {"kv": axis.kv * fault.value}
