"""The machine unit by itself: it moves as ``twin run`` does, to the last bit."""

import numpy as np
import pytest

from tests.fmu.recorded import START, Recorded
from twin.files.shipped import machine_file
from twin.fmu.machine_unit import MachineUnit
from twin.machine.load import read_machine
from twin.recording.alarms import SimulationError


@pytest.mark.seconds("a program is run whole, and its machine stepped period by period")
def test_a_unit_moves_as_the_run_does(recorded: Recorded) -> None:
    unit = MachineUnit(read_machine(machine_file("mill4")))
    unit.start = np.array(START)
    unit.begin()
    for row in range(len(recorded.position)):
        unit.position = recorded.position[row].copy()
        unit.velocity = recorded.velocity[row].copy()
        unit.acceleration = recorded.acceleration[row].copy()
        unit.step(unit.period_s)
        assert unit.joint_position.tobytes() == recorded.joint_position[row].tobytes(), row
        assert unit.joint_velocity.tobytes() == recorded.joint_velocity[row].tobytes(), row
        assert unit.force.tobytes() == recorded.force[row].tobytes(), row


@pytest.mark.parametrize("name", ["mill3", "mill4a", "mill5", "mill5h"])
def test_a_unit_has_the_axes_of_its_machine(name: str) -> None:
    machine = read_machine(machine_file(name))
    unit = MachineUnit(machine)
    unit.start = np.where(np.array(machine.axes.names) == "Z", -100.0, 0.0)
    unit.begin()
    for tick in range(400):
        unit.position = unit.start + 2.0 * min(1.0, tick / 300.0) ** 3
        unit.step(unit.period_s)
    assert unit.alarm == ""
    assert unit.joint_position == pytest.approx(unit.start + 2.0, abs=0.05)


def test_an_alarm_is_latched_and_brakes() -> None:
    unit = MachineUnit(read_machine(machine_file("mill4")))
    unit.begin()
    speed = place = 0.0
    while not unit.alarm:
        speed = min(speed + 1.0, 250.0)
        place += speed * unit.period_s
        unit.position, unit.velocity = np.array([[place, 0, 0, 0], [speed, 0, 0, 0]])
        unit.step(unit.period_s)
    assert unit.alarm == "hard-limit"
    assert unit.joint_velocity[0] > 200.0
    for _ in range(500):
        unit.step(unit.period_s)
    assert unit.alarm == "hard-limit"
    assert np.abs(unit.joint_velocity).max() < 0.01


def test_only_the_servo_period_is_a_step() -> None:
    unit = MachineUnit(read_machine(machine_file("mill4")))
    with pytest.raises(SimulationError, match="not switched on"):
        unit.step(0.001)
    unit.begin()
    with pytest.raises(SimulationError, match=r"servo period, 0\.001 s"):
        unit.step(0.01)
    unit.position[1] = np.nan
    with pytest.raises(SimulationError, match="finite"):
        unit.step(0.001)
