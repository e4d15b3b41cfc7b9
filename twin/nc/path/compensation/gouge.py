"""Elements of a compensated contour that were passed: a new one must not cross them."""

import collections
import itertools
from typing import NamedTuple

from twin.nc.geometry import curves
from twin.nc.geometry.curves import Box, Curve

NECK = 50
"""Elements of the contour that a new one is checked against: beyond them a neck goes unnoticed."""


class _Element(NamedTuple):
    """An element that was passed, what it belongs to and the line of that."""

    curve: Curve
    own: Curve | None
    line: int


class Passed:
    """The latest elements, the oldest first."""

    def __init__(self) -> None:
        self._elements: collections.deque[_Element] = collections.deque(maxlen=NECK)
        self._boxes: collections.deque[Box] = collections.deque(maxlen=NECK)
        """Where each of them lies."""

    def clear(self) -> None:
        """Forget them: the tool has moved along the normal."""
        self._elements.clear()
        self._boxes.clear()

    def add(self, element: Curve, own: Curve | None, line: int) -> int | None:
        """Remember the next element, of a line and an element of the contour, unless it crosses one where the contour does not.

        Returns:
            Line of the element that it crosses; None: none.
        """
        left, low, right, high = box = curves.box_of(element)
        near = [
            number
            for number, (west, south, east, north) in enumerate(self._boxes)
            if east >= left and west <= right and south <= high and north >= low
        ]
        if near and near[-1] == len(self._boxes) - 1 and self._follows(element, own):
            near.pop()
        for number in near:
            curve, _, passed = self._elements[number]
            if curves.crossing_of(curve, element)[0] and not self._is_excused(number, own):
                return passed
        self._elements.append(_Element(element, own, line))
        self._boxes.append(box)
        return None

    def _follows(self, element: Curve, own: Curve | None) -> bool:
        """It and the last one are lines or paths around corners: these touch each other and cannot cross."""
        last, last_own, _ = self._elements[-1]
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
