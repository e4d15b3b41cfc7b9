"""Damaged and hostile files of every kind are taken or refused with a sentence.

``scripts/fuzz KIND`` tries as many as there is time for; what it found is here by name.
"""

import logging
import sys
from pathlib import Path

import h5py
import pytest

from tests import file_fuzz, fuzz_kinds
from twin.errors import ConfigError, RecordingError
from twin.files.shipped import machine_file
from twin.files.stl import read_stl
from twin.machine.load import read_machine
from twin.machine.model.model import build_spec
from twin.recording.checksum import LENGTH as SEAL_LENGTH
from twin.recording.reader import open_recording


@pytest.mark.parametrize(
    ("kind", "tries"),
    [("jobs", 60), ("machines", 25), ("recordings", 150), ("scenes", 60), ("stl", 150)],
)
def test_damage_is_taken_or_refused(kind: str, tries: int) -> None:
    outcomes = file_fuzz.main(kind, tries)
    assert sum(outcomes.values()) == tries
    assert 0 < outcomes[file_fuzz.TAKEN] < tries


@pytest.mark.parametrize("share", [0.0, 0.1, 0.35, 0.6, 0.8, 0.95])
def test_a_changed_byte_of_a_recording_is_seen(tmp_path: Path, share: float) -> None:
    path = tmp_path / "recording.h5"
    data = bytearray(fuzz_kinds.whole_recording())
    data[int(share * len(data))] ^= 0x55
    path.write_bytes(data)
    refused = pytest.raises(RecordingError, match=r"damaged|not a (readable )?recording")
    with refused, open_recording(path):
        pass


@pytest.mark.parametrize("column", ["time", "drive/force"])
def test_columns_of_other_lengths_or_shapes_are_refused(tmp_path: Path, column: str) -> None:
    path = tmp_path / "recording.h5"
    path.write_bytes(fuzz_kinds.whole_recording())
    with h5py.File(path, "r+") as file:
        del file[column]
        file[column] = [1.0, 2.0]
    with pytest.raises(RecordingError, match=column), open_recording(path):
        pass


@pytest.mark.processes
def test_a_recording_on_which_hdf5_searches_without_end_is_refused(tmp_path: Path) -> None:
    data = bytearray(fuzz_kinds.whole_recording()[:-SEAL_LENGTH])
    alarm = b'"an alarm"]]'
    behind = data.index(alarm) + len(alarm)
    data[behind : behind + 32] = bytes(
        32
    )  # what is free in its heap is 0 bytes long, again and again
    path = tmp_path / "recording.h5"
    path.write_bytes(data)
    with pytest.raises(RecordingError, match="come to an end"), open_recording(path):
        pass


def test_a_recording_that_another_program_added_to_is_read(tmp_path: Path) -> None:
    path = tmp_path / "recording.h5"
    path.write_bytes(fuzz_kinds.whole_recording())
    with h5py.File(path, "r+") as file:
        file.attrs["remark"] = "night shift"
    with open_recording(path) as recording:
        assert len(recording) == fuzz_kinds.SAMPLES


@pytest.mark.parametrize("number", ["nan", "inf", "1e300"])
def test_a_corner_that_lies_nowhere_is_refused(tmp_path: Path, number: str) -> None:
    path = tmp_path / "part.stl"
    facet = f"facet normal 0 0 1\nouter loop\nvertex 0 0 {number}\nvertex 1 0 0\nvertex 0 1 0\n"
    path.write_text(f"solid a\n{facet}endloop\nendfacet\nendsolid a\n")
    with pytest.raises(ConfigError, match=r"beyond|not a readable|no solid"):
        read_stl(path)


def test_reading_many_solids_leaves_nothing_behind(tmp_path: Path) -> None:
    before = list(logging.getLogger("trimesh").handlers)
    for number in range(3):
        path = tmp_path / f"part{number}.stl"
        path.write_text("solid a\nendsolid a\n")
        with pytest.raises(ConfigError):
            read_stl(path)
    assert logging.getLogger("trimesh").handlers == before


def test_a_motor_without_inertia_behind_a_backlash_is_refused(tmp_path: Path) -> None:
    shipped = machine_file("mill4")
    text = shipped.read_text(encoding="utf-8").replace(
        'model = "', f'model = "{shipped.parent}/', 1
    )
    path = tmp_path / "machine.toml"
    path.write_text(text, encoding="utf-8")
    changes = [
        ("machine.axes.X.backlash", 0.01),
        ("machine.axes.X.motor_inertia", 0.0),
        ("machine.axes.X.screw_inertia", 0.0),
    ]
    machine = read_machine(path, changes)
    with pytest.raises(ConfigError, match="motor_inertia"):
        build_spec(machine)


def test_a_solid_in_another_encoding_is_refused_without_a_package_that_guesses_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "charset_normalizer", None)
    path = tmp_path / "part.stl"
    path.write_bytes(b"solid \x80\n" + b"\xff" * 200)
    with pytest.raises(ConfigError, match="not a readable STL file"):
        read_stl(path)
