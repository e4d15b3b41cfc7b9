"""Elements of a compensated contour that were passed: a new one must not cross them."""

import collections
import itertools
from typing import NamedTuple

from twin.nc.geometry import curves
from twin.nc.geometry.curves import Box, Curve

NECK = 50
"""Elements of the contour that a new one is checked against: beyond them a neck goes unnoticed."""


class _Element(NamedTuple):
    """An element that was passed: where it lies, what it belongs to and the line of that."""

    curve: Curve
    box: Box
    own: Curve | None
    line: int


class Passed:
    """The latest elements, the oldest first."""

    def __init__(self) -> None:
        self._elements: collections.deque[_Element] = collections.deque(maxlen=NECK)

    def clear(self) -> None:
        """Forget them: the tool has moved along the normal."""
        self._elements.clear()

    def add(self, element: Curve, own: Curve | None, line: int) -> None:
        """Remember an element, and the contour's that it belongs to, if any."""
        self._elements.append(_Element(element, curves.box_of(element), own, line))

    def crossed_by(self, element: Curve, own: Curve | None) -> int | None:
        """Line of an element that a new one crosses where the contour does not cross itself; or None."""
        left, low, right, high = curves.box_of(element)
        for number, (curve, box, _, line) in enumerate(self._elements):
            if box[2] < left or box[0] > right or box[1] > high or box[3] < low:
                continue
            if curves.crossing_of(curve, element)[0] and not self._is_excused(number, own):
                return line
        return None

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
