"""Backlash and stiffness between motor and axis, from an encoder on either side.

The motor is ahead of the axis by half of the gap on the side that pushes, and by the transmitted force over the
stiffness,

    d = d0 + b/2 s + F/k,

where F moves what lies behind the gap: its mass times acceleration, and its friction. s is the side, the sign
of F. Samples at which F is small, or changed its side a moment ago, are left out: the motor may be
anywhere within the gap.
"""

import dataclasses
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.signal import savgol_filter

from twin.calibrate.fit.parameters import AxisParameters
from twin.calibrate.fit.solve import BATCHES, Interval, linear_intervals
from twin.calibrate.fit.stretch import Stretch
from twin.nc.canonical import FloatArray
from twin.units import AxisKind, to_si

_SMOOTHED_S = (0.01, 0.02)
"""Times over which accelerations are taken; what the second makes different widens intervals [s]."""
_SETTLED_S = 0.03
"""So long after the push has come to a side the gap is taken as crossed [s]."""
_LEAST = 0.3
"""A push below this share of a typical one does not show its side, and crosses a gap slowly."""
_FEW = 100
"""Samples on either side that are needed."""


class Give(NamedTuple):
    """Backlash and stiffness of an axis, with 95 % intervals; None where they are not determined."""

    backlash: Interval | None
    """[mm or deg]."""
    stiffness: Interval | None
    """[N/mm or N m/deg]."""
    why: str
    """What is not determined, and why; empty where all is."""


NO_SECOND_ENCODER = "no second encoder at the axis: the log has no column 'load'"


def fit_give(
    kind: AxisKind,
    stretches: Sequence[Stretch],
    parameters: AxisParameters,
    carried: float,
    friction: Interval | None,
) -> Give:
    """Fit backlash and stiffness.

    Args:
        stretches: All that is fitted, with positions of a second encoder.
        carried: What lies behind the gap: mass [kg] or inertia [kg m²], motor and screw excluded.
        friction: Dry friction, as far as it is known; what it may be off moves the backlash.
    """
    fits = [_fit(kind, stretches, parameters, carried, over) for over in _SMOOTHED_S]
    if fits[0] is None or fits[1] is None:
        return Give(None, None, "the axis is not pushed in both directions for long enough")
    gap, softness = (
        one.widened(abs(one.value - other.value)) for one, other in zip(*fits, strict=True)
    )
    backlash = Interval(*(max(0.0, value) for value in dataclasses.astuple(gap)))
    if softness.low <= 0.0:
        least = 1.0 / softness.high if softness.high > 0.0 else float("inf")
        unit = "N/mm" if kind == "linear" else "N m/deg"
        return Give(backlash, None, f"anything above {least:.3g} {unit} would fit as well")
    stiffness = Interval(1.0 / softness.value, 1.0 / softness.high, 1.0 / softness.low)
    if friction is not None:
        off = max(friction.high - friction.value, friction.value - friction.low)
        backlash = backlash.widened(2.0 * off * softness.value)
    return Give(backlash, stiffness, "")


def _fit(
    kind: AxisKind,
    stretches: Sequence[Stretch],
    parameters: AxisParameters,
    carried: float,
    smoothed_s: float,
) -> tuple[Interval, Interval] | None:
    """Backlash and softness, with accelerations taken over some time; None where a side is missing."""
    parts = [_columns(kind, stretch, parameters, carried, smoothed_s) for stretch in stretches]
    columns = np.vstack([part[0] for part in parts])
    ahead = np.concatenate([part[1] for part in parts])
    sides = columns[:, 1]
    if min(np.count_nonzero(sides > 0.0), np.count_nonzero(sides < 0.0)) < _FEW:
        return None
    batch = (np.arange(len(ahead)) * BATCHES // len(ahead)).astype(np.int64)
    _, gap, softness = linear_intervals(columns, ahead, batch)
    return gap, softness


def _columns(
    kind: AxisKind, stretch: Stretch, parameters: AxisParameters, carried: float, smoothed_s: float
) -> tuple[FloatArray, FloatArray]:
    """One, half the side, the force, of samples whose side is known; and how far the motor is ahead."""
    assert stretch.load is not None
    speed, change = _kinematics(stretch.time, stretch.load, smoothed_s)
    moves = np.abs(speed) > 0.01 * np.abs(speed).max(initial=1e-9)
    force = carried * to_si(kind) * change + parameters.viscous_friction * speed
    force += parameters.dry_friction * np.sign(speed) * moves - parameters.constant_force
    if stretch.pushed is not None:
        force -= stretch.pushed
    typical = float(np.sqrt(np.mean(force[moves] ** 2))) if moves.any() else 1.0
    side = np.where(np.abs(force) > _LEAST * typical, np.sign(force), 0.0)
    began = np.concatenate([[0], np.flatnonzero(np.diff(side) != 0.0) + 1])
    since = began[np.searchsorted(began, np.arange(len(side)), side="right") - 1]
    known = stretch.time - stretch.time[since] > _SETTLED_S
    known &= (side != 0.0) & moves
    known &= stretch.seen
    columns = np.column_stack([np.ones(len(side)), side / 2.0, force])
    return columns[known], (stretch.actual - stretch.load)[known]


def _kinematics(
    clock: FloatArray, place: FloatArray, smoothed_s: float
) -> tuple[FloatArray, FloatArray]:
    """Speed and acceleration of logged positions, shape (n,) each."""
    period = float(clock[-1] - clock[0]) / (len(clock) - 1)
    window = max(5, 2 * round(smoothed_s / period / 2.0) + 1)
    even = np.linspace(clock[0], clock[-1], len(clock))
    places = np.interp(even, clock, place)
    speed, change = (
        np.interp(
            clock, even, np.asarray(savgol_filter(places, window, 3, deriv=order, delta=period))
        )
        for order in (1, 2)
    )
    return speed, change


def rigid_errors(stretches: Sequence[Stretch]) -> dict[str, float]:
    """What a model without a gap makes of mass and friction, as shares of them.

    The motor crosses the gap without what lies behind it. How far mass and friction of the motor's motion
    differ from those of the axis's motion says how much that matters.

    Args:
        stretches: All that is fitted, with positions of a second encoder, and a force or current.
    """
    forces = [stretch.logged_force for stretch in stretches]
    force = np.concatenate([column for column in forces if column is not None] or [np.zeros(0)])
    if any(column is None for column in forces) or not len(force):
        return {}
    found = []
    for of_load in (False, True):
        columns = []
        for stretch in stretches:
            place = stretch.load if of_load else stretch.actual
            assert place is not None
            speed, change = _kinematics(stretch.time, place, _SMOOTHED_S[0])
            moves = np.abs(speed) > 0.01 * np.abs(speed).max(initial=1e-9)
            table = [change, speed, np.sign(speed) * moves, np.ones(len(speed))]
            columns.append(np.column_stack(table)[stretch.measured])
        fitted, *_ = np.linalg.lstsq(np.vstack(columns), force, rcond=None)
        found.append(fitted)
    shares = np.abs(found[1] - found[0])[:3] / np.maximum(np.abs(found[0][:3]), 1e-12)
    return dict(zip(("mass", "viscous_friction", "dry_friction"), shares.tolist(), strict=True))
