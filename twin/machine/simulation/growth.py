"""How the machine grows as spindle and drives warm it (ISO 230-3 is how that is measured).

Each cause of growth is a state of first order. With what drives it as a share q of ``at``, and the
time constant T, it follows

    T s' = q - s,

solved exactly over each servo period, and shifts the tool by s times ``um``.
"""

import dataclasses
from collections.abc import Callable

import numpy as np

from twin.machine.description.config import MachineConfig
from twin.machine.simulation.setpoint_filter import relax
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.recording.form import Samples
from twin.units import UM_PER_MM, to_si


class Growth:
    """Follows a run from cold on, chunk by chunk."""

    def __init__(
        self, machine: MachineConfig, spindle_speed: Callable[[Setpoints], FloatArray] | None = None
    ) -> None:
        """Begin with a cold machine.

        Args:
            machine: Its file says how it grows.
            spindle_speed: Speed of the spindle at setpoints, shape (n,) [1/min]; not a number
                where it is not known, which warms nothing. None: it stands.
        """
        tables = list(machine.file.thermal.values())
        self._spindle_speed = spindle_speed
        self._sources = [
            None if table.source == "spindle" else machine.axes.index(table.source)
            for table in tables
        ]
        self._unit = np.array([to_si(kind) for kind in machine.axes.kinds])
        self._at = np.array([table.at for table in tables])
        period = machine.file.servo_period_s
        self._keep = np.exp(-period / np.array([table.time_constant_s for table in tables]))
        self._shift = np.array([table.um for table in tables]).reshape(-1, 3) / UM_PER_MM
        self._state = np.zeros(len(tables))

    def warm(self, samples: Samples) -> Samples:
        """The samples of a chunk that follows the last one, with what the machine has grown."""
        if not len(self._state) or not len(samples):
            return samples
        if samples.tool is not None:
            speed = samples.tool.spindle_speed
        elif self._spindle_speed is not None:
            speed = np.nan_to_num(self._spindle_speed(samples.setpoint))
        else:
            speed = np.zeros(len(samples))
        power = np.abs(samples.drive_force * samples.joint_velocity) * self._unit
        driven = [speed if axis is None else power[:, axis] for axis in self._sources]
        goal = np.abs(np.column_stack(driven)) / self._at
        states = relax(self._state, self._keep, goal)
        self._state = states[-1].copy()
        return dataclasses.replace(samples, growth=states @ self._shift)
