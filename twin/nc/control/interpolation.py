"""How axis words become a move, and which of these ways the compiled tier knows."""

import dataclasses
import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from twin.nc.control.drilling_cycle import Cycle

if TYPE_CHECKING:
    from twin.nc.control.control import Control


@dataclasses.dataclass(frozen=True, slots=True)
class LineRule:
    """A block of plain axis words goes straight to their target.

    Attributes:
        rapid_feed: Of a rapid at a pace that the program sets: its own feed per second, 0 where it
            follows F; None: the machine's pace.
    """

    rapid_feed: Callable[["Control"], float] | None = None


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ArcRule:
    """A block of plain axis words with I, J, K of the plane or R is an arc.

    Within these bounds nothing about it is doubtful: no error, no warning, no correction to report.

    Attributes:
        clockwise: Its sense.
        mismatch: How far the distances of start and end from the centre may differ [mm].
        mismatch_share: The same as a share of the larger one.
        shift: How far the centre may be moved to fit [mm].
        signed_radius: A negative radius asks for the larger arc; else it is not plain.
        fits_radius: A centre found by its radius is fitted to both points like a given one.
    """

    clockwise: bool
    mismatch: float = math.inf
    mismatch_share: float = math.inf
    shift: float = math.inf
    signed_radius: bool = True
    fits_radius: bool = False


@dataclasses.dataclass(frozen=True, slots=True)
class CycleRule:
    """A block of plain words drills.

    Attributes:
        name: The cycle's code.
        cycle: What is peculiar to it.
        words: Which of its values each word gives, besides that of the axis across the plane.
    """

    name: str
    cycle: Cycle
    words: Mapping[str, int]


@dataclasses.dataclass(frozen=True, slots=True)
class Interpolation:
    """How axis words become a move.

    Attributes:
        perform: Takes the block's words and moves.
        rapid: At the machine's own speed.
        rule: What it does in a block of plain words, for the compiled tier; None: ``perform`` alone
            knows.
    """

    perform: Callable[["Control"], None]
    rapid: bool = False
    rule: LineRule | ArcRule | CycleRule | None = None
