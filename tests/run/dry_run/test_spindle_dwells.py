"""The time that tool changes and the spindle take, against what the keys say."""

from pathlib import Path

import h5py
import numpy as np
import pytest

import twin
from twin.job.job_file import JobFile, ToolTable
from twin.machine.description.machine_file import SpindleTable
from twin.nc.canonical import Axes, Chunk, Dwell, Event, Function, Moves
from twin.nc.functions import SpindleState
from twin.run.dry_run.spindle_dwells import with_spindle_dwells

AXES = Axes(("X", "Y", "Z"), ("linear",) * 3)
TOOLS = (
    ToolTable(number=1, diameter=10.0),
    ToolTable(number=2, diameter=6.0, speed=4500.0),
)
SPINDLE = SpindleTable(tool_change_s=4.0, acceleration=6000.0)


def said(*words: str | tuple[str, float], spindle: SpindleTable = SPINDLE) -> list[Event]:
    """The events that come of functions; a pair is a word with its speed."""
    pairs = [(word, {}) if isinstance(word, str) else (word[0], {"S": word[1]}) for word in words]
    events = [Function(0, line, word, more) for line, (word, more) in enumerate(pairs, start=1)]
    job = JobFile(program="part.nc", tools=TOOLS)
    found: list[Event] = []
    # One chunk for each event: what is known is carried from one to the next.
    chunks = (Chunk(Moves.empty(AXES), (event,)) for event in events)
    for chunk in with_spindle_dwells(chunks, spindle, job, SpindleState()):
        found += chunk.events
    return found


def spindle_dwells(
    *words: str | tuple[str, float], spindle: SpindleTable = SPINDLE
) -> dict[int, float]:
    """Seconds by line."""
    return {e.line: e.seconds for e in said(*words, spindle=spindle) if isinstance(e, Dwell)}


def test_a_tool_change_takes_its_time_once():
    assert spindle_dwells("T2", "M6", "T2", "M6") == {2: 4.0}


def test_the_tool_that_is_in_the_spindle_is_not_changed():
    assert spindle_dwells("T1", "M6") == {}


def test_the_spindle_takes_the_change_of_its_speed():
    asked = (("M3", 6000.0), ("S", 9000.0), ("M3", 9000.0), "M8", ("M4", 3000.0), "M9", "M5")
    assert spindle_dwells(*asked) == pytest.approx({1: 1.0, 2: 0.5, 5: 2.0, 7: 0.5})


def test_a_change_stops_the_spindle_first_and_it_starts_anew_behind():
    asked = (("M3", 6000.0), "T2", "M6", "M3")
    assert spindle_dwells(*asked) == pytest.approx({1: 1.0, 3: 5.0, 4: 1.0})


def test_a_start_without_a_speed_takes_that_of_the_job_or_none():
    assert spindle_dwells("M3") == {}
    assert spindle_dwells("T2", "M6", "M3") == pytest.approx({2: 4.0, 3: 0.75})


def test_a_speed_alone_starts_nothing_and_the_end_is_not_waited_for():
    assert spindle_dwells(("S", 6000.0), "M5") == {}
    assert spindle_dwells(("M3", 6000.0), "M30") == pytest.approx({1: 1.0})


def test_a_path_that_goes_on_does_not_wait():
    event = Function(0, 3, "M3", {"S": 6000.0}, at=0.5)
    job = JobFile(program="part.nc")
    (chunk,) = with_spindle_dwells(
        [Chunk(Moves.empty(AXES), (event,))], SPINDLE, job, SpindleState()
    )
    assert list(chunk.events) == [event]


def test_without_the_keys_nothing_is_counted():
    assert spindle_dwells("T2", "M6", ("M3", 6000.0), spindle=SpindleTable()) == {}


PROGRAM = "G90 G71\nS6000 M3\nG0 X10\nM5\nT2 M6\nS3000 M4\nG1 X0 F600\nM30\n"


@pytest.mark.seconds("a program is run whole")
def test_a_run_counts_them_and_records_a_standstill(tmp_path: Path):
    (tmp_path / "part.nc").write_text(PROGRAM)
    job = 'program = "part.nc"\ndialect = "fagor8070"\nmachine = "{}"\n'
    tools = "".join(f"[[tools]]\nnumber = {number}\ndiameter = 6.0\n" for number in (1, 2))
    (tmp_path / "quick.toml").write_text(
        'base = "mill4"\nname = "quick"\n[spindle]\ntool_change_s = 0.0\nacceleration = 0.0\n'
    )
    seconds = {}
    for machine in ("mill4", "quick.toml"):
        (tmp_path / "part.toml").write_text(job.format(machine) + tools)
        done = twin.run(tmp_path / "part.toml", out=tmp_path / f"out {machine}")
        seconds[machine] = done.outcome.duration_s
    # 1 s to start, 1 s to stop, 4 s to change, 0.5 s to start again.
    assert seconds["mill4"] - seconds["quick.toml"] == pytest.approx(6.5, abs=0.002)
    with h5py.File(tmp_path / "out mill4" / "recording.h5") as recording:
        line = np.asarray(recording["line"])
        speed = np.abs(np.asarray(recording["setpoint/velocity"])).max(axis=1)
    assert np.sum((line == 5) & (speed == 0.0)) == pytest.approx(4000, abs=2)
