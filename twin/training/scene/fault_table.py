"""A fault as a scene or a trainer names it."""

from typing import Annotated, Literal

import pydantic
from pydantic import Field

from twin.files.toml import Table

FaultKind = Literal["friction", "backlash", "dull_drive", "lost_offset", "alarm"]

FAULT_DEFAULTS: dict[FaultKind, tuple[float, str, str]] = {
    "friction": (1500.0, "N", "N m"),
    "backlash": (0.05, "mm", "deg"),
    "dull_drive": (0.4, "", ""),
    "lost_offset": (2.0, "mm", "deg"),
    "alarm": (0.0, "", ""),
}
"""What a fault is offered with: its value, and its unit for a linear and for a rotary axis."""


class FaultTable(Table):
    """One fault.

    ``friction``: dry friction of the axis [N or N m]. ``backlash``: play of the axis [mm or deg].
    ``dull_drive``: the share that is left of the axis's loop gain. ``lost_offset``: the part zero
    of the axis jumps by so much [mm or deg]. ``alarm``: the control stops for no reason.
    """

    kind: FaultKind
    """What is broken."""
    axis: Annotated[str, Field(max_length=8)] = ""
    """The axis that has it; an alarm has none."""
    value: Annotated[float, Field(ge=-1e6, le=1e6)] = 0.0
    """How much, in the unit of its kind."""

    @pydantic.model_validator(mode="after")
    def _fits(self) -> "FaultTable":
        if (self.kind == "alarm") == bool(self.axis):
            raise ValueError("an alarm has no axis, every other fault names one")
        if self.kind in ("friction", "backlash") and self.value < 0.0:
            raise ValueError(f"{self.kind} is 0 or more")
        if self.kind == "dull_drive" and not 0.05 <= self.value <= 1.0:
            raise ValueError("dull_drive leaves a share of 0.05 to 1 of the gain")
        return self
