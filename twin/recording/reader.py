"""The recording: setpoints and simulated joints at the servo rate, as an HDF5 file.

Sample i of ``joint`` and of ``setpoint`` belong to the same instant ``time[i]``. The file is
written under a temporary name and renamed when the run has ended, so that a file under its own
name is whole. Until then it can be read under its temporary name, ``.recording.*.part.h5`` in the
same folder, for HDF5 writes it so that others may read it (single writer, multiple readers).
"""

import contextlib
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from twin.errors import RecordingError
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Axes, FloatArray
from twin.recording.checksum import checksum_is_wrong, has_checksum
from twin.recording.form import (
    COLUMNS,
    CONTOUR,
    GROWTH,
    JOINT_COLUMNS,
    LATER_ATTRIBUTES,
    LONGEST_TEXT,
    TEXT_ATTRIBUTES,
    TOOL_COLUMNS,
    RecordingHeader,
    Samples,
    ToolLoad,
)
from twin.recording.readable import reading_ends
from twin.recording.writer import PROGRAM_TEXT, RecordingWriter, record
from twin.toolpath.machine_geometry import geometry_from_text
from twin.toolpath.part_frame import PartFrame, chain_from_text

__all__ = [
    "CONTOUR",
    "LONGEST_TEXT",
    "Recording",
    "RecordingHeader",
    "RecordingWriter",
    "Samples",
    "open_growing",
    "open_recording",
    "record",
]


_DAMAGE = (KeyError, ValueError, IndexError, TypeError, AttributeError, OSError, RuntimeError)
"""What HDF5 raises when a file is not what it should be."""


class Recording:
    """A recording, open for reading in chunks.

    Attributes:
        header: What it says about itself.
    """

    def __init__(self, path: Path, file: h5py.File) -> None:
        self.path = path
        self._file = file
        self.header = _read_header(file)
        width = len(self.header.axes)
        for name in (*COLUMNS, *JOINT_COLUMNS):
            shape = self._dataset(name).shape
            if shape[1:] != ((width,) if "/" in name else ()):
                raise ValueError(f"'{name}' has {shape[1:]} values a sample")
        self._has_tool = next(iter(TOOL_COLUMNS)) in file
        self._length = len(self._dataset("time"))

    def __len__(self) -> int:
        return self._length

    @property
    def _names(self) -> tuple[str, ...]:
        """Of all datasets that are read."""
        grown = (GROWTH,) if GROWTH in self._file else ()
        return (*COLUMNS, *JOINT_COLUMNS, *(TOOL_COLUMNS if self._has_tool else ()), *grown)

    def refresh(self) -> int:
        """See what has been appended since; how many samples there are now."""
        self._has_tool = list(TOOL_COLUMNS)[-1] in self._file
        datasets = [self._dataset(name) for name in self._names]
        for dataset in datasets:
            dataset.refresh()
        # The columns grow one after the other: only what all of them have is whole.
        self._length = min(len(dataset) for dataset in datasets)
        return self._length

    def check_lengths(self) -> None:
        """Make sure that all columns of a recording that nobody writes any more are equally long.

        Raises:
            ValueError: They are not.
        """
        for name in self._names:
            if len(self._dataset(name)) != len(self):
                raise ValueError(f"'{name}' is not as long as 'time'")

    def _dataset(self, name: str) -> h5py.Dataset:
        dataset = self._file[name]
        if not isinstance(dataset, h5py.Dataset):
            raise TypeError(f"'{name}' is not a dataset")
        return dataset

    def _read(self, name: str, first: int, last: int) -> np.ndarray[Any, Any]:
        try:
            return self._dataset(name)[first:last]
        except _DAMAGE as error:
            raise RecordingError(f"{self.path}: '{name}' cannot be read: {error}") from error

    def column(self, name: str) -> np.ndarray[Any, Any]:
        """One whole dataset, such as ``joint/position``.

        Raises:
            RecordingError: It is damaged.
        """
        return self._read(name, 0, len(self))

    @property
    def alarms(self) -> tuple[tuple[float, str], ...]:
        """When the machine raised which alarm [s, text]."""
        try:
            noted = json.loads(str(self._file.attrs.get("alarms", "[]")))
            return tuple((float(time), str(text)) for time, text in noted)
        except _DAMAGE as error:
            raise RecordingError(f"{self.path}: its alarms cannot be read: {error}") from error

    def contour_um(self, first: int, last: int) -> FloatArray | None:
        """Contour error of the samples from ``first`` up to ``last`` [µm]; None where not known."""
        return self._read(CONTOUR, first, last) if CONTOUR in self._file else None

    def chunks(self, rows: int = 65536) -> Iterator[Samples]:
        """Samples in order, at most ``rows`` at a time."""
        for first in range(0, len(self), rows):
            last = min(first + rows, len(self))
            setpoint = Setpoints(
                **{name: self._read(path, first, last) for path, (name, _) in COLUMNS.items()}
            )
            yield Samples(
                setpoint,
                **{
                    name: self._read(path, first, last) for path, (name, _) in JOINT_COLUMNS.items()
                },
                tool=self._tool(first, last),
                growth=self._read(GROWTH, first, last) if GROWTH in self._file else None,
            )

    def _tool(self, first: int, last: int) -> ToolLoad | None:
        """What loaded the tool; None where that was not simulated."""
        if not self._has_tool:
            return None
        return ToolLoad(
            **{name: self._read(path, first, last) for path, (name, _, _) in TOOL_COLUMNS.items()}
        )


def _read_header(file: h5py.File) -> RecordingHeader:
    values = {name: np.asarray(value).tolist() for name, value in file.attrs.items()}
    axes = Axes(tuple(values["axes"]), tuple(values["kinds"]))
    table_axis = values["table_axis"]
    chain, chain_zero = chain_from_text(values.get("kinematics", ""))
    return RecordingHeader(
        axes=axes,
        period_s=values["period_s"],
        part_zero=np.array(values["part_zero"], np.float64),
        part_frame=PartFrame(
            rotary=axes.index(table_axis) if table_axis else None,
            center=tuple(values["table_center"]),
            turn_zero=values["table_zero"],
            geometry=geometry_from_text(values.get("geometry", "")),
            chain=chain,
            zero=chain_zero,
        ),
        program_text=_program_text(file),
        **{name: values[name] for name in TEXT_ATTRIBUTES},
        **{name: values.get(name, "") for name in LATER_ATTRIBUTES},
    )


def _program_text(file: h5py.File) -> str:
    kept = file.get(PROGRAM_TEXT)
    if isinstance(kept, h5py.Dataset):
        return kept[:].tobytes().decode("utf-8", "surrogatepass")
    return str(file.attrs[PROGRAM_TEXT])  # recordings of earlier versions


@contextlib.contextmanager
def open_recording(path: Path) -> Iterator[Recording]:
    """Open a complete recording.

    Raises:
        RecordingError: The file is missing, torn, incomplete or not a recording.
    """
    with _damage_reported(path):
        if path.is_file() and checksum_is_wrong(path):
            raise RecordingError(f"{path}: is damaged: it is not what was written")
    with _opened(path) as file:
        with _damage_reported(path):
            if not has_checksum(path) and not reading_ends(path):
                raise RecordingError(f"{path}: is damaged: reading it does not come to an end")
            if not file.attrs.get("complete", False):
                raise RecordingError(f"{path}: the recording is not complete")
            recording = Recording(path, file)
            recording.check_lengths()
        yield recording


@contextlib.contextmanager
def open_growing(path: Path) -> Iterator[Recording]:
    """Open a recording that a run is writing; ``Recording.refresh`` sees what has been appended.

    Args:
        path: The name that it will have. When it is there already, it is opened as it is.

    Raises:
        RecordingError: No run is writing it, or it has only begun.
    """
    parts = sorted(
        path.parent.glob(f".{path.stem}.*.part{path.suffix}"), key=lambda part: part.stat().st_mtime
    )
    found = path if path.is_file() or not parts else parts[-1]
    with _opened(found, swmr=True) as file:
        with _damage_reported(found):
            recording = Recording(found, file)
            recording.refresh()
        yield recording


@contextlib.contextmanager
def _opened(path: Path, *, swmr: bool = False) -> Iterator[h5py.File]:
    try:
        file = h5py.File(path, "r", swmr=swmr)
    except FileNotFoundError as error:
        raise RecordingError(f"{path}: no such file") from error
    except OSError as error:
        raise RecordingError(f"{path}: is not a readable recording: {error}") from error
    with file:
        yield file


@contextlib.contextmanager
def _damage_reported(path: Path) -> Iterator[None]:
    try:
        yield
    except _DAMAGE as error:
        raise RecordingError(f"{path}: is not a recording of this twin: {error}") from error
