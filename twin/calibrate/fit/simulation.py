"""One axis along a logged command: the drive model of ``twin.machine.model.drives``, solved exactly.

Between two inputs the axis is linear, so that a step is a matrix exponential; dry friction acts as in
``axis_kernels``. ``tests/calibrate/test_drive_simulation.py`` holds it to MuJoCo's run of the same machine
file. The state begins with position and speed; what the axis has besides (an integrator, filters, a
dead time) adds one state each. Inputs are the setpoint, its velocity and acceleration, and what
pushes from outside over mass.
"""

import dataclasses
import math
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.linalg import expm

from twin.calibrate.fit.axis_kernels import read_cubics, step_axis
from twin.calibrate.fit.parameters import AxisParameters
from twin.nc.canonical import BoolArray, FloatArray
from twin.units import AxisKind, kv_per_second, to_si

LONGEST_STEP_S = 1e-3
_POLYLINE_LOSS = 1.0 / 12.0
"""As in ``twin.machine.simulation.sampling``: a setpoint drawn as a polyline loses this, in units of (W h)²."""
_SPEED = 1
_HELD = slice(1, 3)
"""Inputs that stand still over a step: velocity and acceleration."""
_FASTEST_FILTER_S = 1e-6
"""A filter faster than this is none [s]."""
_STANDS = 1e-3
"""An axis slower than this is at rest [mm/s or deg/s]."""
_ON_AN_INPUT = 1e-3
"""A sample that is taken so near to an input, in steps, is taken at it."""
_START_S = 0.01
"""Over this time the first speed of a log is seen [s]."""


@dataclasses.dataclass(frozen=True, slots=True)
class AxisCommand:
    """What an axis was commanded, at even steps of the simulation.

    Attributes:
        step_s: Between inputs [s].
        places: Of the logged samples, in steps from the first input, shape (samples,).
        position: Setpoint, velocity and acceleration, shape (n, 3) [mm or deg, per s, per s²].
        push: Known force from outside, shape (n,) [N or N m].
        start: Logged position and speed at the first input [mm or deg, per s].
    """

    kind: AxisKind
    step_s: float
    places: FloatArray
    position: FloatArray
    push: FloatArray
    start: tuple[float, float]

    @property
    def kinematics(self) -> FloatArray:
        """Commanded speed and acceleration at the logged samples, shape (samples, 2)."""
        inputs = np.arange(len(self.position), dtype=np.float64)
        columns = (np.interp(self.places, inputs, column) for column in self.position[:, 1:].T)
        return np.column_stack(list(columns))

    @property
    def is_drawn(self) -> bool:
        """Whether it runs between samples by a rule, rather than being logged at every input."""
        return len(self.position) > len(self.places) or bool(np.any(self.places % 1.0))


@dataclasses.dataclass(frozen=True, slots=True)
class Response:
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
    time: FloatArray,
    command: FloatArray,
    actual: FloatArray,
    push: FloatArray | None = None,
    knots: BoolArray | None = None,
) -> AxisCommand:
    """A logged command as inputs of the simulation.

    Args:
        time: Of the samples, rising, as even as they were taken, shape (n,) [s].
        command: Commanded positions, shape (n,) [mm or deg].
        actual: Actual positions; the first tell how the axis starts, shape (n,).
        push: Known force from outside, shape (n,) [N or N m].
        knots: Which samples of the command are its own, and no repetitions or spikes, shape (n,);
            all by default.
    """
    since = time - time[0]
    period = float(since[-1]) / (len(since) - 1)
    every = max(1, math.ceil(period / LONGEST_STEP_S - 1e-9))
    step = period / every
    places = since / step
    whole = np.round(places)
    if np.all(np.abs(places - whole) < _ON_AN_INPUT):
        places = whole
    fine = np.arange(math.ceil(places[-1] - _ON_AN_INPUT) + 1) * step
    own = slice(None) if knots is None else knots
    spline = CubicSpline(places[own] * step, command[own])
    position = np.column_stack([spline(fine), spline(fine, 1), spline(fine, 2)])
    pushed = np.zeros(len(fine)) if push is None else np.interp(fine, since, push)
    return AxisCommand(kind, step, places, position, pushed, _start(since, actual, position[0]))


def drawn_otherwise(command: AxisCommand, asked: FloatArray, knots: BoolArray) -> AxisCommand:
    """A copy of the command, drawn between its samples by another rule (monotone cubics).

    Args:
        asked: Its samples, shape (n,) [mm or deg].
        knots: Which of them are its own, shape (n,).
    """
    curve = PchipInterpolator(command.places[knots] * command.step_s, asked[knots])
    fine = np.arange(len(command.position)) * command.step_s
    slope, bend = (np.asarray(curve.derivative(order)(fine)) for order in (1, 2))
    position = np.column_stack([np.asarray(curve(fine)), slope, bend])
    return dataclasses.replace(command, position=position)


def _start(since: FloatArray, actual: FloatArray, first: FloatArray) -> tuple[float, float]:
    """Position and speed of the first sample, by a parabola through the first of them."""
    count = min(len(actual), max(5, int(np.searchsorted(since, _START_S, side="right"))))
    if since[count - 1] > 5 * _START_S:
        return float(actual[0]), float(first[1])
    _, slope, origin = np.polyfit(since[:count], actual[:count], 2)
    return float(origin), float(slope)


def simulate_axis(parameters: AxisParameters, command: AxisCommand) -> Response:
    """Run an axis along a command."""
    inertia = parameters.mass * to_si(command.kind)
    system = _system(parameters, inertia)
    step = command.step_s
    transition, now, then = _discrete(system.rates, system.forward, step)
    now[:, _HELD] += then[:, _HELD]
    then[:, _HELD] = 0.0
    demand = np.column_stack(
        [command.position, (command.push + parameters.constant_force) / inertia]
    )
    inputs = _held(demand, step)
    start = _start_state(parameters, system, demand[0], command.start)
    dry = parameters.dry_friction / inertia
    push = now[:, 3] + then[:, 3]
    states = step_axis(transition, now, then, push, inputs, start, dry, _SPEED)
    width = system.width
    drive = states @ system.force[:width] + demand @ system.force[width:]
    drive -= _POLYLINE_LOSS * step**2 * _bulge(parameters, system) * demand[:, 2]
    shown = system.places.get("measuring_filter")
    position, rate = states[:, 0], states[:, 1]
    if shown is not None:
        position = states[:, shown]
        rate = (states[:, 0] - position) / parameters.measuring_filter
    return Response(position=position, velocity=rate, speed=states[:, 1], force=drive * inertia)


def _held(command: FloatArray, step: float) -> FloatArray:
    """What the drive is commanded, as it holds it between inputs.

    Args:
        command: Setpoint, its velocity and acceleration, and what pushes, shape (n, 4).
        step: Between inputs [s].

    Returns:
        Shape (n, 4): the setpoint's polyline at the inputs, the velocity along it and the mean
        acceleration of the step that follows, and what pushes.
    """
    inputs = command.copy()
    inputs[:, 0] -= _POLYLINE_LOSS * step**2 * command[:, 2]
    inputs[:-1, 1] = np.diff(inputs[:, 0]) / step
    inputs[:-1, 2] = np.diff(command[:, 1]) / step
    return inputs


def _bulge(parameters: AxisParameters, system: "_System") -> float:
    """Of the force at an input over its mean around it: per commanded acceleration, in units of h²/12.

    The commanded speed is constant over a step: of the speed that follows from it the inputs see the lowest,
    and of the integral of the corresponding trail the highest.
    """
    loop = kv_per_second(parameters.kv)
    damping = 4.0 * parameters.damping_ratio**2 * loop
    bulge = parameters.velocity_feedforward * damping**2
    if "reset_time_s" in system.places:
        trail = (1.0 - parameters.velocity_feedforward) / loop
        bulge += system.law[system.places["reset_time_s"]] * trail
    return bulge


_OPTIONAL = (
    "measuring_filter", "reset_time_s", "command_filter_s", "velocity_filter_s", "loop_delay_s",
)  # fmt: skip
"""Parameters that add a state where they are not zero."""


class _System(NamedTuple):
    """An axis as a linear system, but for its dry friction."""

    width: int
    """Number of states."""
    places: dict[str, int]
    """Of the states that parameters add."""
    rates: FloatArray
    """Of the states by the states, (width, width)."""
    forward: FloatArray
    """And by the inputs, (width, 4)."""
    force: FloatArray
    """Of the drive over mass, by states and inputs, (width + 4,)."""
    law: FloatArray
    """What it would be without the dead time."""


def _system(parameters: AxisParameters, inertia: float) -> _System:
    """The law of ``twin.machine.model.drives`` over mass, every signal as a row over states and inputs."""
    added = [name for name in _OPTIONAL if getattr(parameters, name) > _FASTEST_FILTER_S]
    places = {name: 2 + number for number, name in enumerate(added)}
    width = 2 + len(added)
    every = np.eye(width + 4)
    place, speed = every[0], every[1]
    setpoint, command_speed, command_acceleration, pushed = every[width:]
    rates = np.zeros((width, width + 4))
    if "command_filter_s" in places:
        behind, lag = every[places["command_filter_s"]], parameters.command_filter_s
        filtered_speed = (setpoint - behind) / lag
        command_acceleration = (command_speed - filtered_speed) / lag
        setpoint, command_speed = behind, filtered_speed
        rates[places["command_filter_s"]] = filtered_speed
    seen_speed = speed
    if "velocity_filter_s" in places:
        seen_speed = every[places["velocity_filter_s"]]
        rates[places["velocity_filter_s"]] = (speed - seen_speed) / parameters.velocity_filter_s
    loop = kv_per_second(parameters.kv)
    frequency = 2.0 * parameters.damping_ratio * loop
    damping = 2.0 * parameters.damping_ratio * frequency
    reset = 1.0 / parameters.reset_time_s if "reset_time_s" in places else 0.0
    law = (frequency**2 + damping * reset) * (setpoint - place)
    law = law + damping * (parameters.velocity_feedforward * command_speed - seen_speed)
    law = law + parameters.acceleration_feedforward * command_acceleration
    if "reset_time_s" in places:
        trail = (1.0 - parameters.velocity_feedforward) / loop
        law = law + damping * reset * loop * every[places["reset_time_s"]]
        rates[places["reset_time_s"]] = setpoint - trail * command_speed - place
    force = law
    if "loop_delay_s" in places:
        late = every[places["loop_delay_s"]]
        force = 2.0 * late - law
        rates[places["loop_delay_s"]] = (law - late) / (parameters.loop_delay_s / 2.0)
    if "measuring_filter" in places:
        shown = every[places["measuring_filter"]]
        rates[places["measuring_filter"]] = (place - shown) / parameters.measuring_filter
    rates[0] = speed
    rates[1] = force - parameters.viscous_friction / inertia * speed + pushed
    return _System(width, places, rates[:, :width], rates[:, width:], force, law)


def _start_state(
    parameters: AxisParameters, system: _System, command: FloatArray, start: tuple[float, float]
) -> FloatArray:
    """The states at the first input: filters that have settled, an integrator that holds the axis."""
    place, speed = start
    width, places = system.width, system.places
    state = np.zeros(width)
    state[:2] = place, speed
    for name, value in (
        ("measuring_filter", place - speed * parameters.measuring_filter),
        ("command_filter_s", command[0] - command[1] * parameters.command_filter_s),
        ("velocity_filter_s", speed),
    ):
        if name in places:
            state[places[name]] = value

    def law() -> float:
        return float(system.law[:width] @ state + system.law[width:] @ command)

    if "reset_time_s" in places and abs(speed) < _STANDS:
        state[places["reset_time_s"]] = -(law() + command[3]) / system.law[places["reset_time_s"]]
    if "loop_delay_s" in places:
        state[places["loop_delay_s"]] = law()
    return state


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


def seen_at(
    values: FloatArray, rates: FloatArray, command: AxisCommand, delay_s: float
) -> FloatArray:
    """Values of the simulation at the logged samples, as seen through a delay.

    Args:
        values: At the inputs, shape (n,).
        rates: Their rates, shape (n,).
        delay_s: How late they are logged [s].

    Returns:
        Shape (samples,), by cubics between inputs.
    """
    return read_cubics(values, rates * command.step_s, command.places, delay_s / command.step_s)
