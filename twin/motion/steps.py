"""Stages of planning that pull parts of a program; each keeps its state in an object.

A generator could not be copied, and a plan under an operator's hands is: a training room goes back to
copies of it.
"""

import abc
from collections import deque
from collections.abc import Iterable, Iterator
from typing import Generic, Self, TypeVar

Taken = TypeVar("Taken")
Made = TypeVar("Made")


class PipelineStage(abc.ABC, Generic[Taken, Made]):
    """A stage: takes parts one by one, on demand, and gives what it makes of them.

    Args:
        parts: What it takes, in order.
    """

    def __init__(self, parts: Iterable[Taken]) -> None:
        self._parts = iter(parts)
        self._made: deque[Made] = deque()
        self._over = False

    def __iter__(self) -> Self:
        return self

    def __next__(self) -> Made:
        while not self._made:
            if self._over:
                raise StopIteration
            self._take_next()
        return self._made.popleft()

    def work(self) -> bool:
        """Do the least that brings the next result nearer: one part of the first step that lacks one.

        Returns:
            Whether the next result is there, or none comes any more.
        """
        if not self._made and not self._over:
            if isinstance(self._parts, PipelineStage) and not self._parts.work():
                return False
            self._take_next()
        return bool(self._made) or self._over

    def _take_next(self) -> None:
        part = next(self._parts, None)
        self._over = part is None
        self._made.extend(self.finish() if part is None else self.take(part))

    @abc.abstractmethod
    def take(self, part: Taken) -> Iterator[Made]:
        """What is certain now that a part has come."""

    def finish(self) -> Iterator[Made]:
        """What is left when no part comes any more."""
        return iter(())
