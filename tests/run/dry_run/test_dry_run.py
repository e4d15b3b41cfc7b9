"""What is known of a program before anything moves."""

from pathlib import Path

import pytest

from twin.run.preparing.preparation import prepare
from twin.run.run import Run

JOB = 'program = "part.nc"\ndialect = "{}"\nmachine = "mill4"\n[[tools]]\nnumber = 1\n'


def dry_run(folder: Path, text: str, dialect: str = "fagor8070", more: str = ""):
    (folder / "part.nc").write_text(text)
    (folder / "part.toml").write_text(JOB.format(dialect) + more)
    return Run(prepare(folder / "part.toml")).dry_run


def test_more_speed_than_the_spindle_gives_is_a_warning_at_its_s_and_is_limited(tmp_path: Path):
    found = dry_run(tmp_path, "G90 G71\nS20000 M3\nG1 X10 F600\nM30\n")
    (told,) = found.warnings
    assert (told.code, told.severity, told.line, told.column) == (
        "spindle-limited",
        "warning",
        2,
        1,
    )
    assert told.width == len("S20000")
    assert found.summary.spindle.at(0) == 12000.0


@pytest.mark.parametrize(
    ("dialect", "more", "speed"),
    [("fagor8070", "", 0.0), ("fagor8070", "speed = 900.0\n", 900.0), ("codesys", "", None)],
)
def test_a_start_without_s_stands_where_the_control_has_a_word_for_it(
    tmp_path: Path, dialect: str, more: str, speed: float | None
):
    found = dry_run(tmp_path, "N10 M3\nN20 G1 X10 F10\n", dialect, more)
    assert found.summary.spindle.at(0) == speed
