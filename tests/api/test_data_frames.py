"""Runs as data frames, which need pandas."""

from pathlib import Path

import numpy as np
import pytest

import twin
from tests.check.test_check_runs import write_job
from twin import extras
from twin.errors import UsageError

pytestmark = pytest.mark.thorough


def test_a_frame_has_a_row_for_every_sample_and_a_line_its_worst(tmp_path: Path):
    result = twin.run(write_job(tmp_path, "part"), out=tmp_path / "out")
    frame, lines = result.frame(), result.by_line()
    assert len(frame) == result.outcome.samples
    assert {"time", "line", "contour_um", "joint/position/C"} <= set(frame.columns)
    line, error = frame["line"].to_numpy(), frame["contour_um"].to_numpy()
    lag = np.abs(frame["setpoint/position/X"].to_numpy() - frame["joint/position/X"].to_numpy())
    for number in lines.index.tolist():
        assert lines.at[number, "contour_um"] == error[line == number].max()
        assert lines.at[number, "seconds"] == pytest.approx((line == number).sum() * 0.001)
        assert lines.at[number, "following/X"] == pytest.approx(lag[line == number].max() * 1000.0)
    assert set(lines.index) == set(line[line > 0].tolist())
    assert (
        lines.index[lines["contour_um"].to_numpy().argmax()]
        == result.outcome.figures.contour.worst_line
    )


def test_a_sweep_has_a_row_for_every_combination(tmp_path: Path):
    job = write_job(tmp_path, "part")
    vary = {"machine.axes.X.kv": [3.0, 8.0], "job.tolerance.contour_um": [0.01, 500.0]}
    table = twin.sweep(job, vary, machine="mill4/uncompensated", jobs=1, progress=False)
    assert table["machine.axes.X.kv"].tolist() == [3.0, 3.0, 8.0, 8.0]
    assert table["verdict"].tolist() == ["fail", "pass", "fail", "pass"]
    slow, _, quick, _ = table["contour_um"].tolist()
    assert slow > quick


@pytest.mark.parametrize(
    ("vary", "said"),
    [
        ({"kv": [1.0]}, "machine.KEY"),
        ({"machine.axes.X.kv": []}, "no values"),
        ({"job.": [1]}, "KEY"),
    ],
)
def test_a_sweep_of_no_key_is_refused(tmp_path: Path, vary: dict[str, list[object]], said: str):
    with pytest.raises(UsageError, match=said):
        twin.sweep(write_job(tmp_path, "part"), vary)


def test_a_missing_package_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(extras, "find_spec", lambda _: None)
    with pytest.raises(
        UsageError, match="needs pandas: install mill-twin with its extra 'notebook'"
    ):
        twin.sweep(write_job(tmp_path, "part"), {"job.default_feed": [500.0]})
