"""Limits of a planner, from what it commanded."""

import numpy as np
import pytest
from machine_logs import COLUMNS, mill

from twin.calibrate.limits import Limits, planner_limits
from twin.logs.machine_log import AxisLog

PERIOD = 0.001
VELOCITY, ACCELERATION, JERK = 400.0, 3000.0, 60000.0


def stroke(length: float) -> np.ndarray:
    """Seven phases of constant jerk there, by integrating them."""
    rise, push = ACCELERATION / JERK, VELOCITY / ACCELERATION
    rest = length / VELOCITY - push - rise
    phases = [(JERK, rise), (0.0, push - rise), (-JERK, rise), (0.0, rest),
              (-JERK, rise), (0.0, push - rise), (JERK, rise), (0.0, 0.1)]  # fmt: skip
    jerks = np.concatenate([np.full(round(lasts / 1e-5), jerk) for jerk, lasts in phases])
    place = np.cumsum(np.cumsum(np.cumsum(jerks) * 1e-5) * 1e-5) * 1e-5
    return place[:: round(PERIOD / 1e-5)]


def limits(command: np.ndarray) -> Limits:
    axis = AxisLog("linear", command, command, {}, COLUMNS)
    return planner_limits([(axis, PERIOD)], mill().axis("X"), slow=False)


def course(*lengths: float) -> np.ndarray:
    parts, place = [], 0.0
    for length in lengths:
        parts.append(place + np.sign(length) * stroke(abs(length)))
        place = float(parts[-1][-1])
    return np.concatenate(parts)


@pytest.mark.parametrize("step", [0.0, 0.0001, 0.001])
def test_what_ramp_after_ramp_comes_to_is_a_limit(step: float) -> None:
    command = course(150.0, -150.0, 120.0, -120.0)
    command = np.round(command / step) * step if step else command
    told = limits(command).known
    assert told["velocity"] == pytest.approx(VELOCITY, rel=0.01)
    assert told["acceleration"] == pytest.approx(ACCELERATION, rel=0.03)
    assert told["jerk"] == pytest.approx(JERK, rel=0.06)


def test_ramps_that_differ_tell_no_limit() -> None:
    time = np.arange(0.0, 6.0, PERIOD)
    found = limits(40.0 * np.sin(time * (1.0 + time)))
    assert set(found.reached) == {"velocity", "acceleration", "jerk"}
    assert not {"acceleration", "jerk"} & set(found.known)


def test_a_slow_speed_is_a_feed_and_no_limit() -> None:
    assert "velocity" not in limits(course(150.0, -150.0) / 5.0).known
