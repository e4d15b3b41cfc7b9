"""What the control watches while the axes move."""

import numpy as np

from twin.machine.alarms import Alarm
from twin.machine.config import Machine
from twin.recording import Samples


class Watch:
    """Looks at chunks of samples for the first that raises an alarm."""

    def __init__(self, machine: Machine) -> None:
        self._names = machine.axes.names
        self._units = ["mm" if kind == "linear" else "deg" for kind in machine.axes.kinds]
        limits = [machine.axis(name).following_error_limit for name in self._names]
        self._lag_limit = np.array([limit or np.inf for limit in limits])

    def look(self, samples: Samples) -> Alarm | None:
        """Return the alarm of the first sample that raises one."""
        lag = np.abs(samples.setpoint.position - samples.joint_position)
        over = lag > self._lag_limit
        rows = np.flatnonzero(over.any(axis=1))
        if not len(rows):
            return None
        row = int(rows[0])
        axis = int(np.argmax(over[row]))
        return Alarm(
            "following-error",
            int(samples.setpoint.line[row]),
            float(samples.setpoint.time[row]),
            self._names[axis],
            f"{self._names[axis]} trails its setpoint by {lag[row, axis]:.3f} {self._units[axis]}, "
            f"more than {self._lag_limit[axis]:g}",
        )
