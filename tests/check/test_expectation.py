"""A job that is to end badly passes when it does so, and in no other case."""

from pathlib import Path

import pytest

from twin.check.outcome import CheckOutcome, Finding
from twin.check.program import held_to_expectation
from twin.check.runner import check_program
from twin.check.task import CheckSettings
from twin.errors import ExitCode
from twin.files.shipped import resource_root
from twin.job import load
from twin.job.load import load_job

ALARM = CheckOutcome(
    program="part.toml",
    verdict="alarm",
    exit_code=ExitCode.ALARM,
    findings=(Finding("soft-limit", "X leaves its travel", "part.nc", 3),),
)
PASS = CheckOutcome(program="part.toml", verdict="pass", exit_code=ExitCode.OK)


def test_what_is_expected_passes_and_says_so():
    held = held_to_expectation(ALARM, "soft-limit")
    assert (held.passed, held.exit_code, held.expected) == (True, ExitCode.OK, "soft-limit")
    assert held_to_expectation(ALARM, None) is ALARM


@pytest.mark.parametrize(("outcome", "told"), [(PASS, "none"), (ALARM, "soft-limit")])
def test_what_did_not_happen_fails(outcome: CheckOutcome, told: str):
    held = held_to_expectation(outcome, "collision")
    assert not held.passed
    assert held.exit_code is not ExitCode.OK
    assert held.findings[0].code == "expectation"
    assert told in held.findings[0].message


def test_something_else_beside_it_fails():
    both = CheckOutcome(
        program="part.toml", verdict="alarm", exit_code=ExitCode.ALARM,
        findings=(*ALARM.findings, Finding("baseline-path", "ends at Y1", "part.nc", 2)),
    )  # fmt: skip
    held = held_to_expectation(both, "soft-limit")
    assert not held.passed
    assert [finding.code for finding in held.findings] == ["baseline-path"]


def test_a_defect_is_never_expected():
    crashed = CheckOutcome(program="part.toml", verdict="error", exit_code=ExitCode.CRASH)
    assert held_to_expectation(crashed, "crash") is crashed


BAD_ENDS = {
    "alarm": ("N10 G01 X5 F600\nN20 G00 X9999\n", "soft-limit"),
    "no program": ("N10 G01 X5 F600\nN20 QQ7\n", "missing-value"),
}


@pytest.mark.parametrize("end", BAD_ENDS)
def test_what_is_expected_has_a_baseline_like_any_other(tmp_path: Path, end: str):
    text, expected = BAD_ENDS[end]
    (tmp_path / "part.nc").write_text(text, encoding="utf-8")
    job = tmp_path / "part.toml"
    job.write_text(f'program = "part.nc"\ndialect = "mefi"\nexpect = "{expected}"\n', "utf-8")
    baseline = tmp_path / "baselines"
    update = check_program(job, CheckSettings(baseline=baseline, update_baseline=True))
    assert update.passed, update.findings
    held = CheckSettings(baseline=baseline)
    assert check_program(job, held).passed
    (tmp_path / "part.nc").write_text(text.replace("X5", "X6"), encoding="utf-8")
    changed = check_program(job, held)
    # Without moves there is nothing to hold but the expectation itself.
    assert changed.passed == (end == "no program")


def test_a_job_is_read_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    (tmp_path / "part.nc").write_text("N10 G01 X5 F600\n", encoding="utf-8")
    job = tmp_path / "part.toml"
    job.write_text('program = "part.nc"\ndialect = "mefi"\n', encoding="utf-8")
    read: list[Path] = []
    load_toml = load.load_toml
    monkeypatch.setattr(load, "load_toml", lambda path: read.append(path) or load_toml(path))
    assert check_program(job, CheckSettings()).passed
    assert read == [job]


def test_every_shipped_job_that_ends_badly_says_so():
    alarms = resource_root("programs") / "alarms"
    jobs = {
        path.stem: load_job(path).file.expect
        for path in alarms.rglob("*.toml")
        if "machines" not in path.parts
    }
    assert [name for name, expected in jobs.items() if expected is None] == ["near_miss"]
