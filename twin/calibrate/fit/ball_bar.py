"""Backlash, squareness and the difference in lag of two axes, from a ball-bar's circle.

The tool is off the circle, outward, by the radial part of what each axis is off. With the angle a, the
direction d (1 counter-clockwise, -1 clockwise), the radius R and the speed F (ISO 230-4):

    where the circle lies and how large it is     r + x cos a + y sin a
    one scale longer than the other               e R/2 cos 2a
    an angle of 90 degrees + s between the axes   -s R/2 sin 2a
    lags T1 and T2                                d F (T1 - T2)/2 sin 2a
    backlash b1 and b2                            d b1/2 sign(sin a) cos a - d b2/2 sign(cos a) sin a

The sense of rotation alone tells squareness from a lag. Friction that strains a screw looks as backlash does.
"""

from typing import NamedTuple

import numpy as np

from twin.calibrate.fit.solve import BATCHES, Interval, linear_intervals
from twin.logs.ball_bar import BallBarLog
from twin.nc.canonical import FloatArray
from twin.units import MM, UM_PER_MM

_REVERSAL = np.deg2rad(6.0)
"""So close to where an axis turns round, friction holds it and the gap is being crossed [rad]."""
ONE_DIRECTION = "a turn in one direction does not tell squareness from a lag: log both directions"
STIFFNESS = "a ball-bar does not tell it from backlash: either is lost where the axis turns round"


class BallBarFit(NamedTuple):
    """What one ball-bar's log came to, with 95 % intervals.

    Attributes:
        lost: Of each axis, what it loses where it turns round [mm].
        squareness: As in ``[geometry.squareness]`` [µm/m]; None where one direction is logged.
        lag: Of the first axis less that of the second [s]; None likewise.
        logged_rms: Of the deviation about its circle [mm].
        left_rms: Of what the law above leaves of it [mm].
    """

    log: str
    plane: str
    lost: dict[str, Interval]
    squareness: Interval | None
    lag: Interval | None
    logged_rms: float
    left_rms: float


def fit_ball_bar(log: BallBarLog) -> BallBarFit:
    """Fit one log, away from where the axes turn round."""
    quarter = np.pi / 2.0
    off = np.abs((log.angle + quarter / 2.0) % quarter - quarter / 2.0)
    kept = off > _REVERSAL
    angle = log.angle[kept]
    columns = np.vstack([_columns(log, angle, sense) for sense in log.turns])
    values = np.concatenate([turn[kept] for turn in log.turns.values()])
    both = len(log.turns) == 2
    if not both:
        columns = np.delete(columns, _LAG, axis=1)
    batch = (np.arange(len(values)) * BATCHES // len(values)).astype(np.int64)
    found = linear_intervals(columns, values, batch)
    solved = np.array([interval.value for interval in found])
    circle = slice(0, _SCALE)
    about = values - columns[:, circle] @ np.linalg.lstsq(columns[:, circle], values, rcond=None)[0]
    left = values - columns @ solved
    return BallBarFit(
        log.name,
        log.plane,
        dict(zip(log.plane, found[-2:], strict=True)),
        _scaled(found[_SQUARE], UM_PER_MM / MM) if both else None,
        found[_LAG] if both else None,
        float(np.sqrt(np.mean(about**2))),
        float(np.sqrt(np.mean(left**2))),
    )


def circle_line(circle: BallBarFit) -> str:
    """The figures of a circle in a sentence."""
    lost = ", ".join(f"{name} {1e3 * one.value:.2f} µm" for name, one in circle.lost.items())
    text = f"{circle.log}: circle {circle.plane}: lost where the axes turn round: {lost}; "
    if circle.squareness is None or circle.lag is None:
        text += ONE_DIRECTION
    else:
        first, second = circle.plane
        text += f"squareness {circle.squareness.value:.2f} µm/m; "
        text += f"{first} lags {1e3 * circle.lag.value:.4g} ms more than {second}"
    return f"{text}; {1e3 * circle.left_rms:.2f} of {1e3 * circle.logged_rms:.2f} µm are left"


_SCALE, _SQUARE, _LAG = 3, 4, 5
"""Columns of ``_columns``; what is before is the circle, what comes after the backlash."""


def _columns(log: BallBarLog, angle: FloatArray, sense: int) -> FloatArray:
    """Deviation per unit of each unknown, shape (n, 8)."""
    cosine, sine, half = np.cos(angle), np.sin(angle), log.radius / 2.0
    return np.column_stack([
        np.ones(len(angle)), cosine, sine,
        half * np.cos(2.0 * angle),
        -half * np.sin(2.0 * angle),
        sense * log.speed / 2.0 * np.sin(2.0 * angle),
        sense * np.sign(sine) * cosine / 2.0,
        -sense * np.sign(cosine) * sine / 2.0,
    ])  # fmt: skip


def _scaled(interval: Interval, by: float) -> Interval:
    return Interval(interval.value * by, interval.low * by, interval.high * by)
