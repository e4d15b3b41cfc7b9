"""Contour error by block: feeds and rapids of every source line apart."""

import dataclasses
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from twin.compare.block_kernels import NOBODY, PASSAGE_BINS, ROW, close, collect
from twin.nc.canonical import FloatArray, IntArray, Motion, Moves, Shape

BoolArray = npt.NDArray[np.bool_]

BLOCKS_REMEMBERED = 1 << 16
"""Blocks whose figures are kept where a program has more than twice as many, the worst: 20 MB, as
against a gigabyte for the five million of a mould, and 65 times what is reported."""
_COLUMNS = ("block", "greatest", "when", "_samples", "_arc", "_squares", "_p99")


@dataclasses.dataclass(frozen=True, slots=True)
class BlockFigures:
    """Contour error of m blocks as columns, by line; a line's rapids after its feeds.

    Attributes:
        line: Source line, shape (m,).
        rapid: Whether the row is about the rapids of the line, shape (m,).
        arc: Whether an arc is among its moves, shape (m,).
        samples: How many samples were nearest to it, shape (m,).
        max_um: Greatest contour error, shape (m,) [µm].
        rms_um: Root mean square, shape (m,) [µm].
        p99_um: What 99 % of the samples of one passage do not exceed, at most 0.8 % too high; of
            several passages the greatest, shape (m,) [µm].
        time_s: When the greatest was reached, shape (m,) [s].
        forgotten: How often a block was let go of because enough others were worse. Those that are
            the worst of all are exact in ``max_um`` even so; their other figures leave out what
            was before they were let go of and came again.
    """

    line: IntArray
    rapid: BoolArray
    arc: BoolArray
    samples: IntArray
    max_um: FloatArray
    rms_um: FloatArray
    p99_um: FloatArray
    time_s: FloatArray
    forgotten: int = 0

    def __len__(self) -> int:
        return len(self.line)


class BlockCollector:
    """Collects by source line, in bounded memory: beyond a number the worst blocks are kept.

    Attributes:
        block: ``2 * line`` for the feeds of a line, one more for its rapids, shape (m,).
        greatest: Its greatest contour error, shape (m,) [µm].
        when: The time of that, shape (m,) [s].
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
        self.block = np.zeros(0, np.int64)
        self.greatest = np.zeros(0)
        self.when = np.zeros(0)
        self._samples = np.zeros(0, np.int64)
        self._arc = np.zeros(0, np.bool_)
        self._squares = np.zeros(0)
        self._p99 = np.zeros(0)
        self._forgotten = 0
        self._latest = 0
        self._open_rows = np.array([[NOBODY, 0, 0, 0]] * 2, np.int64)
        self._open_bins = np.zeros((2, PASSAGE_BINS), np.int64)

    def add(
        self, moves: Moves, place: IntArray | None, line: IntArray, error: FloatArray,
        time: FloatArray,
    ) -> IntArray:  # fmt: skip
        """Take in a chunk of n samples.

        Args:
            moves: The moves at hand.
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
            self._arc[entered_rows[np.searchsorted(entered, arcs, side="right") - 1]] = True
        self._latest = collect(
            np.repeat(entered_rows, np.diff(entered, append=len(block))), error,
            error.view(np.int64), time, self._latest, self._open_rows, self._open_bins,
            self._samples, self._squares, self.greatest, self.when, self._p99,
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
        self.block[first : first + len(new)] = new
        self._row_of.update((block, first + index) for index, block in enumerate(new))
        return np.array([self._row_of[block] for block in blocks.tolist()], np.int64)

    def _unknown(self, blocks: IntArray) -> list[int]:
        return [block for block in blocks.tolist() if block not in self._row_of]

    def _forget(self, needed: IntArray) -> None:
        """Let go of all but the worst blocks, those needed now, and those that the tool is in."""
        count = len(self._row_of)
        block = self.block[:count]
        worst_first = np.lexsort((block, -self.greatest[:count]))
        _, worst_apart = np.unique(self._judged_with(block)[worst_first], return_index=True)
        kept = np.isin(block, needed)
        kept[worst_first[: self._remembered]] = True
        kept[worst_first[worst_apart]] = True
        used = self._open_rows[:, ROW] != NOBODY
        kept[self._open_rows[used, ROW]] = True
        rows = np.flatnonzero(kept)
        for name in _COLUMNS:
            setattr(self, name, getattr(self, name)[rows])
        self._open_rows[used, ROW] = np.searchsorted(rows, self._open_rows[used, ROW])
        self._row_of = {block: row for row, block in enumerate(self.block.tolist())}
        self._forgotten += count - len(rows)

    def _judged_with(self, block: IntArray) -> IntArray:
        """A number for those blocks that one limit may hold for, and no other, shape (m,)."""
        group = block % 2
        for number, (first, last) in enumerate(self._apart, start=2):
            group[(block // 2 >= first) & (block // 2 <= last)] = number
        return group

    def _grow(self, size: int) -> None:
        missing = size - len(self.block)
        if missing <= 0:
            return
        missing += size // 2
        for name in _COLUMNS:
            column = getattr(self, name)
            setattr(self, name, np.append(column, np.zeros(missing, column.dtype)))

    def figures(self) -> BlockFigures:
        """The blocks so far, those that the tool is in as far as it got."""
        p99 = self._p99.copy()
        for passage, bins in zip(self._open_rows.copy(), self._open_bins.copy(), strict=True):
            if passage[ROW] != NOBODY:
                close(passage, bins, self.greatest, p99)
        row = np.argsort(self.block[: len(self._row_of)])
        return BlockFigures(
            line=self.block[row] // 2,
            rapid=self.block[row] % 2 == 1,
            arc=self._arc[row],
            samples=self._samples[row],
            max_um=self.greatest[row],
            rms_um=np.sqrt(self._squares[row] / self._samples[row]),
            p99_um=p99[row],
            time_s=self.when[row],
            forgotten=self._forgotten,
        )


NO_BLOCKS = BlockCollector().figures()
