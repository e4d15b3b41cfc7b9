import itertools

import numpy as np
import pytest

from tests.machine.machine_fixtures import PERIOD, line, ramp_up, setpoints, shipped_machine
from twin.columns import join
from twin.job.fixture import FixtureTable
from twin.job.job_file import ToolTable
from twin.machine.description.config import MachineConfig
from twin.machine.description.machine_file import MachineFile
from twin.machine.model.model import MachineModel, build_spec, clearance_model
from twin.machine.simulation.simulate import simulate
from twin.machine.watching.clearance import NEAR_STEP, TOUCH, Clearance
from twin.motion.setpoints.setpoints import Setpoints
from twin.recording.alarms import Alarm
from twin.recording.reader import Samples


def with_fixture(machine: MachineConfig, size, position) -> MachineConfig:
    jaw = FixtureTable(name="vise jaw", size=size, position=position)
    return MachineConfig(
        machine.path,
        MachineFile.model_validate(
            machine.file.model_dump(by_alias=True) | {"fixtures": [jaw.model_dump()]}
        ),
    )


def moves(*points: tuple[float, ...], speed: float = 100.0) -> Setpoints:
    """Straight moves between points, each from rest to rest."""
    columns: list[list[np.ndarray]] = [[], [], []]
    for start, end in itertools.pairwise(points):
        delta = np.array(end, float) - start
        seconds = max(0.3, np.abs(delta).max() / speed)
        time = np.arange(0, seconds, PERIOD)
        shape = ramp_up(time, 1.0, seconds)
        share = [value / (seconds / 2) for value in shape]
        half = len(time) // 2
        up = [value[:half] for value in share]
        distance, velocity, acceleration = up
        span = distance[-1] * 2 + velocity[-1] * PERIOD
        columns[0].append(start + np.outer(np.r_[distance, span - distance[::-1]] / span, delta))
        columns[1].append(np.outer(np.r_[velocity, velocity[::-1]] / span, delta))
        columns[2].append(np.outer(np.r_[acceleration, -acceleration[::-1]] / span, delta))
    return setpoints(*(np.concatenate(column) for column in columns))


def alarm_of(machine: MachineConfig, points: Setpoints, tool=None) -> tuple[Alarm, Samples]:
    simulation = simulate(machine, MachineModel(machine, tool), [points])
    *_, last = list(simulation)
    assert simulation.alarm is not None
    assert last.setpoint.time[-1] == simulation.alarm.time_s
    assert last.setpoint.line[-1] == simulation.alarm.line
    return simulation.alarm, last


def test_an_axis_beyond_its_travel_runs_onto_its_limit_switch():
    machine = shipped_machine()
    points = moves((380.0, 0, 0, 0), (404.0, 0, 0, 0))
    alarm, last = alarm_of(machine, points)
    assert (alarm.code, alarm.axis) == ("hard-limit", "X")
    assert last.joint_position[-1, 0] > 402.0
    assert last.joint_position[:-1, 0].max() <= 402.0


def test_a_drive_at_its_limit_for_too_long_stops_the_machine():
    machine = shipped_machine(force_limit=2000.0, saturation_time_s=0.05)
    alarm, last = alarm_of(machine, line(1, 400.0, 1.0))
    assert (alarm.code, alarm.axis) == ("drive-saturation", "Y")
    at_limit = np.abs(last.drive_force[:, 1]) >= 2000.0
    assert at_limit[-51:].all()
    assert not at_limit[-52]


@pytest.mark.parametrize("size", [1, 7, 1000])
def test_saturation_is_counted_over_the_border_of_chunks(size):
    machine = shipped_machine(force_limit=2000.0, saturation_time_s=0.05)
    points = line(1, 400.0, 1.0)
    whole, _ = alarm_of(machine, points)
    chunks = [points[first : first + size] for first in range(0, len(points), size)]
    simulation = simulate(machine, MachineModel(machine), chunks)
    list(simulation)
    assert simulation.alarm == whole


def test_a_moment_at_the_limit_is_no_alarm():
    machine = shipped_machine(force_limit=2000.0, saturation_time_s=10.0, following_error_limit=0.0)
    simulation = simulate(machine, MachineModel(machine), [line(1, 400.0, 0.8)])
    (samples,) = simulation
    assert simulation.alarm is None
    assert np.abs(samples.drive_force).max() == 2000.0


def test_a_long_tool_meets_the_faceplate():
    machine = shipped_machine()
    tool = ToolTable(number=1, length=150.0, flute=20.0)
    points = moves((0, 0, -300.0, 0), (0, 0, -540.0, 0))
    alarm, last = alarm_of(machine, points, tool)
    assert alarm.code == "collision"
    assert "the cutter meets the faceplate" in alarm.message
    before, at_last = last.joint_position[-2:, 2]
    assert before > -(620.0 - 150.0) - TOUCH > at_last


def test_a_cutter_may_come_close_to_the_table_without_a_near_miss():
    machine = shipped_machine()
    tool = ToolTable(number=1, length=80.0, flute=25.0)
    simulation = simulate(
        machine, MachineModel(machine, tool), [moves((0, 0, -300.0, 0), (0, 0, -539.95, 0))]
    )
    list(simulation)
    assert simulation.alarm is None
    assert simulation.near_miss is None


def test_the_holder_meets_a_fixture_that_turns_in_on_the_table():
    machine = with_fixture(shipped_machine(), (40.0, 20.0, 100.0), (120.0, 0.0, 0.0))
    there = (0.0, 120.0, -548.0, 0.0)
    alarm, last = alarm_of(machine, moves(there, (*there[:3], -180.0), speed=60.0))
    assert alarm.code == "collision"
    assert "vise jaw" in alarm.message
    assert -90.0 < last.joint_position[-1, 3] < -50.0
    away = simulate(machine, MachineModel(machine), [moves(there, (*there[:3], 30.0), speed=60.0)])
    list(away)
    assert away.alarm is None


def test_a_near_miss_is_reported_with_its_distance():
    machine = with_fixture(shipped_machine(), (40.0, 40.0, 100.0), (150.0, 0.0, 0.0))
    points = moves(
        (300.0, 0, -548.0, 0), (300.0, 0, -548.0, 0), (239.0, 0, -548.0, 0), (300.0, 0, -548.0, 0)
    )
    simulation = simulate(machine, MachineModel(machine), [points])
    list(simulation)
    assert simulation.alarm is None
    miss = simulation.near_miss
    assert miss is not None
    closest = 239.0 - 170.0 - 66.0
    assert miss.clearance_mm == pytest.approx(closest, abs=2 * NEAR_STEP)
    assert miss.between == ("spindle nose", "vise jaw")


def test_chunks_do_not_change_when_a_collision_is_seen():
    machine = with_fixture(shipped_machine(), (40.0, 40.0, 100.0), (150.0, 0.0, 0.0))
    points = moves((300.0, 0, -548.0, 0), (150.0, 0, -548.0, 0))
    whole, _ = alarm_of(machine, points)
    simulation = simulate(
        machine, MachineModel(machine), [points[i : i + 13] for i in range(0, len(points), 13)]
    )
    list(simulation)
    assert simulation.alarm == whole


def test_looks_are_few_and_yet_none_is_missed():
    """The clearance at every sample, against what the sparse looks found."""
    machine = with_fixture(shipped_machine(), (30.0, 30.0, 90.0), (60.0, 80.0, 0.0))
    points = moves(
        (200, 150, -400, 0), (-100, 100, -500, 90), (-100, -150, -545, 0), (100, -100, -530, 45)
    )
    model = clearance_model(machine, build_spec(machine))
    (samples,) = simulate(machine, MachineModel(machine), [points])
    watched = Clearance(machine, model)
    told = np.flatnonzero(np.isfinite(watched._near)).tolist()
    every = [
        min(watched._measure(pair, row)[0] for pair in told) for row in samples.joint_position[::25]
    ]
    looks = 0
    measure = watched._measure

    def counted(pair, position, place=None):
        nonlocal looks
        looks += 1
        return measure(pair, position, place)

    watched._measure = counted
    assert watched.look(samples) is None
    assert min(every) > 0
    assert looks < len(samples) / 20
    if watched.near_miss is not None:
        assert watched.near_miss.clearance_mm == pytest.approx(min(every), abs=2 * NEAR_STEP)
    else:
        assert min(every) > machine.file.collision.near_miss - 2 * NEAR_STEP
    assert join([samples.setpoint]).time[0] == 0.0
