"""Each alarm has a program that provokes it, with the line, the axis and what is kept."""

import json
from collections.abc import Iterator
from pathlib import Path

import h5py
import pytest
from command_line import Twin

from twin.check.runner import check_program
from twin.check.task import CheckSettings
from twin.commands.runs.pictures import ALARMS_OF_CONTACT
from twin.files.shipped import resource_root
from twin.run.preparing.preparation import prepare
from twin.run.progress import no_progress
from twin.run.results import result_of
from twin.run.run import Run

pytestmark = pytest.mark.seconds("each program is run up to its alarm, and that is drawn")

FOLDER = resource_root("programs") / "alarms" / "fagor8070"
EXPECTED = {
    "soft_limit": ("soft-limit", 5, "X would go to 450.000 mm"),
    "soft_limit_arc": ("soft-limit", 4, "X would go to 440.000 mm"),
    "hard_limit": ("hard-limit", 4, "X ran onto its limit switch at 402.0"),
    "following_error": ("following-error", 5, "X trails its setpoint by 3.0"),
    "drive_saturation": ("drive-saturation", 5, "the drive of Y has been at its limit of 3500 N"),
    "collision_faceplate": ("collision", 5, "the cutter meets the faceplate"),
    "collision_vise": ("collision", 6, "the holder's nut meets the fixed jaw"),
    "collision_second_tool": ("collision", 9, "the holder's nut meets the "),
    "collision_tool_change": (
        "collision",
        6,
        "a tool of 140 mm comes into the spindle: the cutter meets the fixed jaw (20.00 mm deep)",
    ),
    "collision_change_in_part": (
        "collision",
        5,
        "tool 2, 130 mm long, comes into the spindle 20.00 mm deep in the part",
    ),
    "collision_drill": ("collision", 4, "the cutter meets the faceplate"),
    "collision_flank": ("collision", 5, "the cutter meets the jaw"),
    "collision_holder": ("collision", 11, "the holder of tool 1 meets the part (8.00 mm deep)"),
    "collision_shank": ("collision", 8, "the shank of tool 1 meets the part (6.00 mm deep)"),
    "collision_gantry": ("collision", 4, "the block meets the gantry's beam"),
    "collision_column": ("collision", 4, "the stock meets the column"),
    "collision_table_motor": ("collision", 4, "the rotary table's motor meets the stop"),
    "collision_parallel": ("collision", 4, "the cutter meets the parallel 2"),
    "collision_turning_clamp": ("collision", 5, "the cutter meets the clamp"),
    "rapid_into_stock": (
        "rapid-into-stock",
        6,
        "a rapid drives tool 1 3.00 mm deep into the stock",
    ),
    "gouge": ("gouge", 6, "tool 1 cuts 0.10 mm deep into the nominal part"),
    "tool_broken": ("tool-broken", 5, "tool 1 broke: a chip of "),
    "spindle_stall": ("spindle-stall", 6, "the cut stalled the spindle: it asks for "),
    "spindle_overload": (
        "spindle-overload",
        6,
        "the load of the spindle was above 100 % for 5.0 s",
    ),
    "spindle_off": ("spindle-off", 10, "tool 1 feeds 3.00 mm deep into the stock with the spindle"),
}
FIRST_LINE_AFTER = {"collision_change_in_part": 7}
"""The move before which a tool change is an alarm."""
NO_ALARM = "near_miss"
TOLD_EVERY_DAY = {"soft_limit", "collision_holder", "tool_broken", "gouge"}


def test_every_program_has_its_expectation():
    assert {path.stem for path in FOLDER.glob("*.nc")} == {*EXPECTED, NO_ALARM}


def test_a_near_miss_is_told_and_stops_nothing(twin: Twin, tmp_path: Path):
    done = twin("run", FOLDER / f"{NO_ALARM}.toml", "--out", tmp_path)
    assert done.code == 0, done.stderr
    assert (
        "near_miss.nc:6:1: warning near-miss: the holder's nut passes the fixed jaw" in done.stderr
    )
    result = json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))
    assert result["alarms"] == []
    assert result["near_miss"]["line"] == 6
    assert result["near_miss"]["between"] == ["holder's nut", "fixed jaw"]
    assert result["near_miss"]["clearance_mm"] == pytest.approx(30.0 - 12.0 - 16.0, abs=0.1)


@pytest.mark.parametrize(
    ("spindle", "code"),
    [("", 0), ("M03", 4), ("M13", 3), ("S500", 4), ("M04 S500", 0), ("S0 M03", 4), ("M19", 4)],
)
def test_a_program_that_speaks_of_the_spindle_is_held_to_it(
    tmp_path: Path, spindle: str, code: int
):
    """One that never does runs with it turning; neither a speed alone nor M3 alone starts it."""
    text = f"%A\nG90 G17 T1 {spindle}\nG00 X-60 Y0 Z20\nG01 Z-3 F1000\nG01 X60\nM30\n"
    (tmp_path / "a.nc").write_text(text)
    job = (FOLDER / "spindle_off.toml").read_text(encoding="utf-8")
    job = job.replace("spindle_off.nc", "a.nc").replace('expect = "spindle-off"', "")
    (tmp_path / "a.toml").write_text(job)
    done = check_program(tmp_path / "a.toml", CheckSettings())
    told = "\n".join(map(str, done.findings))
    assert done.exit_code == code, told
    assert ("a.nc:5:1: error spindle-off" in told) == (code == 4)


@pytest.mark.parametrize("behind", ["", "N50 T1 M06\nN60 M03\nN65 G01 Z30 F500\n"])
def test_a_tool_that_leaves_the_part_without_a_move_has_stood_in_it(tmp_path: Path, behind: str):
    name = "collision_change_in_part"
    text = (FOLDER / f"{name}.nc").read_text(encoding="utf-8")
    (tmp_path / "a.nc").write_text(f"{text.partition('N50')[0]}{behind}N70 M30\n")
    job = (FOLDER / f"{name}.toml").read_text(encoding="utf-8")
    job = job.replace(f"{name}.nc", "a.nc").replace('expect = "collision"', "")
    (tmp_path / "a.toml").write_text(job)
    done = check_program(tmp_path / "a.toml", CheckSettings())
    assert done.exit_code == 4
    assert "a.nc:5:1: error collision" in "\n".join(map(str, done.findings))


@pytest.mark.parametrize("name", sorted(EXPECTED))
def test_the_alarm_is_raised_at_its_line(name: str):
    code, line, message = EXPECTED[name]
    run = Run(prepare(FOLDER / f"{name}.toml"))
    outcome = run.execute(None, no_progress)
    assert outcome.verdict.outcome == "alarm"
    assert [reason.what for reason in outcome.verdict.reasons] == [code], "nothing else is wrong"
    (alarm,) = outcome.alarms
    assert (alarm.code, alarm.line) == (code, line)
    assert alarm.message.startswith(message)
    never_run = [each.what for each in outcome.scope.not_watched if "the alarm" in each.why]
    ran = "every line" if code == "soft-limit" else f"all behind line {line}"
    assert never_run == [ran] * alarm.stops
    if alarm.stops:
        ran = FIRST_LINE_AFTER.get(name, line)
        assert {number for number in _lines(result_of(run, outcome)) if number > ran} == set()
        assert outcome.gouge is None or outcome.gouge.time_s == alarm.time_s


def _lines(content: object) -> Iterator[int]:
    """The lines that a result speaks of."""
    if isinstance(content, dict):
        for key, value in content.items():
            if key in ("line", "worst_line") and isinstance(value, int):
                yield value
            yield from _lines(value)
    elif isinstance(content, list | tuple):
        for value in content:
            yield from _lines(value)


def test_a_part_that_an_alarm_left_unfinished_is_not_judged(tmp_path: Path):
    (tmp_path / "a.nc").write_text((FOLDER / "gouge.nc").read_text(encoding="utf-8"))
    job = (FOLDER / "gouge.toml").read_text(encoding="utf-8").replace("gouge.nc", "a.nc")
    job = job.replace('"gouge.stl"', f'"{FOLDER}/gouge.stl"')
    job = job.replace("[nominal]", "[nominal]\nstanding_um = 100.0")
    (tmp_path / "a.toml").write_text(job + "\n[tolerance]\ncycle_time_s = 1.0\n")
    outcome = Run(prepare(tmp_path / "a.toml")).execute(None, no_progress)
    assert [reason.what for reason in outcome.verdict.reasons] == ["gouge"]
    assert {check.what for check in outcome.verdict.checks} == {"contour_um"}
    assert outcome.inspection is None
    assert outcome.gouge is not None
    assert outcome.gouge.depth_mm == pytest.approx(0.1, abs=2e-3)


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=() if name in TOLD_EVERY_DAY else pytest.mark.thorough)
        for name in sorted(EXPECTED)
    ],
)
def test_the_alarm_is_told_and_drawn_and_the_recording_up_to_it_is_kept(
    twin: Twin, tmp_path: Path, name: str
):
    code, line, message = EXPECTED[name]
    done = twin("run", FOLDER / f"{name}.toml", "--out", tmp_path)
    assert done.code == 4, done.stderr
    assert f"{name}.nc:{line}:" in done.stderr
    assert f"error {code}: {message}" in done.stderr
    assert "Traceback" not in done.stderr
    result = json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))
    assert result["verdict"] == "alarm"
    assert [reason["what"] for reason in result["reasons"]] == [code], "nothing else is wrong"
    (alarm,) = result["alarms"]
    assert (alarm["code"], alarm["line"]) == (code, line)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    drawn = f"<figcaption>Line {line}, " in page and (tmp_path / "collision.png").is_file()
    untold = "no picture of the alarm: " not in done.stderr
    assert drawn == (code in ALARMS_OF_CONTACT and untold)
    if code == "soft-limit":
        assert alarm["time_s"] == 0.0
        assert not (tmp_path / "recording.h5").exists()
        return
    with h5py.File(tmp_path / "recording.h5") as file:
        time, lines = file["time"], file["line"]
        assert isinstance(time, h5py.Dataset)
        assert isinstance(lines, h5py.Dataset)
        if code == "tool-broken":
            assert time[-1] > alarm["time_s"], "the machine goes on without an edge"
            return
        assert time[-1] == pytest.approx(alarm["time_s"])
        assert lines[-1] == FIRST_LINE_AFTER.get(name, line)
