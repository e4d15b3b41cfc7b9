"""Samples that come one by one, kept until they are handed on as columns."""

import numpy as np

from twin.motion.setpoints.setpoints import Setpoints
from twin.recording.form import Samples

_FIRST_SIZE = 1024


class SampleLog:
    """Remembers samples.

    Attributes:
        ticks: How many came in all.
        standing: For how many of the last ones nothing was to move.
    """

    def __init__(self, axes: int, period_s: float) -> None:
        """Begin with none.

        Args:
            axes: Number of axes.
            period_s: Time between two samples, the first of which is at 0 [s].
        """
        self._period = period_s
        self.ticks = 0
        self.standing = 0
        self._count = 0
        self._lines = np.zeros((1, _FIRST_SIZE), np.int64)
        self._vectors = np.zeros((6, _FIRST_SIZE, axes))

    def __len__(self) -> int:
        return self._count

    def add(self, sample: Samples) -> None:
        """Remember one sample."""
        row, setpoint = self._count, sample.setpoint
        if row == self._lines.shape[1]:
            self._grow()
        self._lines[0, row] = setpoint.line[0]
        vectors = self._vectors
        vectors[0, row] = setpoint.position[0]
        vectors[1, row] = setpoint.velocity[0]
        vectors[2, row] = setpoint.acceleration[0]
        vectors[3, row] = sample.joint_position[0]
        vectors[4, row] = sample.joint_velocity[0]
        vectors[5, row] = sample.drive_force[0]
        self._count += 1
        self.ticks += 1
        self.standing = 0 if setpoint.velocity.any() else self.standing + 1

    def take(self, count: int) -> Samples:
        """Hand the first samples on, and forget them; of no move yet."""
        first = self.ticks - self._count
        time = np.arange(first, first + count) * np.float64(self._period)
        line = self._lines[0, :count].copy()
        position, velocity, acceleration, joint, speed, force = self._vectors[:, :count].copy()
        left = self._count - count
        for columns in (self._lines, self._vectors):
            columns[:, :left] = columns[:, count : self._count].copy()
        self._count = left
        none = np.zeros(count, np.int64)
        setpoint = Setpoints(
            time, line, none, np.zeros(count), position, velocity, acceleration
        )  # fmt: skip
        return Samples(setpoint, joint, speed, force)

    def _grow(self) -> None:
        self._lines = np.concatenate([self._lines, np.zeros_like(self._lines)], axis=1)
        self._vectors = np.concatenate([self._vectors, np.zeros_like(self._vectors)], axis=1)
