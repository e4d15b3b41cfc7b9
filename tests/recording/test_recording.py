import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

from twin.errors import RecordingError
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Axes
from twin.recording.reader import (
    Recording,
    RecordingHeader,
    Samples,
    open_growing,
    open_recording,
    record,
)
from twin.toolpath.part_frame import PartFrame

AXES = Axes(("X", "Y", "Z", "C"), ("linear", "linear", "linear", "rotary"))


def header() -> RecordingHeader:
    return RecordingHeader(
        axes=AXES,
        period_s=0.001,
        part_zero=np.array([1.0, 2.0, -300.0, 30.0]),
        part_frame=PartFrame(3, (5.0, 6.0), 30.0),
        program="ось.nc",
        program_text="G0 X1 $ комментарий",
        program_sha256="00",
        dialect="gost",
        machine="mill4",
        twin_version="0",
        mujoco_version="4",
    )


def samples(first: int, count: int) -> Samples:
    number = np.arange(first, first + count)
    rows = np.outer(number, [1.0, 2.0, 3.0, 4.0])
    setpoint = Setpoints(
        np.float64(0.001) * number,
        number,
        number,
        np.float64(0.01) * number,
        rows,
        rows + 1,
        rows + 2,
    )
    return Samples(setpoint, rows + 3, rows + 4, rows + 5)


def test_what_was_recorded_comes_back(tmp_path: Path):
    path = tmp_path / "recording.h5"
    with record(path, header()) as writer:
        writer.append(samples(0, 7))
        assert not path.exists()
        writer.append(samples(7, 6))
    with open_recording(path) as recording:
        assert len(recording) == 13
        assert recording.header.axes == AXES
        assert recording.header.part_frame == PartFrame(3, (5.0, 6.0), 30.0)
        assert recording.header.program == "ось.nc"
        whole = samples(0, 13)
        np.testing.assert_array_equal(recording.column("joint/position"), whole.joint_position)
        chunks = list(recording.chunks(5))
        assert [len(chunk) for chunk in chunks] == [5, 5, 3]
        np.testing.assert_array_equal(
            chunks[1].setpoint.acceleration, whole.setpoint.acceleration[5:10]
        )
        np.testing.assert_array_equal(chunks[2].drive_force, whole.drive_force[10:])


def test_the_file_follows_the_contract(tmp_path: Path):
    path = tmp_path / "recording.h5"
    with record(path, header()) as writer:
        writer.append(samples(0, 2))
    with h5py.File(path) as file:
        for name in ("time", "line", "setpoint/position", "joint/velocity", "drive/force"):
            assert name in file
        assert file["setpoint/position"].attrs["unit"] == "mm or deg"
        assert np.asarray(file.attrs["axes"]).tolist() == ["X", "Y", "Z", "C"]
        assert file.attrs["complete"]


READER = """
import sys
from pathlib import Path
from twin.recording.reader import open_growing

with open_growing(Path(sys.argv[1])) as recording:
    print(len(recording), flush=True)
    sys.stdin.readline()
    print(recording.refresh(), recording.column("joint/position")[-1, 0], flush=True)
    print([len(chunk) for chunk in recording.chunks(5)], recording.header.program, flush=True)
"""


def test_it_is_read_while_it_is_written(tmp_path: Path):
    path = tmp_path / "recording.h5"
    with record(path, header()) as writer:
        writer.append(samples(0, 7))
        # Another process, as HDF5 demands of readers.
        reader = subprocess.Popen(
            [sys.executable, "-c", READER, path], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            text=True, encoding="utf-8",
        )  # fmt: skip
        with reader:
            assert reader.stdin is not None
            assert reader.stdout is not None
            assert reader.stdout.readline() == "7\n"
            writer.append(samples(7, 6))
            print(file=reader.stdin, flush=True)
            last = samples(7, 6).joint_position[-1, 0]
            assert reader.stdout.readline() == f"13 {last}\n"
            assert reader.stdout.readline() == "[5, 5, 3] ось.nc\n"
        assert reader.returncode == 0
        assert not path.exists()
    with open_growing(path) as recording:
        assert len(recording) == 13
    with (
        pytest.raises(RecordingError, match="no such file"),
        open_growing(tmp_path / "other.h5"),
    ):
        pass


def test_an_interrupted_recording_is_absent(tmp_path: Path):
    path = tmp_path / "recording.h5"

    def run_and_fail() -> None:
        with record(path, header()) as writer:
            writer.append(samples(0, 3))
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_and_fail()
    assert list(tmp_path.iterdir()) == []


def open_and_close(path: Path) -> Recording:
    with open_recording(path) as recording:
        return recording


def test_other_files_are_refused(tmp_path: Path):
    with pytest.raises(RecordingError, match="no such file"):
        open_and_close(tmp_path / "absent.h5")
    text = tmp_path / "text.h5"
    text.write_text("no")
    with pytest.raises(RecordingError, match="not a readable recording"):
        open_and_close(text)
    other = tmp_path / "other.h5"
    with h5py.File(other, "w") as file:
        file.attrs["complete"] = True
    with pytest.raises(RecordingError, match="not a recording of this twin"):
        open_and_close(other)
    with h5py.File(other, "w") as file:
        file.attrs["complete"] = False
    with pytest.raises(RecordingError, match="not complete"):
        open_and_close(other)


@pytest.mark.parametrize("lengths", [(5000, 5000, 5000), (4096, 1), (3, 4093, 9000), (9000,), (1,)])
def test_what_is_appended_is_read_however_it_was_cut(tmp_path: Path, lengths: tuple[int, ...]):
    """The file's own chunks hold 4096 samples; those behind the last full one wait."""
    path, first = tmp_path / "recording.h5", 0
    with record(path, header()) as writer:
        for length in lengths:
            writer.append(samples(first, length), np.arange(first, first + length) / 2.0)
            first += length
    whole = samples(0, first)
    with open_recording(path) as recording:
        assert len(recording) == first
        step = 2.0**-24
        np.testing.assert_array_equal(
            recording.column("joint/position"), np.rint(whole.joint_position / step) * step
        )
        np.testing.assert_array_equal(recording.column("line"), whole.setpoint.line)
        np.testing.assert_array_equal(recording.column("contour"), np.arange(first) / 2.0)
