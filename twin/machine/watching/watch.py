"""What the control watches while the axes move: lag, force, limit switches."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from twin.machine.description.config import AxisTable, Machine
from twin.machine.watching.alarms import Alarm, AlarmCode
from twin.nc.canonical import FloatArray
from twin.recording.reader import Samples

OVERTRAVEL = 2.0
"""How far beyond its travel an axis meets its limit switch where none is given [mm or deg]."""
_ON_SWITCH = 0.1
"""What an axis that stands on its limit switch may move further onto it, such as by settling
[mm or deg]."""
_AT_LIMIT = 1.0 - 1e-9
"""Share of the force limit from which a drive counts as being at it: rounding, not slack."""


class Watch:
    """Looks at chunks of samples for the first that raises an alarm."""

    def __init__(self, machine: Machine) -> None:
        axes = [machine.axis(name) for name in machine.axes.names]
        self._names = machine.axes.names
        self._units = ["mm" if kind == "linear" else "deg" for kind in machine.axes.kinds]
        self._forces = ["N" if kind == "linear" else "N m" for kind in machine.axes.kinds]
        self._lag_limit = np.array([axis.following_error_limit or np.inf for axis in axes])
        self._force_limit = np.array([axis.force_limit or np.inf for axis in axes])
        self._patience = np.array(
            [round(axis.saturation_time_s / machine.file.servo_period_s) for axis in axes]
        )
        self._saturated = np.zeros(len(axes), np.int64)
        self._switches = np.array([_switches(axis) for axis in axes]).T
        self._lowest, self._highest = self._switches.copy()

    def acknowledge(self, position: FloatArray) -> None:
        """Raise again only what gets worse than it is: an axis may leave its limit switch.

        Args:
            position: Where the axes stand, shape (k,) [mm or deg].
        """
        self._saturated[:] = 0
        self._lowest = np.minimum(self._switches[0], position - _ON_SWITCH)
        self._highest = np.maximum(self._switches[1], position + _ON_SWITCH)

    def look(self, samples: Samples) -> Alarm | None:
        """Return the alarm of the first sample that raises one."""
        lag = np.abs(samples.setpoint.position - samples.joint_position)
        saturated = self._saturated_for(samples.drive_force)
        position = samples.joint_position
        found = [
            _first(samples, "hard-limit", (position < self._lowest) | (position > self._highest),
                   lambda row, axis: self._at_switch(position[row, axis], axis), self._names),
            _first(samples, "following-error", lag > self._lag_limit,
                   lambda row, axis: self._behind(lag[row, axis], axis), self._names),
            _first(samples, "drive-saturation", saturated > self._patience,
                   lambda row, axis: self._at_limit(saturated[row, axis], axis), self._names),
        ]  # fmt: skip
        self._lowest = np.where(position[-1] > self._switches[0], self._switches[0], self._lowest)
        self._highest = np.where(position[-1] < self._switches[1], self._switches[1], self._highest)
        return min(filter(None, found), key=lambda alarm: alarm.time_s, default=None)

    def _saturated_for(self, force: FloatArray) -> npt.NDArray[np.int64]:
        """For how many samples up to each one the drives have been at their limits, (n, k)."""
        at_limit = np.abs(force) >= self._force_limit * _AT_LIMIT
        row = np.arange(1, len(force) + 1)[:, None]
        last_free = np.maximum.accumulate(np.where(at_limit, 0, row), axis=0)
        count = row - last_free + np.where(last_free == 0, self._saturated, 0)
        self._saturated = count[-1]
        return count

    def _at_switch(self, position: float, axis: int) -> str:
        return (
            f"{self._names[axis]} ran onto its limit switch at {position:.3f} {self._units[axis]} "
            "in machine coordinates"
        )

    def _behind(self, lag: float, axis: int) -> str:
        unit = self._units[axis]
        return (
            f"{self._names[axis]} trails its setpoint by {lag:.3f} {unit}, "
            f"more than {self._lag_limit[axis]:g} {unit}"
        )

    def _at_limit(self, _count: int, axis: int) -> str:
        return (
            f"the drive of {self._names[axis]} has been at its limit of "
            f"{self._force_limit[axis]:g} {self._forces[axis]} for longer than it may"
        )


def _switches(axis: AxisTable) -> tuple[float, float]:
    """Where the limit switches of an axis lie [mm or deg]."""
    if axis.limit_switches is not None:
        return axis.limit_switches
    if axis.travel is None:
        return (-np.inf, np.inf)
    return (axis.travel[0] - OVERTRAVEL, axis.travel[1] + OVERTRAVEL)


def _first(
    samples: Samples,
    code: AlarmCode,
    raised: npt.NDArray[np.bool_],
    explain: Callable[[int, int], str],
    names: tuple[str, ...],
) -> Alarm | None:
    """The alarm of the first row in which any axis raises one, explained for that axis."""
    rows = np.flatnonzero(raised.any(axis=1))
    if not len(rows):
        return None
    row = int(rows[0])
    axis = int(np.argmax(raised[row]))
    line, time = int(samples.setpoint.line[row]), float(samples.setpoint.time[row])
    return Alarm(code, line, time, names[axis], explain(row, axis))
