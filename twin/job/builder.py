"""What the machine's builder adds to a control: M codes and the tool change, in a job or a machine file."""

from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, Field

from twin.files.toml import Table
from twin.units import LARGEST_COORDINATE

Positive = Annotated[float, Field(gt=0)]
Coordinate = Annotated[float, Field(ge=-LARGEST_COORDINATE, le=LARGEST_COORDINATE)]
Triple = tuple[Coordinate, Coordinate, Coordinate]


class MachineFunctionTable(Table):
    """An M code that moves no axis."""

    meaning: str
    """For people, such as "clamp the table"."""
    dwell: Annotated[float, Field(ge=0)] = 0.0
    """How long the program waits for it [s]."""


def _from_meaning(value: Any) -> Any:
    """``M10 = "clamp the table"`` is short for a table with nothing but the meaning."""
    return {"meaning": value} if isinstance(value, str) else value


def _each_once(functions: dict[str, MachineFunctionTable]) -> dict[str, MachineFunctionTable]:
    names: dict[int, str] = {}
    for name in functions:
        if (first := names.setdefault(int(name[1:]), name)) != name:
            raise ValueError(f"{first} and {name} are one code")
    return functions


MachineFunctions = Annotated[
    dict[
        Annotated[str, Field(pattern="^M[0-9]{1,4}$")],
        Annotated[MachineFunctionTable, BeforeValidator(_from_meaning)],
    ],
    AfterValidator(_each_once),
]
"""By M code: ``M10 = "clamp the table"`` or ``M22 = { meaning = "change the pallet", dwell = 4.0 }``."""


class ToolChangeTable(Table):
    """The tool change."""

    height: Coordinate | None = None
    """Z that the control, or the builder's macro behind M6, rises to by itself before the tool changes, machine
    coordinates [mm]; none: a Haas rises to machine zero, other controls change the tool where it is."""
