"""Small programs through the whole chain: what a build server sees."""

import functools
import json
import os
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tests.command_line import Twin
from twin.check import runner
from twin.check.discovery import file_of
from twin.check.outcome import CheckOutcome
from twin.check.runner import check_all, check_program
from twin.check.task import CheckSettings
from twin.commands.programs.check import CODE_QUALITY_FILE, check_and_print
from twin.errors import ExitCode, UsageError
from twin.job.load import load_job

PROGRAM = """N10 X0 Y0 Z0 G00
N20 G01 X10.5 F3000
N30 G02 X20.5 Y0 I5 J0
N40 G01 Y-4.25
N50 M30
"""
JOB = 'program = "{name}.nc"\ndialect = "mefi"\n[tolerance]\ncontour_um = {tolerance}\n'


def write_job(folder: Path, name: str, text: str = PROGRAM, tolerance: float = 50.0) -> Path:
    (folder / f"{name}.nc").write_text(text, encoding="utf-8")
    job = folder / f"{name}.toml"
    job.write_text(JOB.format(name=name, tolerance=tolerance), encoding="utf-8")
    return job


@pytest.mark.seconds("programs are run by workers")
def test_programs_pass_fail_and_break_beside_each_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.chdir(tmp_path)
    for name, changes in {
        "good": {}, "tight": {"tolerance": 0.001}, "wrong": {"text": "N10 X1 QQ5"},
    }.items():  # fmt: skip
        write_job(tmp_path, name, **changes)
    (tmp_path / "nokey.toml").write_text('program = "good.nc"\ntolerence = 1\n')
    summary = tmp_path / "summary.md"
    environment = {
        "GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": str(summary), "GITLAB_CI": "true",
    }  # fmt: skip
    code = check_and_print(
        ["."], settings=CheckSettings(reports=Path("reports")), junit=tmp_path / "junit.xml",
        json_file=tmp_path / "check.json", jobs=1, environment=environment,
    )  # fmt: skip
    assert code is ExitCode.FAILED
    programs = json.loads((tmp_path / "check.json").read_text(encoding="utf-8"))["programs"]
    assert {p["program"]: (p["verdict"], p["exit_code"]) for p in programs} == {
        "good.toml": ("pass", 0),
        "nokey.toml": ("error", 2),
        "tight.toml": ("fail", 1),
        "wrong.toml": ("error", 3),
    }
    shown = capsys.readouterr()
    assert "4 programs: 1 pass, 1 fail, 2 error" in shown.out
    assert "::error file=" in shown.out
    assert "did you mean 'tolerance'?" in shown.err
    assert "^" in shown.err
    assert "tight.toml" in summary.read_text(encoding="utf-8")
    assert len(json.loads((tmp_path / CODE_QUALITY_FILE).read_text(encoding="utf-8"))) == 3
    assert (tmp_path / "junit.xml").is_file()
    pages = {page.name: page.read_text(encoding="utf-8") for page in Path("reports").iterdir()}
    assert set(pages) == {"good.html", "tight.html"}
    assert "exceeds contour_um = 0.001" in pages["tight.html"]


MISTAKES = {
    "shifted by 0.02 mm": (PROGRAM.replace("Y-4.25", "Y-4.27"), 4, "baseline-path", "fail"),
    "G02 for G03": (PROGRAM.replace("G02", "G03"), 3, "baseline-path", "fail"),
    "sign dropped": (PROGRAM.replace("Y-4.25", "Y4.25"), 4, "baseline-path", "fail"),
    "decimal lost": (PROGRAM.replace("Y-4.25", "Y-425"), 4, "baseline-path", "alarm"),
    "decimal shifted": (PROGRAM.replace("Y-4.25", "Y-42.5"), 4, "baseline-path", "fail"),
    "centre's sign dropped": (PROGRAM.replace("I5", "I-5"), 3, "baseline-path", "error"),
    "line lost": (PROGRAM.replace("N40 G01 Y-4.25\n", ""), 4, "baseline-path", "fail"),
    "feed lost": (PROGRAM.replace("F3000", "F300"), 2, "baseline-feed", "fail"),
}


@pytest.mark.seconds("programs are run by workers")
def test_a_broken_post_processor_is_caught_at_its_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.chdir(tmp_path)
    held = CheckSettings(baseline=Path("baselines"))
    job = write_job(tmp_path, "part")
    assert check_program(job, held).findings[0].code == "baseline-missing"
    assert check_program(job, CheckSettings(baseline=held.baseline, update_baseline=True)).passed
    assert check_program(job, held).passed
    for what, (text, line, code, verdict) in MISTAKES.items():
        assert text != PROGRAM
        outcome = check_program(write_job(tmp_path, "part", text), held)
        assert outcome.verdict == verdict, what
        found = [(finding.code, finding.line) for finding in outcome.findings]
        assert (code, line) in found, (what, found)


def test_what_fails_or_breaks_is_not_taken_for_a_baseline(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.chdir(tmp_path)
    update = CheckSettings(baseline=Path("baselines"), update_baseline=True)
    for text in (PROGRAM.replace("Y-4.25", "Y-4250"), "N10 X1 QQ5"):
        assert not check_program(write_job(tmp_path, "part", text), update).passed
    assert not Path("baselines").exists()


def test_a_baseline_lies_under_the_jobs_own_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a").mkdir()
    write_job(tmp_path / "a", "part")
    (tmp_path / "a" / "part.tap").touch()
    folder = Path("stored")
    for path, stored in {
        Path("a/part.toml"): "stored/a/part.baseline",
        tmp_path / "a" / "part.nc": "stored/a/part.baseline",
        Path("a/part.tap"): "stored/a/part.tap.baseline",
    }.items():
        job = load_job(path)
        assert file_of(folder, job.path or job.program, ".baseline") == Path(stored)
    monkeypatch.chdir(tmp_path / "a" / "..")
    outside = file_of(folder, Path("/elsewhere/part.nc"), ".baseline")
    assert outside == Path("stored/elsewhere/part.nc.baseline")


def test_updating_needs_a_folder(tmp_path: Path):
    with pytest.raises(UsageError, match="--baseline DIR"):
        check_and_print([str(tmp_path)], settings=CheckSettings(update_baseline=True))


def mark(path: Path, folder: Path) -> CheckOutcome:
    (folder / path.name).write_text(str(os.getpid()))
    return CheckOutcome(program=str(path), verdict="pass", exit_code=ExitCode.OK)


def die_if_bad(path: Path) -> CheckOutcome:
    if path.name == "bad":
        os._exit(9)
    return CheckOutcome(program=str(path), verdict="pass", exit_code=ExitCode.OK)


@pytest.mark.processes
def test_programs_are_spread_over_processes(tmp_path: Path):
    paths = [Path(f"program{index}") for index in range(4)]
    outcomes = list(check_all(paths, functools.partial(mark, folder=tmp_path), jobs=2))
    assert {outcome.program for outcome in outcomes} == {str(path) for path in paths}
    assert str(os.getpid()) not in {path.read_text() for path in tmp_path.iterdir()}


@pytest.fixture
def at_once(monkeypatch: pytest.MonkeyPatch) -> Callable[[float], int]:
    """Check eight programs on two cores, each taking some time [s]; how many were checked at once."""
    running, most = 0, 0

    def check(path: Path, seconds: float) -> CheckOutcome:
        nonlocal running, most
        running += 1
        most = max(most, running)
        time.sleep(seconds)
        running -= 1
        return outcome_of(str(path))

    def checked(seconds: float) -> int:
        programs = [Path(str(number)) for number in range(8)]
        found = list(check_all(programs, functools.partial(check, seconds=seconds)))
        assert {each.program for each in found} == set(map(str, programs))
        return most

    monkeypatch.setattr(runner, "available_cores", lambda: 2)
    monkeypatch.setattr(runner, "_pool", lambda workers, _: ThreadPoolExecutor(workers))
    return checked


def test_programs_that_are_over_soon_are_left_to_one_worker(at_once: Callable[[float], int]):
    assert at_once(0.0) == 1


@pytest.mark.parametrize("limit", ["WORKER_PAYS_S", "LONG_S"])
def test_work_that_lasts_is_spread(
    at_once: Callable[[float], int], monkeypatch: pytest.MonkeyPatch, limit: str
):
    monkeypatch.setattr(runner, limit, 0.01)
    assert at_once(0.05) == 2


@pytest.mark.processes
def test_a_process_that_dies_takes_no_other_program_with_it():
    outcomes = list(check_all([Path("bad"), Path("one"), Path("two")], die_if_bad, jobs=2))
    verdicts = {outcome.program: outcome.verdict for outcome in outcomes}
    assert verdicts == {"bad": "error", "one": "pass", "two": "pass"}


def outcome_of(path: str) -> CheckOutcome:
    return CheckOutcome(program=path, verdict="pass", exit_code=ExitCode.OK)


def test_an_interrupted_check_keeps_what_was_complete(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    jobs = [str(write_job(tmp_path, name)) for name in ("first", "second")]

    def interrupted(*_: object, **__: object) -> Iterator[CheckOutcome]:
        yield outcome_of(jobs[0])
        raise KeyboardInterrupt

    monkeypatch.setattr("twin.commands.programs.check.run_tasks", interrupted)
    with pytest.raises(KeyboardInterrupt):
        check_and_print(
            jobs, settings=CheckSettings(), junit=tmp_path / "a.xml", json_file=tmp_path / "a.json",
            environment={},
        )  # fmt: skip
    shown = capsys.readouterr()
    assert "first.toml" in shown.out
    assert "interrupted: 1 of 2 programs checked" in shown.err
    assert "first.toml" in (tmp_path / "a.xml").read_text(encoding="utf-8")
    assert len(json.loads((tmp_path / "a.json").read_text(encoding="utf-8"))["programs"]) == 1


def test_outputs_that_cannot_be_written_are_told_before_anything_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    job = str(write_job(tmp_path, "part"))
    monkeypatch.setattr(
        "twin.commands.programs.check.run_tasks", lambda *_, **__: pytest.fail("it ran")
    )
    for junit, json_file in ((tmp_path, None), (None, Path(job) / "a.json")):
        with pytest.raises(OSError, match=str(tmp_path)):
            check_and_print(
                [job], settings=CheckSettings(), junit=junit, json_file=json_file, environment={}
            )


@pytest.mark.parametrize(
    "command", [("check", "none.toml"), ("sweep", "none.toml", "--vary", "job.dialect=haas")]
)
def test_a_check_of_nothing_leaves_no_earlier_verdict(
    command: tuple[str, ...], tmp_path: Path, twin: Twin, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("twin.json").write_text('[{"verdict": "pass"}]')
    assert twin(*command, "--json", "twin.json").code == ExitCode.USAGE
    assert not Path("twin.json").exists()


def test_a_program_that_is_wrong_has_no_earlier_report(
    tmp_path: Path, twin: Twin, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write_job(tmp_path, "part", "N10 X1 QQ5")
    Path("reports").mkdir()
    page = file_of(Path("reports"), Path("part.toml"), ".html")
    page.write_text("pass")
    assert twin("check", "part.nc", "--reports", "reports").code == ExitCode.FAILED
    assert not page.exists()


def test_json_alone_stands_on_the_standard_output(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
):
    job = str(write_job(tmp_path, "part"))
    monkeypatch.setattr(
        "twin.commands.programs.check.run_tasks", lambda *_, **__: [outcome_of(job)]
    )
    check_and_print([job], settings=CheckSettings(), json_file=Path("-"), environment={})
    shown = capfd.readouterr()
    assert json.loads(shown.out)["programs"][0]["program"] == job
    assert "1 program: 1 pass" in shown.err


def test_a_defect_at_one_program_has_an_exit_code_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    def defect(*_: object) -> CheckOutcome:
        raise ZeroDivisionError

    monkeypatch.setattr("twin.check.program._run", defect)
    job = str(write_job(tmp_path, "part"))
    code = check_and_print([job], settings=CheckSettings(), jobs=1, environment={})
    assert code is ExitCode.CRASH
    shown = capsys.readouterr()
    assert "ZeroDivisionError" in shown.err
    assert "1 program: 1 error" in shown.out
