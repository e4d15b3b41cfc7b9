"""What stays in force from block to block."""

import dataclasses
import math
from collections.abc import Iterable
from typing import Self, TypedDict

from twin.nc.canonical import Corner
from twin.nc.geometry.arcs import Bounds
from twin.nc.geometry.planes import XY, Plane
from twin.nc.path.compensation.gouge import KEPT
from twin.nc.path.feed_rates import FeedMode


@dataclasses.dataclass(frozen=True, slots=True)
class LineRule:
    """A block of plain axis words goes straight to their target."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ArcRule:
    """A block of plain axis words with I, J, K of the plane or R is an arc.

    Attributes:
        bounds: Beyond them an arc is refused or warned of.
        signed_radius: A negative radius asks for the larger arc; else it is not plain.
        fits_radius: A centre found by its radius is fitted to both points like a given one.
    """

    clockwise: bool = True
    bounds: Bounds
    signed_radius: bool = True
    fits_radius: bool = False


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class MotionMode:
    """How axis words become a move, as far as the kernel of plain lines must know it.

    Attributes:
        rapid: At the machine's own speed.
        rule: What it does in a block of plain words; None: it is Python's.
    """

    rapid: bool = False
    rule: LineRule | ArcRule | None = None


class ModalChanges(TypedDict, total=False):
    """Fields of ``Modal`` and what they become, as a G code sets them."""

    interpolation: MotionMode | None
    cycle: MotionMode | None
    return_to_reference: bool
    plane: Plane
    incremental: bool
    center_absolute: bool
    unit: float
    feed_mode: FeedMode
    corner: Corner
    corner_tolerance: float
    square_corners: bool
    indirect_leads: bool
    look_ahead: int
    correct_center: bool


class ActiveCodes:
    """The number of the G code in force in each modal group."""

    def __init__(self, groups: Iterable[str]) -> None:
        self._codes = dict.fromkeys(groups, math.nan)

    def get(self, group: str, default: float = math.nan) -> float:
        """The code in force in a group, or a default where there is none."""
        code = self._codes.get(group, math.nan)
        return code if code == code else default

    def put(self, group: str, code: float) -> None:
        """Put a code into force, or none: NaN."""
        self._codes[group] = code

    def numbers(self) -> tuple[float, ...]:
        """The codes of all groups that have one."""
        return tuple(code for code in self._codes.values() if code == code)

    def fork(self) -> "ActiveCodes":
        """A copy that changes by itself."""
        fork = ActiveCodes(self._codes)
        fork._codes.update(self._codes)
        return fork


@dataclasses.dataclass(slots=True)
class Modal:
    """What is in force, besides the values of words such as F.

    Attributes:
        active: The code in force in each modal group.
        interpolation: How axis words become a move; None before a motion code.
        cycle: A canned cycle; while it is in force it replaces the interpolation.
        return_to_reference: Cycles end at their reference plane, not at the height of their call.
        incremental: Axis words count from where the tool is.
        center_absolute: The words of a centre count from part zero.
        unit: Of programmed lengths [mm].
        corner: How the ends of moves are passed.
        corner_tolerance: [mm]; NaN: the machine's.
        square_corners: Compensation extends lines at outside corners instead of rolling around them.
        indirect_leads: Compensation begins and ends around the contour's first and last point.
        look_ahead: Elements of a compensated contour among which the control finds a crossing and refuses it.
        correct_center: A centre that start and end are not equally far from is moved to fit.
    """

    active: ActiveCodes
    interpolation: MotionMode | None = None
    cycle: MotionMode | None = None
    return_to_reference: bool = False
    plane: Plane = XY
    incremental: bool = False
    center_absolute: bool = False
    unit: float = 1.0
    feed_mode: FeedMode = FeedMode.PER_MINUTE
    corner: Corner = Corner.EXACT_PATH
    corner_tolerance: float = math.nan
    square_corners: bool = False
    indirect_leads: bool = False
    look_ahead: int = KEPT
    correct_center: bool = True

    def put(self, changes: ModalChanges) -> None:
        """Put values into fields."""
        for name, value in changes.items():
            setattr(self, name, value)

    def values_of(self, changes: ModalChanges) -> ModalChanges:
        """The present values of the fields that changes name."""
        found: ModalChanges = {}
        for name in changes:
            found[name] = getattr(self, name)
        return found

    def fork(self) -> Self:
        """A copy that changes by itself."""
        return dataclasses.replace(self, active=self.active.fork())

    def restore(self, saved: Self) -> None:
        """Put back into force what ``saved`` holds, for a program of the same dialect."""
        for field in dataclasses.fields(self):
            setattr(self, field.name, getattr(saved, field.name))
        self.active = saved.active.fork()
