"""How long each room worked, although the rooms work in turns."""

import contextlib
import time
from collections import defaultdict
from collections.abc import Iterable, Iterator
from typing import TypeVar

ItemT = TypeVar("ItemT")


class StageClock:
    """Exclusive wall time by stage: while an inner stage runs, the outer one's clock stands.

    Attributes:
        seconds: Time spent by stage name [s].
    """

    def __init__(self) -> None:
        self.seconds: dict[str, float] = defaultdict(float)
        self._running: list[str] = []
        self._since = 0.0
        self._began = time.perf_counter()

    @property
    def wall_s(self) -> float:
        """Wall time since the clock was made [s]."""
        return time.perf_counter() - self._began

    @contextlib.contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Count the time of the block for ``name``."""
        self._switch()
        self._running.append(name)
        try:
            yield
        finally:
            self._switch()
            self._running.pop()

    def watch(self, name: str, items: Iterable[ItemT]) -> Iterator[ItemT]:
        """Pass items on, counting the time that producing them takes."""
        iterator = iter(items)
        while True:
            with self.stage(name):
                try:
                    item = next(iterator)
                except StopIteration:
                    return
            yield item

    def _switch(self) -> None:
        now = time.perf_counter()
        if self._running:
            self.seconds[self._running[-1]] += now - self._since
        self._since = now
