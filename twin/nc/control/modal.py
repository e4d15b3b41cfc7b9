"""What stays in force from block to block."""

import dataclasses
from typing import NamedTuple, TypedDict, cast

from twin.nc.canonical import Corner
from twin.nc.control.interpolation import MotionMode
from twin.nc.geometry.planes import XY, Plane
from twin.nc.path.paces import FeedMode


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
    correct_center: bool


@dataclasses.dataclass(slots=True)
class Modal:
    """What is in force, besides the values of words such as F."""

    interpolation: MotionMode | None = None
    cycle: MotionMode | None = None
    """A canned cycle; while it is in force it stands in the place of the interpolation."""
    return_to_reference: bool = False
    """Cycles end at their reference plane, not at the height where they were called."""
    plane: Plane = XY
    incremental: bool = False
    center_absolute: bool = False
    unit: float = 1.0
    """Of programmed lengths [mm]."""
    feed_mode: FeedMode = FeedMode.PER_MINUTE
    corner: Corner = Corner.EXACT_PATH
    corner_tolerance: float = float("nan")
    square_corners: bool = False
    """Compensation extends lines at outside corners instead of rolling around them."""
    indirect_leads: bool = False
    """Compensation begins and ends around the contour's first and last point."""
    correct_center: bool = True
    """A centre that start and end are not equally far from is moved to fit."""

    def apply(self, changes: ModalChanges) -> None:
        """Put changes into force; the names of ``ModalChanges`` are those of the fields."""
        for name, value in changes.items():
            setattr(self, name, value)

    def values(self, of: ModalChanges) -> ModalChanges:
        """What is in force of the fields that changes name."""
        return cast("ModalChanges", {name: getattr(self, name) for name in of})


class SavedModal(NamedTuple):
    """What was in force, to be put back later.

    Attributes:
        modal: A copy.
        active: Number of the G code in force in each group.
    """

    modal: Modal
    active: dict[str, float]
