"""Setpoints of positions that come one by one: what a drive can know of them, as a recording keeps it."""

import numpy as np

from twin.nc.canonical import FloatArray
from twin.recording.form import STEPS

_POSITION, _VELOCITY, _ACCELERATION = (
    STEPS[f"setpoint/{name}"] for name in ("position", "velocity", "acceleration")
)


class Commands:
    """Turns commanded positions into setpoints.

    Attributes:
        position: The last one, shape (k,) [mm or deg].
        velocity: Backward difference of the positions, shape (k,) [mm/s or deg/s].
        acceleration: Backward difference of the velocities, shape (k,) [mm/s² or deg/s²].
    """

    def __init__(self, period_s: float, position: FloatArray) -> None:
        """Begin at rest.

        Args:
            period_s: Time between two positions [s].
            position: Where, shape (k,) [mm or deg].
        """
        self._period = period_s
        self.rest_at(position)

    def rest_at(self, position: FloatArray) -> None:
        """Stand at a position."""
        self.position = rounded(position, _POSITION)
        self.velocity = np.zeros(len(position))
        self.acceleration = np.zeros(len(position))

    def go_to(self, position: FloatArray) -> None:
        """Take the next position, one period later."""
        goal = rounded(position, _POSITION)
        velocity = rounded((goal - self.position) / self._period, _VELOCITY)
        self.acceleration = rounded((velocity - self.velocity) / self._period, _ACCELERATION)
        self.position, self.velocity = goal, velocity


def rounded(values: FloatArray, step: float) -> FloatArray:
    """To multiples of a step, as a recording keeps them."""
    return np.rint(values / step) * step
