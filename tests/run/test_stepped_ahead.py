"""The machine is stepped one chunk ahead of who looks at it; an alarm finds all as if it were not."""

from pathlib import Path

import pytest

from twin import processor
from twin.files.shipped import resource_root
from twin.machine.simulation.simulate import simulate
from twin.motion.setpoints.sampling import settle
from twin.run.judging.outcome import Outcome
from twin.run.pipeline import cutting_forces, planned
from twin.run.preparing.preparation import prepare
from twin.run.progress import no_progress
from twin.run.run import Run

PROGRAM = """%AHEAD
N10 G90 G17 T1 S3000 M03
N20 G00 X-130 Y-15 Z50
N30 G00 Z-12
{}
N50 G01 X-150 F100
N60 G01 X-130 F100
N70 G00 Z50
N80 G00 X0 Y0
N90 G01 Z-45 F2000
N100 G01 Y12
N110 G00 Z50
N120 M30
"""
"""Goes past the vise in its second chunk of 16.384 s, and may go through the blank in its first."""

JOB = """program = "ahead.nc"
dialect = "fagor8070"
machine = "{}"
[part_zero]
Z = -460.0
[start]
Z = 50.0
[stock]
shape = "box"
size = [20.0, 10.0, 8.0]
position = [-100.0, -15.0, -7.0]
[[tools]]
number = 1
diameter = 10.0
length = 60.0
flute = 15.0
"""


def outcome(folder: Path, through: str, cores: int, monkeypatch: pytest.MonkeyPatch) -> Outcome:
    monkeypatch.setattr(processor, "available_cores", lambda: cores)
    (folder / "ahead.nc").write_text(PROGRAM.format(through))
    machine = resource_root("programs") / "alarms/machines/vise.toml"
    (folder / "ahead.toml").write_text(JOB.format(machine))
    run = Run(prepare(folder / "ahead.toml"))
    return run.execute(None, no_progress)


@pytest.mark.seconds("runs a job of two chunks on one core and on two")
def test_an_alarm_finds_nothing_of_what_was_stepped_beyond_it(tmp_path, monkeypatch):
    alone, beside = (
        outcome(tmp_path, "N40 G00 X-80\nN45 G00 X-130", cores, monkeypatch) for cores in (1, 2)
    )
    assert [alarm.code for alarm in beside.alarms] == ["rapid-into-stock"]
    assert beside.near_miss is None
    for name in (
        "verdict",
        "alarms",
        "near_miss",
        "warnings",
        "figures",
        "cut",
        "tools",
        "samples",
        "duration_s",
    ):
        assert repr(getattr(alone, name)) == repr(getattr(beside, name)), name


@pytest.mark.seconds("runs a job of two chunks")
def test_an_alarm_knows_nothing_of_what_was_stepped_behind_it_in_its_own_chunk(
    tmp_path, monkeypatch
):
    monkeypatch.setitem(globals(), "PROGRAM", PROGRAM.replace("F100\n", "F6000\n"))
    assert outcome(tmp_path, "N40 G01 X-130 F6000", 1, monkeypatch).near_miss is not None
    stopped = outcome(tmp_path, "N40 G00 X-80\nN45 G00 X-130", 1, monkeypatch)
    assert [alarm.code for alarm in stopped.alarms] == ["rapid-into-stock"]
    assert stopped.near_miss is None


@pytest.mark.seconds("steps a job whose cut is simulated to its end")
def test_what_a_process_raises_is_seen_however_far_the_machine_is_ahead():
    run = Run(prepare(resource_root("programs") / "alarms/fagor8070/spindle_stall.toml"))
    summary = run.dry_run.summary
    setpoints = settle(
        planned(run.dry_run.program, run.preparation), run.machine.file.servo_period_s
    )
    process = cutting_forces(run.preparation, summary).process
    simulation = simulate(run.machine, run.model, setpoints, summary.tools, process=process)
    *_, last = simulation.watched(list(simulation.stepped()))
    assert simulation.alarm is not None
    assert simulation.alarm.code == "spindle-stall"
    assert last.setpoint.time[-1] == simulation.alarm.time_s


@pytest.mark.seconds("runs a job of two chunks")
def test_what_comes_later_is_seen_when_its_time_comes(tmp_path, monkeypatch):
    assert outcome(tmp_path, "N40 G01 X-130 F100", 2, monkeypatch).near_miss is not None
