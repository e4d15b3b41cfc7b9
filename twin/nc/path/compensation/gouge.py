"""Elements of a compensated contour that were passed: a new one must not cross them."""

import collections
import itertools
from typing import NamedTuple

from twin.nc.geometry import curves
from twin.nc.geometry.curves import Box, Curve

KEPT = 50
"""Elements that a new one is checked against: beyond them a neck of the contour goes unnoticed."""

NEIGHBOURS = 2
"""As many elements does a control look at that passes corners one by one."""


class _Element(NamedTuple):
    """An element that was passed, what it belongs to, and the line and the number of that."""

    curve: Curve
    own: Curve | None
    line: int
    number: int


class Crossing(NamedTuple):
    """A path that crosses one that was passed.

    Attributes:
        back: How many elements of the contour lie before the new one, from that on.
    """

    line: int
    back: int


class Passed:
    """The latest elements, the oldest first."""

    def __init__(self) -> None:
        self._elements: collections.deque[_Element] = collections.deque(maxlen=KEPT)
        self._boxes: collections.deque[Box] = collections.deque(maxlen=KEPT)
        """Where each of them lies."""
        self._count = 0
        """Elements of the contour that have come."""

    def clear(self) -> None:
        """Forget them: the tool has moved along the normal."""
        self._elements.clear()
        self._boxes.clear()

    def add(self, element: Curve, own: Curve | None, line: int) -> Crossing | None:
        """Remember the next element, of a line and an element of the contour; whether it crosses one where the contour does not."""
        self._count += own is not None
        left, low, right, high = box = curves.box_of(element)
        near = [
            number
            for number, (west, south, east, north) in enumerate(self._boxes)
            if east >= left and west <= right and south <= high and north >= low
        ]
        if near and near[-1] == len(self._boxes) - 1 and self._follows(element, own):
            near.pop()
        crossed = None
        for number in reversed(near):
            passed = self._elements[number]
            if curves.crossing_of(passed.curve, element)[0] and not self._is_excused(number, own):
                crossed = Crossing(passed.line, self._count - passed.number)
                break
        self._elements.append(_Element(element, own, line, self._count))
        self._boxes.append(box)
        return crossed

    def _follows(self, element: Curve, own: Curve | None) -> bool:
        """It and the last one are lines or paths around corners: these touch each other and cannot cross."""
        last, last_own = self._elements[-1][:2]
        return not (element[0] and own is not None) and not (last[0] and last_own is not None)

    def _is_excused(self, number: int, own: Curve | None) -> bool:
        """The contour crosses itself near an element."""
        count = len(self._elements)
        latest = [each.own for each in itertools.islice(self._elements, max(0, count - 2), count)]
        others = [each for each in (own, *latest) if each is not None]
        near = itertools.islice(self._elements, max(0, number - 2), min(number + 3, count))
        return any(
            curves.crossing_of(around, other)[0]
            for around in (each.own for each in near)
            if around is not None
            for other in others
        )
