"""Throws damaged files at their readers: they must take them or refuse them with a sentence.

``scripts/fuzz KIND TRIES SEED`` runs as many tries and keeps the first file that fails. Each try
has a chance of its own, so that it can be had again.
"""

import collections
import functools
import random
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import trimesh

from tests.nc import nc_fuzz
from twin.errors import TwinError
from twin.machine.config import read_machine
from twin.machine.model import build_spec, physics_model
from twin.motion.setpoints import Setpoints
from twin.nc.canonical import Axes
from twin.preparation import prepare
from twin.recording import RecordingHeader, Samples, open_recording, record
from twin.resources import machine_file, machine_names
from twin.stl_file import read_stl
from twin.toolpath.part_frame import PartFrame
from twin.training.scene import read_scene

LONGEST_SECONDS = 20.0
"""Processor time that one file may take; a loop without an end takes longer."""
TAKEN = "taken"
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


def changed_toml(chance: random.Random, text: str) -> str:
    """A TOML file with values replaced, lines removed, repeated or moved, or bytes changed."""
    if chance.random() < 0.2:
        return nc_fuzz.mutated(chance, text.encode()).decode("utf-8", "surrogateescape")
    lines = text.splitlines()
    for _ in range(chance.randrange(1, 4)):
        at = chance.randrange(len(lines))
        key, equals, _ = lines[at].partition("=")
        change = chance.randrange(5)
        if change <= 2 and equals:
            lines[at] = f"{key}= {chance.choice(VALUES)}"
        elif change == 3:
            lines.insert(chance.randrange(len(lines)), lines[at])
        else:
            lines[at] = ""
    return "\n".join(lines) + "\n"


@functools.cache
def _programs() -> list[Path]:
    return sorted((nc_fuzz.ROOT / "programs").glob("*/*.toml"))


def try_job(chance: random.Random, folder: Path) -> None:
    """A shipped job, damaged, as far as a run's first step."""
    job = chance.choice(_programs())
    for beside in job.parent.iterdir():
        if beside.is_file() and not (folder / beside.name).exists():
            shutil.copy(beside, folder)
    path = folder / job.name
    path.write_text(
        changed_toml(chance, job.read_text(encoding="utf-8")), "utf-8", "surrogateescape"
    )
    prepare(path)


def try_machine(chance: random.Random, folder: Path) -> None:
    """A shipped machine, damaged, as far as its model of physics."""
    shipped = machine_file(chance.choice(machine_names()))
    text = shipped.read_text(encoding="utf-8")
    for name in (shipped.parent.glob("*.xml"), shipped.parents[1].glob("*/machine.toml")):
        for path in name:
            text = text.replace(f'"{path.name}"', f'"{path}"')
    path = folder / "machine.toml"
    path.write_text(changed_toml(chance, text), "utf-8", "surrogateescape")
    machine = read_machine(path)
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


def try_recording(chance: random.Random, folder: Path) -> None:
    """A recording, damaged, read to its end."""
    path = folder / "recording.h5"
    path.write_bytes(_damaged(chance, whole_recording()))
    with open_recording(path) as recording:
        list(recording.chunks(100))
        _ = recording.alarms, recording.contour_um(0, len(recording)), str(recording.header)


@functools.cache
def _solids() -> list[bytes]:
    solids = (trimesh.creation.box((3, 4, 5)), trimesh.creation.cylinder(4, 7, sections=6))
    exported = [solid.export(file_type=form) for solid in solids for form in ("stl", "stl_ascii")]
    return [each if isinstance(each, bytes) else str(each).encode() for each in exported]


@functools.cache
def _scenes() -> list[Path]:
    return sorted((nc_fuzz.ROOT / "twin" / "training" / "scenes").rglob("*.toml"))


def try_scene(chance: random.Random, folder: Path) -> None:
    """A shipped scene of the training, damaged."""
    scene = chance.choice(_scenes())
    path = folder / scene.name
    for program in scene.parent.glob("*.nc"):
        shutil.copy(program, folder)
    path.write_text(
        changed_toml(chance, scene.read_text(encoding="utf-8")), "utf-8", "surrogateescape"
    )
    read_scene(path)


def try_stl(chance: random.Random, folder: Path) -> None:
    """A solid, damaged."""
    path = folder / "part.stl"
    path.write_bytes(_damaged(chance, chance.choice(_solids())))
    read_stl.__wrapped__(path)


def _damaged(chance: random.Random, data: bytes) -> bytes:
    """Bytes cut off, made up, or changed here and there; numbers of four bytes among them."""
    kind = chance.random()
    if kind < 0.1:
        return data[: chance.randrange(len(data))]
    if kind < 0.15:
        return chance.randbytes(chance.randrange(300))
    if kind < 0.5:
        return nc_fuzz.mutated(chance, data)
    changed = bytearray(data)
    for _ in range(chance.randrange(1, 5)):
        at, width = chance.randrange(len(changed)), chance.choice([1, 2, 4, 8])
        changed[at : at + width] = chance.choice([b"\0", b"\xff", b"\x7f", b"\x01"]) * width
    return bytes(changed[: len(data)])


KINDS: Mapping[str, Callable[[random.Random, Path], None]] = {
    "jobs": try_job,
    "machines": try_machine,
    "recordings": try_recording,
    "scenes": try_scene,
    "stl": try_stl,
}


def attempt(kind: str, seed: int, number: int) -> str:
    """One try; ``TAKEN``, or the kind of refusal.

    Raises:
        AssertionError: It took too long.
    """
    chance = random.Random(f"{kind} {seed} {number}")  # noqa: S311 (no cryptography)
    begin = time.process_time()
    with tempfile.TemporaryDirectory(prefix=f"fuzz-{kind}-{number}-") as folder:
        try:
            KINDS[kind](chance, Path(folder))
            outcome = TAKEN
        except TwinError as error:
            if not str(error).strip():
                raise AssertionError("refused without a word") from error
            outcome = type(error).__name__
    assert time.process_time() - begin < LONGEST_SECONDS, "too slow"
    return outcome


def main(kind: str, tries: int, seed: int = 1, first: int = 0) -> dict[str, int]:
    """Run as many tries.

    Returns:
        How many files were taken, and how many were refused with each kind of error.

    Raises:
        BaseException: A try failed; its number is printed.
    """
    outcomes: collections.Counter[str] = collections.Counter()
    for number in range(first, first + tries):
        try:
            outcomes[attempt(kind, seed, number)] += 1
        except BaseException:
            sys.stderr.write(f"try {number} of {kind}, seed {seed}\n")
            raise
    return dict(outcomes.most_common())


if __name__ == "__main__":
    import faulthandler

    faulthandler.enable()
    kind, *numbers = sys.argv[1:]
    tries, seed, first = [int(n) for n in numbers] + [10_000, 1, 0][len(numbers) :]
    begin = time.perf_counter()
    found = main(kind, tries, seed, first)
    sys.stdout.write(
        f"{tries} {kind} in {time.perf_counter() - begin:.0f} s, seed {seed}: {found}\n"
    )
