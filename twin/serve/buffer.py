"""The agent's memory: observations with sequence numbers, the oldest of which are overwritten."""

import dataclasses
from collections.abc import Collection, Iterable, Iterator
from typing import NamedTuple

from twin.serve.device import UNAVAILABLE

BUFFER_SIZE = 1 << 17
"""Observations that are remembered: at 100 Hz and four moving axes a minute and a half."""


class Condition(NamedTuple):
    """What a condition says.

    Attributes:
        level: ``Normal``, ``Warning``, ``Fault`` or ``Unavailable``.
        code: The machine's own code of a fault; empty when normal.
        text: What happened, for people; empty when normal.
    """

    level: str
    code: str = ""
    text: str = ""


Value = str | Condition
NORMAL = Condition("Normal")


@dataclasses.dataclass(slots=True)
class Observation:
    """One value of one data item.

    Attributes:
        sequence: Number of the observation, from 1, one higher each.
        time: When, in ISO 8601 with the time zone UTC.
        xml: It as an element, once somebody asked for it: however many clients there are, it is
            written once.
    """

    sequence: int
    item: str
    time: str
    value: Value
    xml: str = dataclasses.field(default="", compare=False)


class OutOfRangeError(Exception):
    """A sequence number, or a count, that the buffer does not hold."""


class ObservationBuffer:
    """Remembers observations in the order in which they are made."""

    def __init__(self, items: Iterable[str], time: str, size: int = BUFFER_SIZE) -> None:
        """Begin with nothing known of any data item, as the standard asks.

        Args:
            items: Identifiers of all data items.
            time: When the agent started, ISO 8601.
        """
        self.size = size
        self._kept: list[Observation] = []
        self._next = 1
        self._latest: dict[str, Observation] = {}
        self._before_first: dict[str, Observation] = {}
        for item in items:
            self.add(item, time, UNAVAILABLE)

    @property
    def next_sequence(self) -> int:
        """Number that the next observation will have."""
        return self._next

    @property
    def first_sequence(self) -> int:
        """Number of the oldest observation that is remembered."""
        return self._next - len(self._kept)

    def add(self, item: str, time: str, value: Value) -> None:
        """Remember an observation, unless it repeats the last one of its data item."""
        before = self._latest.get(item)
        if before is not None and before.value == value:
            return
        observation = Observation(self._next, item, time, value)
        self._next += 1
        self._latest[item] = observation
        if len(self._kept) < self.size:
            self._kept.append(observation)
            return
        place = (observation.sequence - 1) % self.size
        gone, self._kept[place] = self._kept[place], observation
        self._before_first[gone.item] = gone

    def current(self, wanted: Collection[str], at: int | None = None) -> list[Observation]:
        """The last observation of each data item.

        Args:
            at: As it was when the observation of this number was made; now by default.

        Raises:
            OutOfRangeError: That observation is not remembered.
        """
        latest = self._latest
        if at is not None:
            if not self.first_sequence <= at < self._next:
                raise OutOfRangeError(
                    f"'at' is {at}; the buffer holds {self.first_sequence} to {self._next - 1}"
                )
            latest = self._before_first.copy()
            for observation in self._range(self.first_sequence, at + 1):
                latest[observation.item] = observation
        found = [latest[item] for item in wanted if item in latest]
        return sorted(found, key=lambda observation: observation.sequence)

    def sample(
        self, wanted: Collection[str], first: int | None, count: int
    ) -> tuple[list[Observation], int]:
        """Observations in order, and where the next request goes on.

        Args:
            wanted: Identifiers of the data items.
            first: Number of the first; the oldest that is remembered by default, or, counting
                backwards, the newest.
            count: How many at most; negative counts backwards from ``first``.

        Raises:
            OutOfRangeError: ``first`` is not remembered and not the next, or ``count`` is 0 or larger
                than the buffer.
        """
        if count == 0 or abs(count) > self.size:
            raise OutOfRangeError(f"'count' is {count}; it must be 1 to {self.size}, or negative")
        oldest, newest = self.first_sequence, self._next - 1
        if first is None:
            first = oldest if count > 0 else newest
        if not oldest <= first <= self._next:
            raise OutOfRangeError(f"'from' is {first}; the buffer holds {oldest} to {newest}")
        found: list[Observation] = []
        if count > 0:
            for observation in self._range(first, self._next):
                if observation.item in wanted:
                    found.append(observation)
                    if len(found) == count:
                        return found, observation.sequence + 1
            return found, self._next
        for observation in self._range(min(first, newest), oldest - 1, -1):
            if observation.item in wanted:
                found.append(observation)
                if len(found) == -count:
                    return found, max(observation.sequence - 1, oldest)
        return found, oldest

    def _range(self, begin: int, end: int, step: int = 1) -> Iterator[Observation]:
        """Remembered observations by their numbers, the last one left out."""
        kept, size = self._kept, self.size
        return (kept[(sequence - 1) % size] for sequence in range(begin, end, step))
