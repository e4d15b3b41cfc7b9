import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.machine.machine_fixtures import PERIOD, circle, line, setpoints, shipped_machine
from twin.machine.description.config import MachineConfig
from twin.machine.model.model import MachineModel, build_spec, drives
from twin.machine.simulation.sampling import held_acceleration, held_velocity, polyline_node
from twin.machine.simulation.simulate import simulate
from twin.motion.setpoints.setpoints import Setpoints
from twin.recording.reader import Samples
from twin.units import MM

PERFECT = {"velocity_feedforward": 1.0, "acceleration_feedforward": 1.0}
F3000, F10000 = 3000.0, 10000.0


def run(machine: MachineConfig, points: Setpoints) -> Samples:
    simulation = simulate(machine, MachineModel(machine), [points])
    (samples,) = simulation
    assert simulation.alarm is None
    return samples


def radius_error_um(samples: Samples, radius: float) -> np.ndarray:
    settled = samples.joint_position[1500:]
    return (np.hypot(settled[:, 0] + radius, settled[:, 1]) - radius) * 1e3


def closed_form_um(
    machine: MachineConfig, radius: float, feed: float, *, told_velocity: bool
) -> float:
    """Radius error of a second-order servo on a circle (mujoco-notes: lag servo)."""
    axis = machine.axis("X")
    frequency = 2 * axis.damping_ratio * axis.kv * 1000 / 60
    ratio = feed / 60 / radius / frequency
    damping = 2 * axis.damping_ratio * ratio
    numerator = np.sqrt(1 + damping**2) if told_velocity else 1.0
    return radius * (numerator / np.hypot(1 - ratio**2, damping) - 1) * 1e3


@given(turns=st.integers(5, 40), per_turn=st.integers(24, 200), phase=st.floats(0, 6.28))
@settings(max_examples=40, deadline=None, derandomize=True)
def test_the_polyline_contains_a_sine_with_its_full_amplitude(turns, per_turn, phase):
    """Fourier's coefficient of the drawn polyline, against that of the sine: (W h)^4 is left."""
    n = turns * per_turn
    angle = 2 * np.pi * np.arange(n + 1) / per_turn + phase
    h, rate = PERIOD, 2 * np.pi / per_turn / PERIOD
    points = setpoints(
        np.sin(angle)[:, None], rate * np.cos(angle)[:, None], -(rate**2) * np.sin(angle)[:, None]
    )
    nodes = polyline_node(points.position, points.acceleration, h)[:, 0]
    velocity = held_velocity(nodes[:-1], nodes[1:], h)
    assert nodes[0] + np.cumsum(velocity) * h == pytest.approx(nodes[1:], abs=1e-9)
    fine = 64
    parameter = (np.arange(n * fine) + 0.5) / fine
    drawn = np.interp(parameter, np.arange(n + 1), nodes)
    wave = np.exp(1j * (2 * np.pi * parameter / per_turn + phase))
    coefficient = 2 * np.mean(drawn * np.conj(wave)) * 1j
    assert abs(coefficient - 1.0) < (rate * h) ** 4 / 100 + (rate * h / fine) ** 2 / 10


def test_a_straight_line_is_drawn_exactly():
    points = line(1, 80.0, 0.5)[300:]
    nodes = polyline_node(points.position, points.acceleration, PERIOD)[:, 1]
    velocity = held_velocity(nodes[:-1], nodes[1:], PERIOD)
    acceleration = held_acceleration(points.velocity[:-1], points.velocity[1:], PERIOD)
    assert velocity == pytest.approx(np.full(len(velocity), 80.0), rel=1e-9)
    assert np.abs(acceleration).max() < 1e-9


@pytest.mark.parametrize("feed", [F3000, F10000])
@pytest.mark.parametrize("radius", [20.0, 50.0])
@pytest.mark.parametrize("damping_ratio", [0.7, 1.0])
def test_lag_servo_on_a_circle_agrees_with_its_closed_form(feed, radius, damping_ratio):
    machine = shipped_machine(damping_ratio=damping_ratio)
    error = radius_error_um(run(machine, circle(radius, feed, 3.0)), radius)
    expected = closed_form_um(machine, radius, feed, told_velocity=False)
    tolerance = 0.1 if feed == F3000 else 1.0
    assert np.abs(error - expected).max() < tolerance / 10


@pytest.mark.parametrize("feed", [F3000, F10000])
def test_servo_told_the_velocity_on_a_circle_agrees_with_its_closed_form(feed):
    machine = shipped_machine(velocity_feedforward=1.0)
    error = radius_error_um(run(machine, circle(20.0, feed, 3.0)), 20.0)
    expected = closed_form_um(machine, 20.0, feed, told_velocity=True)
    assert np.abs(error - expected).max() < (0.01 if feed == F3000 else 0.1)


def test_a_perfect_drive_has_no_following_error():
    machine = shipped_machine(**PERFECT)
    samples = run(machine, circle(20.0, F3000, 3.0))
    assert np.abs(samples.joint_position - samples.setpoint.position).max() < 1e-4


def test_one_sample_of_slip_would_be_seen():
    machine = shipped_machine(**PERFECT)
    samples = run(machine, line(0, 50.0, 1.0))
    slipped = samples.joint_position[1:, 0] - samples.setpoint.position[:-1, 0]
    assert slipped[-1] == pytest.approx(50.0 * PERIOD, rel=1e-6)


def test_the_sampled_velocity_is_that_of_the_line():
    samples = run(shipped_machine(), line(0, 400.0, 1.0))
    assert samples.joint_velocity[-1, 0] == pytest.approx(400.0, rel=1e-9)


@pytest.mark.parametrize("axis", [0, 1, 2, 3])
def test_the_lag_on_a_line_is_speed_over_loop_gain(axis):
    machine = shipped_machine()
    name = machine.axes.names[axis]
    speed = -50.0 if name == "Z" else 50.0
    samples = run(machine, line(axis, speed, 1.2))
    lag = (samples.setpoint.position - samples.joint_position)[-1, axis]
    assert lag == pytest.approx(speed / (machine.axis(name).kv * 1000 / 60), abs=1e-5)


def test_halving_the_loop_gain_doubles_the_lag():
    full = run(shipped_machine(), line(0, 100.0, 1.2))
    half = run(shipped_machine(kv=shipped_machine().axis("X").kv / 2), line(0, 100.0, 1.2))
    ratio = (half.setpoint.position - half.joint_position)[-1, 0] / (
        full.setpoint.position - full.joint_position
    )[-1, 0]
    assert ratio == pytest.approx(2.0, rel=1e-6)


def test_on_a_constant_acceleration_the_lag_grows_as_its_closed_form_says():
    """Ramp input: with p = a t²/2 the lag settles to a (t T - (T² - 1/w²)), T = 2 z/w."""
    machine = shipped_machine(following_error_limit=0.0)
    axis = machine.axis("X")
    frequency = 2 * axis.damping_ratio * axis.kv * 1000 / 60
    time = np.arange(0, 0.4, PERIOD)
    columns = [np.zeros((len(time), 4)) for _ in range(3)]
    rate = 2000.0
    columns[0][:, 0], columns[1][:, 0], columns[2][:, 0] = rate * time**2 / 2, rate * time, rate
    samples = run(machine, setpoints(*columns))
    lag = (samples.setpoint.position - samples.joint_position)[-1, 0]
    delay = 2 * axis.damping_ratio / frequency
    expected = rate * (time[-1] * delay - (delay**2 - 1 / frequency**2))
    assert lag == pytest.approx(expected, abs=1e-4)


@pytest.mark.parametrize(
    "told",
    [
        {},
        {"reset_time_s": 0.01},
        {"velocity_feedforward": 1.0},
        {"velocity_feedforward": 1.0, "acceleration_feedforward": 1.0},
        {"velocity_feedforward": 1.0, "acceleration_feedforward": 1.0, "reset_time_s": 0.01},
    ],
)
def test_the_recorded_force_is_what_accelerates_the_axis(told: dict[str, float]):
    """With any feed-forward, although the drive holds it over a step."""
    machine = shipped_machine(**told)
    samples = run(machine, line(0, 400.0, 0.4))
    moved = drives(machine, build_spec(machine).compile())[0].moved
    needed = moved * np.gradient(samples.joint_velocity[:, 0], PERIOD) * MM
    assert np.abs(needed).max() > 4000.0
    assert np.abs(samples.drive_force[:, 0] - needed)[2:-2].max() < 10.0
