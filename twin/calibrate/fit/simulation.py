"""One axis along a logged command: the drive model of ``twin.machine.model.drives``, solved exactly.

Between two inputs the axis is linear, so that a step is a matrix exponential; dry friction acts as in
``axis_kernels``. ``tests/calibrate/test_drive_simulation.py`` holds it to MuJoCo's run of the same machine
file. The state is (q, v, y, x): position, speed, what the measuring filter shows, and what the
velocity loop has integrated; inputs are the setpoint, its velocity and acceleration, and what pushes
from outside over mass.
"""

import dataclasses
import math

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.linalg import expm

from twin.calibrate.fit.axis_kernels import read_cubics, step_axis
from twin.calibrate.fit.parameters import Parameters
from twin.nc.canonical import FloatArray
from twin.units import AxisKind, kv_per_second, to_si

LONGEST_STEP_S = 1e-3
_POLYLINE_LOSS = 1.0 / 12.0
"""As in ``twin.machine.simulation.sampling``: a setpoint drawn as a polyline loses this, in units of (W h)²."""
_SPEED = 1
_FASTEST_FILTER_S = 1e-6
"""A filter faster than this is none [s]."""
_START_S = 0.01
"""Over this time the first speed of a log is seen [s]."""


@dataclasses.dataclass(frozen=True, slots=True)
class Command:
    """What an axis was told, at even steps of the simulation.

    Attributes:
        kind: Of the axis.
        step_s: Between inputs [s].
        every: Inputs per logged sample.
        position: Setpoint, velocity and acceleration, shape (n, 3) [mm or deg, per s, per s²].
        push: Known force from outside, shape (n,) [N or N m].
        start: Logged position and speed at the first input [mm or deg, per s].
    """

    kind: AxisKind
    step_s: float
    every: int
    position: FloatArray
    push: FloatArray
    start: tuple[float, float]


@dataclasses.dataclass(frozen=True, slots=True)
class Motion:
    """What came of a command, at its inputs; shape (n,).

    Attributes:
        position: Of the axis, behind the measuring filter [mm or deg].
        velocity: Its rate, behind the filter too [mm/s or deg/s].
        speed: Of the axis itself [mm/s or deg/s].
        force: Of the drive [N or N m].
    """

    position: FloatArray
    velocity: FloatArray
    speed: FloatArray
    force: FloatArray


def command_of(
    kind: AxisKind,
    period_s: float,
    command: FloatArray,
    actual: FloatArray,
    push: FloatArray | None = None,
) -> Command:
    """A logged command as inputs of the simulation.

    Args:
        kind: Of the axis.
        period_s: Between samples [s].
        command: Commanded positions, shape (n,) [mm or deg].
        actual: Actual positions; the first tell how the axis starts, shape (n,).
        push: Known force from outside, shape (n,) [N or N m].
    """
    every = max(1, math.ceil(period_s / LONGEST_STEP_S - 1e-9))
    samples = np.arange(len(command), dtype=np.float64)
    fine = np.arange((len(command) - 1) * every + 1) / every
    spline = CubicSpline(samples, command)
    position = np.column_stack(
        [spline(fine), spline(fine, 1) / period_s, spline(fine, 2) / period_s**2]
    )
    pushed = np.zeros(len(fine)) if push is None else np.interp(fine, samples, push)
    return Command(
        kind, period_s / every, every, position, pushed, _start(period_s, actual, position[0])
    )


def drawn_otherwise(command: Command, asked: FloatArray) -> Command:
    """A copy of the command, drawn between its samples by another rule (monotone cubics).

    Args:
        command: As drawn by a spline.
        asked: Its samples, shape (n,) [mm or deg].
    """
    curve = PchipInterpolator(np.arange(len(asked), dtype=np.float64), asked)
    fine = np.arange(len(command.position)) / command.every
    period = command.step_s * command.every
    slope, bend = (np.asarray(curve.derivative(order)(fine)) for order in (1, 2))
    position = np.column_stack([np.asarray(curve(fine)), slope / period, bend / period**2])
    return dataclasses.replace(command, position=position)


def _start(period_s: float, actual: FloatArray, first: FloatArray) -> tuple[float, float]:
    """Position and speed of the first sample, by a parabola through the first of them."""
    count = min(len(actual), max(5, 1 + int(_START_S / period_s)))
    if (count - 1) * period_s > 5 * _START_S:
        return float(actual[0]), float(first[1])
    place = np.arange(count) * period_s
    _, slope, origin = np.polyfit(place, actual[:count], 2)
    return float(origin), float(slope)


def simulate_axis(parameters: Parameters, command: Command) -> Motion:
    """Run an axis along a command.

    Args:
        parameters: The axis.
        command: What it was told.
    """
    unit = to_si(command.kind)
    inertia = parameters.mass * unit
    law, feedforward, integral = _control_law(parameters)
    states_of, forward = _matrices(parameters, law, feedforward, integral, inertia)
    step = command.step_s
    transition, now, then = _discrete(states_of, forward, step)
    inputs = np.column_stack(
        [
            command.position[:, 0] - _POLYLINE_LOSS * step**2 * command.position[:, 2],
            command.position[:, 1:],
            (command.push + parameters.constant_force) / inertia,
        ]
    )
    push = now[:, 3] + then[:, 3]
    place, speed = command.start
    stored = 0.0
    if integral:
        asked = law[0] * (command.position[0, 0] - place) + inputs[0, 3]
        stored = -asked / integral if abs(speed) < 1e-3 else 0.0
    start = np.array([place, speed, place, stored])
    dry = parameters.dry_friction / inertia
    states = step_axis(transition, now, then, push, inputs, start, dry, _SPEED)
    lag = command.position[:, 0] - states[:, 0]
    drive = (
        law[0] * lag
        - law[1] * states[:, 1]
        + command.position[:, 1:] @ feedforward
        + integral * states[:, 3]
    )
    filtered = parameters.measuring_filter > _FASTEST_FILTER_S
    rate = (states[:, 0] - states[:, 2]) / parameters.measuring_filter if filtered else states[:, 1]
    return Motion(
        position=states[:, 2] if filtered else states[:, 0],
        velocity=rate,
        speed=states[:, 1],
        force=drive * inertia,
    )


def _control_law(parameters: Parameters) -> tuple[FloatArray, FloatArray, float]:
    """Gains over mass: of lag and speed, of the setpoint's speed and acceleration, of the integral."""
    loop = kv_per_second(parameters.kv)
    frequency = 2.0 * parameters.damping_ratio * loop
    damping = 2.0 * parameters.damping_ratio * frequency
    reset = 1.0 / parameters.reset_time_s if parameters.reset_time_s else 0.0
    law = np.array([frequency**2 + damping * reset, damping])
    told = np.array(
        [parameters.velocity_feedforward * damping, parameters.acceleration_feedforward]
    )
    return law, told, damping * reset * loop


def _matrices(
    parameters: Parameters, law: FloatArray, told: FloatArray, integral: float, inertia: float
) -> tuple[FloatArray, FloatArray]:
    """Rates of the state by the state (4, 4) and by the inputs (4, 4)."""
    states_of = np.zeros((4, 4))
    forward = np.zeros((4, 4))
    states_of[0, 1] = 1.0
    states_of[1] = [-law[0], -law[1] - parameters.viscous_friction / inertia, 0.0, integral]
    forward[1] = [law[0], told[0], told[1], 1.0]
    if parameters.measuring_filter > _FASTEST_FILTER_S:
        states_of[2, 0] = 1.0 / parameters.measuring_filter
        states_of[2, 2] = -1.0 / parameters.measuring_filter
    if integral:
        states_of[3, 0] = -1.0
        trail = (1.0 - parameters.velocity_feedforward) / kv_per_second(parameters.kv)
        forward[3] = [1.0, -trail, 0.0, 0.0]
    return states_of, forward


def _discrete(
    states_of: FloatArray, forward: FloatArray, step: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """A step's effect of the state, of the inputs at its begin and of those at its end.

    Inputs run straight between samples: C. F. Van Loan, "Computing integrals involving the matrix
    exponential", IEEE Trans. Automatic Control 23 (1978).
    """
    width, given = forward.shape
    whole = np.zeros((width + 2 * given, width + 2 * given))
    whole[:width, :width] = states_of * step
    whole[:width, width : width + given] = forward * step
    whole[width : width + given, width + given :] = np.eye(given)
    power = np.asarray(expm(whole))
    held = power[:width, width : width + given]
    rising = power[:width, width + given :]
    parts = (power[:width, :width], held - rising, rising)
    transition, now, then = (np.ascontiguousarray(part, np.float64) for part in parts)
    return transition, now, then


def seen_at(values: FloatArray, rates: FloatArray, command: Command, delay_s: float) -> FloatArray:
    """Values of the simulation at the logged samples, as seen through a delay.

    Args:
        values: At the inputs, shape (n,).
        rates: Their rates, shape (n,).
        command: Whose samples.
        delay_s: How late they are logged [s].

    Returns:
        Shape (samples,), by cubics between inputs.
    """
    return read_cubics(values, rates * command.step_s, command.every, delay_s / command.step_s)
