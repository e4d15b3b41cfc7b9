"""Logs of a drive that shares no code with the package: a cascade, solved by ``scipy.signal``.

A position loop gives a speed, a velocity loop a force on a mass with viscous friction. The command is a
chain of minimum-jerk strokes in closed form.
"""

import dataclasses

import numpy as np
from machine_logs import COLUMNS
from scipy.signal import lsim, lti

from twin.logs.machine_log import AxisLog, MachineLog
from twin.nc.canonical import FloatArray

STEP_S = 0.00025
ACCELERATION_PER_A = 250.0
"""What one ampere does to the axis [mm/s²]."""
GAIN_PER_S, SPEED_GAIN_PER_S, FRICTION_PER_S = 90.0, 300.0, 0.5
"""Of the position loop, of the velocity loop, and viscous friction over mass [1/s]."""
KV = GAIN_PER_S * 0.06
"""The position loop's gain [(m/min)/mm]."""
_STROKES = ((40.0, 0.35), (8.0, 0.25), (90.0, 0.5), (2.0, 0.4), (25.0, 0.2))
"""Lengths [mm] and times [s]."""


def command(seconds: float) -> FloatArray:
    """Strokes there and back, (n,) [mm]."""
    time = np.arange(0.0, seconds, STEP_S)
    place, begin = np.zeros(len(time)), 0.15
    while begin < seconds:
        for length, lasts in _STROKES:
            for way in (length, -length):
                part = np.clip((time - begin) / lasts, 0.0, 1.0)
                place += way * part**3 * (10.0 - 15.0 * part + 6.0 * part**2)
                begin += lasts + 0.05
    return place


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Logger:
    """How a log is taken.

    Attributes:
        period_s: Between samples [s].
        noise: Of the position [mm].
        step: Of its numbers [mm]; 0: none.
        filter_s: Time constant that the position and its noise are smoothed with [s].
        late_s: How much later than the command the position is taken [s].
        current: Whether what the motor gives is logged too.
    """

    period_s: float = 0.001
    noise: float = 0.0005
    step: float = 0.0
    filter_s: float = 0.0
    late_s: float = 0.0
    current: bool = False


def log_of(logger: Logger, seconds: float = 4.0) -> MachineLog:
    """What is logged of the drive."""
    asked = command(seconds)
    time = np.arange(len(asked)) * STEP_S
    every = round(logger.period_s / STEP_S)
    stiff = GAIN_PER_S * SPEED_GAIN_PER_S
    drive = lti([stiff], [1.0, SPEED_GAIN_PER_S + FRICTION_PER_S, stiff])
    _, actual, _ = lsim(drive, asked, time)
    seen = np.interp(time - logger.late_s, time, actual)
    shown = seen[::every]
    shown = shown + logger.noise * np.random.default_rng(3).standard_normal(len(shown))
    if logger.filter_s:
        clock = np.arange(len(shown)) * logger.period_s
        _, shown, _ = lsim(lti([1.0], [logger.filter_s, 1.0]), shown, clock)
    told = asked[::every]
    if logger.step:
        shown, told = (np.round(values / logger.step) * logger.step for values in (shown, told))
    more = {}
    if logger.current:
        speed = np.gradient(actual, STEP_S)
        given = np.gradient(speed, STEP_S) + FRICTION_PER_S * speed
        more["current"] = given[::every] / ACCELERATION_PER_A
    axis = AxisLog("linear", told, shown, more, COLUMNS)
    clock = np.asarray(np.arange(len(told)) * logger.period_s, np.float64)
    return MachineLog("other.csv", clock, {"X": axis}, np.zeros(len(told), np.int64))
