"""The table ``[geometry]`` of a machine file: how far the machine is from straight and square.

Names and signs are those of ISO 230-1 (``twin.toolpath.machine_geometry``).
"""

import re

import pydantic
from pydantic import Field

from twin.files.toml import Table
from twin.nc.canonical import SPATIAL_AXES, Axes
from twin.toolpath.machine_geometry import ErrorTerm, MachineGeometry
from twin.units import MDEG_PER_DEGREE, MM, UM_PER_MM

_NAME = re.compile(r"E([A-Z])([A-Z]\w*)")
_FAR = 1e5
"""Beyond any travel: a slope is a table between the two [mm]."""
_TURN = 360.0


class ErrorTable(Table):
    """An error by the position of its axis; straight lines between, constant beyond the ends."""

    at: tuple[float, ...] = Field(min_length=1)
    """Positions of the axis, rising [mm or deg]; of a rotary axis without travel within one turn."""
    um: tuple[float, ...] | None = None
    """The error there, of errors along X, Y, Z [µm]."""
    mdeg: tuple[float, ...] | None = None
    """The error there, of the indexing of a rotary axis [mdeg]."""

    @pydantic.model_validator(mode="after")
    def _one_value_a_place(self) -> "ErrorTable":
        values = self.um if self.mdeg is None else self.mdeg
        if values is None or (self.um is not None and self.mdeg is not None):
            raise ValueError("an error needs either 'um' or 'mdeg'")
        if len(values) != len(self.at):
            raise ValueError(f"{len(self.at)} places in 'at', but {len(values)} errors")
        if any(after <= before for before, after in zip(self.at, self.at[1:], strict=False)):
            raise ValueError("'at' must rise")
        return self


class SquarenessTable(Table):
    """Angles between axes less 90 degrees [µm/m]: positive where the angle is greater."""

    XY: float = 0.0
    """Between X and Y: at greater Y the tool is at lesser X."""
    YZ: float = 0.0
    """Between Y and Z: at greater Z the tool is at lesser Y."""
    ZX: float = 0.0
    """Between Z and X: at greater Z the tool is at lesser X."""


class TableAxisTable(Table):
    """Where the rotary table's axis lies, against where the control takes it to be."""

    offset_um: tuple[float, float] = (0.0, 0.0)
    """Along X and Y (EX0C, EY0C) [µm]."""
    tilt_um_per_m: tuple[float, float] = (0.0, 0.0)
    """Turned about X and about Y (EA0C, EB0C) [µm/m]."""


class GeometryTable(Table):
    """Errors of the machine's geometry; what is not given is ideal.

    They shift the actual tool point, not what the axes are commanded.
    """

    squareness: SquarenessTable = SquarenessTable()
    table: TableAxisTable = TableAxisTable()
    errors: dict[str, ErrorTable] = Field(default_factory=dict)
    """By ISO 230-1's name: EXX positioning, EYX straightness, ECC indexing, EXC run-out."""
    compensation: dict[str, ErrorTable] = Field(default_factory=dict)
    """What the control takes off, by the same names."""

    def of(self, axes: Axes) -> MachineGeometry:
        """What the tables come to.

        Raises:
            ValueError: A name is none of ISO 230-1's over these axes, or an error has the wrong unit.
        """
        terms = [
            *(self._square(axes, name) for name in ("XY", "YZ", "ZX")),
            *(_term(axes, key, table, 1.0) for key, table in self.errors.items()),
            *(_term(axes, key, table, -1.0) for key, table in self.compensation.items()),
        ]
        x, y = (value / UM_PER_MM for value in self.table.offset_um)
        about_x, about_y = (value * MM / UM_PER_MM for value in self.table.tilt_um_per_m)
        present = tuple(term for term in terms if any(term.error))
        return MachineGeometry(present, (x, y), (about_x, about_y))

    def _square(self, axes: Axes, name: str) -> ErrorTerm:
        slope = getattr(self.squareness, name) * MM / UM_PER_MM
        moving, toward = (name[0], name[1]) if name == "ZX" else (name[1], name[0])
        shift = slope * _FAR
        column, along = axes.index(moving), axes.index(toward)
        return ErrorTerm(f"squareness {name}", column, along, (-_FAR, _FAR), (shift, -shift))


def _term(axes: Axes, key: str, table: ErrorTable, sign: float) -> ErrorTerm:
    found = _NAME.fullmatch(key)
    moving = "" if found is None else found[2]
    toward = "" if found is None else found[1]
    known = moving in axes.names and (toward in SPATIAL_AXES or toward == moving)
    if not known:
        raise ValueError(
            f"'{key}' is no error of these axes: E, then X, Y or Z or the axis itself, then one of "
            f"{', '.join(axes.names)}"
        )
    column, along = axes.index(moving), axes.index(toward)
    rotary = axes.kinds[along] == "rotary"
    values = table.mdeg if rotary else table.um
    if values is None:
        raise ValueError(f"'{key}' is given in '{'mdeg' if rotary else 'um'}'")
    per_unit = MDEG_PER_DEGREE if rotary else UM_PER_MM
    error = tuple(sign * value / per_unit for value in values)
    turns = axes.kinds[column] == "rotary"
    if turns and table.at[-1] - table.at[0] >= _TURN:
        raise ValueError(f"'{key}' repeats after a turn: its places lie within 360 degrees")
    name = _kind(axes, moving, toward, key) + (" compensation" if sign < 0.0 else "")
    return ErrorTerm(name, column, along, table.at, error, _TURN if turns else 0.0)


def _kind(axes: Axes, moving: str, toward: str, key: str) -> str:
    if axes.kinds[axes.index(moving)] == "rotary":
        what = "indexing" if toward == moving else "run-out"
    else:
        what = "positioning" if toward == moving else "straightness"
    return f"{what} {key}"
