"""The fit's own simulation is the machine's: held to MuJoCo's run of the same machine file."""

import numpy as np
import pytest
from machine_logs import PERIOD, logged, mill, strokes

from twin.calibrate.fit.parameters import of_base
from twin.calibrate.fit.simulation import command_of, seen_at, simulate_axis
from twin.machine.model.model import build_spec, drives


@pytest.mark.parametrize(
    ("changes", "within_um"),
    [
        ({}, 0.01),
        ({"velocity_feedforward": 0.8, "acceleration_feedforward": 0.5}, 0.05),
        ({"dry_friction": 400.0, "viscous_friction": 2.0, "constant_force": 60.0}, 1.0),
        ({"reset_time_s": 0.02, "dry_friction": 300.0}, 1.0),
        ({"damping_ratio": 0.4, "dry_friction": 300.0}, 3.0),
        ({"mass": 700.0, "kv": 4.0}, 0.01),
        ({"command_filter_s": 0.004, "velocity_feedforward": 0.6}, 0.05),
        ({"velocity_filter_s": 0.0013}, 0.5),
        ({"loop_delay_s": 0.0021, "kv": 3.0}, 0.5),
        (
            {
                "loop_delay_s": 0.002,
                "velocity_filter_s": 0.0013,
                "command_filter_s": 0.003,
                "kv": 3.0,
                "reset_time_s": 0.05,
                "velocity_feedforward": 0.5,
            },
            0.5,
        ),
    ],
)
def test_an_axis_moves_as_in_mujoco(changes: dict[str, float], within_um: float) -> None:
    machine = mill(**changes)
    log = logged(machine, strokes(3.0))
    axis = log.axes["X"]
    moved = drives(machine, build_spec(machine).compile())[0].moved
    motion = simulate_axis(
        of_base(machine.axis("X"), moved),
        command_of("linear", log.time, axis.command, axis.actual),
    )
    assert np.abs(motion.position - axis.actual)[20:].max() * 1e3 < within_um
    off = motion.force - axis.more["force"]
    assert np.sqrt(np.mean(off**2)) < 0.03 * np.sqrt(np.mean(axis.more["force"] ** 2))


def test_a_delay_between_samples_is_seen_to_a_hundredth_of_a_micrometre() -> None:
    course = strokes(2.0)
    time = np.asarray(np.arange(len(course)) * PERIOD, np.float64)
    command = command_of("linear", time, course[:, 0], course[:, 0])
    delay = 0.00037
    seen = seen_at(course[:, 0], course[:, 1], command, delay)
    meant = course[:, 0] - delay * course[:, 1] + delay**2 / 2 * course[:, 2]
    assert np.abs(seen - meant)[5:].max() < 1e-5
