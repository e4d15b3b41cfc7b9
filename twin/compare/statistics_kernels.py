"""Counting values into the bins of a histogram, for compiled loops.

The bins are told from the bits of a float: its exponent and the leading bits of its mantissa, so
that finding one takes no logarithm.
"""

from twin.compilation.kernel import kernel

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
    """The bin of a magnitude, from the 64 bits of its float."""
    index = ((bits & _SIGN_AWAY) >> SHIFT) - FIRST_CODE + 1
    return min(max(index, 0), BINS - 1)


@kernel
def tally(values, bits, histogram):
    """Count values into a histogram.

    Args:
        values: Shape (n,).
        bits: The same memory seen as int64, shape (n,).
        histogram: Counts by bin, added to, shape (BINS,).

    Returns:
        Index of the greatest magnitude (the first of several) and the sum of the squares.
    """
    worst, greatest, squares = 0, -1.0, 0.0
    for i in range(len(values)):
        size = abs(values[i])
        histogram[bin_of(bits[i])] += 1
        squares += size * size
        if size > greatest:
            worst, greatest = i, size
    return worst, squares
