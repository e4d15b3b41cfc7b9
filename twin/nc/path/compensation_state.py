"""How far radius compensation has come between two blocks: what the compiled tier is given, and gives back."""

import dataclasses
import enum

from twin.nc.canonical import Event
from twin.nc.geometry.arcs import Point
from twin.nc.geometry.curves import Box
from twin.nc.geometry.elements import Element
from twin.nc.geometry.planes import Plane
from twin.nc.path.move_columns import Segment

NECK = 50
"""Elements of the contour that a new one is checked against: beyond them a neck goes unnoticed."""


class Stage(enum.IntEnum):
    """What compensation waits for."""

    OFF = 0
    """For its beginning."""
    STARTED = 1
    """For the straight move that leads in."""
    LEADING_IN = 2
    """For the contour's first element; the move that leads in is held."""
    FOLLOWING = 3
    """For the contour's next element; the last one is held."""
    LEADING_OUT = 4
    """It has ended, and waits for the straight move that leads out."""


@dataclasses.dataclass(frozen=True, slots=True)
class PassedElement:
    """A compensated element that was emitted, its contour, its source line and where it lies."""

    element: Element
    contour: Element | None
    line: int
    box: Box


@dataclasses.dataclass(frozen=True, slots=True)
class CompensationState:
    """Compensation between two blocks, at a stage other than ``OFF``.

    Attributes:
        stage: What it waits for.
        plane: In part coordinates.
        signed_offset: The tool's radius, signed as its side [mm].
        square: Outside corners between lines are extended.
        indirect: Leads go around the contour's first and last point.
        move: The move that is held, as programmed, or None.
        contour: Itself in the plane; ``LEADING_OUT``: the contour's last element.
        element: Its parallel; None but for ``FOLLOWING``.
        start: Where its compensated path begins in the plane.
        here: Where the path has come to, shape (k,); empty before it has begun.
        gouge_history: Elements that were passed, the oldest first.
    """

    stage: Stage
    plane: Plane
    signed_offset: float
    square: bool
    indirect: bool
    move: Segment | None
    contour: Element | None
    element: Element | None
    start: Point
    here: list[float]
    gouge_history: list[PassedElement]


@dataclasses.dataclass(frozen=True, slots=True)
class CompensationResult:
    """What a run has made of a contour.

    Attributes:
        state: How far it has come, or None.
        waiting: Moves and events at the end of the held move, in order.
        latest: The last programmed move, or None where there was none.
        before: The last programmed move, or None where an event came behind it.
        came: Something came at all.
    """

    state: CompensationState | None
    waiting: list[Segment | Event]
    latest: Segment | None
    before: Segment | None
    came: bool
