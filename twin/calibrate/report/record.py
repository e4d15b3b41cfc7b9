"""The sources of a calibration, so that somebody can sign for it."""

import datetime as dt
import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from twin.logs.machine_log import MachineLog

_AT_ONCE = 1 << 20


class LogRecord(NamedTuple):
    """One log: its file, what it was for, its rate [Hz], rows, length [s] and digest."""

    name: str
    role: str
    rate_hz: float
    rows: int
    seconds: float
    sha256: str


class Record(NamedTuple):
    """What a page is made of.

    Attributes:
        map_text: The map of columns; empty where the headings sufficed.
    """

    date: str
    machine_file: str
    machine_sha256: str
    map_text: str
    logs: tuple[LogRecord, ...]


def record_of(
    machine: tuple[str, Path], columns: Path | None, logs: Sequence[tuple[str, Path, MachineLog]]
) -> Record:
    """Collect the sources of a calibration.

    Args:
        machine: The base as it was named, and its file.
        columns: The map, if there is one.
        logs: Role, file and content of each.
    """
    return Record(
        f"{dt.datetime.now(dt.UTC):%Y-%m-%d %H:%M} UTC",
        machine[0],
        _digest(machine[1]),
        "" if columns is None else columns.read_text(encoding="utf-8", errors="replace"),
        tuple(_log(*each) for each in logs),
    )


def _log(role: str, path: Path, log: MachineLog) -> LogRecord:
    step = float(np.median(np.diff(log.time))) if len(log.time) > 1 else float("nan")
    seconds = float(log.time[-1] - log.time[0]) if len(log.time) else 0.0
    return LogRecord(path.name, role, 1.0 / step, len(log.time), seconds, _digest(path))


def _digest(path: Path) -> str:
    found = hashlib.sha256()
    with path.open("rb") as file:
        while piece := file.read(_AT_ONCE):
            found.update(piece)
    return found.hexdigest()
