"""The velocity along a program, as phases of constant jerk."""

import dataclasses
from collections.abc import Iterator

import numpy as np

from twin.columns import join
from twin.motion.pieces.pieces import Pieces
from twin.motion.profile.segment_kernels import place_phases
from twin.motion.profile.windows import Window
from twin.nc.canonical import FloatArray, IntArray


@dataclasses.dataclass(frozen=True, slots=True)
class Phases:
    """A run of m phases of constant jerk over a window of pieces.

    Attributes:
        parts: The window, in one or two parts.
        rows: Begin [s], duration [s], x within the piece, v, a, j; shape (m, 6). The one that leads
            away from a stop may begin before the one that leads to it has ended.
        rows_pieces: Rows of ``pieces`` in which each phase begins and ends, shape (m, 2).
    """

    parts: tuple[Pieces, ...]
    rows: FloatArray
    rows_pieces: IntArray

    @property
    def pieces(self) -> Pieces:
        """The window as a whole."""
        return join(self.parts)

    def joined(self) -> "Phases":
        """These phases over one part."""
        return Phases((self.pieces,), self.rows, self.rows_pieces)

    def by_part(self) -> Iterator["Phases"]:
        """These phases in turn, over one part each; few pieces lie at the border of two."""
        beyond = self.rows_pieces[:, 1] >= len(self.parts[0])
        if len(self.parts) == 1 or not np.any(beyond):
            yield Phases(self.parts[:1], self.rows, self.rows_pieces)
            return
        row = int(np.argmax(beyond))
        if row > 0 and self.rows[row, 0] < self.rows[row - 1, :2].sum():
            row -= 1
        piece = int(self.rows_pieces[row, 0])
        if row > 0:
            yield Phases(self.parts[:1], self.rows[:row], self.rows_pieces[:row])
        rest = join([self.parts[0][piece:], *self.parts[1:]])
        yield Phases((rest,), self.rows[row:], self.rows_pieces[row:] - piece)

    @property
    def end_time(self) -> float:
        """When the last phase ends [s]."""
        return float(self.rows[-1, 0] + self.rows[-1, 1])


def phases_of(window: Window, rows: FloatArray, segments: IntArray) -> Phases:
    """Phases by pieces; ``rows`` are overwritten."""
    parts = window.parts_until(int(segments[:, 1].max(initial=0)))
    length = np.concatenate([part.length for part in parts])
    return Phases(parts, rows, place_phases(rows, segments, window.begins, length))


def no_phases(pieces: Pieces) -> Phases:
    """The beginning of phases over pieces."""
    return Phases((pieces,), np.zeros((0, 6)), np.zeros((0, 2), np.int64))


def brakes_from(brakes: FloatArray, due: int) -> FloatArray:
    """What is known of the next window: the result of ``backward_pass`` from ``due`` on."""
    known = brakes[:, due:].copy()
    known[[1, 3]] -= due
    # The window's end was taken to be a stop.
    return known[:, :-1]
