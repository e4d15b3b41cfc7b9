"""The test programs for a real machine are valid in every dialect and stay within its travel."""

from pathlib import Path

import numpy as np
import pytest
from command_line import Twin

import twin as package
from twin.calibrate.programs import WORDINGS, write_programs
from twin.files.shipped import machine_file
from twin.machine.load import read_machine


@pytest.mark.parametrize("dialect", WORDINGS)
@pytest.mark.parametrize("machine", ["mill3", "mill4", "mill4_light", "mill4a", "mill5", "mill5h"])
def test_a_program_plans_within_the_travel(tmp_path: Path, dialect: str, machine: str) -> None:
    described = read_machine(machine_file(machine))
    write_programs(described, tmp_path)
    setpoints = package.plan(tmp_path / f"calibrate_{dialect}.toml")
    for index, name in enumerate("XYZ"):
        travel = described.axis(name).travel
        assert travel is not None
        reached = setpoints.position[:, index]
        assert travel[0] <= reached.min() < reached.max() <= travel[1]
        assert np.ptp(reached) > min(150.0, 0.2 * (travel[1] - travel[0]))
    for index, name in list(enumerate(described.axes.names))[3:]:
        low, high = described.axis(name).travel or (-np.inf, np.inf)
        reached = setpoints.position[:, index]
        assert low <= reached.min() < reached.max() <= high
        assert np.ptp(reached) > min(80.0, 0.2 * (high - low))
    assert setpoints.time[-1] < 600.0


def test_the_command_writes_them_without_a_log(twin: Twin, tmp_path: Path) -> None:
    done = twin("calibrate", "--programs", tmp_path / "air", "--base", "mill4")
    assert done.code == 0, done.stderr
    written = sorted(path.name for path in (tmp_path / "air").glob("*.nc"))
    assert written == sorted(f"calibrate_{dialect}.nc" for dialect in WORDINGS)
    assert twin("calibrate").code == 2
    assert twin("calibrate", "--out", tmp_path / "a.toml").code == 2


def test_jobs_find_a_machine_file_of_one_s_own(twin: Twin, tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text('base = "mill4"\nname = "old mill"\n', encoding="utf-8")
    done = twin("calibrate", "--programs", tmp_path / "air", "--base", tmp_path / "mine.toml")
    assert done.code == 0, done.stderr
    assert package.plan(tmp_path / "air" / "calibrate_mefi.toml").time[-1] < 600.0
