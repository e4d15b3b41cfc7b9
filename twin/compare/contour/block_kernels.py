"""Contour error by block, sample by sample.

A *passage* is the time that the tool spends on one block. Two passages are kept open, so that a
tool that goes to and fro between two blocks, as it does when it rings about a corner, stays in
the same two.
"""

import math
from typing import NamedTuple

from twin.compare.statistics import BINS, FIRST_CODE, MANTISSA_BITS, bin_of
from twin.compilation.kernel import kernel
from twin.nc.canonical import BoolArray, FloatArray, IntArray

COARSER = 3
"""Passages are distinguished by bins 2 to this power times wider than those of a whole run: 0.8 %."""
PASSAGE_BINS = (BINS >> COARSER) + 1
NOBODY = -1
"""Row of a passage that has not begun."""


class BlockColumns(NamedTuple):
    """What is known of m blocks.

    Attributes:
        block: ``2 * line`` for the feeds of a line, one more for its rapids, shape (m,).
        greatest: Greatest contour error, shape (m,) [µm].
        when: Time of the greatest, shape (m,) [s].
        samples: How many samples, shape (m,).
        arc: Whether an arc is among its moves, shape (m,).
        squares: Sum of the squared contour errors, shape (m,) [µm²].
        p99: Greatest 99th percentile of a passage, shape (m,) [µm].
    """

    block: IntArray
    greatest: FloatArray
    when: FloatArray
    samples: IntArray
    arc: BoolArray
    squares: FloatArray
    p99: FloatArray


class OpenPassages(NamedTuple):
    """The two passages that the tool was in last.

    Attributes:
        row: Of the block of each; ``NOBODY``: it has not begun, shape (2,).
        samples: How many, shape (2,).
        lowest: Least bin in use, shape (2,).
        highest: Greatest bin in use, shape (2,).
        bins: Their histograms, shape (2, PASSAGE_BINS).
    """

    row: IntArray
    samples: IntArray
    lowest: IntArray
    highest: IntArray
    bins: IntArray


@kernel
def close(passages, which, greatest, p99):
    """Enter the 99th percentile of a passage (nearest rank) into its row, and empty it.

    Args:
        passages: The open passages; read and written.
        which: Of the two.
        greatest: By row: greatest error, shape (m,).
        p99: By row: greatest percentile so far, shape (m,); written.
    """
    if passages.samples[which] == 0:
        return
    bins = passages.bins[which]
    row, index, above = passages.row[which], passages.highest[which], 0
    while above + bins[index] <= passages.samples[which] // 100:
        above += bins[index]
        index -= 1
    code = (index << COARSER) + (1 << COARSER) - 1 + FIRST_CODE
    octave = 1 << MANTISSA_BITS
    edge = math.ldexp(1.0 + (code & (octave - 1)) / octave, (code >> MANTISSA_BITS) - 1023)
    p99[row] = max(p99[row], min(edge, greatest[row]))
    bins[passages.lowest[which] : passages.highest[which] + 1] = 0
    passages.samples[which] = 0


@kernel
def collect(row, error, bits, time, latest, passages, blocks):
    """Take in the samples of a chunk.

    Args:
        row: Row of the block of each sample, shape (n,).
        error: Contour error, shape (n,) [µm].
        bits: The same memory seen as int64, shape (n,).
        time: Shape (n,) [s].
        latest: Which of the two open passages the tool was in last.
        passages: The open passages; written.
        blocks: What is known of the blocks, by row; written.

    Returns:
        Which of the two open passages the tool is in now.
    """
    for i in range(len(row)):
        r, size = row[i], error[i]
        if passages.row[latest] != r:
            latest = 1 - latest
            if passages.row[latest] != r:
                close(passages, latest, blocks.greatest, blocks.p99)
                passages.row[latest] = r
        index = bin_of(bits[i]) >> COARSER
        passages.bins[latest, index] += 1
        if passages.samples[latest] == 0:
            passages.lowest[latest], passages.highest[latest] = index, index
        passages.samples[latest] += 1
        passages.lowest[latest] = min(passages.lowest[latest], index)
        passages.highest[latest] = max(passages.highest[latest], index)
        blocks.samples[r] += 1
        blocks.squares[r] += size * size
        if blocks.samples[r] == 1 or size > blocks.greatest[r]:
            blocks.greatest[r], blocks.when[r] = size, time[i]
    return latest
