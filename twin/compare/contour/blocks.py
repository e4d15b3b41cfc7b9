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
            The rows of the blocks that the tool was in, each once.
        """
        block = 2 * line
        if place is not None:
            block += moves.motion[place] == Motion.RAPID
        entered = np.flatnonzero(np.diff(block, prepend=NOBODY))
        blocks, which = np.unique(block[entered], return_inverse=True)
        rows = self._rows_of(blocks)
        entered_rows = rows[which]
        if place is not None:
            here = np.flatnonzero(np.diff(place, prepend=NOBODY))
            arcs = here[moves.shape[place[here]] == Shape.ARC]
            self.columns.arc[entered_rows[np.searchsorted(entered, arcs, side="right") - 1]] = True
        self._latest = collect(
            np.repeat(entered_rows, np.diff(entered, append=len(block))), error,
            error.view(np.int64), time, self._latest, self._open, self.columns,
        )  # fmt: skip
        return rows

    def _rows_of(self, blocks: IntArray) -> IntArray:
        """The rows of blocks, new ones for those that have none."""
        new = self._unknown(blocks)
        if len(self._row_of) + len(new) > 2 * self._remembered:
            self._forget(blocks)
            new = self._unknown(blocks)
        first = len(self._row_of)
        self._grow(first + len(new))
        self.columns.block[first : first + len(new)] = new
        self._row_of.update((block, first + index) for index, block in enumerate(new))
        return np.array([self._row_of[block] for block in blocks.tolist()], np.int64)

    def _unknown(self, blocks: IntArray) -> list[int]:
        return [block for block in blocks.tolist() if block not in self._row_of]

    def _forget(self, needed: IntArray) -> None:
        """Let go of all but the worst blocks, those needed now, and those that the tool is in."""
        count = len(self._row_of)
        block = self.columns.block[:count]
        worst_first = np.lexsort((block, -self.columns.greatest[:count]))
        _, worst_apart = np.unique(self._judged_with(block)[worst_first], return_index=True)
        kept = np.isin(block, needed)
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
