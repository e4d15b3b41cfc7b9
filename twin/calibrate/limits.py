"""The planner's limits, as commands show them: what they come to again and again."""

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np
from scipy.signal import savgol_coeffs, savgol_filter

from twin.calibrate.health import resolution
from twin.logs.machine_log import AxisLog
from twin.machine.description.machine_file import AxisTable
from twin.nc.canonical import FloatArray

_ORDERS = {"velocity": 1, "acceleration": 2, "jerk": 3}
_WINDOWS = (5, 9, 17, 33)
"""Samples over which a derivative is taken: as few as the steps of the command allow."""
_NOISE = 0.02
"""Share of the greatest derivative that the command's steps may make of it."""
_LOBE = 0.3
"""Above this share of the greatest, a derivative belongs to a ramp."""
_OFTEN, _ALIKE = 3, 0.95
"""A limit is what so many ramps come to, none of them below this share of the greatest."""
_STEEP = 8.0
"""An acceleration that is reached within so many samples shows no jerk, but the samples."""
_RAPID = 0.3
"""A speed below this share of the base's is taken for a feed."""


@dataclasses.dataclass(frozen=True, slots=True)
class Limits:
    """What the commands of an axis reach, and what of it is a limit of the planner.

    Attributes:
        reached: Greatest velocity, acceleration and jerk [mm or deg, per s, s², s³].
        known: Those that ramp after ramp comes to.
    """

    reached: Mapping[str, float]
    known: Mapping[str, float]


def planner_limits(
    pieces: Sequence[tuple[AxisLog, float]], base: AxisTable, *, slow: bool
) -> Limits:
    """Find an axis's limits.

    Args:
        pieces: Even stretches of its logs, with their periods [s].
        slow: Whether derivatives of the positions are none: then logged columns of them count.
    """
    ramps: dict[str, list[float]] = {}
    for axis, period in pieces:
        for name, order in _ORDERS.items():
            column = axis.more.get(f"command_{name}") if slow else None
            values = column if column is not None else _derivative(axis.command, order, period)
            if slow and column is None and name != "velocity":
                continue
            ramps.setdefault(name, []).extend(_peaks(values))
    peaks = {name: sorted(found, reverse=True) for name, found in ramps.items() if found}
    reached = {name: found[0] for name, found in peaks.items()}
    known = {
        name: float(np.median(found[:_OFTEN]))
        for name, found in peaks.items()
        if len(found) >= _OFTEN and found[_OFTEN - 1] > _ALIKE * found[0]
    }
    longest = max((period for _, period in pieces), default=0.0)
    if "jerk" in known and reached["acceleration"] < _STEEP * longest * known["jerk"]:
        known.pop("jerk")
    if known.get("velocity", 0.0) < _RAPID * base.velocity:
        known.pop("velocity", None)
    return Limits(reached, known)


def _derivative(command: FloatArray, order: int, period_s: float) -> FloatArray:
    """Over as few samples as the command's own steps allow; empty where all are too few."""
    step = resolution(command)
    for window in _WINDOWS:
        if window > len(command):
            break
        values: FloatArray = np.asarray(
            savgol_filter(command, window, 3, deriv=order, delta=period_s), np.float64
        )
        weights = np.asarray(savgol_coeffs(window, 3, deriv=order, delta=period_s), np.float64)
        noise = step / np.sqrt(12.0) * float(np.sqrt(np.sum(weights**2)))
        if noise < _NOISE * float(np.abs(values).max(initial=0.0)):
            return values
    return np.zeros(0)


def _peaks(values: FloatArray) -> list[float]:
    """Greatest value of every ramp."""
    size = np.abs(values)
    if not size.any():
        return []
    least = _LOBE * float(size.max())
    edges = np.flatnonzero(np.diff(np.where(size > least, np.sign(values), 0.0))) + 1
    peaks = [float(part.max()) for part in np.split(size, edges)]
    return [peak for peak in peaks if peak > least]
