"""Contour error by block, sample by sample.

A *passage* is the time that the tool spends on one block. Two passages are kept open, so that a
tool that goes to and fro between two blocks, as it does when it rings about a corner, stays in
the same two.
"""

import math

from twin.compare.statistics_kernels import BINS, FIRST_CODE, MANTISSA_BITS, bin_of
from twin.compilation.kernel import array_kernel

COARSER = 3
"""Passages are told apart by bins 2 to this power times wider than those of a whole run: 0.8 %."""
PASSAGE_BINS = (BINS >> COARSER) + 1
ROW, COUNT, LOW, HIGH = 0, 1, 2, 3
"""Columns of an open passage: its row, its samples, the least and greatest bin in use."""
NOBODY = -1
"""Row of a passage that has not begun."""


@array_kernel
def close(passage, bins, greatest, p99):
    """Enter the 99th percentile of a passage (nearest rank) into its row, and empty it.

    Args:
        passage: Its row, count, least and greatest bin, shape (4,); read and written.
        bins: Its histogram, shape (PASSAGE_BINS,); read and written.
        greatest: By row: greatest error, shape (m,).
        p99: By row: greatest percentile so far, shape (m,); written.
    """
    if passage[COUNT] == 0:
        return
    row, index, above = passage[ROW], passage[HIGH], 0
    while above + bins[index] <= passage[COUNT] // 100:
        above += bins[index]
        index -= 1
    code = (index << COARSER) + (1 << COARSER) - 1 + FIRST_CODE
    octave = 1 << MANTISSA_BITS
    edge = math.ldexp(1.0 + (code & (octave - 1)) / octave, (code >> MANTISSA_BITS) - 1023)
    p99[row] = max(p99[row], min(edge, greatest[row]))
    bins[passage[LOW] : passage[HIGH] + 1] = 0
    passage[COUNT] = 0


@array_kernel
def collect(
    row, error, bits, time, latest, open_rows, open_bins, samples, squares, greatest, when, p99
):
    """Take in the samples of a chunk.

    Args:
        row: Row of the block of each sample, shape (n,).
        error: Contour error, shape (n,) [µm].
        bits: The same memory seen as int64, shape (n,).
        time: Shape (n,) [s].
        latest: Which of the two open passages the tool was in last.
        open_rows: The open passages: row, count, least and greatest bin, shape (2, 4); written.
        open_bins: Their histograms, shape (2, PASSAGE_BINS); written.
        samples: By row: how many, added to, shape (m,).
        squares: By row: sum of squares, added to, shape (m,).
        greatest: By row: greatest error, shape (m,).
        when: By row: its time, shape (m,).
        p99: By row: greatest 99th percentile of a passage, shape (m,).

    Returns:
        Which of the two open passages the tool is in now.
    """
    for i in range(len(row)):
        r, size = row[i], error[i]
        if open_rows[latest, ROW] != r:
            latest = 1 - latest
            if open_rows[latest, ROW] != r:
                close(open_rows[latest], open_bins[latest], greatest, p99)
                open_rows[latest, ROW] = r
        index = bin_of(bits[i]) >> COARSER
        passage = open_rows[latest]
        open_bins[latest, index] += 1
        if passage[COUNT] == 0:
            passage[LOW], passage[HIGH] = index, index
        passage[COUNT] += 1
        passage[LOW], passage[HIGH] = min(passage[LOW], index), max(passage[HIGH], index)
        samples[r] += 1
        squares[r] += size * size
        if samples[r] == 1 or size > greatest[r]:
            greatest[r], when[r] = size, time[i]
    return latest
