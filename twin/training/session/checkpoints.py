"""Copies of a room at earlier moments, so that going back takes no longer after hours.

A copy is made while the machine runs, so it must be quick and small: what never changes is shared,
and of the stock only the tiles that were cut since the copy before.
"""

import dataclasses
import functools
from collections.abc import Iterator
from itertools import zip_longest
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt
from pydantic import BaseModel

from twin.copies import copied
from twin.cutting.heights.height_map import HeightMap
from twin.cutting.heights.outline import BlankOutline
from twin.machine.description.config import MachineConfig
from twin.machine.model.head_shape import HeadShape
from twin.machine.watching.relative_motion import RelativeMotion
from twin.motion.retiming.run_kernels import RunPieces
from twin.nc.control.constructs import Structure
from twin.nc.control.program_counter import FoundInText
from twin.nc.text.grammar import Grammar
from twin.nc.text.lines import Lines
from twin.training.room.room import SLICE, Room

APART_S = 4.0
"""Machine time between two copies [s]."""
DENSE = 20
"""Newest copies that are kept; older ones lie further apart the older they are."""

SPREAD = 0.2
"""Between older copies lies at least this share of their age."""
MOST = 28
"""Copies that are kept at most, the beginning with them: a room needs no more memory after a day."""
TILE = 64
"""Cells along a side of a tile of the stock."""

_SHARED = (
    MachineConfig,
    BaseModel,
    mujoco.MjModel,
    HeadShape,
    RelativeMotion,
    BlankOutline,
    Grammar,
    Lines,
    FoundInText,
    Structure,
    RunPieces,
)
"""What never changes and need not be copied."""
_FROZEN_IN = ("twin.nc.", "twin.motion.", "twin.toolpath.", "twin.training.", "twin.columns")
"""Where what is frozen holds nothing that is written to."""


@functools.cache
def never_changes(kind: type) -> bool:
    """Whether the copies of a room share what has a type."""
    fields = vars(kind).get("__dataclass_params__")
    frozen = fields is not None and fields.frozen and kind.__module__.startswith(_FROZEN_IN)
    return frozen or issubclass(kind, _SHARED)


Cells = npt.NDArray[np.float64 | np.float32]
"""What is kept of every cell of the stock."""


class KeptMap:
    """A map of the stock as it was: tiles that had not changed are those of the copy before.

    Attributes:
        tiles: Row by row.
        shape: Of all of them.
    """

    def __init__(self, cells: Cells, before: "KeptMap | None") -> None:
        """Keep heights or walls.

        Args:
            cells: Shape (ny, nx) or (ny, nx, 2).
            before: Of the stock as it was earlier; None, or of another shape: nothing is shared.
        """
        self.shape, self._type = cells.shape, cells.dtype
        known = [None] * len(list(self._places()))
        if before is not None and before.shape == cells.shape:
            known = before.tiles
        self.tiles = [
            old if old is not None and np.array_equal(old, cells[place]) else cells[place].copy()
            for place, old in zip(self._places(), known, strict=True)
        ]

    def _places(self) -> Iterator[tuple[slice, slice]]:
        rows, columns = self.shape[:2]
        for row in range(0, rows, TILE):
            for column in range(0, columns, TILE):
                yield slice(row, row + TILE), slice(column, column + TILE)

    def __deepcopy__(self, _memo: dict[int, Any]) -> Cells:
        """Copied as the map itself, with which a room can continue."""
        return self.laid_out()

    def laid_out(self) -> Cells:
        """The map, to be cut again."""
        cells = np.zeros(self.shape, self._type)
        for place, tile in zip(self._places(), self.tiles, strict=True):
            cells[place] = tile
        return cells


@dataclasses.dataclass(frozen=True, slots=True)
class Checkpoint:
    """A room as it was.

    Attributes:
        tick: Servo periods since the beginning.
        done: How many commands had been given by then.
        room: The copy; its stock is laid out when it is used.
        maps: Heights of its stock, and heights and walls that the force of the cut is computed from, where
            there are such.
    """

    tick: int
    done: int
    room: Room
    maps: tuple[KeptMap, ...]

    def restored(self) -> Room:
        """A room that goes on from there; the copy stays as it is."""
        return copied(self.room, never_changes, {})


class Checkpoints:
    """The copies of a session's room."""

    def __init__(self, room: Room) -> None:
        self._kept = [checkpoint(room, 0, ())]
        self._apart = SLICE * round(APART_S / room.slice_s)

    def note(self, room: Room, done: int) -> None:
        """Take a copy where the last one is old enough."""
        if room.tick - self._kept[-1].tick >= self._apart:
            self._kept.append(checkpoint(room, done, self._kept[-1].maps))
            self._thin_out()

    def before(self, tick: int) -> Checkpoint:
        """The newest copy that is not younger than a tick; younger ones are forgotten."""
        while self._kept[-1].tick > tick:
            self._kept.pop()
        return self._kept[-1]

    def _thin_out(self) -> None:
        """Of the older copies keep such as lie apart by a share of their age."""
        newest = self._kept[-1].tick
        kept = self._kept[:1]
        for number, one in enumerate(self._kept[1:], 1):
            recent = number >= len(self._kept) - DENSE
            if recent or one.tick - kept[-1].tick >= SPREAD * (newest - one.tick):
                kept.append(one)
        # The oldest behind the beginning goes first: it lies so far back that a session is left there.
        self._kept = [*kept[:1], *kept[1:][-(MOST - 1) :]]


def checkpoint(room: Room, done: int, before: tuple[KeptMap, ...]) -> Checkpoint:
    """A copy of a room.

    Args:
        before: What the copy before kept of the stock.
    """
    memo: dict[int, Any] = {}
    kept: list[KeptMap] = []
    for cells, earlier in zip_longest(_maps(room), before):
        if cells is not None:
            kept.append(KeptMap(cells, earlier))
            memo[id(cells)] = kept[-1]
    for stock in _stocks(room):
        memo[id(stock.uncut)] = stock.uncut
    return Checkpoint(room.tick, done, copied(room, never_changes, memo), tuple(kept))


def _stocks(room: Room) -> Iterator[HeightMap]:
    """What is cut: the part, and what the force of the cut is computed from."""
    if room.setup.work is not None and room.setup.work.map is not None:
        yield room.setup.work.map
    if room.setup.cut.process is not None:
        yield room.setup.cut.process.material


def _maps(room: Room) -> Iterator[Cells]:
    """What cutting changes of them."""
    for stock in _stocks(room):
        yield stock.heights
    if room.setup.cut.process is not None:
        yield room.setup.cut.process.walls
