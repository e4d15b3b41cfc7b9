"""Contour error by block: feeds and rapids of every source line apart."""

from collections.abc import Sequence

import numpy as np

from twin.compare.contour.block_kernels import (
    NOBODY,
    PASSAGE_BINS,
    BlockColumns,
    OpenPassages,
    close,
    collect,
)
from twin.compare.figures import BlockFigures
from twin.nc.canonical import FloatArray, IntArray, Motion, Moves, Shape

BLOCKS_REMEMBERED = 1 << 16
"""Blocks whose figures are kept where a program has more than twice as many, the worst: 20 MB, as
against a gigabyte for the five million of a mould, and 65 times what is reported."""


class BlockCollector:
    """Collects by source line, in bounded memory: beyond a number the worst blocks are kept.

    Attributes:
        columns: What is known of each block so far, with spare rows at the end.
    """

    def __init__(
        self, apart: Sequence[tuple[int, int]] = (), remembered: int = BLOCKS_REMEMBERED
    ) -> None:
        """Begin with nothing.

        Args:
            apart: First and last line of ranges that are judged apart; the worst block of each is
                kept whatever the others are like.
            remembered: How many blocks are kept at least, where there are so many.
        """
        self._apart = tuple(apart)
        self._remembered = remembered
        self._row_of: dict[int, int] = {}
        self.columns = BlockColumns(
            block=np.zeros(0, np.int64),
            greatest=np.zeros(0),
            when=np.zeros(0),
            samples=np.zeros(0, np.int64),
            arc=np.zeros(0, np.bool_),
            squares=np.zeros(0),
            p99=np.zeros(0),
        )
        self._forgotten = 0
        self._latest = 0
        self._open = OpenPassages(
            row=np.full(2, NOBODY, np.int64),
            samples=np.zeros(2, np.int64),
            lowest=np.zeros(2, np.int64),
            highest=np.zeros(2, np.int64),
            bins=np.zeros((2, PASSAGE_BINS), np.int64),
        )

    def add(
        self, moves: Moves, place: IntArray | None, line: IntArray, error: FloatArray,
        time: FloatArray,
    ) -> IntArray:  # fmt: skip
        """Take in a chunk of n samples.

        Args:
            place: Index in ``moves`` of each sample's nearest place, or None without a path.
            line: Source line of that place, shape (n,).
            error: Contour error, shape (n,) [µm].
            time: Shape (n,) [s].

        Returns:
            The rows of the blocks that the tool was in and that are not forgotten yet, each once, by block.
        """
        block, arc = 2 * line, np.zeros(len(line), np.bool_)
        if place is not None:
            block += moves.motion[place] == Motion.RAPID
            arc = moves.shape[place] == Shape.ARC
        entered = np.flatnonzero(np.diff(block, prepend=NOBODY))
        stays, has_arc = block[entered], np.logical_or.reduceat(arc, entered)
        ends, first, bits = np.append(entered, len(block)), 0, error.view(np.int64)
        while first < len(stays):
            rows = self._rows_of(stays[first:])
            last = first + len(rows)
            self.columns.arc[rows[has_arc[first:last]]] = True
            here = slice(ends[first], ends[last])
            self._latest = collect(
                np.repeat(rows, np.diff(ends[first : last + 1])), error[here], bits[here],
                time[here], self._latest, self._open, self.columns,
            )  # fmt: skip
            first = last
        known = self._row_of
        return np.array([known[b] for b in np.unique(stays).tolist() if b in known], np.int64)

    def _rows_of(self, stays: IntArray) -> IntArray:
        """The rows of the blocks that the tool comes to in turn, new ones for those that have none.

        They end before the block that is one too many. Others are forgotten when the tool has come to it, so that it
        does not matter how the samples are divided into chunks.
        """
        row_of, most = self._row_of, 2 * self._remembered
        if len(row_of) >= most and int(stays[0]) not in row_of:
            self._forget()
            row_of = self._row_of
        count, new, rows = len(row_of), [], []
        for block in stays.tolist():
            if block not in row_of:
                if rows and len(row_of) >= most:
                    break
                row_of[block] = len(row_of)
                new.append(block)
            rows.append(row_of[block])
        self._grow(len(row_of))
        self.columns.block[count : len(row_of)] = new
        return np.array(rows, np.int64)

    def _forget(self) -> None:
        """Let go of all but the worst blocks, and those that the tool is in."""
        count = len(self._row_of)
        block = self.columns.block[:count]
        worst_first = np.lexsort((block, -self.columns.greatest[:count]))
        _, worst_apart = np.unique(self._judged_with(block)[worst_first], return_index=True)
        kept = np.zeros(count, np.bool_)
        kept[worst_first[: self._remembered]] = True
        kept[worst_first[worst_apart]] = True
        open_row = self._open.row
        used = open_row != NOBODY
        kept[open_row[used]] = True
        rows = np.flatnonzero(kept)
        self.columns = BlockColumns._make(column[rows] for column in self.columns)
        open_row[used] = np.searchsorted(rows, open_row[used])
        self._row_of = {block: row for row, block in enumerate(self.columns.block.tolist())}
        self._forgotten += count - len(rows)

    def _judged_with(self, block: IntArray) -> IntArray:
        """A number for those blocks that one limit may hold for, and no other, shape (m,)."""
        group = block % 2
        for number, (first, last) in enumerate(self._apart, start=2):
            group[(block // 2 >= first) & (block // 2 <= last)] = number
        return group

    def _grow(self, size: int) -> None:
        missing = size - len(self.columns.block)
        if missing <= 0:
            return
        missing += size // 2
        self.columns = BlockColumns._make(
            np.append(column, np.zeros(missing, column.dtype)) for column in self.columns
        )

    def figures(self) -> BlockFigures:
        """The blocks so far, those that the tool is in as far as it got."""
        known = self.columns
        p99 = known.p99.copy()
        passages = OpenPassages._make(column.copy() for column in self._open)
        for which in np.flatnonzero(passages.row != NOBODY):
            close(passages, which, known.greatest, p99)
        row = np.argsort(known.block[: len(self._row_of)])
        return BlockFigures(
            line=known.block[row] // 2,
            rapid=known.block[row] % 2 == 1,
            arc=known.arc[row],
            samples=known.samples[row],
            max_um=known.greatest[row],
            rms_um=np.sqrt(known.squares[row] / known.samples[row]),
            p99_um=p99[row],
            time_s=known.when[row],
            forgotten=self._forgotten,
        )
