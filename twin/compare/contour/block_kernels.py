"""Contour error by block, sample by sample.

A *passage* is the time that the tool spends on one block. Two passages are kept open, so that a
tool that goes to and fro between two blocks, as it does when it rings about a corner, stays in
the same two.
"""

import enum
import math
from typing import NamedTuple

from twin.compare.statistics_kernels import BINS, FIRST_CODE, MANTISSA_BITS, bin_of
from twin.compilation.kernel import kernel
from twin.nc.canonical import BoolArray, FloatArray, IntArray

COARSER = 3
"""Passages are told apart by bins 2 to this power times wider than those of a whole run: 0.8 %."""
PASSAGE_BINS = (BINS >> COARSER) + 1
NOBODY = -1
"""Row of a passage that has not begun."""


class Passage(enum.IntEnum):
    """Columns of an open passage."""

    ROW = 0
    COUNT = 1
    """Samples."""
    LOW = 2
    """Least bin in use."""
    HIGH = 3


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
        rows: A ``Passage`` each, shape (2, 4).
        bins: Their histograms, shape (2, PASSAGE_BINS).
    """

    rows: IntArray
    bins: IntArray


@kernel
def close(passage, bins, greatest, p99):
    """Enter the 99th percentile of a passage (nearest rank) into its row, and empty it.

    Args:
        passage: Its row, count, least and greatest bin, shape (4,); read and written.
        bins: Its histogram, shape (PASSAGE_BINS,); read and written.
        greatest: By row: greatest error, shape (m,).
        p99: By row: greatest percentile so far, shape (m,); written.
    """
    if passage[Passage.COUNT] == 0:
        return
    row, index, above = passage[Passage.ROW], passage[Passage.HIGH], 0
    while above + bins[index] <= passage[Passage.COUNT] // 100:
        above += bins[index]
        index -= 1
    code = (index << COARSER) + (1 << COARSER) - 1 + FIRST_CODE
    octave = 1 << MANTISSA_BITS
    edge = math.ldexp(1.0 + (code & (octave - 1)) / octave, (code >> MANTISSA_BITS) - 1023)
    p99[row] = max(p99[row], min(edge, greatest[row]))
    bins[passage[Passage.LOW] : passage[Passage.HIGH] + 1] = 0
    passage[Passage.COUNT] = 0


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
        if passages.rows[latest, Passage.ROW] != r:
            latest = 1 - latest
            if passages.rows[latest, Passage.ROW] != r:
                close(passages.rows[latest], passages.bins[latest], blocks.greatest, blocks.p99)
                passages.rows[latest, Passage.ROW] = r
        index = bin_of(bits[i]) >> COARSER
        passage = passages.rows[latest]
        passages.bins[latest, index] += 1
        if passage[Passage.COUNT] == 0:
            passage[Passage.LOW], passage[Passage.HIGH] = index, index
        passage[Passage.COUNT] += 1
        passage[Passage.LOW], passage[Passage.HIGH] = (
            min(passage[Passage.LOW], index),
            max(passage[Passage.HIGH], index),
        )
        blocks.samples[r] += 1
        blocks.squares[r] += size * size
        if blocks.samples[r] == 1 or size > blocks.greatest[r]:
            blocks.greatest[r], blocks.when[r] = size, time[i]
    return latest
