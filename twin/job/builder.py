"""What the machine's builder adds to a control: M codes and the tool change, in a job or a machine file."""

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from twin.files.toml import Table


class MachineFunctionTable(Table):
    """An M code that moves no axis."""

    meaning: str
    """For people, such as "clamp the table"."""
    dwell: Annotated[float, Field(ge=0)] = 0.0
    """How long the program waits for it [s]."""
    wait: Literal["spindle"] | None = None
    """``spindle``: the program waits until the spindle has its speed, which it has done since M3."""


def _from_meaning(value: Any) -> Any:
    """``M10 = "clamp the table"`` is short for a table with nothing but the meaning."""
    return {"meaning": value} if isinstance(value, str) else value


MachineFunctions = dict[
    Annotated[str, Field(pattern="^M[0-9]{1,4}$")],
    Annotated[MachineFunctionTable, BeforeValidator(_from_meaning)],
]
"""By M code: ``M10 = "clamp the table"`` or ``M22 = { meaning = "change the pallet", dwell = 4.0 }``."""


class ToolChangeTable(Table):
    """The tool change."""

    height: float | None = None
    """Z that the control, or the builder's macro behind M6, rises to by itself before the tool changes, machine
    coordinates [mm]; none: a Haas rises to machine zero, other controls change the tool where it is."""
