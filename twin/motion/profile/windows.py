"""Windows: the segments to drive next, and those that the planner looks ahead to.

A window is taken to end in a stop, so what is planned in it stays possible whatever follows. It
holds two batches of blocks, counted from the start of the program, whatever chunks they come in.
"""

import dataclasses
from collections.abc import Iterable, Iterator

import numpy as np

from twin.columns import join
from twin.motion.pieces.pieces import Pieces
from twin.motion.profile.segment_kernels import find_segments, merge_limits
from twin.motion.steps import PipelineStage
from twin.nc.canonical import FloatArray, IntArray

LOOK_AHEAD = 2000
"""Blocks that are planned at a time, and that the planner sees at least beyond these."""

MAX_PIECES = 32768
"""Of a batch: blocks of many turns are looked ahead to in smaller numbers."""


@dataclasses.dataclass(frozen=True, slots=True)
class Window:
    """A run of n pieces as m segments.

    Attributes:
        parts: The pieces of one batch, or of two.
        begins: First piece of each segment and, last, n; shape (m + 1,).
        limits: Rows length, velocity, acceleration, deceleration, jerk, shape (5, m).
        entry: Highest velocity at each border, the last 0, shape (m + 1,).
        overlap: How far from a stop at each border the moves on both sides may overlap, 0: not at
            all, shape (m,) [mm or deg].
        pause: How long each segment waits, shape (m,) [s].
        due: Segments to drive now; the rest is looked ahead to.
    """

    parts: tuple[Pieces, ...]
    begins: IntArray
    limits: FloatArray
    entry: FloatArray
    overlap: FloatArray
    pause: FloatArray
    due: int

    @property
    def whole(self) -> bool:
        """Whether the program ends with the window."""
        return self.due == len(self.pause)

    @property
    def pieces(self) -> Pieces:
        """All pieces."""
        return join(self.parts)

    def parts_until(self, segment: int) -> tuple[Pieces, ...]:
        """The pieces up to the end of a segment at least."""
        beyond = int(self.begins[segment + 1]) - len(self.parts[0])
        if beyond <= 0 or len(self.parts) == 1:
            return self.parts[:1]
        return self.parts[0], self.parts[1][:beyond]

    def joined(self) -> "Window":
        """This window with all its pieces as one part."""
        return dataclasses.replace(self, parts=(self.pieces,))

    def piece_at(self, segment: int, x: float) -> tuple[int, float]:
        """The piece at x within a segment, and x within the piece; n, 0 after the last."""
        if segment == len(self.pause):
            return len(self.pieces), 0.0
        piece = int(self.begins[segment])
        while piece + 1 < self.begins[segment + 1] and x >= self.pieces.length[piece]:
            x -= float(self.pieces.length[piece])
            piece += 1
        return piece, x

    def segment_at(self, piece: int, x: float) -> tuple[int, float]:
        """The segment at x within a piece, and x within the segment."""
        segment = int(np.searchsorted(self.begins, piece, "right")) - 1
        return segment, x + float(self.pieces.length[self.begins[segment] : piece].sum())

    def with_pause(self, segment: int, pause: float) -> "Window":
        """This window, where a segment waits for so long [s]."""
        pauses = self.pause.copy()
        pauses[segment] = pause
        return dataclasses.replace(self, pause=pauses)

    def parted_at(self, piece: int) -> "Window":
        """This window with a border between segments before a piece."""
        segment, x = self.segment_at(piece, 0.0)
        if self.begins[segment] == piece:
            return self
        limits = np.insert(self.limits, segment, self.limits[:, segment], axis=1)
        limits[0, segment] = x
        limits[0, segment + 1] -= x
        return dataclasses.replace(
            self,
            begins=np.insert(self.begins, segment + 1, piece),
            limits=limits,
            entry=np.insert(self.entry, segment + 1, np.inf),
            overlap=np.insert(self.overlap, segment + 1, 0.0),
            pause=np.insert(self.pause, segment + 1, 0.0),
            due=self.due + int(segment < self.due),
        )


@dataclasses.dataclass(frozen=True, slots=True)
class _Batch:
    pieces: Pieces
    begins: IntArray
    limits: FloatArray


class Windows(PipelineStage[Pieces, Window]):
    """Windows of a program; each begins where the one before it had its ``due``.

    Args:
        look_ahead: Blocks per batch.
    """

    def __init__(self, parts: Iterable[Pieces], look_ahead: int = LOOK_AHEAD) -> None:
        super().__init__(_Batches(parts, look_ahead))
        self._now: _Batch | None = None

    def take(self, part: Pieces) -> Iterator[Window]:
        """The batch before, now that this one is known."""
        table = np.stack(
            [part.length, part.velocity, part.acceleration, part.deceleration, part.jerk]
        )
        begins = find_segments(table, part.entry, part.feed)
        before = self._now
        self._now = _Batch(part, begins, merge_limits(table, part.entry, begins))
        if before is not None:
            yield _window([before, self._now], len(before.begins) - 1)

    def finish(self) -> Iterator[Window]:
        """The last batch."""
        if self._now is not None:
            yield _window([self._now], len(self._now.begins) - 1)


def _window(batches: list[_Batch], due: int) -> Window:
    begins, behind = [], 0
    for batch in batches:
        begins.append(batch.begins[:-1] + behind)
        behind += len(batch.pieces)
    entries = [batch.pieces.entry[batch.begins[:-1]] for batch in batches]
    return Window(
        parts=tuple(batch.pieces for batch in batches),
        begins=np.append(np.concatenate(begins), behind),
        limits=np.concatenate([batch.limits for batch in batches], axis=1),
        entry=np.append(np.concatenate(entries), 0.0),
        overlap=np.concatenate([batch.pieces.overlap[batch.begins[:-1]] for batch in batches]),
        pause=np.concatenate([batch.pieces.pause[batch.begins[:-1]] for batch in batches]),
        due=due,
    )


class _Batches(PipelineStage[Pieces, Pieces]):
    """Regroups pieces: so many blocks at a time, or ``MAX_PIECES`` if these are fewer."""

    def __init__(self, parts: Iterable[Pieces], blocks: int) -> None:
        super().__init__(parts)
        self._blocks = blocks
        self._waiting: list[Pieces] = []
        self._count = self._found = 0

    def take(self, part: Pieces) -> Iterator[Pieces]:
        """The batches that are full."""
        starts = (part.begin == 0.0) | (part.length == 0.0)
        first = 0
        while True:
            # The piece with which the first block too many begins, or the first piece too many.
            room = first + MAX_PIECES - self._count
            inside = first + np.flatnonzero(starts[first:room])
            end = min(len(part), room)
            if len(inside) > self._blocks - self._found:
                end = int(inside[self._blocks - self._found])
            if end == len(part) and end < room:
                break
            if end > first:
                self._waiting.append(part[first:end])
            yield join(self._waiting)
            self._waiting, self._count, self._found, first = [], 0, 0, end
        if first < len(part):
            self._waiting.append(part[first:])
            self._count += len(part) - first
            self._found += int(np.count_nonzero(starts[first:]))

    def finish(self) -> Iterator[Pieces]:
        """What has not filled a batch."""
        if self._count > 0:
            yield join(self._waiting)
