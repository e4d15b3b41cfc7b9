"""Pockets, slots and studs: rings along the wall, from depth to depth.

A pocket is entered in its middle and cleared outwards, a stud is entered beside the blank and cleared inwards;
rings lie at most a step apart.
"""

import dataclasses
import math

from twin.nc.control.control import Control
from twin.nc.geometry.arcs import Point
from twin.nc.iso.cycle_moves import at_feed, go, go_to_height, turn
from twin.nc.iso.milling.outlines import Outline

DIAGONAL = 1.7
"""Rings of a pocket lie at most this many radii apart, so that nothing stays between their corners.

Two corners of rings s apart are s times the root of 2 apart; the tool in the inner one reaches what
the outer ring leaves up to s = r (1 + 1 / root of 2).
"""
MOST_PASSES = 10_000
"""Rings and depths of one pocket, so that a slip of the pen does not run for hours."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Clearing:
    """How a pocket or a stud is milled; heights are programmed coordinates.

    Attributes:
        radius: Of the tool [mm].
        reference: Height of the reference plane, where plunging begins [mm].
        surface: Height at which the first pass begins [mm].
        bottom: Height of the last one [mm].
        back: Height to which the tool returns [mm].
        depth: Of a pass at most [mm].
        step: How far rings lie apart at most [mm].
        stock: What roughing leaves at the wall [mm].
        floor: What it leaves at the bottom [mm].
        roughs: Whether there is roughing.
        finishes: Whether what it leaves is taken away.
        plunge: Feed of plunging; None: that of milling.
        finish_feed: Feed of the last ring; None: that of milling.
        helix: Radius of the helix on which the tool plunges, 0 for straight down [mm].
        pitch: Of that helix [mm].
    """

    name: str
    radius: float
    reference: float
    surface: float
    bottom: float
    back: float
    depth: float
    step: float
    stock: float = 0.0
    floor: float = 0.0
    roughs: bool = True
    finishes: bool = True
    feed: float | None
    plunge: float | None = None
    finish_feed: float | None = None
    helix: float = 0.0
    pitch: float = 1.0

    @property
    def levels(self) -> tuple[float, ...]:
        """Heights of the passes [mm]."""
        levels = levels_between(self.surface, self.bottom + self.floor, self.depth)
        if not self.roughs:
            return (self.bottom,)
        return (*levels, self.bottom) if self.finishes and self.floor > 0.0 else levels

    @property
    def leaves(self) -> bool:
        """Roughing leaves something that a last ring at the wall takes away."""
        return self.roughs and self.finishes and (self.stock > 0.0 or self.floor > 0.0)


def levels_between(surface: float, bottom: float, depth: float) -> tuple[float, ...]:
    """Heights of passes of a depth [mm], down to the bottom."""
    found, height = [], surface
    while height > bottom:
        height = max(height - depth, bottom)
        if bottom < height < bottom + 1e-6:
            height = bottom
        found.append(height)
    return tuple(found)


def clear_pocket(control: Control, outline: Outline, clearing: Clearing) -> None:
    """Mill a pocket or a slot."""
    stock = clearing.stock if clearing.roughs else 0.0
    room, step = outline.room - stock, min(clearing.step, DIAGONAL * clearing.radius)
    if room < 0.0:
        message = f"the tool's radius {clearing.radius:g} and the stock leave no room in the pocket"
        control.fail("cycle-size", f"{clearing.name}: {message}")
    count = math.ceil(room / step - 1e-9)
    _require_passes(control, clearing, count + 1)
    rings = tuple(stock + room * (1.0 - each / max(count, 1)) for each in range(count + 1))
    if not clearing.roughs and clearing.floor == 0.0:
        rings = (0.0,)
    entry, helix = outline.entry, min(clearing.helix, outline.room)
    _mill(control, outline, dataclasses.replace(clearing, helix=helix), entry, rings)


def clear_around(
    control: Control, outline: Outline, clearing: Clearing, left: float, entry: Point
) -> None:
    """Mill around a stud, of whose blank so much is left around it [mm], from an entry beside that."""
    roughing = left - clearing.stock
    count = max(1, math.ceil(roughing / clearing.step - 1e-9))
    _require_passes(control, clearing, count)
    first = max(roughing, 0.0)
    rings = tuple(-clearing.stock - first * (1.0 - (each + 1) / count) for each in range(count))
    _mill(control, outline, clearing, entry, rings if clearing.roughs else (0.0,))


def _require_passes(control: Control, clearing: Clearing, rings: int) -> None:
    levels = (clearing.surface - clearing.bottom) / clearing.depth
    if rings * levels > MOST_PASSES:
        message = f"{clearing.name} would need more than {MOST_PASSES} passes"
        control.fail("cycle-size", message)


def _mill(
    control: Control, outline: Outline, clearing: Clearing, entry: Point, rings: tuple[float, ...]
) -> None:
    """Rings at every level, the last ring if there is one, and back over the entry."""
    height = control.motion.programmed[control.modal.plane.axes[2]]
    go_to_height(control, max(height, clearing.reference))
    go(control, entry, rapid=True)
    go_to_height(control, clearing.reference)
    for level in clearing.levels:
        with at_feed(control, clearing.feed):
            go(control, entry)
        with at_feed(control, clearing.plunge or clearing.feed):
            _plunge(control, clearing, entry, level)
        with at_feed(control, clearing.feed):
            for inset in rings:
                outline.go_around(control, inset)
    if clearing.leaves:
        with at_feed(control, clearing.finish_feed or clearing.feed):
            outline.go_around(control, 0.0)
    go_to_height(control, clearing.back)
    go(control, entry, rapid=True)


def _plunge(control: Control, clearing: Clearing, entry: Point, level: float) -> None:
    """Go down to a level, straight or on a helix about the entry."""
    fall = control.motion.programmed[control.modal.plane.axes[2]] - level
    if clearing.helix <= 0.0 or fall <= 0.0:
        go_to_height(control, level, rapid=False)
        return
    begin = (entry[0] + clearing.helix, entry[1])
    go(control, begin)
    turn(control, entry, begin, 360.0 * math.ceil(fall / clearing.pitch), level)
    turn(control, entry, begin, 360.0)
    go(control, entry)
