"""The command line as a stranger uses it: exit codes, diagnostics, files."""

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py
import pytest
import trimesh
from command_line import Twin, machine_with_gain
from typer.main import get_command

from twin.cli import app
from twin.files.shipped import resource_root

PROGRAMS = resource_root("programs")


def program(folder: Path, text: str, job: str = "") -> Path:
    path = folder / "part.nc"
    path.write_text(text, encoding="utf-8")
    if job:
        (folder / "part.toml").write_text(f'program = "part.nc"\n{job}', encoding="utf-8")
    return path


@pytest.mark.seconds("a program is run whole")
def test_a_run_writes_all_that_the_contract_names(twin: Twin, tmp_path: Path):
    done = twin("run", PROGRAMS / "codesys" / "semicircle_by_radius.nc", "--out", tmp_path)
    assert done.code == 0, done.stderr
    assert "pass" in done.stdout
    result = json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))
    assert result["verdict"] == "pass"
    assert result["dialect"] == "codesys"
    assert result["machine"] == "mill4"
    assert result["final"]["commanded"] == pytest.approx({"X": 200, "Y": 100, "Z": 0, "C": 0})
    assert result["final"]["simulated"] == pytest.approx(
        {"X": 200, "Y": 100, "Z": 0, "C": 0}, abs=1e-3
    )
    assert {"interpret_s", "plan_s", "simulate_s", "compare_s", "cut_s"} <= set(result["stages"])
    assert [arc["radius_mm"] for arc in result["arcs"]] == pytest.approx([50.0])
    assert result["cut"]["removed_mm3"] > 0.0
    with h5py.File(tmp_path / "recording.h5") as file:
        assert file.attrs["complete"]
        assert len(file["time"]) == result["samples"]  # pyright: ignore[reportArgumentType]
    part = trimesh.load_mesh(tmp_path / "part.stl")
    assert part.is_watertight
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "http://" not in page.replace("http://www.w3.org", "")
    assert not list(tmp_path.glob(".*"))


@pytest.mark.parametrize(
    ("text", "dialect", "word"),
    [
        ("N5 G00 X0 Y0\nN10 G79 X5 F100\n", "mefi", "G79"),
        ("G0 X0 Y0\nG102 X360\n", "gost", "X360"),
        ("N10 G0 X0 Y0\nN20 G2 X10 I5 J5 T1200 F1\n", "codesys", "T1200"),
        ("G0 X0 Y0\nG2 X10 Y0 R2 F100\nM30\n", "fagor8070", "R2"),
        ("G0 X0 Y0\nG1 W5 F100\n", "gost", "W5"),
    ],
)
def test_a_wrong_program_is_refused_with_a_caret(
    twin: Twin, tmp_path: Path, text: str, dialect: str, word: str
):
    path = program(tmp_path, text)
    done = twin("run", path, "--dialect", dialect, "--out", tmp_path / "out")
    assert done.code == 3
    assert re.search(rf"{re.escape(str(path))}:2:\d+: error [a-z0-9-]+: ", done.stderr)
    source, caret = done.stderr.splitlines()[1:3]
    marked = source[caret.index("^") : caret.rindex("^") + 1]
    assert marked == word
    assert not (tmp_path / "out").exists()


def test_a_target_outside_the_travel_is_an_alarm_before_anything_moves(twin: Twin, tmp_path: Path):
    path = program(tmp_path, "G0 X10 Y0\nG1 X900 F1000\nM30\n")
    done = twin("run", path, "--dialect", "gost", "--out", tmp_path / "out")
    assert done.code == 4
    assert f"{path}:2:4: error soft-limit" in done.stderr
    assert "^^^^" in done.stderr
    result = json.loads((tmp_path / "out" / "result.json").read_text(encoding="utf-8"))
    assert result["verdict"] == "alarm"
    assert [(alarm["code"], alarm["line"]) for alarm in result["alarms"]] == [("soft-limit", 2)]
    left = {item.name for item in (tmp_path / "out").iterdir()}
    assert left == {"result.json", "report.html"}
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "outside its travel" in page


@pytest.mark.parametrize(
    ("job", "said"),
    [
        ("toleranse = 3", "did you mean 'tolerance'?"),
        ('machine = "mill9"', "shipped machines are"),
        ('dialect = "mazatrol"', "gost"),
        ("[part_zero]\nW = 3.0", "X, Y, Z, C"),
        ('[tolerance]\ncontour_um = "small"', "tolerance.contour_um"),
    ],
)
def test_a_wrong_job_is_refused(twin: Twin, tmp_path: Path, job: str, said: str):
    done = twin("run", program(tmp_path, "G102 C360\nG0 X1\n", job), "--out", tmp_path / "out")
    assert done.code == 2
    assert said in done.stderr
    assert not (tmp_path / "out").exists()


def test_what_is_not_there_is_refused(twin: Twin, tmp_path: Path):
    assert twin("run", tmp_path / "absent.nc").code == 2
    assert twin("run", tmp_path).code == 2
    assert twin("interpret", tmp_path / "absent.nc").code == 2
    assert twin("nonsense").code == 2
    assert twin("interpret", program(tmp_path, "G102 C0\n"), "--format", "xml").code == 2


@pytest.mark.parametrize("text", ["", "%\n", "(nothing here)\n"])
def test_a_program_that_moves_nothing_says_so(twin: Twin, tmp_path: Path, text: str):
    done = twin("run", program(tmp_path, text), "--dialect", "gost", "--out", tmp_path / "out")
    # A check that looked at nothing never passes.
    assert done.code == 1, done.stderr
    assert "nothing-moves" in done.stderr
    assert (tmp_path / "out" / "report.html").is_file()


def test_the_summary_of_an_alarm_names_it(twin: Twin, tmp_path: Path):
    path = program(tmp_path, "G0 X5000\n")
    done = twin("run", path, "--dialect", "gost", "--out", tmp_path / "out")
    assert done.code == 4
    assert "soft-limit at line 1" in done.stdout


def test_a_folder_is_for_check(twin: Twin, tmp_path: Path):
    done = twin("run", tmp_path)
    assert done.code == 2
    assert "twin check" in done.stderr


@pytest.mark.seconds("a program is run whole")
def test_a_dull_drive_fails_the_tolerance_and_names_the_line(twin: Twin, tmp_path: Path):
    path = PROGRAMS / "mefi" / "helix.toml"
    machine = machine_with_gain(tmp_path, 0.5)
    done = twin("run", path, "--machine", machine, "--out", tmp_path / "out")
    assert done.code == 1, done.stderr
    result = json.loads((tmp_path / "out" / "result.json").read_text(encoding="utf-8"))
    assert result["verdict"] == "fail"
    assert result["contour_um"]["worst_line"] in (3, 4, 5)
    assert f"helix.nc:{result['contour_um']['worst_line']}:1: error contour_um: " in done.stderr


def help_texts(command: Any) -> Iterator[str]:
    yield command.help or ""
    for each in command.params:
        yield getattr(each, "help", None) or ""
    for each in getattr(command, "commands", {}).values():
        yield from help_texts(each)


def test_help_says_units_and_loses_no_word(twin: Twin) -> None:
    """Square brackets in a help text would be taken for markup and vanish."""
    assert not [text for text in help_texts(get_command(app)) if re.search(r"\[[a-z#/@]", text)]
    for command in ("render", "compare", "machine circle", "machine show"):
        text = twin(*command.split(), "--help").stdout
        assert "(mm" in text or "(s)" in text, command


def test_a_defect_of_the_twin_ends_with_a_code_of_its_own(
    twin: Twin, monkeypatch: pytest.MonkeyPatch
):
    def defect() -> str:
        raise ZeroDivisionError

    monkeypatch.setattr("twin.commands.explain.overview", defect)
    ended = twin("explain")
    assert ended.code == 70
    assert "ZeroDivisionError" in ended.stderr
    assert "please report" in ended.stderr
