"""Events as columns: they become objects when somebody looks at them."""

import dataclasses
import functools
import math
from collections.abc import Iterable, Iterator, Sequence
from typing import overload

from twin.nc.canonical import Dwell, Event, FloatArray, Function, IntArray
from twin.nc.functions import SPINDLE_SPEED

FUNCTION, SPEED, TOOL, AUXILIARY, DWELL = range(5)
"""Kinds of events: an M function, with S where that counts; S; T; H; a dwell."""
_BEFORE = 0


@dataclasses.dataclass(frozen=True, slots=True)
class EventRows:
    """Events as the compiled run reports them.

    Attributes:
        rows: Index of the move that comes next, line, kind and number of an M function, shape (m, 4).
        amounts: What it counts; of T and H the number; NaN for nothing, shape (m,).
    """

    rows: IntArray
    amounts: FloatArray

    def __len__(self) -> int:
        return len(self.amounts)

    def __iter__(self) -> Iterator[Event]:
        pairs = zip(self.rows.tolist(), self.amounts.tolist(), strict=True)
        return (_event(row, amount) for row, amount in pairs)

    @property
    def before(self) -> IntArray:
        """Index of the move that comes next, shape (m,)."""
        return self.rows[:, _BEFORE]

    def behind(self, moves: int) -> "EventRows":
        """These events behind further moves, in columns of their own."""
        rows = self.rows.copy()
        rows[:, _BEFORE] += moves
        return EventRows(rows, self.amounts.copy())

    def part(self, begin: int, end: int) -> "EventRows":
        """Some of them."""
        return EventRows(self.rows[begin:end], self.amounts[begin:end])


class Events(Sequence[Event]):
    """The events of a chunk in program order."""

    def __init__(self, parts: Iterable[list[Event] | EventRows]) -> None:
        """Join parts, which change no more."""
        self._parts = tuple(parts)
        self._count = sum(len(part) for part in self._parts)

    @functools.cached_property
    def _objects(self) -> tuple[Event, ...]:
        return tuple(event for part in self._parts for event in part)

    def __len__(self) -> int:
        return self._count

    @overload
    def __getitem__(self, index: int) -> Event: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Event, ...]: ...
    def __getitem__(self, index: int | slice) -> Event | tuple[Event, ...]:
        return self._objects[index]

    def __iter__(self) -> Iterator[Event]:
        return iter(self._objects)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and self._objects == tuple(other)

    def __hash__(self) -> int:
        return hash(self._objects)

    def __repr__(self) -> str:
        return repr(self._objects)


def _event(row: list[int], amount: float) -> Event:
    before, line, kind, number = row
    if kind == FUNCTION:
        speed = {} if math.isnan(amount) else {SPINDLE_SPEED: amount}
        return Function(before, line, f"M{number}", speed)
    if kind == SPEED:
        return Function(before, line, SPINDLE_SPEED, {SPINDLE_SPEED: amount})
    if kind == DWELL:
        return Dwell(before, line, amount)
    return Function(before, line, f"{'T' if kind == TOOL else 'H'}{int(amount)}", {})
