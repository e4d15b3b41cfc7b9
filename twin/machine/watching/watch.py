"""What the control watches while the axes move: lag, force, limit switches."""

import numpy as np

from twin.machine.description.config import MachineConfig
from twin.machine.description.machine_file import AxisTable
from twin.machine.watching.watch_kernels import AxisWatch, Raised, find_raised
from twin.nc.canonical import FloatArray
from twin.recording.alarms import Alarm, AlarmCode
from twin.recording.reader import Samples

OVERTRAVEL = 2.0
"""How far beyond its travel an axis meets its limit switch where none is given [mm or deg]."""
_ON_SWITCH = 0.1
"""What an axis that is on its limit switch may move further onto it, such as by settling
[mm or deg]."""
_AT_LIMIT = 1.0 - 1e-9
"""Share of the force limit from which a drive counts as being at it: rounding, not slack."""


class Watch:
    """Looks at chunks of samples for the first that raises an alarm."""

    def __init__(self, machine: MachineConfig) -> None:
        axes = [machine.axis(name) for name in machine.axes.names]
        self._names = machine.axes.names
        self._units = ["mm" if kind == "linear" else "deg" for kind in machine.axes.kinds]
        self._forces = ["N" if kind == "linear" else "N m" for kind in machine.axes.kinds]
        force_limit = np.array([axis.force_limit or np.inf for axis in axes])
        patience = [round(axis.saturation_time_s / machine.file.servo_period_s) for axis in axes]
        switches = np.array([limit_switches(axis) for axis in axes]).T.copy()
        self._force_limit = force_limit
        self._watched = AxisWatch(
            lag=np.array([axis.following_error_limit or np.inf for axis in axes]),
            force=force_limit * _AT_LIMIT,
            patience=np.array(patience),
            switches=switches,
            raised_at=switches.copy(),
            saturated=np.zeros(len(axes), np.int64),
        )

    def acknowledge(self, position: FloatArray) -> None:
        """Raise again only what gets worse than it is: an axis may leave its limit switch.

        Args:
            position: Where the axes stand, shape (k,) [mm or deg].
        """
        watched = self._watched
        watched.saturated[:] = 0
        watched.raised_at[0] = np.minimum(watched.switches[0], position - _ON_SWITCH)
        watched.raised_at[1] = np.maximum(watched.switches[1], position + _ON_SWITCH)

    def look(self, samples: Samples) -> Alarm | None:
        """Return the alarm of the first sample that raises one."""
        setpoint, position = samples.setpoint.position, samples.joint_position
        kind, row, axis = find_raised(self._watched, setpoint, position, samples.drive_force)
        if kind == Raised.NOTHING:
            return None
        here = float(position[row, axis])
        behind = abs(float(setpoint[row, axis]) - here)
        messages: dict[int, tuple[AlarmCode, str]] = {
            Raised.HARD_LIMIT: ("hard-limit", self._at_switch(here, axis)),
            Raised.FOLLOWING_ERROR: ("following-error", self._behind(behind, axis)),
            Raised.SATURATION: ("drive-saturation", self._at_limit(axis)),
        }
        code, message = messages[kind]
        line, time = int(samples.setpoint.line[row]), float(samples.setpoint.time[row])
        return Alarm(code, line, time, self._names[axis], message)

    def _at_switch(self, position: float, axis: int) -> str:
        return (
            f"{self._names[axis]} ran onto its limit switch at {position:.3f} {self._units[axis]} "
            "in machine coordinates"
        )

    def _behind(self, lag: float, axis: int) -> str:
        unit = self._units[axis]
        return (
            f"{self._names[axis]} trails its setpoint by {lag:.3f} {unit}, "
            f"more than {self._watched.lag[axis]:g} {unit}"
        )

    def _at_limit(self, axis: int) -> str:
        return (
            f"the drive of {self._names[axis]} has been at its limit of "
            f"{self._force_limit[axis]:g} {self._forces[axis]} for longer than it may"
        )


def limit_switches(axis: AxisTable) -> tuple[float, float]:
    """Where the limit switches of an axis lie [mm or deg]."""
    if axis.limit_switches is not None:
        return axis.limit_switches
    if axis.travel is None:
        return (-np.inf, np.inf)
    return (axis.travel[0] - OVERTRAVEL, axis.travel[1] + OVERTRAVEL)
