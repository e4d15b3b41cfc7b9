"""Samples that come one by one, kept until they are handed on as columns."""

import dataclasses

import numpy as np

from twin.columns import join
from twin.recording.form import Samples


class SampleLog:
    """Remembers samples.

    Attributes:
        ticks: How many came in all.
        standing: For how many of the last ones nothing was to move.
    """

    def __init__(self, period_s: float) -> None:
        """Begin with none.

        Args:
            period_s: Time between two samples, the first of which is at 0 [s].
        """
        self.ticks = 0
        self.standing = 0
        self._period = period_s
        self._kept: list[Samples] = []

    def __len__(self) -> int:
        return len(self._kept)

    def add(self, sample: Samples) -> None:
        """Remember one sample."""
        self._kept.append(sample)
        self.ticks += 1
        self.standing = 0 if any(sample.setpoint.velocity[0].tolist()) else self.standing + 1

    def take(self, count: int) -> Samples:
        """Hand the first samples on, and forget them; of no move yet."""
        first = self.ticks - len(self._kept)
        samples = join(self._kept[:count])
        del self._kept[:count]
        time = np.arange(first, first + count) * np.float64(self._period)
        return dataclasses.replace(
            samples, setpoint=dataclasses.replace(samples.setpoint, time=time)
        )
