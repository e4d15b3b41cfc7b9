"""Contour error by block: feeds and rapids of every source line apart."""

import dataclasses

import numpy as np
import numpy.typing as npt

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
        time_s: When the greatest was reached, shape (m,) [s].
    """

    line: IntArray
    rapid: BoolArray
    arc: BoolArray
    samples: IntArray
    max_um: FloatArray
    rms_um: FloatArray
    time_s: FloatArray

    def __len__(self) -> int:
        return len(self.line)


class BlockCollector:
    """Collects by source line; its memory grows with the text of the program, not with time."""

    def __init__(self) -> None:
        self._samples = np.zeros(0, np.int64)
        self._arc = np.zeros(0, np.bool_)
        self._squares = np.zeros(0)
        self._max = np.zeros(0)
        self._time = np.zeros(0)

    def add(
        self, moves: Moves, place: IntArray | None, line: IntArray, error: FloatArray,
        time: FloatArray,
    ) -> None:  # fmt: skip
        """Take in a chunk of n samples.

        Args:
            moves: The moves at hand.
            place: Index in ``moves`` of each sample's nearest place, or None without a path.
            line: Source line of that place, shape (n,).
            error: Contour error, shape (n,) [µm].
            time: Shape (n,) [s].
        """
        rapid, arc = np.zeros(len(line), np.int64), np.zeros(len(line), np.bool_)
        if place is not None:
            rapid = (moves.motion[place] == Motion.RAPID).astype(np.int64)
            arc = moves.shape[place] == Shape.ARC
        row = 2 * line + rapid
        self._grow(int(row.max()) + 1)
        np.add.at(self._samples, row, 1)
        np.add.at(self._squares, row, error**2)
        np.logical_or.at(self._arc, row, arc)
        order = np.argsort(error, kind="stable")
        row, error, time = row[order], error[order], time[order]
        greater = (error > self._max[row]) | (self._samples[row] == 0)
        # Of several values written to one row the last, the greatest, stays.
        self._max[row[greater]] = error[greater]
        self._time[row[greater]] = time[greater]

    def _grow(self, size: int) -> None:
        missing = size - len(self._max)
        if missing <= 0:
            return
        missing += size // 2
        self._samples = np.append(self._samples, np.zeros(missing, np.int64))
        self._arc = np.append(self._arc, np.zeros(missing, np.bool_))
        self._squares = np.append(self._squares, np.zeros(missing))
        self._max = np.append(self._max, np.zeros(missing))
        self._time = np.append(self._time, np.zeros(missing))

    def figures(self) -> BlockFigures:
        """The blocks so far."""
        row = np.flatnonzero(self._samples)
        return BlockFigures(
            line=row // 2,
            rapid=row % 2 == 1,
            arc=self._arc[row],
            samples=self._samples[row],
            max_um=self._max[row],
            rms_um=np.sqrt(self._squares[row] / self._samples[row]),
            time_s=self._time[row],
        )


NO_BLOCKS = BlockCollector().figures()
