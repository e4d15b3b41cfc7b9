"""Breaking a machine, at the start of a scene or by the trainer while it runs."""

from typing import Any

from twin.errors import ConfigError
from twin.machine.description.config import AxisTable
from twin.training.scene.fault_table import FaultTable
from twin.training.session.observed import Notice, Observed


def inject(room: Observed, fault: FaultTable) -> None:
    """Break something.

    Raises:
        ConfigError: The machine cannot have this fault.
    """
    names = room.machine.machine.axes.names
    if fault.kind == "alarm":
        room.raise_alarm(Notice("external", "the machine's own safety circuit has tripped"))
        return
    if fault.axis not in names:
        raise ConfigError(f"no axis '{fault.axis}': the machine has {', '.join(names)}")
    if fault.kind == "lost_offset":
        room.tables.zero[names.index(fault.axis)] += fault.value
    else:
        sound = room.scene.preparation.machine.axis(fault.axis)
        room.machine.change(fault.axis, **_axis_change(fault, sound))
        room.faults[:] = [
            one for one in room.faults if (one.kind, one.axis) != (fault.kind, fault.axis)
        ]
    room.faults.append(fault)


def repair(room: Observed) -> None:
    """Take back every fault that is there."""
    room.machine.repair()
    names = room.machine.machine.axes.names
    for fault in room.faults:
        if fault.kind == "lost_offset":
            room.tables.zero[names.index(fault.axis)] -= fault.value
    room.faults.clear()


def forget_offset(room: Observed, axis: str) -> None:
    """Part zero of an axis has been set anew: what was lost of it counts no longer."""
    room.faults[:] = [one for one in room.faults if (one.kind, one.axis) != ("lost_offset", axis)]


def _axis_change(fault: FaultTable, sound: AxisTable) -> dict[str, Any]:
    """The keys of the axis's table that a fault of the machine changes."""
    if fault.kind == "friction":
        return {"dry_friction": fault.value}
    if fault.kind == "backlash":
        return {"backlash": fault.value}
    return {"kv": sound.kv * fault.value}
