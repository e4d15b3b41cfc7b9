"""What a baseline holds of whole programs: their job, their machine, and the line that changed."""

from pathlib import Path

import pytest

from twin.check.runner import check_program
from twin.check.task import CheckSettings
from twin.files.shipped import resource_root

MACHINE = 'base = "{base}"\nschema = 1\nname = "own"\n[axes.X]\nfollowing_error_limit = {limit}\n'
JOB = """program = "part.nc"
dialect = "fanuc"
machine = "own.toml"
[start]
Z = 20.0
[offsets."G54.1 P1"]
X = 10.0
[[tools]]
number = 1
kind = "drill"
"""
PROGRAM = """O1000 (HOLES)
G54.1 P1
M3 S1000
G0 G90 X0 Y0 Z10.
G83 G99 X0 Z-10. R2. Q1. F300
X10.
X20.
G80 G0 Z10.
M30
"""


@pytest.fixture
def job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    write(tmp_path)
    update = CheckSettings(baseline=Path("baselines"), update_baseline=True)
    outcome = check_program(tmp_path / "part.toml", update)
    assert outcome.passed, outcome.findings
    return tmp_path / "part.toml"


def write(folder: Path, program: str = PROGRAM, limit: float = 5.0) -> None:
    base = resource_root("models") / "mill4" / "machine.toml"
    (folder / "own.toml").write_text(MACHINE.format(base=base, limit=limit), encoding="utf-8")
    (folder / "part.toml").write_text(JOB, encoding="utf-8")
    (folder / "part.nc").write_text(program, encoding="utf-8")


def found(job: Path) -> list[tuple[str, int, str]]:
    findings = check_program(job, CheckSettings(baseline=Path("baselines"))).findings
    return [(finding.code, finding.line, finding.message) for finding in findings]


def test_a_run_holds_its_own_baseline_with_a_blank_in_a_key(job: Path):
    assert found(job) == []


def test_a_limit_of_the_machine_that_was_loosened_is_named(job: Path):
    write(job.parent, limit=50.0)
    message = "machine.axes.X.following_error_limit is 50.0, baseline 5.0"
    assert found(job) == [("baseline-job", 5, message)]


def test_a_word_of_a_cycle_is_one_finding_at_its_line(job: Path):
    write(job.parent, PROGRAM.replace("Z-10. R2.", "Z-11. R2."))
    path, *rest = found(job)
    assert (path[0], path[1]) == ("baseline-path", 5)
    assert "more of this change" in path[2]
    assert [code for code, *_ in rest] == ["baseline-cycle-time"]


def test_a_lost_function_is_told_at_its_line(job: Path):
    write(job.parent, PROGRAM.replace("M3 S1000\n", ""))
    assert ("baseline-function", 3) in [each[:2] for each in found(job)]


def test_comments_are_those_of_the_control(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Round brackets hold the values of a cycle here, and no comment: the changed line is found."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.toml").write_text('program = "p.mpf"\ndialect = "sinumerik"\n')
    program = (
        "G17 G90 G94 G71 ; head\nT1 M6\nS900 M3\nG0 X0 Y0 Z20\nF200\nMCALL CYCLE82(10,0,2,-4,,0.2)\n"
        "X5 Y5\nX9 Y5\nMCALL\nM30\n"
    )
    (tmp_path / "p.mpf").write_text(program)
    update = CheckSettings(baseline=Path("baselines"), update_baseline=True)
    assert check_program(tmp_path / "p.toml", update).passed
    (tmp_path / "p.mpf").write_text(program.replace("; head", " ; other\n"))
    assert found(tmp_path / "p.toml") == []
    (tmp_path / "p.mpf").write_text(program.replace("-4,", "-5,"))
    assert [each[:2] for each in found(tmp_path / "p.toml") if each[1]] == [("baseline-path", 6)]
