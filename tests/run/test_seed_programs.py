"""Every program that ships runs to a pass, and the gate bites when the drives are dull."""

import json
from pathlib import Path

import pytest
from command_line import Twin, machine_with_gain

from twin.check.runner import check_program
from twin.check.task import CheckSettings
from twin.files.shipped import resource_root
from twin.job.load import load_job

pytestmark = pytest.mark.seconds("each program that ships is run whole")

PROGRAMS = resource_root("programs")
JOBS = sorted(job for job in PROGRAMS.glob("*/*.toml") if job.parent.name != "alarms")
"""Programs that provoke alarms have tests of their own."""

FINAL = {
    **{
        f"gost/recalculation_{number}": {"C": angle}
        for number, angle in enumerate((10, 370, 730, 10, -350, -370, -730), start=1)
    },
    "mefi/helix": {"X": 200.0, "Y": 0.0, "Z": 22.575},
}
"""Where the axes are in the end, as the seeds say it: the table's physical angle, the helix."""


def name_of(job: Path) -> str:
    return f"{job.parent.name}/{job.stem}"


each_job = pytest.mark.parametrize("job", JOBS, ids=name_of)
each_final = pytest.mark.parametrize(
    "job", [job for job in JOBS if name_of(job) in FINAL], ids=name_of
)
each_other = pytest.mark.parametrize(
    "job", [job for job in JOBS if name_of(job) not in FINAL], ids=name_of
)


@each_other
def test_it_passes(job: Path):
    done = check_program(job, CheckSettings())
    assert done.passed, "\n".join(map(str, done.findings))


@each_final
def test_it_runs_and_ends_where_it_shall(twin: Twin, tmp_path: Path, job: Path):
    done = twin("run", job, "--out", tmp_path)
    assert done.code == 0, done.stderr
    final = json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))["final"]
    for axis, value in FINAL[name_of(job)].items():
        assert final["commanded"][axis] == pytest.approx(value, abs=1e-9)
        assert final["simulated"][axis] == pytest.approx(value, abs=2e-3)


@pytest.mark.thorough
@each_job
def test_it_fails_with_half_the_gain(tmp_path: Path, job: Path):
    machine = machine_with_gain(tmp_path, 0.5, load_job(job).file.machine)
    dull = check_program(job, CheckSettings(machine=str(machine)))
    assert (dull.verdict, dull.exit_code) == ("fail", 1)
    assert any(f"{job.stem}." in str(finding) for finding in dull.findings)
    assert dull.worst_line > 0
