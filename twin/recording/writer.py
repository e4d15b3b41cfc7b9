"""Writing a recording: columns that grow chunk by chunk, complete or absent in the end."""

import contextlib
import json
import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from twin.files.atomic import complete_or_absent, with_path
from twin.nc.canonical import FloatArray
from twin.recording.checksum import write_checksum
from twin.recording.form import (
    COLUMNS,
    CONTOUR,
    GROWTH,
    JOINT_COLUMNS,
    LATER_ATTRIBUTES,
    STEPS,
    TEXT_ATTRIBUTES,
    TOOL_COLUMNS,
    RecordingHeader,
    Samples,
)

_STEP = 8 << 20
"""Bytes that are taken at a time."""


class DiskSpace:
    """Allocates disk space before HDF5 writes to it.

    HDF5 cannot close a file that it could not write, and crashes the process when it exits. A full disk
    is met here first, where it is an error like any other.
    """

    def __init__(self, handle: int, path: Path) -> None:
        """Allocate nothing yet.

        Args:
            handle: The descriptor of the file.
        """
        self._handle = handle
        self._path = path
        self._end = 0

    def hold(self, end: int) -> None:
        """Make sure that the file can be written up to ``end`` [bytes].

        Raises:
            OSError: The disk is full, or the file would be larger than is allowed.
        """
        if end <= self._end:
            return
        try:
            os.posix_fallocate(self._handle, 0, end + _STEP)
        except OSError as error:
            raise with_path(error, self._path) from error
        self._end = end + _STEP


_ROWS_PER_CHUNK = 4096
_FORMAT = ("v110", "v110")
"""The oldest format of HDF5 that can be read while it is written."""

PROGRAM_TEXT = "program_text"
"""Dataset of the program as UTF-8."""

_BOOKKEEPING = 1 << 20
"""What HDF5 may write in addition to columns [bytes]: attributes, and where the chunks lie."""
_MOST_OF_A_LETTER = 4
"""In UTF-8 [bytes]."""


class RecordingWriter:
    """Appends chunks of samples to an open recording."""

    def __init__(self, file: h5py.File, header: RecordingHeader) -> None:
        self._file = file
        self._count = 0
        self._waiting: dict[str, np.ndarray[Any, Any]] = {}
        self._datasets: dict[str, h5py.Dataset] = {}
        width = len(header.axes)
        self._space = DiskSpace(file.id.get_vfd_handle(), Path(file.filename))
        self._hold_space(len(header.program_text) * _MOST_OF_A_LETTER)
        values = sum(width if "/" in path else 1 for path in (*COLUMNS, *JOINT_COLUMNS, CONTOUR))
        self._row_bytes = values * np.dtype(np.float64).itemsize
        for path, (name, unit) in {**COLUMNS, **JOINT_COLUMNS}.items():
            kind = np.int64 if name in ("line", "move") else np.float64
            self._create(path, (0, width) if "/" in path else (0,), kind, unit)
        _write_attributes(file, header)

    def _create(self, path: str, shape: tuple[int, ...], kind: type[np.generic], unit: str) -> None:
        # Each axis in chunks of its own: a third smaller and a quarter faster than side by side.
        chunks = (_ROWS_PER_CHUNK, *(1 for _ in shape[1:]))
        dataset = self._datasets[path] = self._file.create_dataset(
            path, shape, maxshape=(None, *shape[1:]), dtype=kind, chunks=chunks,
            compression="gzip", compression_opts=1, shuffle=True,
        )  # fmt: skip
        if unit:
            dataset.attrs["unit"] = unit

    def _create_tool_columns(self) -> None:
        if next(iter(TOOL_COLUMNS)) in self._datasets:
            return
        for path, (name, unit, width) in TOOL_COLUMNS.items():
            kind = np.bool_ if name == "broken" else np.float64
            self._create(path, (0, width) if width else (0,), kind, unit)
            self._row_bytes += max(1, width) * np.dtype(kind).itemsize

    def note_alarms(self, alarms: Iterable[tuple[float, str]]) -> None:
        """Add what the machine raised when [s, text]."""
        self._file.attrs["alarms"] = json.dumps(list(alarms))

    def append(self, samples: Samples, contour_um: FloatArray | None = None) -> None:
        """Add a chunk that follows the last one.

        Of one that fills a chunk of the file, the samples behind it wait for more to come.

        Args:
            samples: n samples.
            contour_um: Their contour errors, shape (n,) [µm]; for all chunks or for none.

        Raises:
            OSError: The disk is full.
        """
        columns: dict[str, np.ndarray[Any, Any]] = {}
        if contour_um is not None:
            if CONTOUR not in self._datasets:
                self._create(CONTOUR, (0,), np.float64, "um")
            columns[CONTOUR] = contour_um
        if samples.tool is not None:
            self._create_tool_columns()
            for path, (name, _, _) in TOOL_COLUMNS.items():
                columns[path] = getattr(samples.tool, name)
        if samples.growth is not None:
            if GROWTH not in self._datasets:
                self._create(GROWTH, (0, 3), np.float64, "mm")
                self._row_bytes += 3 * np.dtype(np.float64).itemsize
            columns[GROWTH] = samples.growth
        for path, (name, _) in COLUMNS.items():
            columns[path] = getattr(samples.setpoint, name)
        for path, (name, _) in JOINT_COLUMNS.items():
            columns[path] = getattr(samples, name)
        if self._waiting:
            columns = {
                path: np.concatenate([self._waiting[path], column])
                for path, column in columns.items()
            }
        end = self._count + len(columns["time"])
        full = end - end % _ROWS_PER_CHUNK
        # A chunk that is written before it is full is compressed, and leaves a hole, once more.
        self._waiting = {}
        if full > self._count:
            written = full - self._count
            self._waiting = {path: column[written:].copy() for path, column in columns.items()}
            columns = {path: column[:written] for path, column in columns.items()}
        self._write(columns)

    def finish(self) -> None:
        """Write the buffered rows.

        Raises:
            OSError: The disk is full.
        """
        if self._waiting:
            self._write(self._waiting)
            self._waiting = {}

    def _write(self, columns: Mapping[str, np.ndarray[Any, Any]]) -> None:
        count = len(columns["time"])
        # The last chunk of each column may be there already, in part, and is written once more.
        self._hold_space((count + _ROWS_PER_CHUNK) * self._row_bytes)
        for path, column in columns.items():
            self._put(path, column, self._count + count)
        self._count += count
        self._file.flush()

    def _hold_space(self, size: int) -> None:
        self._space.hold(self._file.id.get_filesize() + size + _BOOKKEEPING)

    def _put(self, path: str, values: np.ndarray[Any, Any], end: int) -> None:
        dataset = self._datasets[path]
        dataset.resize(end, axis=0)
        step = STEPS.get(path)
        dataset[self._count : end] = values if step is None else np.rint(values / step) * step


def _write_attributes(file: h5py.File, header: RecordingHeader) -> None:
    attributes = file.attrs
    attributes["axes"] = list(header.axes.names)
    attributes["kinds"] = list(header.axes.kinds)
    attributes["period_s"] = header.period_s
    attributes["part_zero"] = header.part_zero
    attributes["table_axis"] = (
        "" if header.part_frame.rotary is None else header.axes.names[header.part_frame.rotary]
    )
    attributes["table_center"] = header.part_frame.center
    attributes["table_zero"] = header.part_frame.turn_zero
    attributes["kinematics"] = header.part_frame.as_text()
    attributes["geometry"] = header.part_frame.geometry.as_text()
    for name in (*TEXT_ATTRIBUTES, *LATER_ATTRIBUTES):
        attributes[name] = getattr(header, name)
    text = np.frombuffer(header.program_text.encode("utf-8", "surrogatepass"), np.uint8)
    compression = "gzip" if len(text) else None
    file.create_dataset(PROGRAM_TEXT, data=text, compression=compression)
    attributes["complete"] = False


@contextlib.contextmanager
def record(path: Path, header: RecordingHeader) -> Iterator[RecordingWriter]:
    """Open a recording for writing; it appears under ``path`` when the block ends without error.

    Raises:
        OSError: It cannot be written.
    """
    with complete_or_absent(path) as temporary:
        with h5py.File(temporary, "w", libver=_FORMAT) as file:
            writer = RecordingWriter(file, header)
            file.swmr_mode = True
            yield writer
            writer.finish()
        # Opened again, HDF5 also gives the room back that was held and not needed.
        with h5py.File(temporary, "r+", libver=_FORMAT) as file:
            file.attrs["complete"] = True
        write_checksum(temporary)
