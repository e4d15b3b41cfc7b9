"""The velocity along a program, as phases of constant jerk."""

import dataclasses
from collections.abc import Iterable, Iterator

import numpy as np

from twin.motion.limits import MotionLimits
from twin.motion.pieces import Pieces, pieces_of_chunks
from twin.motion.profile_kernels import STATE_AT_REST, find_phases
from twin.motion.reach_kernels import find_reach
from twin.motion.windows import BATCH, entry_velocities, limit_table, windows
from twin.nc.canonical import Chunk, FloatArray, IntArray


@dataclasses.dataclass(frozen=True, slots=True)
class Phases:
    """A run of m phases of constant jerk over a window of pieces.

    Attributes:
        pieces: The window.
        rows: Begin [s], duration [s], x within the piece, v, a, j; shape (m, 6).
        rows_pieces: Rows of ``pieces`` in which each phase begins and ends, shape (m, 2).
    """

    pieces: Pieces
    rows: FloatArray
    rows_pieces: IntArray

    @property
    def end_time(self) -> float:
        """When the last phase ends [s]."""
        return float(self.rows[-1, 0] + self.rows[-1, 1])


def plan_phases(
    chunks: Iterable[Chunk], limits: MotionLimits, *, start: FloatArray
) -> Iterator[Phases]:
    """Plan the velocity along a program.

    Args:
        chunks: The program.
        limits: Of the axes and the path.
        start: Where the axes stand before, part coordinates, shape (k,) [mm or deg].
    """
    state = STATE_AT_REST.copy()
    known = np.zeros(0)
    for window, whole in windows(pieces_of_chunks(chunks, limits, start)):
        first = int(state[0])
        pieces = window[first:]
        table, entry = limit_table(pieces), entry_velocities(pieces)
        reach = find_reach(table, entry, known)
        stop = len(pieces) if whole else BATCH - first
        state[0] = 0.0
        rows, rows_pieces = find_phases(table, entry, reach, pieces.pause, stop, np.inf, state)
        known = reach[int(state[0]) : -1]
        state[0] += first - BATCH
        # What a brake was compared with lies behind.
        state[5:] = STATE_AT_REST[5:]
        if len(rows) > 0:
            yield Phases(pieces, rows, rows_pieces)
