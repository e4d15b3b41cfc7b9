"""Loops of a path, cut out where it crosses itself (CODESYS SoftMotion's G61).

The older of two crossing moves ends where they cross, those between are left out, and the path goes
on with the younger one (the library's page on SMC_AvoidLoop). Decision: a loop has at most
``LONGEST_LOOP`` moves; the page leaves this to the size of a buffer.
"""

import collections
import dataclasses
from collections.abc import Callable

from twin.nc.canonical import Event
from twin.nc.geometry import curves
from twin.nc.geometry.curves import Curve
from twin.nc.geometry.planes import Plane
from twin.nc.path.move_columns import Segment
from twin.nc.path.segments import element_of, part_of

LONGEST_LOOP = 32
"""Moves that a loop may have."""


@dataclasses.dataclass(slots=True)
class _Held:
    """A move that a later one may cross, and what happens behind it."""

    move: Segment
    element: Curve
    waiting: list[Event] = dataclasses.field(default_factory=list)


class Loops:
    """Cuts loops out of the path in one plane."""

    def __init__(
        self, plane: Plane, emit: Callable[[Segment], None], happen: Callable[[Event], None]
    ) -> None:
        self._plane = plane
        self._emit = emit
        self._happen = happen
        self._held: collections.deque[_Held] = collections.deque()

    def add(self, move: Segment) -> None:
        """The next move."""
        element = element_of(move, self._plane)
        if element is None:
            self.flush()
            self._emit(move)
            return
        for index, older in enumerate(self._held):
            crosses, *place = curves.crossing_of(older.element, element)
            if crosses:
                move, element = self._cut(index, move, element, *place)
                break
        self._held.append(_Held(move, element))
        while len(self._held) > LONGEST_LOOP:
            self._release()

    def event(self, event: Event) -> None:
        """Something that happens where the path has come to."""
        if self._held:
            self._held[-1].waiting.append(event)
        else:
            self._happen(event)

    def flush(self) -> None:
        """Nothing follows that could cross."""
        while self._held:
            self._release()

    def _release(self) -> None:
        held = self._held.popleft()
        self._emit(held.move)
        for event in held.waiting:
            self._happen(event)

    def _cut(
        self, index: int, move: Segment, element: Curve, left: float, right: float
    ) -> tuple[Segment, Curve]:
        """Cut out the loop from a share of an older move on to a share of this one."""
        older = self._held[index]
        waiting = [event for held in list(self._held)[index:] for event in held.waiting]
        while len(self._held) > index:
            self._held.pop()
        head = part_of(older.move, older.element, self._plane, 0.0, left)
        tail = part_of(move, element, self._plane, right, 1.0)
        tail = dataclasses.replace(tail, start=head.end)
        self._held.append(_Held(head, curves.head_of(older.element, left), waiting))
        return tail, element_of(tail, self._plane) or element
