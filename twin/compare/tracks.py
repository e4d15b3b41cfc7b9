"""Commanded and actual positions over time, of a recording or of a log of the real machine."""

import csv
import dataclasses
import re
from pathlib import Path

import numpy as np

from twin.errors import UsageError
from twin.nc.canonical import FloatArray, IntArray
from twin.recording.reader import open_recording


@dataclasses.dataclass(frozen=True, slots=True)
class Track:
    """What the axes were told and what they did.

    Attributes:
        name: Where it comes from.
        axes: Names of the k axes.
        time: Rising, shape (n,) [s].
        commanded: Shape (n, k) [mm or deg].
        actual: Shape (n, k) [mm or deg].
        line: Program line of every sample, 0 where none is known, shape (n,).
    """

    name: str
    axes: tuple[str, ...]
    time: FloatArray
    commanded: FloatArray
    actual: FloatArray
    line: IntArray


_TIME = re.compile(r"(time|t)(_?\[?s\]?)?", re.IGNORECASE)
_UNIT = r"(_?[\[(]?(mm|deg)[\])]?)?"
_COMMANDED = re.compile(
    rf"([A-Z])\d?_?(setpoint|command|commanded)(_?position)?{_UNIT}", re.IGNORECASE
)
_ACTUAL = re.compile(rf"([A-Z])\d?_?(joint|actual)(_?position)?{_UNIT}", re.IGNORECASE)
WHAT_WORKS = (
    "a log is CSV with a heading; its columns are time_s (or a period is given), and for every "
    "axis such as X a commanded and an actual position in mm or degrees: X_commanded and X_actual, "
    "X1_CommandPosition and X1_ActualPosition, or X_setpoint_mm and X_joint_mm"
)


def read_track(path: Path, *, period_s: float | None = None) -> Track:
    """Read a recording (``.h5``) or a CSV log.

    Args:
        path: The file.
        period_s: Time between the samples of a log without a time column [s].

    Raises:
        UsageError: The file cannot be read; the message says which columns work.
    """
    if path.suffix in (".h5", ".hdf5"):
        with open_recording(path) as recording:
            return Track(
                str(path),
                recording.header.axes.names,
                recording.column("time"),
                recording.column("setpoint/position"),
                recording.column("joint/position"),
                recording.column("line"),
            )
    return _read_log(path, period_s)


def _read_log(path: Path, period_s: float | None) -> Track:
    header, rows = _read_cells(path)
    commanded, actual = _columns(header, _COMMANDED), _columns(header, _ACTUAL)
    axes = tuple(name for name in commanded if name in actual)
    time = next((i for i, name in enumerate(header) if _TIME.fullmatch(name)), None)
    if not axes or (time is None and period_s is None):
        raise UsageError(f"{path}: has the columns {', '.join(header) or 'none'}; {WHAT_WORKS}")
    if len(rows) < 2 or any(len(row) != len(header) for row in rows):
        raise UsageError(f"{path}: needs two rows or more, each with {len(header)} values")
    wanted = [*(commanded[name] for name in axes), *(actual[name] for name in axes)]
    used = _numbers(path, rows, wanted)
    clock = np.float64(period_s or 0.0) * np.arange(len(rows))
    if time is not None:
        clock = _numbers(path, rows, [time])[:, 0]
    if not (np.diff(clock) > 0.0).all():
        raise UsageError(f"{path}: the time does not rise from row to row")
    line = np.zeros(len(rows), np.int64)
    if "line" in header:
        line = _numbers(path, rows, [header.index("line")])[:, 0].astype(np.int64)
    return Track(str(path), axes, clock, used[:, : len(axes)], used[:, len(axes) :], line)


def _read_cells(path: Path) -> tuple[list[str], list[list[str]]]:
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = csv.reader(file)
            header = [name.strip() for name in next(rows, [])]
            return header, [row for row in rows if row]
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror}") from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise UsageError(f"{path}: is not a log: {error}; {WHAT_WORKS}") from error


def _numbers(path: Path, rows: list[list[str]], columns: list[int]) -> FloatArray:
    try:
        values = np.array([[float(row[column]) for column in columns] for row in rows])
    except ValueError as error:
        raise UsageError(f"{path}: a position, time or line is not a number: {error}") from error
    if not np.isfinite(values).all():
        raise UsageError(f"{path}: a position, time or line is not a number")
    return values


def _columns(header: list[str], pattern: re.Pattern[str]) -> dict[str, int]:
    found: dict[str, int] = {}
    for index, name in enumerate(header):
        match = pattern.fullmatch(name)
        if match:
            found.setdefault(match[1].upper(), index)
    return found
