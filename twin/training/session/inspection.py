"""What the sheet shows of the part that was handed in: measured places, and how it looks."""

import math
from typing import NamedTuple

from twin.training.session.moment import Moment
from twin.training.session.observed import Observed


class MeasuredPlace(NamedTuple):
    """A place of the part, measured.

    Attributes:
        x: Program coordinates at C0 [mm].
        y: The same along Y [mm].
        wanted: Height that the scene asks for [mm].
        found: Height of the part [mm]; None: there is no part.
        good: Whether both agree within the scene's tolerance.
    """

    x: float
    y: float
    wanted: float
    found: float | None
    good: bool


class Inspection(NamedTuple):
    """A part that was handed in.

    Attributes:
        moment: How it looks, with the tool as it stood then.
        places: Those that the scene measures.
        removed: Material that was cut off [mm³]; None: there was no blank.
        wanted_removed: Least and most that the scene asks for [mm³]; None: it does not ask.
    """

    moment: Moment
    places: tuple[MeasuredPlace, ...] = ()
    removed: float | None = None
    wanted_removed: tuple[float, float] | None = None


def part_is_right(room: Observed) -> bool:
    """Whether the part on the table is the one that the scene asks for."""
    part, work = room.scene.file.part, room.work
    if part is None:
        return True
    if work is None or not part.removed_mm3[0] <= work.removed <= part.removed_mm3[1]:
        return False
    return all(place.good for place in measured_places(room))


def measured_places(room: Observed) -> tuple[MeasuredPlace, ...]:
    """Measure the part on the table where the scene asks for it."""
    part, work = room.scene.file.part, room.work
    if part is None or work is None:
        return ()
    found = []
    for x, y, wanted in part.points:
        height = work.height_at(x, y)
        good = abs(height - wanted) <= part.tolerance
        found.append(MeasuredPlace(x, y, wanted, height if math.isfinite(height) else None, good))
    return tuple(found)


def inspect_part(room: Observed, moment: Moment) -> Inspection:
    """Measure what is handed in."""
    part, work = room.scene.file.part, room.work
    if part is None or work is None:
        return Inspection(moment)
    return Inspection(moment, measured_places(room), work.removed, part.removed_mm3)
