"""Filters and dead time of a drive, held to their transfer functions; nothing of them where they are 0."""

from typing import Any

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.machine.machine_fixtures import PERIOD, circle, line, shipped_machine
from twin.errors import ConfigError
from twin.machine.description.config import MachineConfig
from twin.machine.description.machine_file import AxisTable
from twin.machine.model.model import build_spec, drives, physics_model
from twin.machine.simulation.drive_kernels import DriveSetpoints
from twin.machine.simulation.live import LiveMachine
from twin.machine.simulation.setpoint_filter import SetpointFilter
from twin.machine.simulation.simulate import simulate
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.recording.reader import Samples
from twin.units import kv_per_second

LATE: dict[str, float] = {
    "loop_delay_s": 0.0021, "velocity_filter_s": 0.0016, "command_filter_s": 0.0034,
}  # fmt: skip


def run(machine: MachineConfig, points: Setpoints) -> Samples:
    simulation = simulate(machine, physics_model(machine, build_spec(machine)), [points])
    (samples,) = simulation
    assert simulation.alarm is None
    return samples


def response(axis: AxisTable, moved: float, rate: float) -> complex:
    """Joint over setpoint of a sine of some rate [rad/s]: the law of ``drives``, all lags in place."""
    s = 1j * rate
    loop = kv_per_second(axis.kv)
    damping = moved * 4.0 * axis.damping_ratio**2 * loop
    reset = 1.0 / axis.reset_time_s if axis.reset_time_s else 0.0
    stiffness = damping * loop + damping * reset
    trail = (1.0 - axis.velocity_feedforward) / loop
    late = np.exp(-s * axis.loop_delay_s)
    told = stiffness + damping * axis.velocity_feedforward * s
    told += moved * axis.acceleration_feedforward * s**2
    told += damping * reset * loop / s * (1.0 - trail * s)
    back = stiffness + damping * s / (1.0 + axis.velocity_filter_s * s)
    back += damping * reset * loop / s
    filtered = 1.0 / (1.0 + axis.command_filter_s * s)
    return complex(filtered * late * told / (moved * s**2 + late * back))


@pytest.mark.seconds("circles are run at the machine")
@pytest.mark.parametrize(
    ("changes", "within_um"),
    [
        ({"command_filter_s": 0.02}, 0.02),
        ({"command_filter_s": 0.004, "velocity_feedforward": 1.0}, 0.02),
        ({"velocity_filter_s": 0.002}, 0.02),
        ({"velocity_filter_s": 0.0005, "damping_ratio": 0.8}, 0.02),
        ({"loop_delay_s": 0.0005}, 0.02),
        ({"loop_delay_s": 0.003, "kv": 3.0}, 0.05),
        (
            {"loop_delay_s": 0.002, "velocity_feedforward": 1.0, "acceleration_feedforward": 1.0},
            0.05,
        ),
        ({"loop_delay_s": 0.002, "reset_time_s": 0.03, "kv": 4.0}, 0.05),
        (LATE | {"reset_time_s": 0.05, "velocity_feedforward": 0.7, "kv": 3.0}, 0.05),
        ({"loop_delay_s": 0.002, "velocity_filter_s": 0.001, "kv": 4.0}, 0.05),
        ({"damping_ratio": 3.0}, 0.02),
    ],
)
@pytest.mark.parametrize("feed", [3000.0, 10000.0])
def test_a_circle_has_the_radius_and_the_phase_of_the_transfer_function(
    changes: dict[str, float], within_um: float, feed: float
) -> None:
    radius = 20.0
    machine = shipped_machine(**changes, following_error_limit=0.0)
    samples = run(machine, circle(radius, feed, 2.0))
    seen = samples.joint_position[-1, 0] + radius + 1j * samples.joint_position[-1, 1]
    asked = samples.setpoint.position[-1, 0] + radius + 1j * samples.setpoint.position[-1, 1]
    moved = drives(machine, physics_model(machine, build_spec(machine)))
    along = [
        response(machine.axis(name), loop.moved, feed / 60.0 / radius)
        for name, loop in zip("XY", moved, strict=False)
    ]
    # The masses of the axes differ, what they do to gains cancels: X and Y respond alike.
    assert along[0] == pytest.approx(along[1], abs=1e-12)
    um = 1e3 * radius * (seen / asked / along[0] - 1.0)
    assert abs(um.real) < within_um * (feed / 3000.0) ** 2
    assert abs(um.imag) < within_um * (feed / 3000.0) ** 2


@pytest.mark.parametrize(("feedforward", "trail"), [(0.0, 1.0), (1.0, 0.0), (0.4, 0.6)])
def test_on_a_line_only_the_filter_of_the_command_adds_to_the_lag(
    feedforward: float, trail: float
) -> None:
    machine = shipped_machine(**LATE, kv=4.0, velocity_feedforward=feedforward)
    samples = run(machine, line(0, 80.0, 1.5))
    lag = (samples.setpoint.position - samples.joint_position)[-1, 0]
    meant = 80.0 * (trail / kv_per_second(4.0) + LATE["command_filter_s"])
    assert lag == pytest.approx(meant, abs=1e-6)
    assert samples.drive_force[-1, 0] == pytest.approx(0.0, abs=0.05)


@given(
    turns=st.integers(3, 20), per_turn=st.integers(40, 400),
    time_constant=st.floats(2e-5, 0.05), start=st.integers(1, 60),
)  # fmt: skip
@settings(max_examples=examples(40), deadline=None, derandomize=True)
def test_a_filter_lags_as_its_closed_form_says_however_it_is_fed(
    turns: int, per_turn: int, time_constant: float, start: int
) -> None:
    rate = 2 * np.pi / per_turn / PERIOD
    angle = 2 * np.pi * np.arange(turns * per_turn + 1) / per_turn
    points = DriveSetpoints(
        (1.0 - np.cos(angle))[:, None], rate * np.sin(angle)[:, None],
        rate**2 * np.cos(angle)[:, None],
    )  # fmt: skip
    lag = SetpointFilter(np.array([time_constant]), PERIOD)
    whole = lag.follow(points)
    x = rate * time_constant
    wave = (np.cos(angle) + x * np.sin(angle)) / (1.0 + x**2)
    settling = (1.0 / (1.0 + x**2) - 1.0) * np.exp(-angle / rate / time_constant)
    assert whole.position[:, 0] == pytest.approx(1.0 - wave + settling, abs=2e-6)
    pieces = SetpointFilter(np.array([time_constant]), PERIOD)
    first = pieces.follow(DriveSetpoints(*(column[: start + 1] for column in points)))
    rest = pieces.follow(DriveSetpoints(*(column[start:] for column in points)))
    for name in ("position", "velocity", "acceleration"):
        both = np.concatenate([getattr(first, name), getattr(rest, name)[1:]])
        assert np.array_equal(both, getattr(whole, name))


@pytest.mark.parametrize("size", [1, 7])
def test_slices_move_bit_for_bit_as_one_run(size: int) -> None:
    machine = shipped_machine(**LATE, kv=3.0, reset_time_s=0.05)
    points = circle(10.0, 2000.0, 0.4)
    whole = run(machine, points)
    live = LiveMachine(machine)
    parts = [live.follow(points[i : i + size]) for i in range(1, len(points), size)]
    assert np.array_equal(
        np.concatenate([part.joint_position for part in parts]), whole.joint_position[1:]
    )
    assert np.array_equal(
        np.concatenate([part.drive_force for part in parts]), whole.drive_force[1:]
    )


def test_the_force_that_is_told_is_the_force_that_accelerates() -> None:
    machine = shipped_machine(**LATE, kv=3.0, velocity_feedforward=0.5)
    samples = run(machine, circle(10.0, 4000.0, 1.5))
    moved = drives(machine, physics_model(machine, build_spec(machine)))[0].moved
    gained: FloatArray = np.gradient(samples.joint_velocity[:, 0], PERIOD)
    assert samples.drive_force[20:-20, 0] == pytest.approx(
        1e-3 * moved * gained[20:-20], rel=0.01, abs=2.0
    )


def test_an_operator_may_stop_clear_and_change_a_late_drive() -> None:
    live = LiveMachine(shipped_machine(**LATE, kv=3.0))
    points = line(0, 50.0, 1.0)
    live.follow(points[1:600])
    moving = live.position[0]
    live.change("X", dry_friction=50.0)
    live.follow(points[600:700])
    assert live.position[0] == pytest.approx(moving + 5.0, abs=0.01)
    live.repair()
    live.raise_alarm("emergency-stop", "the button")
    for _ in range(20):
        live.brake(50)
    stood = live.position
    live.clear()
    live.hold(300)
    assert np.abs(live.position - stood).max() < 1e-3


def test_zero_is_ideal_and_costs_nothing() -> None:
    machine = shipped_machine()
    zero = shipped_machine(loop_delay_s=0.0, velocity_filter_s=0.0, command_filter_s=0.0)
    plain, model = (physics_model(one, build_spec(one)) for one in (machine, zero))
    assert (model.nu, model.na, model.opt.timestep) == (plain.nu, plain.na, PERIOD)
    points = DriveSetpoints(*(np.ones((5, 4)) for _ in range(3)))
    assert SetpointFilter(np.zeros(4), PERIOD).follow(points) is points


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"loop_delay_s": 0.01}, "swings up by itself, because of loop_delay_s; kv up to"),
        (
            {"loop_delay_s": 0.004, "velocity_filter_s": 0.004},
            "because of loop_delay_s and velocity_filter_s; kv up to",
        ),
        ({"loop_delay_s": 1e-5}, "loop_delay_s = 1e-05 is too short to be simulated; from 0.00013"),
        ({"velocity_filter_s": 1e-5}, "velocity_filter_s = 1e-05 is too short"),
        ({"damping_ratio": 20.0}, "reacts faster than a 20th of the servo period"),
    ],
)
def test_what_cannot_be_is_refused_with_what_works(changes: dict[str, Any], told: str) -> None:
    with pytest.raises(ConfigError, match=told):
        build_spec(shipped_machine(**changes))


def test_the_loop_gain_that_a_refusal_names_works() -> None:
    with pytest.raises(ConfigError, match=r"kv up to (\S+) works") as refused:
        build_spec(shipped_machine(loop_delay_s=0.01))
    named = float(str(refused.value).split("kv up to ")[1].split()[0])
    build_spec(shipped_machine(loop_delay_s=0.01, kv=named * 0.99))
    with pytest.raises(ConfigError):
        build_spec(shipped_machine(loop_delay_s=0.01, kv=named * 1.02))
