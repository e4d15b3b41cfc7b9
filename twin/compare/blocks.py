"""Contour error by block: feeds and rapids of every source line apart."""

import dataclasses

import numpy as np
import numpy.typing as npt

from twin.compare.block_kernels import NOBODY, PASSAGE_BINS, ROW, close, collect
from twin.nc.canonical import FloatArray, IntArray, Motion, Moves, Shape

BoolArray = npt.NDArray[np.bool_]


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
    """

    line: IntArray
    rapid: BoolArray
    arc: BoolArray
    samples: IntArray
    max_um: FloatArray
    rms_um: FloatArray
    p99_um: FloatArray
    time_s: FloatArray

    def __len__(self) -> int:
        return len(self.line)


class BlockCollector:
    """Collects by source line; its memory grows with the text of the program, not with time.

    Row ``2 * line`` of the columns is about the feeds of a line, the next about its rapids.

    Attributes:
        greatest: Greatest contour error by row, shape (m,) [µm].
        when: Its time by row, shape (m,) [s].
    """

    def __init__(self) -> None:
        self.greatest = np.zeros(0)
        self.when = np.zeros(0)
        self._samples = np.zeros(0, np.int64)
        self._arc = np.zeros(0, np.bool_)
        self._squares = np.zeros(0)
        self._p99 = np.zeros(0)
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
            The rows that the tool was in, each once.
        """
        row = 2 * line
        if place is not None:
            row += moves.motion[place] == Motion.RAPID
        entered = np.flatnonzero(np.diff(row, prepend=NOBODY))
        rows = np.unique(row[entered])
        self._grow(int(rows[-1]) + 1)
        if place is not None:
            here = place[np.flatnonzero(np.diff(place, prepend=NOBODY))]
            arcs = here[moves.shape[here] == Shape.ARC]
            self._arc[2 * moves.line[arcs] + (moves.motion[arcs] == Motion.RAPID)] = True
        self._latest = collect(
            row, error, error.view(np.int64), time, self._latest, self._open_rows, self._open_bins,
            self._samples, self._squares, self.greatest, self.when, self._p99,
        )  # fmt: skip
        return rows

    def _grow(self, size: int) -> None:
        missing = size - len(self.greatest)
        if missing <= 0:
            return
        missing += size // 2
        self._samples = np.append(self._samples, np.zeros(missing, np.int64))
        self._arc = np.append(self._arc, np.zeros(missing, np.bool_))
        self._squares = np.append(self._squares, np.zeros(missing))
        self._p99 = np.append(self._p99, np.zeros(missing))
        self.greatest = np.append(self.greatest, np.zeros(missing))
        self.when = np.append(self.when, np.zeros(missing))

    def figures(self) -> BlockFigures:
        """The blocks so far, those that the tool is in as far as it got."""
        p99 = self._p99.copy()
        for passage, bins in zip(self._open_rows.copy(), self._open_bins.copy(), strict=True):
            if passage[ROW] != NOBODY:
                close(passage, bins, self.greatest, p99)
        row = np.flatnonzero(self._samples)
        return BlockFigures(
            line=row // 2,
            rapid=row % 2 == 1,
            arc=self._arc[row],
            samples=self._samples[row],
            max_um=self.greatest[row],
            rms_um=np.sqrt(self._squares[row] / self._samples[row]),
            p99_um=p99[row],
            time_s=self.when[row],
        )


NO_BLOCKS = BlockCollector().figures()
