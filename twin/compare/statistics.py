"""Maximum, root mean square and percentile of a stream, in bounded memory."""

import math

import numpy as np

from twin.nc.canonical import FloatArray

RESOLUTION = 1e-3
"""Relative width of a histogram bin: a percentile is right to 0.1 %."""
LEAST = 1e-4
"""Values up to this share the first bin [µm or mdeg]: a tenth of a nanometre."""
_GREATEST = 1e8
_BINS = 2 + math.ceil(math.log(_GREATEST / LEAST) / math.log1p(RESOLUTION))


class Extent:
    """Size of the values seen so far, sign left out.

    Attributes:
        count: How many values.
        greatest: The greatest magnitude; 0 before the first.
    """

    def __init__(self) -> None:
        self.count = 0
        self.greatest = 0.0
        self._squares = 0.0

    def add(self, values: FloatArray) -> None:
        """Take in more values, shape (n,)."""
        if len(values):
            self.count += len(values)
            self.greatest = max(self.greatest, float(np.abs(values).max()))
            self._squares += float(values @ values)

    @property
    def rms(self) -> float:
        """Root mean square; 0 before the first value."""
        return math.sqrt(self._squares / self.count) if self.count else 0.0


class Distribution(Extent):
    """An ``Extent`` that also knows percentiles, by a histogram with logarithmic bins."""

    def __init__(self) -> None:
        super().__init__()
        self._histogram = np.zeros(_BINS, np.int64)

    def add(self, values: FloatArray) -> None:
        """Take in more values, shape (n,)."""
        super().add(values)
        size = np.clip(np.abs(values), LEAST, _GREATEST)
        bins = np.ceil(np.log(size / LEAST) / math.log1p(RESOLUTION)).astype(np.int64)
        self._histogram += np.bincount(bins, minlength=_BINS)

    def percentile(self, percent: float) -> float:
        """The value that ``percent`` of all do not exceed, at most ``RESOLUTION`` too high.

        Nearest-rank definition: the smallest value that at least that share of all lies at or
        below.
        """
        if not self.count:
            return 0.0
        rank = max(1, math.ceil(percent / 100.0 * self.count))
        index = int(np.searchsorted(np.cumsum(self._histogram), rank))
        return min(LEAST * (1.0 + RESOLUTION) ** index, self.greatest)
