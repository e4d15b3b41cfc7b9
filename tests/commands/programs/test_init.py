"""A first job file, with what the program itself tells."""

from pathlib import Path

import pytest
from command_line import Twin

from twin.job.load import load_job

PROGRAM = "N10 T2 M6\nN20 G0 X10 Y20 Z5\nN30 G1 Z-6 F200\nN40 X90 Y60\nN50 G0 Z50\nN60 M30\n"


def test_a_first_job_holds_the_program_and_passes_its_own_reader(tmp_path: Path, twin: Twin):
    program = tmp_path / "part.nc"
    program.write_text(PROGRAM)
    written = twin("init", program, "--dialect", "fagor8070")
    assert written.code == 0, written.stderr
    file = load_job(tmp_path / "part.toml").file
    assert file.stock is not None
    assert file.stock.size == (100.0, 60.0, 16.0)
    assert file.stock.position == (50.0, 40.0, 0.0)
    assert [tool.number for tool in file.tools] == [2]
    again = twin("init", program, "--dialect", "fagor8070")
    assert again.code == 2
    assert "--force replaces it" in again.stderr


def test_a_program_that_counts_from_machine_zero_gets_a_place(tmp_path: Path, twin: Twin):
    program = tmp_path / "post.nc"
    program.write_text(
        "N10 G0 G53 Z0\nN20 G54 T1 M6\nN30 G0 X10 Y20 Z5\nN40 G1 Z-6 F200\nN50 X30\nN60 G0 G53 Z0\nN70 M30\n"
    )
    written = twin("init", program, "--dialect", "gost")
    assert written.code == 0, written.stderr
    file = load_job(tmp_path / "post.toml").file
    assert file.stock is not None
    assert list(file.part_zero) == ["X", "Y", "Z"]
    assert twin("interpret", program).code == 0


def test_a_program_above_zero_gets_no_stock(tmp_path: Path, twin: Twin):
    (tmp_path / "high.nc").write_text("N10 G0 X0 Z5\nN20 G1 X50 F500\n")
    assert twin("init", tmp_path / "high.nc", "--dialect", "fagor8070").code == 0
    assert load_job(tmp_path / "high.toml").file.stock is None


@pytest.mark.parametrize("command", ["run", "check", "init", "doctor"])
def test_help_is_short_to_ask_for_and_ends_with_examples(twin: Twin, command: str):
    shown = twin(command, "-h")
    assert shown.code == 0
    assert "Examples:" in shown.stdout
    assert f"twin {command}" in shown.stdout


def test_shipped_programs_have_names(twin: Twin, tmp_path: Path):
    assert twin("interpret", "semicircle_by_radius").code == 0
    nowhere = twin("interpret", tmp_path / "none.nc")
    assert nowhere.code == 2
    assert "no such file" in nowhere.stderr
