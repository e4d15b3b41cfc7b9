import csv
import dataclasses
from pathlib import Path

import numpy as np
import pytest

from tests.compare.paths import AXES, UP, arc, line, moves_of
from tests.compare.runs import FRAME, PART_ZERO, samples, setpoints
from twin.commands.runs.export import csv_header, export_csv
from twin.compare.track_comparison import compare_tracks
from twin.compare.tracks import read_track
from twin.errors import RecordingError, UsageError
from twin.recording.reader import RecordingHeader, open_recording, record

CORNER = np.array([50.0, 0, 0, 0])
MOVES = moves_of(
    line(np.zeros(4), CORNER), arc(CORNER, np.array([50.0, 20.0, 0]), UP, 270.0, turn=30.0)
)
HEADER = RecordingHeader(
    axes=AXES, period_s=0.001, part_zero=PART_ZERO, part_frame=FRAME, program="a.nc",
    program_text="", program_sha256="", dialect="gost", machine="mill4", twin_version="0",
    mujoco_version="4",
)  # fmt: skip


@pytest.fixture
def recorded(tmp_path: Path) -> Path:
    asked = setpoints(MOVES, per_move=800, wait=50)
    run = samples(asked, asked.position - np.array([0.1, 0.2, 0.0, 0.05]))
    with record(tmp_path / "run.h5", HEADER) as writer:
        writer.append(run)
    return tmp_path / "run.h5"


def test_a_csv_has_units_in_its_header_and_every_number(recorded: Path, tmp_path: Path):
    with open_recording(recorded) as recording:
        assert export_csv(recording, tmp_path / "run.csv") == len(recording)
        position = recording.column("joint/position")
    with (tmp_path / "run.csv").open(encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    assert header == csv_header(AXES)
    assert header[:3] == ["time_s", "line", "X_setpoint_mm"]
    assert {"C_joint_deg", "C_setpoint_deg_per_s", "Z_force_N", "C_force_Nm"} <= set(header)
    column = header.index("C_joint_deg")
    assert [float(row[column]) for row in rows] == pytest.approx(position[:, 3], rel=1e-8)


def test_one_of_so_many_samples_is_written_whatever_the_chunks(
    recorded: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    with open_recording(recorded) as recording:
        chunks = list(recording.chunks(101))
        monkeypatch.setattr(type(recording), "chunks", lambda _: iter(chunks))
        assert export_csv(recording, tmp_path / "run.csv", every=7) == -(-len(recording) // 7)
    track = read_track(tmp_path / "run.csv")
    assert np.diff(track.time) == pytest.approx(0.007)


def test_a_run_does_not_differ_from_its_own_export(recorded: Path, tmp_path: Path):
    with open_recording(recorded) as recording:
        export_csv(recording, tmp_path / "run.csv")
    found = compare_tracks(read_track(recorded), read_track(tmp_path / "run.csv"))
    assert found.offset_s == pytest.approx(0.0, abs=1e-6)
    assert set(found.axes) == {"X", "Y", "Z", "C"}
    assert max(axis.actual_max for axis in found.axes.values()) < 1e-4


@pytest.mark.parametrize("offset", [0.0, 0.3217, -1.25])
def test_a_log_that_began_at_another_time_is_aligned(recorded: Path, offset: float):
    twin = read_track(recorded)
    every = slice(0, None, 4)
    log = dataclasses.replace(
        twin, axes=("X", "Y"), time=twin.time[every] - offset,
        commanded=twin.commanded[every, :2],
        actual=twin.actual[every, :2] + np.array([0.010, 0.0]),
    )  # fmt: skip
    found = compare_tracks(twin, log)
    assert found.offset_s == pytest.approx(offset, abs=1e-4)
    assert found.axes["X"].actual_rms == pytest.approx(0.010, abs=2e-3)
    assert found.axes["X"].following_rms == pytest.approx(0.010, abs=2e-3)
    assert found.axes["Y"].actual_rms < 2e-3
    assert found.overlap_s == pytest.approx(1.65, abs=0.01)


def test_where_two_runs_differ_most_is_told_with_its_line(recorded: Path):
    twin = read_track(recorded)
    actual = twin.actual.copy()
    actual[1000, 3] += 0.5
    found = compare_tracks(twin, dataclasses.replace(twin, actual=actual), offset_s=0.0)
    worst = found.axes["C"]
    assert (worst.actual_max, worst.time_s, worst.line) == pytest.approx((0.5, 1.0, 2))
    assert found.axes["X"].actual_max == 0.0


@pytest.mark.parametrize(
    "heading",
    ["time_s,X_commanded,X_actual", "t,X1_CommandPosition,X1_ActualPosition",
     "Time,x_setpoint_mm,x_joint_mm", "time [s],X command [mm],X actual [mm]"],
)  # fmt: skip
def test_logs_are_read_by_their_headings(tmp_path: Path, heading: str):
    path = tmp_path / "log.csv"
    path.write_text(heading.replace(" ", "_") + "\n0.0,1,2\n0.1,3,4\n", encoding="utf-8")
    track = read_track(path)
    assert track.axes == ("X",)
    assert track.commanded.tolist() == [[1.0], [3.0]]
    assert track.actual.tolist() == [[2.0], [4.0]]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "X_commanded"),
        ("time_s,a,b\n0,1,2\n1,2,3\n", "has the columns time_s, a, b"),
        ("X_commanded,X_actual\n1,2\n2,3\n", "or a period is given"),
        ("time_s,X_commanded,X_actual\n0,1,2\n", "two rows"),
        ("time_s,X_commanded,X_actual\n0,1,2\n1,2\n", "two rows"),
        ("time_s,X_commanded,X_actual\n0,1,2\n0,2,3\n", "does not rise"),
        ("time_s,X_commanded,X_actual\n0,1,\n1,2,3\n", "has no number in row 1"),
        ("time_s,X_commanded,X_actual\n0,1,x\n1,2,3\n", "not a number"),
    ],
)
def test_a_log_that_cannot_be_used_is_refused_with_what_works(tmp_path: Path, text: str, told: str):
    path = tmp_path / "log.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(UsageError, match=told):
        read_track(path)


def test_other_columns_may_hold_what_they_like(tmp_path: Path):
    path = tmp_path / "log.csv"
    rows = "X1_ActualPosition,State,X1_CommandPosition\n1,unworn,2\n2,,3\n"
    path.write_text(rows, encoding="utf-8")
    assert read_track(path, period_s=0.1).commanded.tolist() == [[2.0], [3.0]]


def test_a_period_stands_for_a_missing_clock(tmp_path: Path):
    path = tmp_path / "log.csv"
    path.write_text("X_commanded,X_actual\n1,2\n2,3\n", encoding="utf-8")
    assert read_track(path, period_s=0.1).time.tolist() == [0.0, 0.1]


def test_runs_without_anything_in_common_are_refused(recorded: Path, tmp_path: Path):
    twin = read_track(recorded)
    with pytest.raises(UsageError, match="none in common"):
        compare_tracks(twin, dataclasses.replace(twin, axes=("A", "B", "U", "V")))
    with pytest.raises(UsageError, match="share no time"):
        compare_tracks(twin, twin, offset_s=1e6)
    (tmp_path / "torn.h5").write_bytes(b"no hdf5")
    with pytest.raises(RecordingError, match="not a readable recording"):
        read_track(tmp_path / "torn.h5")
