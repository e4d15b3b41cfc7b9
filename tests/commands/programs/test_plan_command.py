"""``twin plan`` as a stranger meets it."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from twin.cli import app

PROGRAM = "N10 G0 X10\nN20 G1 X60 F3000\nN40 G1 Y20 F3000\n"


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "part.nc"
    path.write_text(PROGRAM, encoding="utf-8")
    return path


def test_json_names_blocks_and_reasons(program: Path, tmp_path: Path) -> None:
    command = ["plan", str(program), "--dialect", "mefi", "--out", str(tmp_path / "out")]
    done = CliRunner().invoke(app, [*command, "--format", "json"])
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert found["cycle_s"] == pytest.approx(sum(block["seconds"] for block in found["blocks"]))
    assert [block["line"] for block in found["blocks"]][:2] == [1, 2]
    assert found["lost_to_s"]["stop at a block's end"] > 0.05
    assert Path(found["plot"]).stat().st_size > 1000


def test_text_says_the_cycle_time(program: Path, tmp_path: Path) -> None:
    command = ["plan", str(program), "--dialect", "mefi", "--out", str(tmp_path / "out")]
    done = CliRunner().invoke(app, command)
    assert done.exit_code == 0, done.output
    assert done.stdout.startswith("cycle time ")
    assert "time lost to" in done.stdout


def test_unknown_format_is_refused(program: Path) -> None:
    done = CliRunner().invoke(app, ["plan", str(program), "--format", "yaml"])
    assert done.exit_code != 0
