"""Blocks: the moves that take time, and the dwells, with what happens where one meets the next."""

import dataclasses
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from twin.columns import Columns, join
from twin.compilation.kernel import array_kernel
from twin.motion.steps import PipelineStage
from twin.nc.canonical import (
    Chunk,
    CodeArray,
    Corner,
    Dwell,
    Event,
    FeedUnit,
    FloatArray,
    IntArray,
    Motion,
    Moves,
    Shape,
)
from twin.toolpath.geometry import Geometry, geometry
from twin.units import SECONDS_PER_MINUTE


@array_kernel
def largest_travels(
    start: FloatArray, end: FloatArray, rotary: np.ndarray[tuple[int], np.dtype[np.bool_]]
) -> tuple[FloatArray, FloatArray]:
    """How far the axis goes that goes farthest.

    Args:
        start: Of the moves, shape (n, k) [mm or deg].
        end: Shape (n, k) [mm or deg].
        rotary: Whether an axis is one, shape (k,).

    Returns:
        Of all axes, and of the linear ones, shape (n,) each [mm or deg].
    """
    count, axes = start.shape
    farthest, linear = np.zeros(count), np.zeros(count)
    for i in range(count):
        for axis in range(axes):
            travel = abs(end[i, axis] - start[i, axis])
            farthest[i] = max(farthest[i], travel)
            if not rotary[axis]:
                linear[i] = max(linear[i], travel)
    return farthest, linear


SHORTEST = 1e-9
"""A shorter block takes no time [mm or deg]: a thousandth of the nanometre the path is kept to."""

STEEPEST = 10.0
"""How far an axis may go per path parameter; where one goes further than this while the feed counts
next to nothing (C turns, X moves by a rounding), the parameter is stretched."""

JOIN_TOLERANCE = 1e-6
"""Largest gap between consecutive moves that is rounding, not a fault [mm or deg]."""

BoolArray = np.ndarray[tuple[int], np.dtype[np.bool_]]


class BlockLimits(NamedTuple):
    """What the program asks of n blocks.

    Attributes:
        velocity: Highest v, shape (n,).
        acceleration: Highest a, shape (n,).
        deceleration: Highest -a, shape (n,).
        parameter_scale: Path parameter per what the feed counts, shape (n,).
        rotary_alone: Whether only rotary axes move, shape (n,).
    """

    velocity: FloatArray
    acceleration: FloatArray
    deceleration: FloatArray
    parameter_scale: FloatArray
    rotary_alone: BoolArray


@dataclasses.dataclass(frozen=True, slots=True)
class Blocks(Columns):
    """A run of n blocks, as columns. A dwell is a block without length.

    Attributes:
        move: Number of the move in the whole program, -1 before the first, shape (n,).
        line: Source line, shape (n,).
        length: In path parameter x, shape (n,) [mm or deg]; 0 for dwells.
        parameter_scale: Path parameter per what the feed counts, almost always 1, shape (n,).
        rapid: Whether the move is a rapid, shape (n,).
        feed: Shape (n,) [mm/s or deg/s]; infinite for rapids that the program gives none.
        acceleration: Programmed, shape (n,) [mm/s² or deg/s²]; infinite: the machine's.
        deceleration: Programmed for slowing down, shape (n,) [mm/s² or deg/s²].
        rotary_alone: Only rotary axes move, shape (n,).
        corner: ``Corner`` code of the border before the block, shape (n,).
        tolerance: Of a continuous border before the block, shape (n,) [mm]; NaN: the machine's.
        pause: How long a dwell waits, shape (n,) [s].
        geometry: n rows.
    """

    move: IntArray
    line: IntArray
    length: FloatArray
    parameter_scale: FloatArray
    rapid: BoolArray
    feed: FloatArray
    acceleration: FloatArray
    deceleration: FloatArray
    rotary_alone: BoolArray
    corner: CodeArray
    tolerance: FloatArray
    pause: FloatArray
    geometry: Geometry

    def limits(self, largest_override: float) -> BlockLimits:
        """What the program asks of them, up to a factor of the feeds."""
        velocity = self.feed * self.parameter_scale
        return BlockLimits(
            velocity * np.where(self.rapid, 1.0, largest_override),
            self.acceleration, self.deceleration, self.parameter_scale, self.rotary_alone,
        )  # fmt: skip


class BlocksOfChunks(PipelineStage[Chunk, Blocks]):
    """The blocks of a program, in order.

    The path comes to rest before and after rapids, dwells and functions, as the conventions of
    canonical moves demand; a function at a switch point within a move does not stop it.

    Args:
        start: Where the axes are before, part coordinates, shape (k,) [mm or deg].

    Raises:
        ValueError: When pulled: a move does not begin where the one before it ended.
    """

    def __init__(self, chunks: Iterable[Chunk], start: FloatArray) -> None:
        super().__init__(chunks)
        self._first = 0
        self._position = start
        self._corner, self._tolerance = int(Corner.EXACT_STOP), np.nan
        self._within_rapid = False

    def take(self, part: Chunk) -> Iterator[Blocks]:
        """The blocks of a chunk."""
        moves = part.moves
        _check_joined(self._position, moves)
        done = 0
        for event in (*(event for event in part.events if _stops(event)), None):
            until = len(moves) if event is None else event.before
            if until > done:
                between = moves[done:until]
                blocks, self._corner, self._tolerance = _of_moves(
                    between, self._first + done, self._corner, self._tolerance, self._within_rapid
                )
                self._within_rapid = bool(goes_on(between)[-1])
                yield blocks
                self._position = between.end[-1]
                done = until
            if event is not None:
                self._corner = int(Corner.EXACT_STOP)
            if isinstance(event, Dwell):
                yield _of_dwell(event, self._first + done - 1, self._position)
        self._first += len(moves)


def _stops(event: Event) -> bool:
    return isinstance(event, Dwell) or event.at == 0.0


def goes_on(moves: Moves) -> BoolArray:
    """Which moves are parts of a rapid under tool centre point control that goes on behind them, shape (n,)."""
    rapid = (moves.shape == Shape.CURVE) & (moves.motion == Motion.RAPID)
    return rapid & (moves.corner != Corner.EXACT_STOP)


def _of_moves(
    moves: Moves, first: int, corner: int, tolerance: float, within_rapid: bool
) -> tuple[Blocks, int, float]:
    """The blocks of moves, and the corner and tolerance at their end.

    Args:
        corner: At its begin.
        within_rapid: The move before it is a part of the same rapid.
    """
    farthest, linear = largest_travels(moves.start, moves.end, moves.axes.rotary())
    length = np.maximum(moves.length, farthest / STEEPEST)
    rows = np.flatnonzero(length >= SHORTEST)
    corners = np.append(corner, moves.corner).astype(np.uint8)
    tolerances = np.append(tolerance, moves.corner_tolerance)
    before = np.append(rows, len(moves))
    at_border = corners[before]
    # A stop that was asked for at a move of no length still stops the path.
    stops = np.append(0, np.cumsum(corners == Corner.EXACT_STOP))
    previous = np.append(-1, rows)
    at_border[stops[before + 1] > stops[previous + 1]] = Corner.EXACT_STOP
    kept = moves if len(rows) == len(moves) else moves[rows]
    rapid = kept.motion == Motion.RAPID
    # Rapids stand still at both ends (twin.nc.canonical).
    inner = goes_on(kept)
    at_border[:-1][rapid & ~np.append(within_rapid, inner)[:-1]] = Corner.EXACT_STOP
    at_border[1:][rapid & ~inner] = Corner.EXACT_STOP
    shapes = geometry(kept)
    scale = length / np.maximum(moves.length, 1e-12)
    turns = (linear[rows] == 0.0) & (shapes.angle == 0.0)
    if kept.curve is not None:
        # Its linear axes follow the rotary ones while the tip rests.
        turns |= (kept.shape == Shape.CURVE) & (kept.feed_unit == FeedUnit.DEG_PER_MIN)
    blocks = Blocks(
        move=first + rows,
        line=kept.line,
        length=length[rows],
        parameter_scale=scale[rows],
        rapid=rapid,
        feed=np.where(np.isnan(kept.feed), np.inf, kept.feed / SECONDS_PER_MINUTE),
        acceleration=np.where(np.isnan(kept.acceleration), np.inf, kept.acceleration),
        deceleration=np.where(np.isnan(kept.deceleration), np.inf, kept.deceleration),
        rotary_alone=turns,
        corner=at_border[:-1],
        tolerance=tolerances[rows],
        pause=np.zeros(len(rows)),
        geometry=shapes,
    )
    return blocks, int(at_border[-1]), float(tolerances[-1])


def _of_dwell(dwell: Dwell, move: int, position: FloatArray) -> Blocks:
    """The block of a dwell: it is at ``position``, the end of the move before."""
    zero = np.zeros(1)
    still = Geometry(
        base=position[None],
        drift=np.zeros_like(position)[None],
        bend=np.zeros((1, len(position), 4)),
        cosine=np.zeros((1, 3)),
        sine=np.zeros((1, 3)),
        angle=zero,
        end=position[None],
    )
    return Blocks(
        move=np.array([move]),
        line=np.array([dwell.line]),
        length=zero,
        parameter_scale=np.ones(1),
        rapid=np.zeros(1, np.bool_),
        feed=zero,
        acceleration=zero,
        deceleration=zero,
        rotary_alone=np.zeros(1, np.bool_),
        corner=np.array([Corner.EXACT_STOP], np.uint8),
        tolerance=np.array([np.nan]),
        pause=np.array([dwell.seconds]),
        geometry=still,
    )


def _check_joined(position: FloatArray, moves: Moves) -> None:
    before = np.concatenate([position[None], moves.end])[: len(moves)]
    gaps = np.abs(moves.start - before)
    if gaps.max(initial=0.0) > JOIN_TOLERANCE:
        row = int(np.argmax(np.any(gaps > JOIN_TOLERANCE, axis=1)))
        raise ValueError(
            f"line {moves.line[row]}: the move begins at {moves.start[row]}, "
            f"but the axes are at {before[row]}"
        )


@dataclasses.dataclass(frozen=True, slots=True)
class Surroundings:
    """Blocks to work on now, with their neighbours on both sides.

    Attributes:
        first: Row of the first block to work on.
        last: Row after the last block to work on.
        to_the_end: Whether the program ends with the last of ``blocks``.
    """

    blocks: Blocks
    first: int
    last: int
    to_the_end: bool


class WithNeighbours(PipelineStage[Blocks, Surroundings]):
    """Regroups blocks: ``batch`` at a time, with up to ``context`` known on either side.

    Groups are counted from the start of the program, whatever parts the blocks come in. They are
    smaller, and less is known beside them, where arcs turn by more than ``most_angle`` together
    [rad], that of the last one left out, and where they can end at a stop, so that more is between stops. More is known beside them, up to half a batch, where lines that go on
    without a stop are so short that ``context`` of them are less than ``view`` [mm or deg].
    """

    def __init__(
        self, parts: Iterable[Blocks], batch: int, context: int, most_angle: float = np.inf,
        view: float = 0.0,
    ) -> None:  # fmt: skip
        super().__init__(parts)
        self._batch, self._context, self._most_angle, self._view = batch, context, most_angle, view
        self._most = max(context, batch // 2) if view else context
        self._waiting: list[Blocks] = []
        self._count = self._first = 0

    def take(self, part: Blocks) -> Iterator[Surroundings]:
        """The groups whose neighbours are known."""
        if len(part):
            self._waiting.append(part)
            self._count += len(part)
        while self._count - self._first >= self._batch + self._most:
            yield self._group(self._batch, at_end=False)

    def finish(self) -> Iterator[Surroundings]:
        """The last groups."""
        while self._count > self._first:
            yield self._group(None, at_end=True)

    def _group(self, most: int | None, *, at_end: bool) -> Surroundings:
        """The next group, of so many blocks at most."""
        first, most_angle = self._first, self._most_angle
        window = join(self._waiting)
        angle = np.abs(window.geometry.angle)
        last = first + _within(angle[first : None if most is None else first + most], most_angle)
        if last < self._count:
            last = _at_stop(window.corner, first, last)
        context = self._beside(window[max(0, first - self._most) : first][::-1])
        before = _within(angle[max(0, first - context) : first][::-1], most_angle)
        context = self._beside(window[last : last + self._most])
        behind = _within(angle[last : last + context], most_angle)
        kept = max(0, last - self._most)
        to_the_end = at_end and last + behind == self._count
        self._waiting, self._count, self._first = [window[kept:]], self._count - kept, last - kept
        known = window[first - before : last + behind]
        return Surroundings(known, before, before + last - first, to_the_end)

    def _beside(self, blocks: Blocks) -> int:
        """How many blocks are to be known on one side, of those that may be, from the nearest on."""
        if len(blocks) <= self._context:
            return self._context
        ends = (blocks.corner == Corner.EXACT_STOP) | (blocks.geometry.angle != 0.0)
        goes_on = (np.cumsum(blocks.length) < self._view) & ~np.logical_or.accumulate(ends)
        return max(self._context, int(np.count_nonzero(goes_on)) + 1)


def _at_stop(corner: CodeArray, first: int, last: int) -> int:
    """The last stop in the second half of a group; its end where there is none."""
    behind = (first + last) // 2 + 1
    stops = np.flatnonzero(corner[behind : last + 1] == Corner.EXACT_STOP)
    return behind + int(stops[-1]) if len(stops) else last


def _within(angle: FloatArray, most: float) -> int:
    """How many arcs, lines among them, turn by no more than that, but for the last."""
    return min(len(angle), int(np.searchsorted(np.cumsum(angle), most)) + 1)
