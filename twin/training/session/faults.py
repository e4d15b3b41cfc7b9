"""What can be broken at a machine, at the start of a scene or by the trainer while it runs."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

import pydantic
from pydantic import Field

from twin.errors import ConfigError
from twin.files.toml import Table
from twin.machine.config import AxisTable

if TYPE_CHECKING:
    from twin.training.session.room import Room

FaultKind = Literal["friction", "backlash", "dull_drive", "lost_offset", "alarm"]

FAULT_KINDS: tuple[FaultKind, ...] = (
    "friction", "backlash", "dull_drive", "lost_offset", "alarm",
)  # fmt: skip


class FaultTable(Table):
    """One fault.

    ``friction``: dry friction of the axis [N or N m]. ``backlash``: play of the axis [mm or deg].
    ``dull_drive``: the share that is left of the axis's loop gain. ``lost_offset``: the part zero
    of the axis jumps by so much [mm or deg]. ``alarm``: the control stops for no reason.
    """

    kind: FaultKind
    axis: str = ""
    """The axis that has it; an alarm has none."""
    value: Annotated[float, Field(ge=-1e6, le=1e6)] = 0.0

    @pydantic.model_validator(mode="after")
    def _fits(self) -> "FaultTable":
        if (self.kind == "alarm") == bool(self.axis):
            raise ValueError("an alarm has no axis, every other fault names one")
        if self.kind in ("friction", "backlash") and self.value < 0.0:
            raise ValueError(f"{self.kind} is 0 or more")
        if self.kind == "dull_drive" and not 0.05 <= self.value <= 1.0:
            raise ValueError("dull_drive leaves a share of 0.05 to 1 of the gain")
        return self


def _axis_change(fault: FaultTable, axis: AxisTable) -> dict[str, Any]:
    """The keys of the axis's table that a fault of the machine changes."""
    if fault.kind == "friction":
        return {"dry_friction": fault.value}
    if fault.kind == "backlash":
        return {"backlash": fault.value}
    return {"kv": axis.kv * fault.value}


def inject(room: "Room", fault: FaultTable) -> None:
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
