"""The recording: setpoints and simulated joints at the servo rate, as an HDF5 file.

Sample i of ``joint`` and of ``setpoint`` belong to the same instant ``time[i]``. The file is
written under a temporary name and renamed when the run has ended, so that a file under its own
name is whole.
"""

import contextlib
import dataclasses
import json
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from twin.errors import RecordingError
from twin.files import complete_or_absent
from twin.forgiving_file import ForgivingFile
from twin.motion.setpoints import Setpoints
from twin.nc.canonical import Axes, FloatArray
from twin.toolpath.part_frame import PartFrame


@dataclasses.dataclass(frozen=True, slots=True)
class Samples:
    """A chunk of n samples over k axes: what was asked for and what the joints did.

    Attributes:
        setpoint: The setpoints of the same instants, machine coordinates.
        joint_position: Shape (n, k) [mm or deg], machine coordinates.
        joint_velocity: Shape (n, k) [mm/s or deg/s].
        drive_force: Shape (n, k) [N or N m].
    """

    setpoint: Setpoints
    joint_position: FloatArray
    joint_velocity: FloatArray
    drive_force: FloatArray

    def __len__(self) -> int:
        return len(self.setpoint)

    def __getitem__(self, index: slice) -> "Samples":
        """A run of samples, as columns again."""
        return Samples(*(getattr(self, field.name)[index] for field in dataclasses.fields(self)))


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class RecordingHeader:
    """What a recording says about itself; the attributes of the file."""

    axes: Axes
    period_s: float
    part_zero: FloatArray
    """Machine coordinates of program zero, shape (k,) [mm or deg]."""
    part_frame: PartFrame
    program: str
    program_text: str
    """Empty where the program is longer than ``LONGEST_TEXT``."""
    program_sha256: str
    dialect: str
    machine: str
    twin_version: str
    mujoco_version: str
    job: str = ""
    """The job as JSON, files in it as whole paths; empty in recordings that were made without."""
    machine_file: str = ""
    """Where the machine file lay."""


_COLUMNS: Mapping[str, tuple[str, str]] = {
    "time": ("time", "s"),
    "line": ("line", ""),
    "move": ("move", ""),
    "fraction": ("fraction", ""),
    "setpoint/position": ("position", "mm or deg"),
    "setpoint/velocity": ("velocity", "mm/s or deg/s"),
    "setpoint/acceleration": ("acceleration", "mm/s^2 or deg/s^2"),
}
_JOINT_COLUMNS: Mapping[str, tuple[str, str]] = {
    "joint/position": ("joint_position", "mm or deg"),
    "joint/velocity": ("joint_velocity", "mm/s or deg/s"),
    "drive/force": ("drive_force", "N or N m"),
}
CONTOUR = "contour"
"""Dataset of the contour error, shape (n,) [µm]; missing where nobody compared."""
_ROWS_PER_CHUNK = 4096

_STEPS: Mapping[str, float] = {
    "fraction": 2.0**-24,
    "setpoint/position": 2.0**-24,
    "setpoint/velocity": 2.0**-20,
    "setpoint/acceleration": 2.0**-10,
    "joint/position": 2.0**-24,
    "joint/velocity": 2.0**-20,
    "drive/force": 2.0**-14,
    CONTOUR: 2.0**-14,
}
"""What columns are rounded to, in their units: positions to 0.06 nm.

It is far below what any figure shows, and the zero bits behind it leave a third of the file and
half of the time that writing takes.
"""

LONGEST_TEXT = 16 << 20
"""Bytes of a program up to which its text is kept in the recording."""
_TEXT = "program_text"


class RecordingWriter:
    """Appends chunks of samples to an open recording."""

    def __init__(self, file: h5py.File, header: RecordingHeader, disk: ForgivingFile) -> None:
        self._file = file
        self._disk = disk
        self._count = 0
        width = len(header.axes)
        for path, (name, unit) in {**_COLUMNS, **_JOINT_COLUMNS}.items():
            kind = np.int64 if name in ("line", "move") else np.float64
            self._create(path, (0, width) if "/" in path else (0,), kind, unit)
        _write_attributes(file, header)

    def _create(self, path: str, shape: tuple[int, ...], kind: type[np.generic], unit: str) -> None:
        dataset = self._file.create_dataset(
            path, shape, maxshape=(None, *shape[1:]), dtype=kind, chunks=(_ROWS_PER_CHUNK, *shape[1:]),
            compression="gzip", compression_opts=1, shuffle=True,
        )  # fmt: skip
        if unit:
            dataset.attrs["unit"] = unit

    def note_alarms(self, alarms: Iterable[tuple[float, str]]) -> None:
        """Add what the machine raised when [s, text]."""
        self._file.attrs["alarms"] = json.dumps(list(alarms))

    def append(self, samples: Samples, contour_um: FloatArray | None = None) -> None:
        """Add a chunk that follows the last one.

        Args:
            samples: n samples.
            contour_um: Their contour errors, shape (n,) [µm]; for all chunks or for none.

        Raises:
            OSError: The disk is full.
        """
        end = self._count + len(samples)
        if contour_um is not None:
            if CONTOUR not in self._file:
                self._create(CONTOUR, (0,), np.float64, "um")
            self._put(CONTOUR, contour_um, end)
        for path, (name, _) in _COLUMNS.items():
            self._put(path, getattr(samples.setpoint, name), end)
        for path, (name, _) in _JOINT_COLUMNS.items():
            self._put(path, getattr(samples, name), end)
        self._count = end
        self._disk.check()

    def _put(self, path: str, values: np.ndarray[Any, Any], end: int) -> None:
        dataset = self._file[path]
        assert isinstance(dataset, h5py.Dataset)
        dataset.resize(end, axis=0)
        step = _STEPS.get(path)
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
    for name in (*_TEXT_ATTRIBUTES, *_LATER_ATTRIBUTES):
        attributes[name] = getattr(header, name)
    text = np.frombuffer(header.program_text.encode("utf-8", "surrogatepass"), np.uint8)
    compression = "gzip" if len(text) else None
    file.create_dataset(_TEXT, data=text, compression=compression)
    attributes["complete"] = False


_TEXT_ATTRIBUTES = (
    "program",
    "program_sha256",
    "dialect",
    "machine",
    "twin_version",
    "mujoco_version",
)
_LATER_ATTRIBUTES = ("job", "machine_file")
"""Recordings of earlier versions lack them."""


@contextlib.contextmanager
def record(path: Path, header: RecordingHeader) -> Iterator[RecordingWriter]:
    """Open a recording for writing; it appears under ``path`` when the block ends without error.

    Args:
        path: The file to be.
        header: What the recording says about itself.

    Raises:
        OSError: It cannot be written.
    """
    with complete_or_absent(path) as temporary, ForgivingFile(temporary) as disk:
        with h5py.File(disk, "w") as file:
            yield RecordingWriter(file, header, disk)
            file.attrs["complete"] = True
        disk.check()


class Recording:
    """A complete recording, open for reading in chunks.

    Attributes:
        path: The file.
        header: What it says about itself.
    """

    def __init__(self, path: Path, file: h5py.File) -> None:
        self.path = path
        self._file = file
        self.header = _read_header(file)

    def __len__(self) -> int:
        return len(self._dataset("time"))

    def _dataset(self, name: str) -> h5py.Dataset:
        dataset = self._file[name]
        if not isinstance(dataset, h5py.Dataset):
            raise TypeError(f"'{name}' is not a dataset")
        return dataset

    def column(self, name: str) -> np.ndarray[Any, Any]:
        """One whole dataset, such as ``joint/position``."""
        return self._dataset(name)[:]

    @property
    def alarms(self) -> tuple[tuple[float, str], ...]:
        """When the machine raised which alarm [s, text]."""
        noted = json.loads(str(self._file.attrs.get("alarms", "[]")))
        return tuple((float(time), str(text)) for time, text in noted)

    def contour_um(self, first: int, last: int) -> FloatArray | None:
        """Contour error of the samples from ``first`` up to ``last`` [µm]; None where not known."""
        return self._dataset(CONTOUR)[first:last] if CONTOUR in self._file else None

    def chunks(self, rows: int = 65536) -> Iterator[Samples]:
        """Samples in order, at most ``rows`` at a time."""
        for first in range(0, len(self), rows):
            here = slice(first, first + rows)
            setpoint = Setpoints(
                **{name: self._dataset(path)[here] for path, (name, _) in _COLUMNS.items()}
            )
            yield Samples(
                setpoint,
                **{name: self._dataset(path)[here] for path, (name, _) in _JOINT_COLUMNS.items()},
            )


def _read_header(file: h5py.File) -> RecordingHeader:
    values = {name: np.asarray(value).tolist() for name, value in file.attrs.items()}
    axes = Axes(tuple(values["axes"]), tuple(values["kinds"]))
    table_axis = values["table_axis"]
    return RecordingHeader(
        axes=axes,
        period_s=values["period_s"],
        part_zero=np.array(values["part_zero"], np.float64),
        part_frame=PartFrame(
            rotary=axes.index(table_axis) if table_axis else None,
            center=tuple(values["table_center"]),
            turn_zero=values["table_zero"],
        ),
        program_text=_program_text(file),
        **{name: values[name] for name in _TEXT_ATTRIBUTES},
        **{name: values.get(name, "") for name in _LATER_ATTRIBUTES},
    )


def _program_text(file: h5py.File) -> str:
    kept = file.get(_TEXT)
    if isinstance(kept, h5py.Dataset):
        return kept[:].tobytes().decode("utf-8", "surrogatepass")
    return str(file.attrs[_TEXT])  # recordings of earlier versions


@contextlib.contextmanager
def open_recording(path: Path) -> Iterator[Recording]:
    """Open a complete recording.

    Raises:
        RecordingError: The file is missing, torn, incomplete or not a recording.
    """
    try:
        file = h5py.File(path, "r")
    except OSError as error:
        raise RecordingError(f"{path}: is not a readable recording: {error}") from error
    with file:
        if not file.attrs.get("complete", False):
            raise RecordingError(f"{path}: the recording is not complete")
        try:
            recording = Recording(path, file)
        except (KeyError, ValueError, IndexError) as error:
            raise RecordingError(f"{path}: is not a recording of this twin: {error}") from error
        yield recording
