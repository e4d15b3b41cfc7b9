"""Ramps in a log too slow for dynamics: where a sample falls into one, its velocities tell the lag.

A log of ten samples a second hits a ramp of ten milliseconds now and then. Its columns of commanded
velocity and acceleration then say how far into the ramp the sample was taken, as a planner that
accelerates at a constant rate from one speed to another leaves few combinations of which both numbers come
about. The control forms them as differences over its cycle, which is seen from the numbers too.
"""

import dataclasses

import numpy as np

from twin.calibrate.fit.parameters import AxisParameters
from twin.calibrate.fit.simulation import AxisCommand, seen_at, simulate_axis
from twin.logs.machine_log import AxisLog, MachineLog
from twin.nc.canonical import FloatArray

_STEP_S = 5e-4
_BEFORE_S, _AFTER_S = 0.06, 0.14
_CYCLES_S = (0.001, 0.002, 0.004, 0.008)
"""Cycles over which a control may form its velocity."""
_RAMP = 0.1
"""A commanded acceleration above this share of the greatest belongs to a ramp."""
_UNLIKELY = 10.0
"""A sample that fits no ramp better than this is left out."""
_LATER = 0.05
"""What a less plain course of the speed must fit better."""
_ALIKE = 1.0
"""Courses that fit no worse than the best by more than this are as likely."""
_TELLING = 0.3
"""Where likely courses make lags that differ by more than this share, a sample tells nothing."""
_TYPICAL_LAG_S = 0.008
"""Lag by which courses are distinguished [s]."""
NEEDED = ("command_velocity", "velocity", "command_acceleration")
"""Columns without which ramps tell nothing."""


@dataclasses.dataclass(frozen=True, slots=True)
class Ramp:
    """A sample within a ramp.

    Attributes:
        command: The ramp, from well before the sample.
        place: Of the sample, in inputs of the command.
        window: Inputs per cycle of the control.
        lag: Logged commanded minus actual velocity [mm/s or deg/s].
        tells: Whether all courses of the speed that fit the sample make alike lags.
    """

    row: int
    command: AxisCommand
    place: int
    window: int
    lag: float
    tells: bool


def find_cycle(log: MachineLog, rows: tuple[tuple[int, int], ...]) -> float:
    """The cycle over which a control forms its velocities, which its ramps agree with best [s]."""
    costs = [
        sum(
            min(cost, _UNLIKELY)
            for name in axes_with_ramps(log)
            for cost, _ in _candidates(log, name, rows, cycle)
        )
        for cycle in _CYCLES_S
    ]
    return _CYCLES_S[int(np.argmin(costs))]


def axes_with_ramps(log: MachineLog) -> list[str]:
    """Axes whose columns suffice to fit their ramps."""
    return [name for name, axis in log.axes.items() if set(NEEDED) <= set(axis.more)]


def find_ramps(
    log: MachineLog, name: str, rows: tuple[tuple[int, int], ...], cycle_s: float
) -> list[Ramp]:
    """Find the samples of an axis that fell into ramps.

    Args:
        name: Of an axis with ``NEEDED``.
        rows: First and last row, exclusive, of each stretch.
        cycle_s: Over which the control forms its velocities [s].
    """
    found = _candidates(log, name, rows, cycle_s)
    return [ramp for cost, ramp in found if cost < _UNLIKELY and ramp.tells]


def _candidates(
    log: MachineLog, name: str, rows: tuple[tuple[int, int], ...], cycle_s: float
) -> list[tuple[float, Ramp]]:
    """Samples in ramps with how badly they fit; a path accelerates as a whole."""
    every = [log.axes[other].more["command_acceleration"] for other in axes_with_ramps(log)]
    whole = np.sqrt(np.sum(np.square(every), axis=0))
    limit = float(whole.max(initial=0.0))
    axis = log.axes[name]
    own = axis.more["command_acceleration"]
    return [
        _likeliest(axis, row, limit * abs(float(own[row] / whole[row])), cycle_s)
        for begin, end in rows
        for row in range(begin + 1, end - 1)
        if abs(own[row]) > _RAMP * limit
    ]


def _likeliest(axis: AxisLog, row: int, rate: float, cycle_s: float) -> tuple[float, Ramp]:
    """The ramp that a sample fits best, and how badly."""
    asked, changed = axis.more["command_velocity"], axis.more["command_acceleration"]
    time = np.arange(-_BEFORE_S, _AFTER_S, _STEP_S)
    window = round(cycle_s / _STEP_S)
    speed = max(abs(asked[row]), 1e-3 * rate)
    best_cost, best_place, best = np.inf, 0, np.zeros(len(time))
    lags: list[tuple[float, float]] = []
    courses = _courses(time, asked[row - 1 : row + 2], rate)
    for order, course in enumerate(courses):
        mean = _averaged(course, window)
        change = np.gradient(mean, _STEP_S) if window == 0 else _difference(mean, window) / cycle_s
        cost = ((mean - asked[row]) / (0.01 * speed + 0.05 * rate * cycle_s)) ** 2
        cost = cost + ((change - changed[row]) / (0.04 * rate)) ** 2 + order * _LATER
        place = int(np.argmin(cost))
        earlier = mean[max(0, place - round(_TYPICAL_LAG_S / _STEP_S))]
        lags.append((float(cost[place]) - order * _LATER, float(mean[place] - earlier)))
        if cost[place] < best_cost:
            best_cost, best_place, best = float(cost[place]), place, course
    alike = [lag for cost, lag in lags if cost < best_cost + _ALIKE]
    tells = max(alike) - min(alike) <= _TELLING * max(map(abs, alike))
    change = np.gradient(best, _STEP_S)
    position = np.concatenate([[0.0], np.cumsum((best[1:] + best[:-1]) / 2) * _STEP_S])
    command = AxisCommand(
        axis.kind, _STEP_S, np.arange(len(best), dtype=np.float64), np.column_stack([position, best, change]), np.zeros(len(best)),
        (0.0, float(best[0])),
    )  # fmt: skip
    lag = float(asked[row] - axis.more["velocity"][row])
    return best_cost, Ramp(row, command, best_place, window, lag, tells)


def _courses(time: FloatArray, speeds: FloatArray, rate: float) -> list[FloatArray]:
    """How the speed may have gone between the samples before and after, plainest first."""
    before, now, after = map(float, speeds)

    def ramp(start: float, end: float, begin: float = 0.0) -> FloatArray:
        lasts = max(abs(end - start) / rate, 1e-9)
        return start + (end - start) * np.clip((time - begin) / lasts, 0.0, 1.0)

    far = 2.0 * rate * _BEFORE_S
    return [
        ramp(before, after),
        ramp(0.0, after),
        ramp(before, 0.0),
        ramp(before, 0.0) + ramp(0.0, after, abs(before) / rate),
        ramp(-after, after),
        ramp(before, -before),
        ramp(0.0, now),
        ramp(0.0, before),
        ramp(far, 0.0),
        ramp(-far, 0.0),
        ramp(0.0, far),
        ramp(0.0, -far),
    ]


def _averaged(values: FloatArray, window: int) -> FloatArray:
    """Mean of the inputs of a cycle that has just ended."""
    sums = np.concatenate([[0.0], np.cumsum(values)])
    mean = values.copy()
    mean[window:] = (sums[window + 1 :] - sums[1:-window])[: len(values) - window] / window
    return mean


def _difference(values: FloatArray, window: int) -> FloatArray:
    change = np.zeros(len(values))
    change[window:] = values[window:] - values[:-window]
    return change


@dataclasses.dataclass(frozen=True, slots=True)
class RampSignals:
    """What the model has at a ramp's sample: lag of velocity, velocity, acceleration."""

    lag: float
    velocity: float
    acceleration: float


def predict_ramp(parameters: AxisParameters, ramp: Ramp) -> RampSignals:
    """Run the model through a ramp, and see it as the log does."""
    command = ramp.command
    # Over milliseconds of a ramp friction matters little, and its state is not known.
    free = dataclasses.replace(parameters, dry_friction=0.0, constant_force=0.0)
    motion = simulate_axis(free, command)
    acceleration = np.gradient(motion.speed, command.step_s)
    rate = np.gradient(acceleration, command.step_s)
    velocity = seen_at(motion.speed, acceleration, command, parameters.delay)
    change = seen_at(acceleration, rate, command, parameters.delay)
    place = ramp.place
    own = _averaged(command.position[:, 1], ramp.window)[place]
    done = _averaged(velocity, ramp.window)[place]
    return RampSignals(float(own - done), float(done), float(change[place]))
