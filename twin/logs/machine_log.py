"""A log of a machine: what its axes were commanded and what they did, in the shop's units."""

import dataclasses
import difflib
from collections.abc import Collection, Mapping
from pathlib import Path

import numpy as np

from twin.errors import UsageError
from twin.logs.channels import Channel, RawLog, joined_names
from twin.logs.column_map import (
    QUANTITIES,
    AxisColumns,
    ColumnMap,
    ColumnTable,
    guessed_map,
    template,
)
from twin.logs.delimited import read_delimited
from twin.logs.text_pieces import text_pieces, whole_text
from twin.logs.traces import (
    CODESYS_FIRST_LINE,
    read_codesys_trace,
    read_edge_capture,
    read_sinumerik_trace,
)
from twin.logs.units import factor, kind_of, time_factor
from twin.nc.canonical import BoolArray, FloatArray, IntArray
from twin.units import AxisKind

_MOST_MISSING = 0.5
"""Share of rows with a missing cell, above which a column rather is no column of numbers."""


@dataclasses.dataclass(frozen=True, slots=True)
class AxisLog:
    """One axis of a log; columns of shape (n,).

    Attributes:
        kind: ``linear`` [mm, N] or ``rotary`` [deg, N m].
        command: Commanded position [mm or deg].
        actual: Actual position [mm or deg].
        more: The other columns by their role in ``AxisColumns`` [mm or deg, per s, per s², N or
            N m, as logged for ``current``].
        columns: Where all of them came from.
    """

    kind: AxisKind
    command: FloatArray
    actual: FloatArray
    more: Mapping[str, FloatArray]
    columns: AxisColumns

    def of_rows(self, rows: slice | BoolArray) -> "AxisLog":
        """The same columns, of some rows."""
        more = {role: values[rows] for role, values in self.more.items()}
        return AxisLog(self.kind, self.command[rows], self.actual[rows], more, self.columns)


@dataclasses.dataclass(frozen=True, slots=True)
class MachineLog:
    """A log.

    Attributes:
        time: As logged, which may jump, shape (n,) [s].
        line: Program line of every sample, 0 where none is known, shape (n,).
        missing: Rows that were left out, because a cell of them is missing, counted from 1.
    """

    name: str
    time: FloatArray
    axes: Mapping[str, AxisLog]
    line: IntArray
    missing: IntArray = dataclasses.field(default_factory=lambda: np.zeros(0, np.int64))


def read_raw_log(
    path: Path, *, tick_s: float | None = None, wanted: Collection[str | int] | None = None
) -> RawLog:
    """Read a file of any known form.

    Args:
        tick_s: What a time stamp counts, where a trace does not say it [s].
        wanted: Names or numbers of the columns that are kept of a table; all by default.

    Raises:
        UsageError: The file cannot be read, or is of no known form.
    """
    pieces = text_pieces(path)
    first = next(pieces)
    begin = first.lstrip()
    if begin.startswith(CODESYS_FIRST_LINE):
        return read_codesys_trace(path, whole_text(path, first, pieces), tick_s)
    if begin.startswith("<"):
        return read_sinumerik_trace(path, whole_text(path, first, pieces))
    if begin.startswith(("{", "[")):
        return read_edge_capture(path, whole_text(path, first, pieces))
    return read_delimited(path, first, pieces, wanted)


def read_machine_log(
    path: Path,
    columns: ColumnMap | None = None,
    *,
    period_s: float | None = None,
    units_needed: bool = False,
    gaps_allowed: bool = False,
) -> MachineLog:
    """Read a log of any known form.

    Args:
        columns: What its columns are; by default what its headings say.
        period_s: Between the samples of a log without a clock [s].
        units_needed: Without a map, refuse headings that say no unit.
        gaps_allowed: Leave out rows with missing cells, instead of refusing them.

    Raises:
        UsageError: The file cannot be read, or what its columns are is not known; the message holds
            a map to fill in.
    """
    tick = None
    if columns is not None and columns.time is not None and columns.time.column is None:
        tick = time_factor(columns.time.unit, columns.where)
    raw = read_raw_log(path, tick_s=tick, wanted=None if columns is None else columns.named)
    meant = columns or guessed_map(raw, units_needed=units_needed)
    if not meant.axes:
        raise UsageError(
            f"{path}: has the columns {joined_names(raw.names)}; its headings do not say which is "
            "commanded and which is actual position, and in which unit (as X_command_mm and "
            f"X_actual_mm do). A map does, --columns MAP.toml:\n{template(raw)}"
        )
    period = period_s or meant.period_s or raw.period_s
    time = _clock(raw, meant, period)
    axes = {name: _axis(raw, meant.where, name, table, time) for name, table in meant.axes.items()}
    line = np.zeros(len(time), np.int64)
    if meant.line is not None and (channel := raw.find(meant.line)) is not None:
        line = np.nan_to_num(channel.numbers(path)).astype(np.int64)
    return _without_missing(MachineLog(str(path), time, axes, line), gaps_allowed=gaps_allowed)


def _without_missing(log: MachineLog, *, gaps_allowed: bool) -> MachineLog:
    """A log without the rows in which a number is missing."""
    named = {"time": log.time}
    for name, axis in log.axes.items():
        named |= {f"command of {name}": axis.command, f"actual of {name}": axis.actual}
        named |= {f"{role} of {name}": values for role, values in axis.more.items()}
    complete = np.logical_and.reduce([np.isfinite(values) for values in named.values()])
    missing = np.flatnonzero(~complete)
    if not len(missing):
        return log
    what = next(what for what, values in named.items() if not np.isfinite(values[missing[0]]))
    if not gaps_allowed or len(missing) > _MOST_MISSING * len(complete):
        raise UsageError(
            f"{log.name}: {what} has no number in row {missing[0] + 1} of the values, and so "
            f"{'do' if len(missing) > 2 else 'does'} {len(missing) - 1} more of {len(complete)} rows: "
            "leave out rows or columns without numbers"
        )
    axes = {name: axis.of_rows(complete) for name, axis in log.axes.items()}
    return MachineLog(log.name, log.time[complete], axes, log.line[complete], missing + 1)


def _clock(raw: RawLog, meant: ColumnMap, period_s: float | None) -> FloatArray:
    """The time of every row, (n,) [s]."""
    first = channel_of(raw, meant.where, "command", next(iter(meant.axes.values())).command)
    if meant.time is not None and meant.time.column is not None:
        column = ColumnTable(column=meant.time.column, unit=meant.time.unit)
        channel = channel_of(raw, meant.where, "time", column)
        return _times(channel.numbers(raw.path), time_factor(meant.time.unit, meant.where))
    if first.time is not None:
        return first.time
    if period_s is None:
        raise UsageError(
            f"{raw.path}: has the columns {joined_names(raw.names)}: no time, unless a column "
            "time_s is there or a period is given"
        )
    return period_s * np.arange(len(first.cells), dtype=np.float64)


def channel_of(raw: RawLog, where: str, role: str, column: ColumnTable) -> Channel:
    """A column of a log, as a map names it.

    Args:
        role: What the map takes the column for.

    Raises:
        UsageError: The log has no such column.
    """
    found = raw.find(column.column)
    if found is not None:
        return found
    near = difflib.get_close_matches(str(column.column), raw.names, n=1)
    hint = f"; did you mean '{near[0]}'?" if near else ""
    raise UsageError(
        f"{raw.path}: has no column '{column.column}', which {where} names as {role}{hint}; it has "
        f"{joined_names(raw.names)}"
    )


def _times(values: FloatArray, scale: float, offset: float = 0.0) -> FloatArray:
    """Values in other units; the same array where they are in those already, since logs are large."""
    if scale == 1.0 and offset == 0.0:
        return values
    scaled = values * scale
    scaled += offset
    return scaled


def _axis(raw: RawLog, where: str, name: str, table: AxisColumns, time: FloatArray) -> AxisLog:
    kind = kind_of(table.command.unit)
    values: dict[str, FloatArray] = {}
    for role, quantity in QUANTITIES.items():
        column: ColumnTable | None = getattr(table, role)
        if column is None:
            continue
        place = f"{where}: columns.{name}.{role}"
        scale = factor(quantity, kind, column.unit, place)
        channel = channel_of(raw, where, f"{role} of {name}", column)
        numbers = _times(channel.numbers(raw.path), column.scale * scale, column.offset * scale)
        clock = time if channel.time is None else channel.time
        if len(clock) != len(numbers):
            raise UsageError(f"{place}: has {len(numbers)} values, its time {len(clock)}")
        taken = clock + column.delay_s
        if len(taken) != len(time) or not np.array_equal(taken, time, equal_nan=True):
            there = np.isfinite(numbers) & np.isfinite(taken)
            numbers = np.interp(time, taken[there], numbers[there])
            if channel.time is None:
                numbers[~there] = np.nan
        values[role] = numbers
    command = values.pop("command")
    actual = values.pop("actual") if "actual" in values else command - values["following_error"]
    values.pop("following_error", None)
    return AxisLog(kind, command, actual, values, table)
