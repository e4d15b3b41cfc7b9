"""``twin interpret`` as a person and a script see it."""

import json
from pathlib import Path

from tests.command_line import Twin


def written(folder: Path, text: str) -> Path:
    path = folder / "part.nc"
    path.write_text(text, encoding="utf-8")
    return path


def test_diagnostics_go_to_stderr_with_their_caret(twin: Twin, tmp_path: Path) -> None:
    path = written(tmp_path, "N10 G1 X10\nN20 G2 X20\n")
    done = twin("interpret", path, "--dialect", "gost")
    assert done.code == 3
    assert done.stdout.splitlines() == ["     1  line  X10 Y0 Z0 C0  F1000 mm/min"]
    warning, error = (done.stderr.index(code) for code in ("no-feed", "arc-without-center"))
    assert warning < error
    assert f"{path}:1:5: warning no-feed" in done.stderr
    assert "    N20 G2 X20\n        ^^\n    hint: write I, J or R" in done.stderr


def test_the_last_record_of_a_wrong_program_is_its_error(twin: Twin, tmp_path: Path) -> None:
    path = written(tmp_path, "N10 G1 X10\nN20 G2 X20\n")
    done = twin("interpret", path, "--dialect", "gost", "--format", "jsonl")
    records = [json.loads(line) for line in done.stdout.splitlines()]
    assert [record["type"] for record in records] == ["move", "diagnostic", "diagnostic"]
    assert [record.get("severity") for record in records[1:]] == ["warning", "error"]


def test_text_tells_rapids_and_places_on_the_path(twin: Twin, tmp_path: Path) -> None:
    path = written(tmp_path, "N10 G0 X10 FF5 N20 G1 X20 F10 H2 O0.5 N30 M7 K1\n")
    done = twin("interpret", path, "--dialect", "codesys")
    assert done.code == 0
    assert done.stdout.splitlines()[:4] == [
        "     1  line  X10 Y0 Z0 C0  rapid F300 mm/min",
        "     1  H2  on1  at 0.5 of the move",
        "     1  line  X20 Y0 Z0 C0  F600 mm/min",
        "     1  M7  K1",
    ]


def test_strict_makes_an_error_of_a_warning(twin: Twin, tmp_path: Path) -> None:
    path = written(tmp_path, "%\n")
    assert twin("interpret", path, "--dialect", "gost").code == 0
    done = twin("interpret", path, "--dialect", "gost", "--strict")
    assert done.code == 3
    assert "error empty-program" in done.stderr


def test_an_empty_file_is_called_so(twin: Twin, tmp_path: Path) -> None:
    done = twin("interpret", written(tmp_path, "\n \n"))
    assert done.code == 2
    assert "is empty" in done.stderr
    assert "could be any" not in done.stderr


def test_codes_are_listed_and_explained(twin: Twin) -> None:
    assert "no-feed" in twin("explain").stdout
    assert "Example of a program that causes it" in twin("explain", "no-feed").stdout
