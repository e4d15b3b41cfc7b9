"""A run that ends without a verdict leaves none of an earlier run in its folder."""

import sys
from pathlib import Path

import pytest

from tests.command_line import Twin
from twin.commands.runs.run import run_and_print
from twin.errors import ExitCode
from twin.run.run_folder import INSPECTION_FILES, VERDICT_FILES, without_verdict

GOOD = "G21 G90 G17\nG1 X1 F600\nM2\n"
JOB = 'program = "p.nc"\ndialect = "linuxcnc"\n'

ENDS: dict[str, tuple[ExitCode, str, str]] = {
    "the job is wrong": (ExitCode.USAGE, GOOD, JOB + "cell = 1\n"),
    "a tolerance judges nothing that is simulated": (
        ExitCode.USAGE, GOOD, JOB + "[tolerance]\nforce_n = 1.0\n",
    ),
    "the program is gone": (ExitCode.USAGE, GOOD, JOB.replace("p.nc", "q.nc")),
    "the program is wrong": (ExitCode.PROGRAM, "G1 Q77 W\n" + GOOD, JOB),
    "the program is wrong behind its first moves": (
        ExitCode.PROGRAM, "G21 G90\nG1 X1 F600\nG99.9\nM2\n", JOB,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", ENDS)
def test_no_older_verdict_is_left(name: str, tmp_path: Path, twin: Twin) -> None:
    code, program, job = ENDS[name]
    (tmp_path / "p.nc").write_text(GOOD)
    (tmp_path / "p.toml").write_text(JOB)
    run = ("run", str(tmp_path / "p.toml"), "--out", str(tmp_path / "out"))
    assert twin(*run).code == ExitCode.OK
    assert (tmp_path / "out" / "result.json").is_file()
    (tmp_path / "p.nc").write_text(program)
    (tmp_path / "p.toml").write_text(job)
    assert twin(*run).code == code
    assert [each for each in VERDICT_FILES if (tmp_path / "out" / each).exists()] == []


@pytest.mark.parametrize("command", [("render", "p.toml"), ("render", "out/recording.h5")])
def test_pictures_that_fail_leave_none_of_an_earlier_part(
    command: tuple[str, ...], tmp_path: Path, twin: Twin, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "out").mkdir()
    for name in INSPECTION_FILES:
        (tmp_path / "out" / name).touch()
    asked = ("--out", "out", "--inspect", "commanded")
    assert twin(*command, *asked).code == ExitCode.USAGE
    assert list((tmp_path / "out").iterdir()) == []


def test_an_interruption_before_the_run_leaves_no_older_verdict(tmp_path: Path) -> None:
    (tmp_path / "result.json").touch()
    with pytest.raises(KeyboardInterrupt), without_verdict(tmp_path):
        raise KeyboardInterrupt
    assert not (tmp_path / "result.json").exists()


def test_a_folder_of_another_run_keeps_what_is_in_it(tmp_path: Path, twin: Twin) -> None:
    """A command line that names the folder of something else removes nothing but verdicts."""
    (tmp_path / "note.txt").write_text("mine")
    assert twin("run", str(tmp_path / "none.toml"), "--out", str(tmp_path)).code == ExitCode.USAGE
    assert (tmp_path / "note.txt").read_text() == "mine"


def test_a_defect_while_results_are_written_leaves_no_report_that_passes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def defective(*_: object) -> None:
        raise RuntimeError

    (tmp_path / "p.nc").write_text(GOOD)
    (tmp_path / "p.toml").write_text(JOB)
    monkeypatch.setattr(sys.modules["twin.run.results"], "write_result", defective)
    out = tmp_path / "out"
    with pytest.raises(RuntimeError):
        run_and_print(
            tmp_path / "p.toml", out, dialect=None, machine=None, video=False, strict=False
        )
    assert [each for each in VERDICT_FILES if (out / each).exists()] == []
