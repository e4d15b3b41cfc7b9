"""Commanded and actual positions over time, of a recording or of a log of the real machine."""

import dataclasses
from pathlib import Path

import numpy as np

from twin.errors import UsageError
from twin.logs.column_map import ColumnMap
from twin.logs.machine_log import read_machine_log
from twin.nc.canonical import FloatArray, IntArray
from twin.recording.reader import open_recording


@dataclasses.dataclass(frozen=True, slots=True)
class Track:
    """What the axes were commanded and what they did.

    Attributes:
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


def read_track(
    path: Path, *, period_s: float | None = None, columns: ColumnMap | None = None
) -> Track:
    """Read a recording (``.h5``) or a log of a real machine.

    Args:
        period_s: Time between the samples of a log without a time column [s].
        columns: What the columns of a log are; by default what its headings say.

    Raises:
        UsageError: The file cannot be read; the message says which columns work.
    """
    if path.suffix not in (".h5", ".hdf5"):
        return _log_track(path, period_s, columns)
    with open_recording(path) as recording:
        return Track(
            str(path),
            recording.header.axes.names,
            recording.column("time"),
            recording.column("setpoint/position"),
            recording.column("joint/position"),
            recording.column("line"),
        )


def _log_track(path: Path, period_s: float | None, columns: ColumnMap | None) -> Track:
    log = read_machine_log(path, columns, period_s=period_s)
    if not (np.diff(log.time) > 0.0).all():
        raise UsageError(f"{path}: the time does not rise from row to row")
    return Track(
        log.name,
        tuple(log.axes),
        log.time,
        np.column_stack([axis.command for axis in log.axes.values()]),
        np.column_stack([axis.actual for axis in log.axes.values()]),
        log.line,
    )
