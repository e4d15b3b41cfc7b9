"""Rows of a slow log at which positions jump faster than any axis moves: they give no speed."""

import numpy as np

from twin.calibrate.findings import LogFinding
from twin.logs.machine_log import AxisLog, MachineLog
from twin.nc.canonical import BoolArray, FloatArray

_FASTER = 3.0
"""Times the distance from sample to sample that the axis keeps up anywhere else."""
_ACCELERATION = 5_000.0
"""What a machine tool's axis accelerates with, at the most of what is usual [mm/s² or deg/s²]."""
_SPEEDS = ("command_velocity", "velocity")


def jumps_of(log: MachineLog, period_s: float) -> BoolArray:
    """Where positions jump from one sample to the next, shape (n - 1,); a row is wrong in all of its axes.

    A jump is farther than an axis comes from rest to rest in that time (a T² / 4), and several times as far
    as it comes in two samples of one direction, or by its logged speeds.

    Args:
        period_s: Between its samples [s].
    """
    found = np.zeros(len(log.time) - 1, np.bool_)
    for axis in log.axes.values():
        usual = max(_kept_up(axis.command), _fastest(axis) * period_s)
        farthest = max(_FASTER * usual, _ACCELERATION * period_s**2 / 4.0)
        found |= np.abs(np.diff(axis.command)) > farthest
    return found


def _kept_up(command: FloatArray) -> float:
    """The greatest distance from sample to sample that the next goes on with."""
    steps = np.diff(command)
    one, other = steps[:-1], steps[1:]
    on = one * other > 0.0
    return float(np.minimum(np.abs(one), np.abs(other))[on].max(initial=0.0))


def _fastest(axis: AxisLog) -> float:
    return max(
        (float(np.abs(axis.more[role]).max()) for role in _SPEEDS if role in axis.more), default=0.0
    )


def look_at_jumps(log: MachineLog, jumps: BoolArray) -> list[LogFinding]:
    """Report jumps, where there are any."""
    if not jumps.any():
        return []
    first = int(np.flatnonzero(jumps)[0])
    sizes = {
        name: float(axis.command[first + 1] - axis.command[first])
        for name, axis in log.axes.items()
    }
    name = max(sizes, key=lambda one: abs(sizes[one]))
    unit = "mm" if log.axes[name].kind == "linear" else "deg"
    message = (
        f"positions jump {np.count_nonzero(jumps)} times as no axis moves, first from row {first + 1} to "
        f"{first + 2} ({name} by {sizes[name]:+.4g} {unit} in one sample): the logger repeated other rows "
        "or lost some; speeds are not taken from positions there"
    )
    return [LogFinding("jump", message)]
