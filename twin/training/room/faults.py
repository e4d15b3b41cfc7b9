"""What is broken, from the start of a scene or by the trainer while it runs."""

from typing import Any

from twin.errors import ConfigError
from twin.machine.description.machine_file import AxisTable
from twin.training.room.observed import Observed, RoomAlarm
from twin.training.scene.scene_file import FaultTable


class Faults:
    """The faults of a machine; other files read it and call its methods.

    Attributes:
        active: Those that have not been taken back.
    """

    def __init__(self) -> None:
        self.active: list[FaultTable] = []

    def inject(self, room: Observed, fault: FaultTable) -> None:
        """Break something.

        Raises:
            ConfigError: The machine cannot have this fault.
        """
        axes = room.machine.machine.axes
        if fault.kind == "alarm":
            room.raise_alarm(RoomAlarm("external", "the machine's own safety circuit has tripped"))
            return
        if fault.axis not in axes.names:
            known = ", ".join(axes.names)
            raise ConfigError(f"no axis '{fault.axis}': the machine has {known}")
        if fault.kind == "lost_offset":
            room.setup.tables.shift_zero(axes.index(fault.axis), fault.value)
        else:
            sound = room.scene.preparation.machine.axis(fault.axis)
            room.machine.change(fault.axis, **_axis_change(fault, sound))
            self._forget(fault.kind, fault.axis)
        self.active.append(fault)

    def repair(self, room: Observed) -> None:
        """Take back every fault that there is."""
        room.machine.repair()
        axes = room.machine.machine.axes
        for fault in self.active:
            if fault.kind == "lost_offset":
                room.setup.tables.shift_zero(axes.index(fault.axis), -fault.value)
        self.active = []

    def forget_offset(self, axis: str) -> None:
        """Part zero of an axis has been set again: what was lost of it counts no longer."""
        self._forget("lost_offset", axis)

    def _forget(self, kind: str, axis: str) -> None:
        self.active = [one for one in self.active if (one.kind, one.axis) != (kind, axis)]


def _axis_change(fault: FaultTable, sound: AxisTable) -> dict[str, Any]:
    """The keys of the axis's table that a fault of the machine changes."""
    if fault.kind == "friction":
        return {"dry_friction": fault.value}
    if fault.kind == "backlash":
        return {"backlash": fault.value}
    return {"kv": sound.kv * fault.value}
