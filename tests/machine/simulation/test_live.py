"""A machine in slices: the same motion, alarms that latch, faults that come while it moves."""

import copy
import dataclasses
import doctest

import numpy as np
import pytest

import twin.machine.simulation.live
from tests.machine.machine_fixtures import PERIOD, circle, line, setpoints, shipped_machine
from twin.errors import ConfigError
from twin.files.shipped import machine_file
from twin.job.fixture import FixtureTable
from twin.job.job_file import ToolTable
from twin.machine.description.config import MachineConfig
from twin.machine.load import read_machine
from twin.machine.model.model import MachineModel, build_spec, drives
from twin.machine.simulation.live import LiveMachine
from twin.machine.simulation.simulate import simulate
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.recording.alarms import AlarmStandsError
from twin.recording.reader import Samples
from twin.units import MM


def after(live: LiveMachine, points: Setpoints) -> Setpoints:
    """Setpoints moved to where and when the machine is."""
    last = live.setpoint
    shift = last.position[0] - points.position[0]
    return Setpoints(
        points.time + last.time[0], points.line, points.move, points.fraction,
        points.position + shift, points.velocity, points.acceleration,
    )[1:]  # fmt: skip


def positions(parts: list[Samples]) -> FloatArray:
    return np.concatenate([part.joint_position for part in parts])


def test_the_example_holds():
    assert doctest.testmod(twin.machine.simulation.live).failed == 0
    assert doctest.testmod(twin.machine.simulation.live).attempted > 5


@pytest.mark.parametrize("size", [1, 4, 37])
@pytest.mark.parametrize("name", ["mill4", "mill4_light", "mill4a"])
def test_slices_move_bit_for_bit_as_one_run(name, size):
    machine = read_machine(machine_file(name))
    points = circle(10.0, 2000.0, 0.5)
    points.position[:, 2] -= 50.0
    whole = positions(list(simulate(machine, MachineModel(machine), [points])))
    live = LiveMachine(machine, position=points.position[0])
    parts = [live.follow(points[i : i + size]) for i in range(1, len(points), size)]
    assert live.alarm is None
    assert np.array_equal(positions(parts), whole[1:])
    assert np.array_equal(live.position, whole[-1])


def test_an_alarm_latches_and_the_machine_is_where_it_was_raised():
    live = LiveMachine(shipped_machine(following_error_limit=0.5))
    points = line(0, 200.0, 0.6)
    samples = live.follow(points[1:])
    assert live.alarm is not None
    assert live.alarm.code == "following-error"
    assert len(samples) < len(points) - 1
    assert samples.setpoint.time[-1] == live.alarm.time_s == live.setpoint.time[0]
    assert np.array_equal(live.position, samples.joint_position[-1])
    with pytest.raises(AlarmStandsError, match="following-error has not been cleared"):
        live.follow(after(live, points))
    with pytest.raises(AlarmStandsError, match="X still moves"):
        live.clear()


def test_braking_takes_the_axis_to_rest_at_its_acceleration():
    live = LiveMachine(shipped_machine(acceleration=2000.0))
    live.follow(line(0, 300.0, 0.5)[1:])
    before = live.setpoint.position[0, 0]
    parts = [live.brake(10) for _ in range(40)]
    way = parts[-1].setpoint.position[-1, 0] - before
    assert way == pytest.approx(300.0**2 / 2 / 2000.0)
    assert live.position[0] == pytest.approx(before + way, abs=1e-3)
    assert np.abs(live.velocity).max() < 0.01
    speeds = np.concatenate([part.setpoint.velocity[:, 0] for part in parts])
    assert np.diff(speeds).min() == pytest.approx(-2000.0 * PERIOD)
    assert np.allclose(np.diff(np.concatenate([p.setpoint.time for p in parts])), PERIOD)


def rest(live: LiveMachine) -> None:
    for _ in range(20):
        live.brake(50)


def test_an_axis_may_leave_its_limit_switch_after_the_alarm_is_cleared_but_go_no_further():
    live = LiveMachine(shipped_machine(), position=np.array([380.0, 0.0, 0.0, 0.0]))
    live.follow(after(live, line(0, 100.0, 0.5)))
    assert live.alarm is not None
    assert live.alarm.code == "hard-limit"
    rest(live)
    live.clear()
    assert live.position[0] > 402.0
    live.follow(after(live, line(0, 20.0, 0.3)))
    assert live.alarm is not None
    assert live.alarm.code == "hard-limit"
    rest(live)
    live.clear()
    live.follow(after(live, line(0, -100.0, 0.5)))
    assert live.alarm is None
    assert live.position[0] < 402.0
    live.hold(500)
    live.follow(after(live, line(0, 100.0, 0.5)))
    assert live.alarm is not None


def with_jaw(machine: MachineConfig) -> MachineConfig:
    jaw = FixtureTable(name="vise jaw", size=(40.0, 40.0, 100.0), position=(150.0, 0.0, 0.0))
    return MachineConfig(machine.path, machine.file.model_copy(update={"fixtures": (jaw,)}))


def test_what_has_met_may_be_driven_apart_but_not_deeper():
    live = LiveMachine(with_jaw(shipped_machine()), position=np.array([300.0, 0.0, -548.0, 0.0]))
    live.follow(after(live, line(0, -100.0, 2.0)))
    assert live.alarm is not None
    assert live.alarm.code == "collision"
    rest(live)
    live.clear()
    live.follow(after(live, line(0, -20.0, 0.5)))
    assert live.alarm is not None
    assert live.alarm.code == "collision"
    rest(live)
    live.clear()
    live.follow(after(live, line(0, 100.0, 0.6)))
    assert live.alarm is None
    live.hold(300)
    live.follow(after(live, line(0, -100.0, 2.0)))
    assert live.alarm is not None


def test_the_first_alarm_counts_and_one_from_outside_stops_the_machine_too():
    live = LiveMachine(shipped_machine())
    live.hold(10)
    live.raise_alarm("emergency-stop", "the button")
    live.raise_alarm("rapid-into-stock", "later")
    assert live.alarm is not None
    assert (live.alarm.code, live.alarm.time_s) == ("emergency-stop", pytest.approx(0.01))
    with pytest.raises(AlarmStandsError):
        live.hold(1)
    live.clear()
    assert live.hold(3).setpoint.time[-1] == pytest.approx(0.013)


def test_a_cleared_machine_holds_still_where_it_stands():
    """Also where the weight hangs on the drive, and where the transmission gives."""
    for fields in (
        {"counterbalance": 0.0},
        {"counterbalance": 0.0, "reset_time_s": 0.02},
        {"counterbalance": 0.5, "backlash": 0.02, "dry_friction": 100.0},
    ):
        live = LiveMachine(shipped_machine(**fields))
        live.follow(line(2, -50.0, 0.5)[1:])
        rest(live)
        stood = live.position
        live.raise_alarm("emergency-stop", "the button")
        live.clear()
        live.hold(500)
        assert np.abs(live.position - stood).max() < 1e-3, fields


def test_friction_that_sets_in_adds_to_the_lag_from_then_on():
    machine = shipped_machine()
    live = LiveMachine(machine)
    points = line(0, 50.0, 2.0)
    lag = 50.0 / 125.0
    first = live.follow(points[1:1000])
    assert first.setpoint.position[-1, 0] - first.joint_position[-1, 0] == pytest.approx(lag)
    live.change("X", dry_friction=800.0)
    second = live.follow(points[1000:])
    loop = drives(machine, build_spec(machine).compile())[0]
    trail = (second.setpoint.position - second.joint_position)[:, 0]
    assert trail[-1] == pytest.approx(lag + 800.0 / loop.position_gain / MM, abs=1e-5)
    assert trail[0] == pytest.approx(lag + 800.0 / loop.moved * PERIOD**2 / 2 / MM, abs=1e-4)
    assert live.machine.axis("X").dry_friction == 800.0
    live.repair()
    assert live.machine is machine


@pytest.mark.parametrize(
    "fields",
    [
        {"backlash": 0.05, "dry_friction": 300.0},
        {"stiffness": 30_000.0},
        {"kv": 3.0},
        {"reset_time_s": 0.05},
        {"force_limit": 3000.0},
        {"dry_friction": 100.0, "lugre": {"stiffness": 20_000.0, "damping": 200.0}},
    ],
)
def test_a_fault_that_sets_in_moves_nothing_by_itself_and_can_be_repaired(fields):
    live = LiveMachine(shipped_machine())
    live.follow(line(0, 50.0, 0.5)[1:])
    before, speed = live.position, live.velocity
    live.change("X", **fields)
    assert live.hold(1).joint_position[0] == pytest.approx(before + speed * PERIOD, abs=0.01)
    live.hold(1000)
    stood = live.position
    live.repair()
    live.hold(1)
    assert live.position == pytest.approx(stood, abs=0.01)


def test_a_dull_drive_trails_more():
    live = LiveMachine(shipped_machine())
    live.change("Y", kv=2.5)
    samples = live.follow(line(1, 50.0, 2.0)[1:])
    trail = (samples.setpoint.position - samples.joint_position)[-1, 1]
    assert trail == pytest.approx(3 * 50.0 / 125.0)


@pytest.mark.parametrize(
    ("axis", "fields", "message"),
    [
        ("W", {"kv": 3.0}, "mill4 has the axes X, Y, Z, C"),
        ("X", {"fricton": 3.0}, r"unknown key 'axes\.X\.fricton'"),
        ("X", {"dry_friction": -3.0}, r"'axes\.X\.dry_friction'"),
        ("X", {"joint": "Y"}, r"axes\.X\.joint cannot change while the machine runs"),
        ("X", {"kv": 2000.0}, r"kv up to .* works"),
    ],
)
def test_a_fault_that_makes_no_sense_changes_nothing(axis, fields, message):
    live = LiveMachine(shipped_machine())
    with pytest.raises(ConfigError, match=message):
        live.change(axis, **fields)
    assert live.machine.file == shipped_machine().file
    live.hold(5)


def test_another_tool_has_other_collisions():
    live = LiveMachine(shipped_machine(), position=np.array([0.0, 0.0, -400.0, 0.0]))
    down = after(live, line(2, -100.0, 1.1))
    live.mount(ToolTable(number=1, length=150.0, flute=20.0))
    live.follow(down)
    assert live.alarm is not None
    assert "the cutter meets the faceplate" in live.alarm.message


def test_nothing_to_follow_is_nothing_done():
    live = LiveMachine(shipped_machine())
    assert len(live.hold(0)) == 0
    still = np.zeros((0, 4))
    assert len(live.follow(setpoints(still, still, still))) == 0
    assert np.array_equal(live.position, np.zeros(4))


def test_a_copy_moves_as_the_machine_does_a_few_periods_at_a_time():
    live = LiveMachine(read_machine(machine_file("mill4")))
    live.hold(20)
    setpoint = live.setpoint
    speed = setpoint.velocity.copy()
    speed[0, 0] = 5.0
    moved = dataclasses.replace(setpoint, time=setpoint.time + 0.001, velocity=speed)
    live.follow(moved)
    copied = copy.deepcopy(live)
    for _ in range(5):
        ours, theirs = live.hold(3), copied.hold(3)
        assert np.array_equal(ours.joint_position, theirs.joint_position)
