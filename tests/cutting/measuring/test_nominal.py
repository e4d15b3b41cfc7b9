"""A tool that cuts into the nominal part: seen, in its line, and judged as the job chooses."""

import shutil
from pathlib import Path

import pytest

from twin import api
from twin.errors import ConfigError
from twin.files.shipped import resource_root
from twin.job.load import load_job

pytestmark = pytest.mark.seconds("a program is run and its part cut")

SHIPPED = resource_root("programs") / "alarms" / "fagor8070"


def job(folder: Path, *changes: tuple[str, str]) -> Path:
    for name in ("gouge.nc", "gouge.stl", "gouge.toml"):
        shutil.copy(SHIPPED / name, folder / name)
    for name in ("gouge.nc", "gouge.toml"):
        text = (folder / name).read_text(encoding="utf-8")
        for old, new in changes:
            text = text.replace(old, new)
        (folder / name).write_text(text, encoding="utf-8")
    return folder / "gouge.toml"


def test_an_alarm_stops_where_the_cut_is_too_deep(tmp_path: Path):
    outcome = api.run(job(tmp_path), out=tmp_path / "out").outcome
    assert outcome.verdict.outcome == "alarm"
    (alarm,) = outcome.alarms
    assert (alarm.code, alarm.line) == ("gouge", 6)
    assert outcome.final_simulated[2] == pytest.approx(-5.1, abs=0.03)


def test_a_tolerance_fails_with_depth_and_line_of_the_deepest_place(tmp_path: Path):
    found = api.run(job(tmp_path, ('gouge = "alarm"', 'gouge = "fail"')), out=tmp_path / "out")
    verdict = found.outcome.verdict
    assert verdict.outcome == "fail"
    (reason,) = verdict.reasons
    assert reason.what == "gouge_um"
    assert "gouge into the nominal part 3000.0 µm exceeds gouge_um = 100" in reason.message
    assert reason.line in (6, 7)
    assert found.outcome.gouge is not None
    assert found.outcome.gouge.place[2] == pytest.approx(-8.0, abs=1e-3)


@pytest.mark.parametrize(
    "changes",
    [
        (("Z-8", "Z-5"),),
        (("Z-8", "Z-5.05"),),
        (("Z-8", "Z-5.2"), ("[nominal]", "[nominal]\ngouge_um = 300.0")),
    ],
    ids=["as drawn", "half of what is allowed", "more is allowed"],
)
def test_what_the_job_allows_passes(tmp_path: Path, changes: tuple[tuple[str, str], ...]):
    outcome = api.run(job(tmp_path, *changes), out=tmp_path / "out").outcome
    assert outcome.verdict.outcome == "pass"
    assert outcome.gouge is None


def test_a_wall_is_gouged_in_its_line(tmp_path: Path):
    beside = ("X60\nN70 G00", "X60 Y3\nN70 G00")
    outcome = api.run(job(tmp_path, ("Z-8", "Z-5"), beside), out=tmp_path / "out").outcome
    (alarm,) = outcome.alarms
    assert (alarm.code, alarm.line) == ("gouge", 7)


@pytest.mark.parametrize("aside", [0.05, 0.15])
def test_a_gouge_into_a_wall_is_seen_closer_than_by_cells(tmp_path: Path, aside: float):
    beside = ("X60\nN70 G00", f"X60 Y{2 * aside}\nN70 G00")
    outcome = api.run(job(tmp_path, ("Z-8", "Z-5"), beside), out=tmp_path / "out").outcome
    assert [alarm.code for alarm in outcome.alarms] == ["gouge"] * (aside > 0.1)


def test_the_part_of_a_run_is_accepted_as_nominal_and_what_is_left_on_it_is_not(tmp_path: Path):
    zero = ("[stock]", "[part_zero]\nX = 13.0\nY = -7.0\nZ = -260.0\n\n[stock]")
    deep = ('gouge = "alarm"', "gouge_um = 5000.0")
    first = api.run(job(tmp_path, zero, deep, ('expect = "gouge"', "")), out=tmp_path / "out")
    assert first.outcome.verdict.outcome == "pass"
    own = ('"gouge.stl"', '"out/part.stl"')
    close = ('gouge = "alarm"', "gouge_um = 5.0\nstanding_um = 5.0")
    again = api.run(job(tmp_path, zero, own, close), out=tmp_path / "again").outcome
    assert again.verdict.outcome == "pass"
    less = api.run(job(tmp_path, zero, own, close, ("Z-8", "Z-7.9")), out=tmp_path / "less").outcome
    (reason,) = less.verdict.reasons
    assert reason.what == "standing_um"
    assert reason.message.startswith("material left on the nominal part 100.0 µm exceeds")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ((("gouge.stl", "nothing.stl"),), "nothing.stl"),
        ((("[stock]", "[video]"), ('shape = "box"', ""), ("size = [100.0, 60.0, 30.0]", "")),
         "a nominal part needs a"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused(
    tmp_path: Path, changes: tuple[tuple[str, str], ...], message: str
):
    with pytest.raises(ConfigError, match=message):
        api.run(load_job(job(tmp_path, *changes)).path or tmp_path, out=tmp_path / "out")
