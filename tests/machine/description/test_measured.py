"""What is measured at a real machine rather than derived: mass, constant force."""

import numpy as np
import pytest

from tests.machine.machine_fixtures import line, shipped_machine
from twin.errors import ConfigError
from twin.files.shipped import machine_file
from twin.machine.circle.circular_test import circular_test
from twin.machine.load import read_machine
from twin.machine.model.model import build_spec, drives, physics_model
from twin.machine.simulation.simulate import simulate


@pytest.mark.parametrize(("axis", "mass"), [("X", 95.1), ("X", 2000.0), ("Y", 700.0), ("C", 3.0)])
def test_the_motor_feels_the_measured_mass(axis: str, mass: float) -> None:
    machine = read_machine(machine_file("mill4")).changed(axis, mass=mass)
    felt = {
        name: drive.moved
        for name, drive in zip(
            machine.axes.names, drives(machine, build_spec(machine).compile()), strict=True
        )
    }
    assert felt[axis] == pytest.approx(mass, rel=1e-9)


def test_masses_of_an_axis_and_of_the_one_that_carries_it_both_hold() -> None:
    machine = read_machine(machine_file("mill4")).changed("X", mass=300.0).changed("Y", mass=900.0)
    felt = [drive.moved for drive in drives(machine, build_spec(machine).compile())]
    assert felt[:2] == pytest.approx([300.0, 900.0], rel=1e-9)


def test_a_mass_below_what_the_axis_carries_is_refused() -> None:
    machine = read_machine(machine_file("mill4")).changed("X", mass=20.0)
    with pytest.raises(ConfigError, match=r"axes\.X\.mass = 20 is less than"):
        build_spec(machine)


def test_a_mass_does_not_say_what_lies_before_a_spring() -> None:
    with pytest.raises(ConfigError, match="motor_inertia"):
        read_machine(machine_file("mill4/uncompensated")).changed("X", mass=900.0)


def test_a_constant_force_moves_the_circle_by_force_over_gain_of_the_loop() -> None:
    force = 600.0
    machine = shipped_machine(velocity_feedforward=1.0, acceleration_feedforward=1.0)
    gains = [drive.position_gain for drive in drives(machine, build_spec(machine).compile())]
    pulled = machine.changed("X", constant_force=force)
    before, after = (circular_test(it, 50.0, 3000.0) for it in (machine, pulled))
    shift = after.counter_clockwise_um[0] - before.counter_clockwise_um[0]
    assert shift == pytest.approx(force / gains[0] * 1e6, rel=0.01)
    assert after.circular_deviation_um < 0.2


def test_the_drive_stands_against_a_constant_force_from_the_start() -> None:
    machine = shipped_machine(constant_force=-50.0, reset_time_s=0.02)
    (samples,) = simulate(machine, physics_model(machine, build_spec(machine)), [line(0, 0.0, 0.2)])
    assert samples.drive_force[:, 1] == pytest.approx(50.0, abs=1e-6)
    assert np.ptp(samples.joint_position, axis=0).max() < 1e-9
