"""Each alarm has a program that provokes it, with the line, the axis and what is kept."""

import json
from pathlib import Path

import h5py
import pytest
from command_line import Twin

from twin.resources import resource_root

FOLDER = resource_root("programs") / "alarms" / "fagor8070"
EXPECTED = {
    "soft_limit": ("soft-limit", 5, "X would go to 450.000 mm"),
    "soft_limit_arc": ("soft-limit", 4, "X would go to 440.000 mm"),
    "hard_limit": ("hard-limit", 4, "X ran onto its limit switch at 402.0"),
    "following_error": ("following-error", 5, "X trails its setpoint by 3.0"),
    "drive_saturation": ("drive-saturation", 5, "the drive of Y has been at its limit of 6000 N"),
    "collision_faceplate": ("collision", 5, "the tool's shank meets the faceplate"),
    "collision_vise": ("collision", 6, "the holder's nut meets the fixed jaw"),
}


def test_every_program_has_its_expectation():
    assert {path.stem for path in FOLDER.glob("*.nc")} == set(EXPECTED)


@pytest.mark.parametrize("name", sorted(EXPECTED))
def test_the_alarm_is_raised_at_its_line_and_the_recording_up_to_it_is_kept(
    twin: Twin, tmp_path: Path, name: str
):
    code, line, message = EXPECTED[name]
    done = twin("run", FOLDER / f"{name}.toml", "--out", tmp_path)
    assert done.code == 4, done.stderr
    assert f"{name}.nc:{line}:" in done.stderr
    assert f"error {code}: {message}" in done.stderr
    assert "Traceback" not in done.stderr
    result = json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))
    assert result["verdict"] == "alarm"
    (alarm,) = result["alarms"]
    assert (alarm["code"], alarm["line"]) == (code, line)
    if code == "soft-limit":
        assert alarm["time_s"] == 0.0
        assert not (tmp_path / "recording.h5").exists()
        return
    with h5py.File(tmp_path / "recording.h5") as file:
        time, lines = file["time"], file["line"]
        assert isinstance(time, h5py.Dataset)
        assert isinstance(lines, h5py.Dataset)
        assert time[-1] == pytest.approx(alarm["time_s"])
        assert lines[-1] == line
