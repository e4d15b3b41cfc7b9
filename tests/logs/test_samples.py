"""Logs as controls write them, one file of each: the same motion comes out of all of them."""

from pathlib import Path

import numpy as np
import pytest
from command_line import Twin

from twin.logs.column_map import read_column_map
from twin.logs.machine_log import read_machine_log

SAMPLES = Path(__file__).parent / "samples"
MAPS = {
    "halsampler.txt": "halsampler.toml",
    "sinumerik_trace.xml": "sinumerik_trace.toml",
    "sinumerik_edge.json": "sinumerik_edge.toml",
    "sinumerik_edge.csv": "sinumerik_edge_csv.toml",
    "twincat_scope.csv": "twincat_scope.toml",
    "codesys_trace.csv": "codesys_trace.toml",
    "tncscope.txt": "tncscope.toml",
    "servo_guide.csv": "servo_guide.toml",
    "fagor_oscilloscope.txt": "fagor_oscilloscope.toml",
}


@pytest.mark.parametrize("name", MAPS)
def test_every_form_holds_the_same_motion(name: str) -> None:
    meant = read_machine_log(SAMPLES / "reference.csv", units_needed=True)
    found = read_machine_log(SAMPLES / name, read_column_map(SAMPLES / MAPS[name]))
    assert found.time - found.time[0] == pytest.approx(meant.time, abs=1e-6)
    for column in ("command", "actual"):
        values = getattr(found.axes["X"], column)
        assert np.abs(values - getattr(meant.axes["X"], column)).max() < 2e-4


@pytest.mark.parametrize("name", MAPS)
def test_compare_reads_every_form(twin: Twin, name: str) -> None:
    log = SAMPLES / name
    done = twin("compare", log, log, "--columns", SAMPLES / MAPS[name], "--tolerance", "0.001")
    assert done.code == 0, done.stderr


@pytest.mark.seconds("a machine is fitted")
@pytest.mark.parametrize("name", ["twincat_scope.csv", "codesys_trace.csv"])
def test_calibrate_reads_what_is_no_plain_table(twin: Twin, tmp_path: Path, name: str) -> None:
    out = tmp_path / "mine.toml"
    done = twin("calibrate", SAMPLES / name, "--columns", SAMPLES / MAPS[name], "--out", out)
    assert done.code == 0, done.stderr
    assert "X: predicts the lag of the fitted log" in done.stdout
    assert "[axes.X]\nkv = 5." in out.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (('"SetPos"', '"ActPos"', "mm"), "swapped"),
        (('"ActPos"', '"SetPos"', "in"), "the unit of position or of time is another one"),
        (('"ActPos"', '"Torque"', "mm"), "another axis|does not move"),
        (('"ActPos"', '"SetPos"', "deg"), "rotary axis"),
        (('"ActPos"', '"Setpos"', "mm"), "did you mean 'SetPos'"),
    ],
)
def test_a_wrong_map_is_refused_with_the_reason(
    twin: Twin, tmp_path: Path, change: tuple[str, str, str], told: str
) -> None:
    actual, command, unit = change
    text = (
        f'[columns.X]\ncommand = {{ column = {command}, unit = "{unit}" }}\n'
        f'actual = {{ column = {actual}, unit = "{unit}" }}\n'
    )
    (tmp_path / "map.toml").write_text(text, encoding="utf-8")
    done = twin(
        "calibrate", SAMPLES / "twincat_scope.csv", "--columns", tmp_path / "map.toml",
        "--out", tmp_path / "never.toml",
    )  # fmt: skip
    assert done.code == 2
    assert any(part in done.stderr for part in told.split("|")), done.stderr
    assert not (tmp_path / "never.toml").exists()
