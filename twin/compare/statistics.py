"""Maximum, root mean square and percentile of a stream, in bounded memory."""

import math

import numpy as np

from twin.compilation.kernel import kernel
from twin.nc.canonical import FloatArray

MANTISSA_BITS = 10
"""Bins per octave are 2 to this power: none is wider than 0.1 % of the values in it."""
LEAST_EXPONENT = -13
"""Values below 2 to this power share the first bin [µm or mdeg]: a tenth of a nanometre."""
GREATEST_EXPONENT = 27
"""Values from 2 to this power on share the last bin."""
SHIFT = 52 - MANTISSA_BITS
FIRST_CODE = (1023 + LEAST_EXPONENT) << MANTISSA_BITS
BINS = ((GREATEST_EXPONENT - LEAST_EXPONENT) << MANTISSA_BITS) + 1
_SIGN_AWAY = 0x7FFF_FFFF_FFFF_FFFF


@kernel
def bin_of(bits):
    """The bin of a magnitude, from the exponent and the leading mantissa bits of its float: it takes no logarithm."""
    index = ((bits & _SIGN_AWAY) >> SHIFT) - FIRST_CODE + 1
    return min(max(index, 0), BINS - 1)


@kernel
def count_into(values, bits, histogram, squares):
    """Count values into a histogram.

    Args:
        values: Shape (n,).
        bits: The same memory seen as int64, shape (n,).
        histogram: Counts by bin, added to, shape (BINS,).
        squares: Sum of the squares of those before, which is gone on with value by value: however a
            stream is divided, it comes to the same bits.

    Returns:
        Index of the greatest magnitude (the first of several) and the sum of the squares.
    """
    worst, greatest = 0, -1.0
    for i in range(len(values)):
        size = abs(values[i])
        histogram[bin_of(bits[i])] += 1
        squares += size * size
        if size > greatest:
            worst, greatest = i, size
    return worst, squares


RESOLUTION = 1e-3
"""A percentile is at most this much too high, relatively: the width of a bin."""


class Distribution:
    """Size of the values seen so far, sign left out, with a histogram of logarithmic bins.

    Attributes:
        greatest: The greatest magnitude; 0 before the first.
    """

    def __init__(self) -> None:
        self.count = 0
        self.greatest = 0.0
        self._squares = 0.0
        self._histogram = np.zeros(BINS, np.int64)

    def add(self, values: FloatArray) -> int | None:
        """Take in more values, shape (n,).

        Returns:
            Index of the value that is greater than all before it, if one is; of the very first
            values, of the greatest among them.
        """
        if not len(values):
            return None
        values = np.ascontiguousarray(values, np.float64)
        worst, self._squares = count_into(
            values, values.view(np.int64), self._histogram, self._squares
        )
        greatest = abs(float(values[worst]))
        greater = self.count == 0 or greatest > self.greatest
        self.count += len(values)
        self.greatest = max(self.greatest, greatest)
        return int(worst) if greater else None

    def copy(self) -> "Distribution":
        """A distribution that goes on from here by itself."""
        other = Distribution()
        other.count, other.greatest, other._squares = self.count, self.greatest, self._squares
        other._histogram = self._histogram.copy()
        return other

    @property
    def rms(self) -> float:
        """Root mean square; 0 before the first value."""
        return math.sqrt(self._squares / self.count) if self.count else 0.0

    def percentile(self, percent: float) -> float:
        """The value that ``percent`` of all do not exceed, at most ``RESOLUTION`` too high.

        Nearest-rank definition: the smallest value that at least that share of all lies at or
        below.
        """
        if not self.count:
            return 0.0
        rank = max(1, math.ceil(percent / 100.0 * self.count))
        index = int(np.searchsorted(np.cumsum(self._histogram), rank))
        return min(upper_edge(index), self.greatest)


def upper_edge(index: int) -> float:
    """Where a bin ends [µm or mdeg]."""
    return float(np.array([(index + FIRST_CODE) << SHIFT], np.int64).view(np.float64)[0])
