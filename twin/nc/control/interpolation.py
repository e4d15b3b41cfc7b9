"""How axis words become a move, as data: what the kernel of plain lines must know of it."""

import dataclasses
from collections.abc import Mapping

from twin.nc.geometry.arcs import Bounds
from twin.nc.path.drilling_cycle import Cycle


@dataclasses.dataclass(frozen=True, slots=True)
class LineRule:
    """A block of plain axis words goes straight to their target."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ArcRule:
    """A block of plain axis words with I, J, K of the plane or R is an arc.

    Attributes:
        clockwise: Its sense.
        bounds: Beyond them an arc is refused or warned of.
        signed_radius: A negative radius asks for the larger arc; else it is not plain.
        fits_radius: A centre found by its radius is fitted to both points like a given one.
    """

    clockwise: bool = True
    bounds: Bounds
    signed_radius: bool = True
    fits_radius: bool = False


@dataclasses.dataclass(frozen=True, slots=True)
class CycleRule:
    """A block of plain words drills.

    Attributes:
        name: The cycle's code.
        cycle: What is peculiar to it.
        words: Which of its values each word gives, besides that of the axis across the plane.
        options: Other words of its call, and those of their values that change nothing of the path.
    """

    name: str
    cycle: Cycle
    words: Mapping[str, int]
    options: Mapping[str, tuple[float, ...]] = dataclasses.field(default_factory=dict)

    def addresses(self, across: str) -> Mapping[str, int]:
        """Which of its values each word gives, also that of the axis across the plane."""
        return {**self.words, across: self.cycle.across}


MotionRule = LineRule | ArcRule | CycleRule


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class MotionMode:
    """What is in force of how axis words become a move.

    Attributes:
        rapid: At the machine's own speed.
        rule: What it does in a block of plain words; None: it is Python's.
    """

    rapid: bool = False
    rule: MotionRule | None = None
