"""Which column of a log is what, in which unit: from a map (TOML), or from headings that say so."""

import difflib
import re
from pathlib import Path
from typing import Annotated, Any, Literal

import pydantic
from pydantic import Field

from twin.errors import ConfigError
from twin.files.toml import Data, Table, checked, load_toml
from twin.logs.channels import RawLog

Positive = Annotated[float, Field(gt=0)]


class ColumnTable(Table):
    """One column: value = (raw * scale + offset) in a unit."""

    column: str | int
    """Its heading, or its number, counted from 1."""
    unit: str
    """Of the value after ``scale`` and ``offset``."""
    scale: float = 1.0
    """What a raw number is multiplied with."""
    offset: float = 0.0
    """What is added to it then."""
    delay_s: float = 0.0
    """How much later than the time of its row the value was taken, where that is known [s]."""


class ExternalForceTable(ColumnTable):
    """A known force that is not of the control's making."""

    at: Literal["drive", "load"] = "load"
    """Where it acts: ``drive``, added to what the motor gives, so that the drive's force holds it;
    ``load``, at the axis from outside."""


class TimeTable(Table):
    """The clock of a log."""

    column: str | int | None = None
    """Its heading or number; none where every variable has time stamps of its own."""
    unit: str = "s"


class AxisColumns(Table):
    """The columns of one axis; ``command``, and ``actual`` or ``following_error``, are needed."""

    command: ColumnTable
    """Commanded position."""
    actual: ColumnTable | None = None
    """Actual position, as the control's encoder sees it."""
    following_error: ColumnTable | None = None
    """Commanded minus actual position, in place of ``actual``."""
    load: ColumnTable | None = None
    """Position of a second encoder, at the axis where ``actual`` is at the motor."""
    command_velocity: ColumnTable | None = None
    velocity: ColumnTable | None = None
    """Actual velocity."""
    command_acceleration: ColumnTable | None = None
    acceleration: ColumnTable | None = None
    """Actual acceleration."""
    force: ColumnTable | None = None
    """Force of the drive, at the axis."""
    external_force: ExternalForceTable | None = None
    """Known force that is injected at the drive or pushes at the load."""
    current: ColumnTable | None = None
    """Current, torque or voltage of the drive: a force of unknown scale."""

    @pydantic.model_validator(mode="after")
    def _has_position(self) -> "AxisColumns":
        if (self.actual is None) == (self.following_error is None):
            raise ValueError("needs either 'actual' or 'following_error'")
        return self


QUANTITIES = {
    "command": "position", "actual": "position", "following_error": "position",
    "load": "position", "command_velocity": "velocity", "velocity": "velocity",
    "command_acceleration": "acceleration", "acceleration": "acceleration",
    "force": "force", "external_force": "force", "current": "current",
}  # fmt: skip
"""What each role of a column measures."""


class ColumnMap(Table):
    """What the columns of a log are.

    Attributes:
        where: What messages begin with: the map's file, or the log's.
        axes: By the machine's name of the axis.
        time: The clock; none with a period, or where variables have time stamps.
        period_s: Between samples, in place of a clock [s].
        line: Column of program lines, where there is one.
    """

    where: str
    axes: dict[str, AxisColumns]
    time: TimeTable | None = None
    period_s: Positive | None = None
    line: str | None = None

    @property
    def named(self) -> frozenset[str | int]:
        """Names and numbers of all columns that it names."""
        found: set[str | int] = {name for name in (self.line,) if name is not None}
        if self.time is not None and self.time.column is not None:
            found.add(self.time.column)
        for axis in self.axes.values():
            columns = (getattr(axis, role) for role in QUANTITIES)
            found |= {column.column for column in columns if column is not None}
        return frozenset(found)


def read_column_map(path: Path) -> ColumnMap:
    """Read a map.

    Raises:
        ConfigError: It is missing, is not TOML, or has a wrong key or value.
    """
    data = load_toml(path)
    known = ("ball_bar", "columns", "period")
    unknown = sorted(set(data) - set(known))
    if unknown:
        raise ConfigError(f"{path}: unknown key '{unknown[0]}'; known keys: {', '.join(known)}")
    columns = data.get("columns")
    if not isinstance(columns, dict):
        raise ConfigError(f"{path}: 'columns' is missing: a table [columns.X] for every axis")
    period = _period(columns.pop("period", data.get("period")), path)
    clock = columns.pop("time", None)
    axes: Data = {name.upper(): table for name, table in columns.items()}
    if not axes:
        raise ConfigError(f"{path}: no axis: a table [columns.X] names command and actual of X")
    return ColumnMap(
        where=str(path),
        axes={
            name: checked(_table(table, f"{path}: columns.{name}"), AxisColumns,
                          f"{path}: columns.{name}")
            for name, table in axes.items()
        },
        time=None if clock is None
        else checked(_table(clock, f"{path}: columns.time"), TimeTable, f"{path}: columns.time"),
        period_s=period,
    )  # fmt: skip


def _table(value: Any, where: str) -> Data:
    if not isinstance(value, dict):
        raise ConfigError(f'{where} must be a table such as {{ column = "...", unit = "mm" }}')
    return value


def _period(value: Any, path: Path) -> float | None:
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 < value < 1e6:
        raise ConfigError(f"{path}: 'period' must be the seconds between samples (got {value!r})")
    return float(value)


_TIME = re.compile(r"(time|t)(?:[_ ]?[\[(]?(s|ms|us|µs)[\])]?)?", re.IGNORECASE)
_UNIT = r"(?:[_ ]?[\[(]?(mm|deg)[\])]?)?"
_HEADINGS = {
    "command": rf"([A-Z])\d?_?(?:setpoint|command|commanded)(?:_?position)?{_UNIT}",
    "actual": rf"([A-Z])\d?_?(?:joint|actual)(?:_?position)?{_UNIT}",
    "command_velocity": r"([A-Z])_(?:setpoint|command)_(mm|deg)_per_s",
    "velocity": r"([A-Z])_(?:joint|actual)_(mm|deg)_per_s",
    "force": r"([A-Z])_force_(Nm?)",
    "current": r"([A-Z])_current_(A)",
}
_EDGE = {"command": r"DES_POS\|([A-Z])\d?", "actual": r"ENC_POS\|([A-Z])\d?"}
_PER_SECOND = {"command_velocity", "velocity"}


def guessed_map(log: RawLog, *, units_needed: bool) -> ColumnMap:
    """The map of a log whose headings say what its columns are.

    Args:
        units_needed: Leave out positions whose heading says no unit; else they are mm or degrees.

    Returns:
        A map, without axes where no heading is understood.
    """
    found: dict[str, dict[str, ColumnTable]] = {}
    for role, pattern in [*_HEADINGS.items(), *_EDGE.items()]:
        for channel in log.channels:
            match = re.fullmatch(pattern, channel.name, re.IGNORECASE)
            if match is None:
                continue
            stated = match[2] if match.re.groups > 1 else None
            unit = stated or channel.unit or ("" if units_needed else _default_unit(match[1]))
            unit = unit.lower() if unit.lower() in ("mm", "deg") else unit
            if not unit:
                continue
            column = ColumnTable(
                column=channel.name, unit=unit + "/s" if role in _PER_SECOND else unit
            )
            found.setdefault(match[1].upper(), {}).setdefault(role, column)
    clock = next((m for name in log.names if (m := _TIME.fullmatch(name))), None)
    return ColumnMap(
        where=str(log.path),
        axes={
            name: AxisColumns.model_validate(roles)
            for name, roles in found.items()
            if {"command", "actual"} <= set(roles)
        },
        time=None if clock is None
        else TimeTable(column=clock[0], unit=(clock[2] or "s").lower()),
        line="line" if "line" in log.names else None,
    )  # fmt: skip


def _default_unit(axis: str) -> str:
    return "deg" if axis.upper() in "ABC" else "mm"


def template(log: RawLog) -> str:
    """A map to fill in, for a message: with the nearest headings of the log."""

    def near(*words: str) -> str:
        for word in words:
            for name in log.names:
                if word in name.lower():
                    return name
        close = difflib.get_close_matches(words[0], log.names, n=1, cutoff=0.0)
        return close[0] if close else "..."

    return (
        "[columns]\n"
        f'time = {{ column = "{near("time")}", unit = "s" }}    # or period = 0.001\n'
        "[columns.X]\n"
        f'command = {{ column = "{near("command", "des", "set")}", unit = "mm" }}\n'
        f'actual = {{ column = "{near("actual", "enc", "joint")}", unit = "mm" }}'
    )
