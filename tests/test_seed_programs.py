"""Every program that ships runs to a pass, and the gate bites when the drives are dull."""

import json
from pathlib import Path

import pytest
from conftest import Twin
from test_cli import PROGRAMS, machine_with_gain

JOBS = sorted(PROGRAMS.glob("[!a]*/*.toml"))
"""The dialects' folders; programs that provoke alarms have tests of their own."""


@pytest.mark.parametrize("job", JOBS, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_it_passes_and_fails_with_half_the_gain(twin: Twin, tmp_path: Path, job: Path):
    done = twin("run", job, "--out", tmp_path / "full")
    assert done.code == 0, done.stderr
    dull = twin(
        "run", job, "--machine", machine_with_gain(tmp_path, 0.5), "--out", tmp_path / "half"
    )
    assert dull.code == 1, dull.stderr
    result = json.loads((tmp_path / "half" / "result.json").read_text(encoding="utf-8"))
    assert result["verdict"] == "fail"
    assert "line" in dull.stderr


FINAL_TURNS = {1: 10, 2: 370, 3: 730, 4: 10, 5: -350, 6: -370, 7: -730}


@pytest.mark.parametrize("number", FINAL_TURNS)
def test_the_table_really_turns_as_far_as_g102_says(twin: Twin, tmp_path: Path, number: int):
    twin("run", PROGRAMS / "gost" / f"recalculation_{number}.nc", "--out", tmp_path)
    final = json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))["final"]
    assert final["commanded"]["C"] == pytest.approx(FINAL_TURNS[number], abs=1e-9)
    assert final["simulated"]["C"] == pytest.approx(FINAL_TURNS[number], abs=1e-3)


def test_the_helix_ends_where_the_seed_says(twin: Twin, tmp_path: Path):
    twin("run", PROGRAMS / "mefi" / "helix.nc", "--out", tmp_path)
    final = json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))["final"]
    assert final["commanded"] == pytest.approx({"X": 200, "Y": 0, "Z": 22.575, "C": 0}, abs=1e-9)
    assert final["simulated"] == pytest.approx({"X": 200, "Y": 0, "Z": 22.575, "C": 0}, abs=1e-3)
