"""Corners that are tried: what is slower than a simpler passage is replaced by that.

The estimates by which a continuous corner is chosen (``twin.motion.blocks``) know the bounds of an arc, not the
time law that its run gets, and take a rounding as driven at one velocity, which it is not where the
feed changes; and a knee that the machine allows may be faster than any rounding. So between two stops the plan
is made with stops too, and on the exact path too, and the fastest is kept: continuous motion is never slower
than the exact path, nor that than stops.
"""

import dataclasses
from collections import deque
from collections.abc import Iterable, Iterator

import numpy as np

from twin.columns import join
from twin.motion.blocks.blocks import Blocks, BoolArray, Surroundings
from twin.motion.blocks.corners import Borders, find_borders
from twin.motion.limits import MotionLimits
from twin.motion.open_chains import OpenChains, first_pieces, slow_arcs
from twin.motion.phases_of_pieces import seconds_alone
from twin.motion.pieces.pieces import BATCH, Pieces, blocks_to_cut, cut
from twin.motion.steps import PipelineStage
from twin.nc.canonical import Chunk, Corner, FloatArray, IntArray


@dataclasses.dataclass(frozen=True, slots=True)
class _Candidate:
    """Another passage through some blocks, from a stop to a stop.

    Attributes:
        begin: First of a span's pieces that was cut from them.
        end: The one after the last.
        corner: How their borders are to be passed, where they do not ask for more.
    """

    blocks: Blocks
    begin: int
    end: int
    corner: Corner


@dataclasses.dataclass(frozen=True, slots=True)
class _Span:
    """Consecutive pieces of a program.

    Attributes:
        candidates: What may be faster, in order; what is tried last covers what was tried before it.
    """

    pieces: Pieces
    candidates: tuple[_Candidate, ...] = ()


class _Spans(PipelineStage[Surroundings, _Span]):
    """Cuts blocks, and tells between which stops there is something to try.

    A path that goes on from the blocks before or to the next ones is tried at once: these depend on what is chosen.
    """

    def __init__(
        self,
        parts: Iterable[Surroundings],
        limits: MotionLimits,
        largest_override: float,
        most_slow_arcs: float,
    ) -> None:
        super().__init__(parts)
        self._largest_override, self._most_slow_arcs = largest_override, most_slow_arcs
        self._chains = OpenChains(limits, largest_override, most_slow_arcs)

    def take(self, part: Surroundings) -> Iterator[_Span]:
        """The pieces of some blocks."""
        part, borders, pieces = self._chains.choose(part)
        begins = first_pieces(pieces)
        slow = np.append(0, np.cumsum(slow_arcs(pieces, self._largest_override)))

        def affordable(first: int, last: int) -> bool:
            return bool(slow[last - part.first] - slow[first - part.first] <= self._most_slow_arcs)

        stopping = [span for span in _worth_stopping(part, borders) if affordable(*span)]
        whole = set[tuple[int, int]]()
        if self._chains.has_knees and np.any(part.blocks.corner == Corner.CONTINUOUS):
            whole |= {span for span in _continuous(part, borders) if affordable(*span)}
        waiting, done = deque(stopping), 0
        for first, last in _outermost(whole, stopping):
            begin, end = begins[[first - part.first, last - part.first]].tolist()
            if begin > done:
                yield _Span(pieces[done:begin])
            done = end
            candidates: list[_Candidate] = []
            while waiting and waiting[0][0] < last:
                one, other = waiting.popleft()
                there, behind = (begins[[one - part.first, other - part.first]] - begin).tolist()
                candidates.append(
                    _Candidate(part.blocks[one:other], there, behind, Corner.EXACT_STOP)
                )
            if (first, last) in whole:
                candidates.append(
                    _Candidate(part.blocks[first:last], 0, end - begin, Corner.EXACT_PATH)
                )
            yield _Span(pieces[begin:end], tuple(candidates))
        yield _Span(pieces[done:])


class PiecesOfChunks(PipelineStage[_Span, Pieces]):
    """Cuts a program into pieces, dwells included, in order.

    Args:
        start: Where the axes are before, part coordinates, shape (k,) [mm or deg].
        largest_override: Of the feed that the limits of a piece must leave room for.
        batch: How many blocks are cut together.
        most_slow_arcs: In a path for which another passage is tried: arcs that are slower than the feed get a time law of
            their own, which takes most of a plan.

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
        most_slow_arcs: float = np.inf,
    ) -> None:
        parts = blocks_to_cut(chunks, start, batch)
        super().__init__(_Spans(parts, limits, largest_override, most_slow_arcs))
        self._limits, self._largest_override = limits, largest_override

    def take(self, part: _Span) -> Iterator[Pieces]:
        """The pieces of a span, each trial's where they are faster."""
        pieces, shift, known = part.pieces, 0, None
        for candidate in part.candidates:
            whole = candidate.begin == 0 and candidate.end == len(part.pieces)
            begin, end = (
                (0, len(pieces)) if whole else (candidate.begin + shift, candidate.end + shift)
            )
            if known is None or not whole:
                known = seconds_alone(pieces[begin:end], self._limits)
            tried = self._cut(candidate)
            tried.overlap[0] = pieces.overlap[begin]
            seconds = seconds_alone(tried, self._limits)
            if seconds < known:
                shift += len(tried) - (end - begin)
                pieces = join([pieces[:begin], tried, pieces[end:]])
            known = min(known, seconds) if whole else None
        yield pieces

    def _cut(self, candidate: _Candidate) -> Pieces:
        blocks, limits, override = candidate.blocks, self._limits, self._largest_override
        corner = np.minimum(blocks.corner, np.uint8(candidate.corner))
        apart = Surroundings(dataclasses.replace(blocks, corner=corner), 0, len(blocks), True)
        return cut(apart, find_borders(apart.blocks, limits, override), limits, override)


def _worth_stopping(surroundings: Surroundings, borders: Borders) -> list[tuple[int, int]]:
    """Between which stops stopping everywhere may be faster: corners beside arcs, or roundings between feeds.

    Returns:
        First block and the one after the last.
    """
    blocks = surroundings.blocks
    bent, feed = blocks.geometry.angle != 0.0, blocks.feed * blocks.parameter_scale
    bends: BoolArray = bent.copy()
    bends[1:] |= bent[:-1]
    changes = np.append(False, feed[1:] != feed[:-1])
    knee = (borders.entry > 0.0) & (borders.entry < np.inf)
    undecided = ((borders.width > 0.0) & (bends | changes)) | (knee & bends)
    stops = np.flatnonzero((borders.entry == 0.0) & (borders.width == 0.0))
    if not np.any(blocks.corner == Corner.CONTINUOUS):
        # A path that is kept exactly is the same whatever happens at the ends of these blocks: it may stop there too.
        stops = np.union1d(stops, [surroundings.first, surroundings.last])
    return list(_between(surroundings, stops, undecided))


def _continuous(surroundings: Surroundings, borders: Borders) -> list[tuple[int, int]]:
    """Between which stops that are asked for a continuous corner is rounded, or stops.

    Args:
        borders: Before each of them.

    Returns:
        First block and the one after the last.
    """
    blocks = surroundings.blocks
    asked = np.flatnonzero(blocks.corner == Corner.EXACT_STOP)
    slowed = (blocks.corner == Corner.CONTINUOUS) & ((borders.width > 0.0) | (borders.entry == 0.0))
    return list(_between(surroundings, asked, slowed))


def _between(
    surroundings: Surroundings, stops: IntArray, undecided: BoolArray
) -> Iterator[tuple[int, int]]:
    """Pairs of stops, both among the blocks to work on, with an undecided border between them."""
    if surroundings.to_the_end:
        stops = np.append(stops, len(surroundings.blocks))
    among = np.searchsorted(np.flatnonzero(undecided), stops)
    for first, last, before, behind in zip(
        stops[:-1].tolist(), stops[1:].tolist(), among[:-1], among[1:], strict=True
    ):
        if behind > before and surroundings.first <= first and last <= surroundings.last:
            yield first, last


def _outermost(
    whole: Iterable[tuple[int, int]], parts: Iterable[tuple[int, int]]
) -> list[tuple[int, int]]:
    """Spans in order, without those that lie within another."""
    spans: list[tuple[int, int]] = []
    for first, last in sorted({*whole, *parts}, key=lambda span: (span[0], -span[1])):
        if not spans or first >= spans[-1][1]:
            spans.append((first, last))
    return spans
