"""The kinds of files that are damaged: whole ones, ways to change them, and their readers."""

import dataclasses
import functools
import random
import shutil
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np
import trimesh

from tests.nc import fuzz
from twin.files.shipped import machine_file, machine_names
from twin.files.stl import read_stl
from twin.job.load import load_job
from twin.machine.description.config import MachineConfig
from twin.machine.load import read_machine
from twin.machine.model.model import build_spec, physics_model
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Axes
from twin.nc.dialects import DIALECTS
from twin.recording.reader import RecordingHeader, Samples, open_recording, record
from twin.run.preparing.preparation import prepare
from twin.toolpath.part_frame import PartFrame
from twin.training.scene.scene_file import read_scene

SAMPLES = 300

VALUES = [
    "-1",
    "0",
    "1e308",
    "-1e308",
    "1e-320",
    "nan",
    "inf",
    "true",
    '""',
    '"x"',
    "[]",
    "{}",
    "[1]",
    "[[[[]]]]",
    '[1, "a"]',
    "2024-01-01",
    "0x7f",
    "9223372036854775807",
    '"../../../etc/passwd"',
    '"/dev/zero"',
    '"\\u0000"',
    '"a/\\nb"',
    "1_000",
    "-0.0",
    "[nan, 1, 1]",
    "[1.0, 2.0, 3.0]",
    '["X", "X"]',
    "{a = 1}",
    "10.5",
    '"Y"',
    "3",
]
"""What a value of a TOML file is replaced by."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Kind:
    """A kind of file.

    Attributes:
        wholes: Files that are as they should be.
        change: Damages one.
        read: Reads one that lies in a folder of which nothing else is expected.
        beside: Lays into that folder what such files name.
    """

    wholes: Callable[[], Sequence[bytes]]
    change: Callable[[random.Random, bytes], bytes]
    read: Callable[[bytes, Path], object]
    beside: Callable[[Path], None] | None = None


def changed_toml(chance: random.Random, data: bytes) -> bytes:
    """A TOML file with values replaced, lines removed, repeated or moved, or bytes changed."""
    if chance.random() < 0.2:
        return fuzz.mutated(chance, data)
    lines = data.splitlines() or [b""]
    for _ in range(chance.randrange(1, 4)):
        at = chance.randrange(len(lines))
        key, equals, _ = lines[at].partition(b"=")
        change = chance.randrange(5)
        if change <= 2 and equals:
            lines[at] = key + b"= " + chance.choice(VALUES).encode()
        elif change == 3:
            lines.insert(chance.randrange(len(lines)), lines[at])
        else:
            lines[at] = b""
    return b"\n".join(lines) + b"\n"


def changed_bytes(chance: random.Random, data: bytes) -> bytes:
    """Bytes cut off, made up, or changed here and there; numbers of four bytes among them."""
    kind = chance.random()
    if kind < 0.1:
        return data[: chance.randrange(len(data) + 1)]
    if kind < 0.15:
        return chance.randbytes(chance.randrange(300))
    if kind < 0.5 or not data:
        return fuzz.mutated(chance, data)
    changed = bytearray(data)
    for _ in range(chance.randrange(1, 5)):
        at, width = chance.randrange(len(changed)), chance.choice([1, 2, 4, 8])
        changed[at : at + width] = chance.choice([b"\0", b"\xff", b"\x7f", b"\x01"]) * width
    return bytes(changed[: len(data)])


_DIALECTS = list(DIALECTS.values())


@functools.cache
def _programs() -> list[bytes]:
    """Real programs behind the number of their dialect, a byte."""
    return [
        bytes([number]) + text
        for number, dialect in enumerate(_DIALECTS)
        for text in fuzz.REAL[dialect.name]
    ]


def _changed_program(chance: random.Random, data: bytes) -> bytes:
    number = data[0] % len(_DIALECTS) if data else 0
    if chance.random() < 0.5:
        return bytes([number]) + fuzz.mutated(chance, data[1:])
    return bytes([number]) + fuzz.program(chance, _DIALECTS[number])


def _read_program(data: bytes, folder: Path) -> None:  # noqa: ARG001 (no file is needed)
    number = data[0] if data else 0
    fuzz.check(data[1:], _DIALECTS[number % len(_DIALECTS)])


def _jobs() -> list[Path]:
    return sorted((fuzz.ROOT / "programs").glob("*/*.toml"))


def _lay_programs(folder: Path) -> None:
    for job in _jobs():
        shutil.copy(load_job(job).program, folder)


def _read_job(data: bytes, folder: Path) -> None:
    path = folder / "job.toml"
    path.write_bytes(data)
    prepare(path)


@functools.cache
def _machines() -> list[bytes]:
    """The shipped machines, which name their models and bases by their whole paths."""
    found = []
    for name in machine_names():
        shipped = machine_file(name)
        text = shipped.read_text(encoding="utf-8")
        for paths in (shipped.parent.glob("*.xml"), shipped.parents[1].glob("*/machine.toml")):
            for path in paths:
                text = text.replace(f'"{path.name}"', f'"{path}"')
        found.append(text.encode())
    return found


def _read_machine(data: bytes, folder: Path) -> MachineConfig:
    path = folder / "machine.toml"
    path.write_bytes(data)
    return read_machine(path)


def _read_physics(data: bytes, folder: Path) -> None:
    machine = _read_machine(data, folder)
    physics_model(machine, build_spec(machine))


@functools.cache
def whole_recording() -> bytes:
    """A small recording."""
    axes = Axes(("X", "Y", "Z", "C"), ("linear", "linear", "linear", "rotary"))
    number = np.arange(SAMPLES)
    milli = np.float64(0.001) * number
    rows = np.outer(number, [1.0, 2.0, 3.0, 4.0])
    setpoint = Setpoints(milli, number, number, milli, rows, rows, rows)
    header = RecordingHeader(
        axes=axes, period_s=0.001, part_zero=np.zeros(4), part_frame=PartFrame(3, (0.0, 0.0), 0.0),
        program="a.nc", program_text="G0 X1\n", program_sha256="00", dialect="gost",
        machine="mill4", twin_version="0", mujoco_version="4",
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "recording.h5")
        with record(path, header) as writer:
            writer.append(Samples(setpoint, rows, rows, rows), np.ones(len(number)))
            writer.note_alarms([(0.1, "an alarm")])
        return path.read_bytes()


def _read_recording(data: bytes, folder: Path) -> None:
    path = folder / "recording.h5"
    path.write_bytes(data)
    with open_recording(path) as recording:
        list(recording.chunks(100))
        _ = recording.alarms, recording.contour_um(0, len(recording)), str(recording.header)


@functools.cache
def _solids() -> list[bytes]:
    solids = (trimesh.creation.box((3, 4, 5)), trimesh.creation.cylinder(4, 7, sections=6))
    exported = [solid.export(file_type=form) for solid in solids for form in ("stl", "stl_ascii")]
    return [each if isinstance(each, bytes) else str(each).encode() for each in exported]


def _read_stl(data: bytes, folder: Path) -> None:
    path = folder / "part.stl"
    path.write_bytes(data)
    read_stl.__wrapped__(path)


def _scenes() -> list[Path]:
    return sorted((fuzz.ROOT / "twin" / "training" / "scenes").rglob("*.toml"))


def _lay_scenes(folder: Path) -> None:
    for scene in _scenes():
        for program in scene.parent.glob("*.nc"):
            shutil.copy(program, folder)


def _read_scene(data: bytes, folder: Path) -> None:
    path = folder / "scene.toml"
    path.write_bytes(data)
    read_scene(path)


def _contents(paths: Callable[[], Sequence[Path]]) -> Callable[[], Sequence[bytes]]:
    return functools.cache(lambda: [path.read_bytes() for path in paths()])


KINDS: Mapping[str, Kind] = {
    "programs": Kind(wholes=_programs, change=_changed_program, read=_read_program),
    "jobs": Kind(
        wholes=_contents(_jobs), change=changed_toml, read=_read_job, beside=_lay_programs
    ),
    "machines": Kind(wholes=_machines, change=changed_toml, read=_read_machine),
    "models": Kind(wholes=_machines, change=changed_toml, read=_read_physics),
    "scenes": Kind(
        wholes=_contents(_scenes), change=changed_toml, read=_read_scene, beside=_lay_scenes
    ),
    "stl": Kind(wholes=_solids, change=changed_bytes, read=_read_stl),
    "recordings": Kind(
        wholes=lambda: [whole_recording()], change=changed_bytes, read=_read_recording
    ),
}
"""``machines`` are read; ``models`` are read and made into the model of physics."""
