"""Continuous corners beside arcs and between feeds, tried: where stops are faster after all, the path stops.

The estimates by which a corner is chosen (``twin.motion.blocks``) know the bounds of an arc, not the
time law that its run gets, and take a rounding as driven at one velocity, which it is not where the
feed changes. So between two stops the plan is made in both ways, and the faster one is kept.
"""

import dataclasses
from collections.abc import Iterable, Iterator

import numpy as np

from twin.columns import join
from twin.motion.blocks.blocks import Blocks, BoolArray, Surroundings
from twin.motion.blocks.corners import Borders, find_borders
from twin.motion.limits import MotionLimits
from twin.motion.phases_of_pieces import phases_of_pieces
from twin.motion.pieces.pieces import BATCH, Pieces, blocks_to_cut, cut
from twin.motion.steps import Step
from twin.nc.canonical import Chunk, Corner, FloatArray

MOST_BLOCKS = 64
"""Between two stops: of more, stops do not make up for what passing their corners gains."""


@dataclasses.dataclass(frozen=True, slots=True)
class _Span:
    """Pieces of a program, the last of which are doubtful.

    Attributes:
        pieces: All of them, in order.
        first: The first doubtful one.
        blocks: What the doubtful ones were cut from, from a stop to a stop; None: none is doubtful.
    """

    pieces: Pieces
    first: int = 0
    blocks: Blocks | None = None


class _Spans(Step[Surroundings, _Span]):
    """Cuts blocks, and tells between which stops they are doubtful."""

    def __init__(
        self, parts: Iterable[Surroundings], limits: MotionLimits, largest_override: float
    ) -> None:
        super().__init__(parts)
        self._limits, self._largest_override = limits, largest_override

    def take(self, part: Surroundings) -> Iterator[_Span]:
        """The pieces of some blocks."""
        borders = find_borders(part.blocks, self._limits, self._largest_override)
        pieces = cut(part, borders, self._limits, self._largest_override)
        begins = np.append(
            np.flatnonzero((pieces.begin == 0.0) | (pieces.length == 0.0)), len(pieces)
        )
        done = 0
        for first, last in _doubtful(part, borders):
            begin, end = begins[[first - part.first, last - part.first]].tolist()
            yield _Span(pieces[done:end], begin - done, part.blocks[first:last])
            done = end
        yield _Span(pieces[done:])


class PiecesOfChunks(Step[_Span, Pieces]):
    """Cuts a program into pieces, dwells included, in order.

    Args:
        chunks: The program.
        limits: Of the axes and the path.
        start: Where the axes stand before, part coordinates, shape (k,) [mm or deg].
        largest_override: Of the feed that the limits of a piece must leave room for.
        batch: How many blocks are cut together.

    Raises:
        ValueError: When pulled: a move does not begin where the one before it ended.
    """

    def __init__(
        self,
        chunks: Iterable[Chunk],
        limits: MotionLimits,
        start: FloatArray,
        largest_override: float = 1.0,
        batch: int = BATCH,
    ) -> None:
        super().__init__(_Spans(blocks_to_cut(chunks, start, batch), limits, largest_override))
        self._limits, self._largest_override = limits, largest_override

    def take(self, part: _Span) -> Iterator[Pieces]:
        """The pieces of a span, the doubtful ones by stops at every corner where that is faster."""
        blocks = part.blocks
        if blocks is None:
            yield part.pieces
            return
        limits, override = self._limits, self._largest_override
        corner = np.full(len(blocks), Corner.EXACT_STOP, np.uint8)
        apart = Surroundings(dataclasses.replace(blocks, corner=corner), 0, len(blocks), True)
        stopping = cut(apart, find_borders(apart.blocks, limits, override), limits, override)
        passing = part.pieces[part.first :]
        stopping.overlap[0] = passing.overlap[0]
        if _seconds(stopping, limits) < _seconds(passing, limits):
            yield join([part.pieces[: part.first], stopping])
        else:
            yield part.pieces


def _doubtful(surroundings: Surroundings, borders: Borders) -> list[tuple[int, int]]:
    """First block and the one after the last, between two stops, with roundings beside arcs or between feeds."""
    blocks = surroundings.blocks
    bent, feed = blocks.geometry.angle != 0.0, blocks.feed * blocks.parameter_scale
    rounded: BoolArray = borders.width > 0.0
    rounded[1:] &= bent[1:] | bent[:-1] | (feed[1:] != feed[:-1])
    if not np.any(rounded):
        return []
    stops = np.flatnonzero((borders.entry == 0.0) & (borders.width == 0.0))
    if surroundings.to_the_end:
        stops = np.append(stops, len(blocks))
    among = np.searchsorted(np.flatnonzero(rounded), stops)
    return [
        (int(first), int(last))
        for first, last, before, behind in zip(stops[:-1], stops[1:], among[:-1], among[1:], strict=True)
        if behind > before and last - first <= MOST_BLOCKS
        and surroundings.first <= first and last <= surroundings.last
    ]  # fmt: skip


def _seconds(pieces: Pieces, limits: MotionLimits) -> float:
    """How long pieces take from rest to rest [s]."""
    return sum(phases.end_time for phases in phases_of_pieces([pieces], limits))
