"""Pockets and studs: rings along the wall, from depth to depth.

A pocket is entered at its centre and cleared outwards, a stud is entered beside the blank and cleared inwards;
rings lie at most a step apart.
"""

import dataclasses
import enum
import math

from twin.nc.control.control import Control
from twin.nc.geometry.arcs import Point, turned

DIAGONAL = 1.7
"""Rings lie at most this many radii apart, so that nothing stays between their corners.

Two corners of rings s apart are s times the root of 2 apart; the tool in the inner one reaches what
the outer ring leaves up to s = r (1 + 1 / root of 2).
"""
MOST_PASSES = 10_000
"""Rings and depths of one pocket, so that a slip of the pen does not run for hours."""


class CornerKind(enum.IntEnum):
    """What the corners of a pocket are: M of G87."""

    SQUARE = 0
    ROUNDED = 1
    CHAMFERED = 2


@dataclasses.dataclass(frozen=True, slots=True)
class Corner:
    """The corners of a rectangular pocket.

    Attributes:
        size: Radius, or distance of the chamfer's ends from the corner, at the wall [mm].
        radius: Of the tool [mm].
    """

    kind: CornerKind = CornerKind.SQUARE
    size: float = 0.0
    radius: float = 0.0

    def at(self, inset: float) -> float:
        """Size on a ring that lies so far from the tool's path along the wall [mm].

        A parallel at the distance d shortens a radius by d, and the legs of a chamfer of 45 degrees
        by d (2 - root of 2).
        """
        share = 1.0 if self.kind is CornerKind.ROUNDED else 2.0 - math.sqrt(2.0)
        return max(0.0, self.size - share * (self.radius + inset))


@dataclasses.dataclass(frozen=True, slots=True)
class Pocket:
    """A pocket in the working plane.

    Attributes:
        center: In the plane, programmed coordinates [mm].
        length: Half its length less the tool's radius, or the radius of the tool's widest circle [mm].
        width: Half its width less the tool's radius; None for a circular pocket [mm].
        angle: Of its length against the abscissa [deg].
    """

    center: Point
    length: float
    width: float | None
    angle: float
    clockwise: bool
    corner: Corner


@dataclasses.dataclass(frozen=True, slots=True)
class Passes:
    """How it is cleared.

    Attributes:
        reference: Height of the reference plane [mm].
        levels: Height of each pass [mm].
        insets: How far each ring of a pass lies from the tool's path along the wall; outside a stud below 0 [mm].
        finish: How far the last rings lie from it, at the lowest level; none where nothing is finished [mm].
        plunge: Feed of plunging; None: the feed in force.
        finish_feed: Feed of the last rings; None: the feed in force.
        back: Height to which the tool returns [mm].
        entry: Where the tool plunges, in the plane [mm].
        helix: Radius of the helix on which it does, 0 for straight down [mm].
        pitch: Of that helix [mm].
    """

    reference: float
    levels: tuple[float, ...]
    insets: tuple[float, ...]
    finish: tuple[float, ...]
    plunge: float | None
    finish_feed: float | None
    back: float
    entry: Point
    helix: float = 0.0
    pitch: float = 0.0


def levels_between(surface: float, bottom: float, depth: float) -> tuple[float, ...]:
    """Heights of passes of a depth [mm], down to the bottom."""
    found, height = [], surface
    while height > bottom:
        height = max(height - depth, bottom)
        if bottom < height < bottom + 1e-6:
            height = bottom
        found.append(height)
    return tuple(found)


def insets_of(pocket: Pocket, step: float, stock: float) -> tuple[float, ...]:
    """How far the rings of a pocket, at most a step apart, lie from the tool's path along the wall, from inside to outside [mm].

    The innermost ring of a rectangle is the line along its middle; a circle begins with the plunge.
    """
    inner = pocket.length if pocket.width is None else min(pocket.length, pocket.width)
    room = inner - stock
    count = math.ceil(room / step - 1e-9)
    if count == 0:
        return (stock,)
    first = 1 if pocket.width is None else 0
    return tuple(stock + room * (1.0 - number / count) for number in range(first, count + 1))


def require_room(
    control: Control,
    name: str,
    pocket: Pocket,
    stock: float,
    levels: float,
    step: float,
    radius: float,
) -> None:
    """The tool must fit into a pocket, in as many passes as make sense."""
    least = pocket.length if pocket.width is None else min(pocket.length, pocket.width)
    if least - stock < 0.0:
        message = f"the tool's radius {radius:g} and the stock leave no room in the pocket"
        control.fail("cycle-size", f"{name}: {message}")
    if (math.ceil(least / step) + 1) * levels > MOST_PASSES:
        control.fail("cycle-size", f"{name} would need more than {MOST_PASSES} passes")


def mill(control: Control, pocket: Pocket, passes: Passes) -> None:
    """Mill a pocket, or around a stud."""
    axis = control.modal.plane.axes[2]
    feed = control.motion.feed
    _rise(control, max(control.motion.programmed[axis], passes.reference))
    _go(control, passes.entry, rapid=True)
    _rise(control, passes.reference)
    for number, level in enumerate(passes.levels):
        if number > 0:
            _go(control, passes.entry, rapid=False)
        control.motion.feed = feed if passes.plunge is None else passes.plunge
        _plunge(control, passes, level)
        control.motion.feed = feed
        for inset in passes.insets:
            _ring(control, pocket, inset)
    control.motion.feed = passes.finish_feed or feed
    for inset in passes.finish:
        _ring(control, pocket, inset)
    control.motion.feed = feed
    _rise(control, passes.back)
    _go(control, passes.entry, rapid=True)


def _plunge(control: Control, passes: Passes, level: float) -> None:
    """Go down to a level, straight or on a helix about the entry."""
    axis = control.modal.plane.axes[2]
    fall = control.motion.programmed[axis] - level
    if passes.helix <= 0.0 or fall <= 0.0:
        _rise(control, level, rapid=False)
        return
    _go(control, (passes.entry[0] + passes.helix, passes.entry[1]), rapid=False)
    target = list(control.motion.programmed)
    target[axis] = level
    control.arc_to(target, passes.entry, 360.0 * math.ceil(fall / passes.pitch))
    control.arc_to(list(target), passes.entry, 360.0)
    _go(control, passes.entry, rapid=False)


def _ring(control: Control, pocket: Pocket, inset: float) -> None:
    sign = -1.0 if pocket.clockwise else 1.0
    length = pocket.length - inset
    if pocket.width is None:
        begin = turned((pocket.center[0] + length, pocket.center[1]), pocket.center, pocket.angle)
        _go(control, begin, rapid=False)
        if length > 0.0:
            control.arc_to(list(control.motion.programmed), pocket.center, sign * 360.0)
        return
    _rectangle(control, pocket, length, pocket.width - inset, pocket.corner.at(inset))


def _rectangle(
    control: Control, pocket: Pocket, length: float, width: float, corner: float
) -> None:
    """Go once around a rectangle by its half length and half width, corners cut or rounded."""
    sign = -1.0 if pocket.clockwise else 1.0
    corner = min(corner, length, width)

    def go(along: float, across: float) -> Point:
        point = (pocket.center[0] + along, pocket.center[1] + sign * across)
        place = turned(point, pocket.center, pocket.angle)
        _go(control, place, rapid=False)
        return place

    go(length, 0.0)
    for along, across in ((1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)):
        ends = [
            (along * length, across * (width - corner)),
            (along * (length - corner), across * width),
        ]
        if along != across:
            ends.reverse()
        go(*ends[0])
        if corner > 0.0 and pocket.corner.kind is CornerKind.ROUNDED:
            middle = (along * (length - corner), sign * across * (width - corner))
            center = turned(
                (pocket.center[0] + middle[0], pocket.center[1] + middle[1]),
                pocket.center,
                pocket.angle,
            )
            end = turned(
                (pocket.center[0] + ends[1][0], pocket.center[1] + sign * ends[1][1]),
                pocket.center,
                pocket.angle,
            )
            _arc(control, end, center, sign * 90.0)
        elif corner > 0.0:
            go(*ends[1])
    go(length, 0.0)


def _arc(control: Control, end: Point, center: Point, sweep: float) -> None:
    plane, target = control.modal.plane, list(control.motion.programmed)
    plane.aim(target, end)
    control.arc_to(target, center, sweep)


def _go(control: Control, point: Point, *, rapid: bool) -> None:
    plane, target = control.modal.plane, list(control.motion.programmed)
    plane.aim(target, point)
    control.line_to(target, rapid=rapid)


def _rise(control: Control, height: float, *, rapid: bool = True) -> None:
    target = list(control.motion.programmed)
    target[control.modal.plane.axes[2]] = height
    control.line_to(target, rapid=rapid)
