"""Continuous paths that go on beyond the blocks that are cut together: where the exact path is faster, it is kept.

Of the blocks at hand both are planned, with what is known on either side. What is chosen holds for what goes on
into the next blocks, and so does what that has gained: as long as the exact path could not make up for it, it is not
tried again. So the path is no slower than the exact one however long it is, and is known as far as ever.
"""

import dataclasses
from typing import NamedTuple

import numpy as np

from twin.columns import join
from twin.motion.blocks.blocks import BoolArray, Surroundings
from twin.motion.blocks.corners import CONTEXT, Borders, find_borders
from twin.motion.limits import MotionLimits
from twin.motion.phases_of_pieces import seconds_alone
from twin.motion.pieces.pieces import Pieces, cut
from twin.nc.canonical import Corner, IntArray

AT_FEED = 1.0 - 1e-9
"""Share of the feed from which on nothing but the feed bounds a piece."""

SEEN_BEFORE = 2048
"""Pieces before the blocks to work on that tell how fast the path comes to them."""

WAY_BACK = 2e-3
"""Share of its time that a path must gain by roundings where it goes on unseen: the exact path may be faster there, and
to come back to it takes a while."""

STAYS = 7
"""Groups of blocks in which a path that goes on is kept exactly without trying a rounding again, where that was faster so far."""


class CutBlocks(NamedTuple):
    """Blocks, how their borders are passed, and the pieces of those to work on."""

    part: Surroundings
    borders: Borders
    pieces: Pieces


class OpenChains:
    """Chooses how paths are passed that go on over the ends of the blocks that are cut together.

    Args:
        most_slow_arcs: As for ``PiecesOfChunks``.

    Attributes:
        has_knees: Whether the exact path may step anywhere.
    """

    def __init__(
        self, limits: MotionLimits, largest_override: float, most_slow_arcs: float
    ) -> None:
        self._limits, self._largest_override = limits, largest_override
        self._most_slow_arcs = most_slow_arcs
        steps = limits.junction_velocity_step, limits.junction_acceleration_step
        self.has_knees = any(np.any(np.asarray(step) > 0.0) for step in steps)
        self._exact = self._stays = self._longest = 0
        """How many blocks before the next ones are kept exactly up to their end; for how many groups that stays so,
        now and where it was tried last."""
        self._gained, self._pace = 0.0, 1.0
        """What the path that goes on has gained by not being kept exactly [s], and its time, of that at its limits."""
        self._before: list[Pieces] = []
        """Pieces before the next ones, where the path goes on."""

    def choose(self, part: Surroundings) -> CutBlocks:
        """Blocks, passed on the exact path where that is faster and the path goes on over their ends."""
        first, last, count = part.first, part.last, len(part.blocks)
        asked = part.blocks.corner == Corner.EXACT_STOP
        stops = first + np.flatnonzero(asked[first:last])
        behind = last + np.flatnonzero(asked[last:])
        end = int(behind[0]) if len(behind) else count
        comes, goes = first > 0 and not asked[first], last < count and not asked[last]
        head = int(stops[0]) if len(stops) else end
        kept, stays = self._exact if comes else 0, self._stays if comes else 0
        since = max(0, first - kept)
        if goes:
            # What has been chosen goes on into the blocks behind: they count too.
            part = dataclasses.replace(part, last=end)
        if kept:
            # The border at which the blocks before end is passed as they took it to be.
            part = _kept(part, since, head if stays else first + 1)
        here, exact_since = self._cut(part), since if stays and not len(stops) else count
        if comes and not stays and (kept or self._may_lose(here.pieces)):
            begin = since if kept else first + CONTEXT
            faster = self._faster(here, (begin, head), (first, head), last)
            if faster is not None:
                here, exact_since = faster, count if len(stops) else begin
        if goes and (len(stops) or not comes):
            tail = int(stops[-1]) if len(stops) else first
            self._before, self._gained = [], 0.0
            faster = self._faster(here, (tail, end), (tail, end), last)
            if faster is not None:
                here, exact_since = faster, tail
        goes_on = goes and exact_since < last
        self._exact = last - exact_since if goes_on else 0
        # The more often it was faster, the longer that is taken to stay so.
        self._longest = (
            min(STAYS, 2 * self._longest + 1) if goes_on and not stays else self._longest
        )
        self._stays = (stays - 1 if stays else self._longest) if goes_on else 0
        if not goes_on:
            self._longest = 0
        pieces = here.pieces[: first_pieces(here.pieces)[last - first]]
        self._before = [pieces[-SEEN_BEFORE:]] if goes else []
        return CutBlocks(dataclasses.replace(here.part, last=last), here.borders, pieces)

    def _may_lose(self, pieces: Pieces) -> bool:
        """Whether the exact path, at the feed all along, might gain more along pieces than it has lost before them."""
        at_limits, at_feed = _times(pieces, self._largest_override)
        risk = self._pace * at_limits - at_feed
        if 2.0 * risk > self._gained:
            return True
        self._gained -= max(0.0, risk)
        return False

    def _cut(self, part: Surroundings) -> CutBlocks:
        borders = find_borders(part.blocks, self._limits, self._largest_override)
        return CutBlocks(part, borders, cut(part, borders, self._limits, self._largest_override))

    def _faster(
        self, here: CutBlocks, exact: tuple[int, int], look: tuple[int, int], own: int
    ) -> CutBlocks | None:
        """The cut that keeps the path exactly between two borders; None where it is not faster.

        Args:
            exact: The first of these borders, and the one behind the last.
            look: First block that is looked at, and the one after the last.
            own: Row of the first block that is only known: there it may be chosen otherwise.
        """
        blocks, begin = here.part.blocks, here.part.first
        free = slice(max(exact[0], look[0]), look[1])
        if not np.any(blocks.corner[free] == Corner.CONTINUOUS):
            return None
        one, other = first_pieces(here.pieces)[[look[0] - begin, look[1] - begin]].tolist()
        if not _is_slowed(here.pieces[one:other], self._largest_override):
            return None
        slow = slow_arcs(here.pieces[one:other], self._largest_override)
        if np.count_nonzero(slow) > self._most_slow_arcs:
            return None
        there = self._cut(_kept(here.part, *exact))
        rounded = here
        if own + CONTEXT < look[1]:
            # What the exact path is held against goes back to it as soon as it can.
            rounded = self._cut(_kept(here.part, own + CONTEXT, look[1]))
            other = int(first_pieces(rounded.pieces)[look[1] - begin])
        first, last = first_pieces(there.pieces)[[look[0] - begin, look[1] - begin]].tolist()
        before = self._before if look[0] == begin else []
        seconds = [
            seconds_alone(join([*before, pieces]), self._limits)
            for pieces in (rounded.pieces[one:other], there.pieces[first:last])
        ]
        self._gained += seconds[1] - seconds[0]
        self._pace = seconds[0] / _times(join([*before, rounded.pieces[one:other]]), 1.0)[0]
        begins_rounding = (
            exact[0] <= look[0] and look[1] == len(blocks) and not here.part.to_the_end
        )
        slack = WAY_BACK if begins_rounding else 0.0
        return there if seconds[1] < seconds[0] * (1.0 + slack) else None


def slow_arcs(pieces: Pieces, largest_override: float) -> BoolArray:
    """Which blocks are arcs that are driven more slowly than is asked: each gets a time law of its own."""
    wanted = pieces.feed * np.where(pieces.rapid, 1.0, largest_override)
    slow = (pieces.velocity < AT_FEED * wanted) & (
        pieces.geometry.table.angle[pieces.geometry.row] != 0.0
    )
    return np.logical_or.reduceat(slow, first_pieces(pieces)[:-1])


def first_pieces(pieces: Pieces) -> IntArray:
    """The first piece of each block and, last, how many there are."""
    return np.append(np.flatnonzero((pieces.begin == 0.0) | (pieces.length == 0.0)), len(pieces))


def _is_slowed(pieces: Pieces, largest_override: float) -> bool:
    """Whether anything but one feed all along bounds the velocity of pieces between their ends."""
    wanted = pieces.feed * np.where(pieces.rapid, 1.0, largest_override)
    slower = np.any(pieces.velocity < AT_FEED * wanted) or np.any(
        pieces.entry[1:] < AT_FEED * wanted[1:]
    )
    return bool(slower or np.any(wanted != wanted[0]))


def _times(pieces: Pieces, largest_override: float) -> tuple[float, float]:
    """How long pieces take as fast as their limits allow, and as the program asks [s]."""
    moving = pieces[pieces.length > 0.0]
    wanted = moving.feed * np.where(moving.rapid, 1.0, largest_override)
    slowest = np.minimum(moving.velocity, wanted)
    return float(np.sum(moving.length / slowest)), float(np.sum(moving.length / wanted))


def _kept(part: Surroundings, first: int, last: int) -> Surroundings:
    """Blocks whose borders from the first on and before the last are passed on the exact path, or stop."""
    corner = part.blocks.corner.copy()
    corner[first:last] = np.minimum(corner[first:last], np.uint8(Corner.EXACT_PATH))
    return dataclasses.replace(part, blocks=dataclasses.replace(part.blocks, corner=corner))
