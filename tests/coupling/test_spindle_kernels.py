"""The spindle's drive against its machine file: time to speed, torque over speed, stall."""

import math

import numpy as np
import pytest

from twin.coupling.cutting_process import spindle_drive
from twin.coupling.spindle_kernels import lasting_torque, next_speed
from twin.machine.description.machine_file import SpindleTable

TABLE = SpindleTable(
    power=((1500.0, 11000.0), (6000.0, 11000.0), (12000.0, 7500.0)),
    max_speed=12000.0,
    acceleration=8000.0,
)
PERIOD = 1e-3


def speeds(commanded: float, start: float, torque: float, count: int) -> list[float]:
    drive, found = spindle_drive(TABLE), [start]
    for _ in range(count):
        found.append(next_speed(drive, found[-1], commanded, torque, PERIOD))
    return found


@pytest.mark.parametrize(
    ("speed", "power"), [(1500, 11000), (4000, 11000), (9000, 9250), (12000, 7500), (15000, 7500)]
)
def test_torque_is_power_over_speed(speed: float, power: float) -> None:
    turns = speed / 60.0
    torque = lasting_torque(spindle_drive(TABLE), turns)
    assert torque == pytest.approx(power / (2 * math.pi * turns))
    assert lasting_torque(spindle_drive(TABLE), -turns) == torque


def test_below_the_first_speed_the_torque_is_constant() -> None:
    drive = spindle_drive(TABLE)
    assert (
        lasting_torque(drive, 0.0) == lasting_torque(drive, 25.0) == pytest.approx(70.03, abs=0.01)
    )


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_it_takes_its_time_up_and_down(sense: float) -> None:
    up = np.array(speeds(sense * 100.0, 0.0, 0.0, 1000))
    assert int(np.argmax(np.abs(up) >= 100.0)) == pytest.approx(750, abs=1)
    down = np.array(speeds(0.0, sense * 100.0, 0.0, 800))
    assert int(np.argmax(down == 0.0)) == pytest.approx(750, abs=1)
    turned = np.array(speeds(-sense * 100.0, sense * 100.0, 0.0, 1600))
    assert int(np.argmax(turned * sense <= -100.0)) == pytest.approx(1500, abs=2)


def test_nothing_goes_beyond_the_fastest() -> None:
    assert max(speeds(1000.0, 199.0, 0.0, 100)) == 200.0


def test_a_cut_within_the_short_torque_is_borne_and_one_beyond_it_stalls() -> None:
    short = 1.5 * lasting_torque(spindle_drive(TABLE), 20.0)
    assert speeds(20.0, 20.0, 0.99 * short, 100)[-1] == 20.0
    stalling = speeds(20.0, 20.0, 2.0 * short, 400)
    # J = M / (2 pi rate): twice the torque brakes as fast as the drive comes to speed.
    assert stalling[100] == pytest.approx(20.0 - 100 * PERIOD * 200.0 / 1.5, rel=1e-6)
    assert stalling[-1] == 0.0


@pytest.mark.parametrize("commanded", [0.0, -20.0, 5.0])
def test_an_overloaded_spindle_obeys_a_command_to_slow_down(commanded: float) -> None:
    drive = spindle_drive(TABLE)
    torque = 1.01 * 1.5 * lasting_torque(drive, 20.0)
    free = speeds(commanded, 20.0, 0.0, 400)
    loaded = speeds(commanded, 20.0, torque, 400)
    # A cut brakes as well: the spindle is never faster than one that turns freely.
    assert np.all(np.array(loaded)[:90] <= np.array(free)[:90] + 1e-9)
    assert loaded[90] < 18.0


def test_a_spindle_of_which_nothing_is_known_turns_as_it_is_told() -> None:
    drive = spindle_drive(SpindleTable())
    assert next_speed(drive, 0.0, 50.0, 1e9, PERIOD) == 50.0
    assert next_speed(drive, 50.0, 0.0, 1e9, PERIOD) == 0.0
    assert math.isinf(lasting_torque(drive, 50.0))
