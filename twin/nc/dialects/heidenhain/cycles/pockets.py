"""Cycles of pockets, slots and studs: 251, 252, 253, 256, 257, and the old 4 and 5.

Decisions, since the manuals leave the path open: pockets are entered at their centre and cleared outwards in rings
along the wall, Q370 radii apart at most; with Q366=1 or 2 the tool goes down on a helix of half its radius, by a
tenth of that radius a turn; studs are entered beside the blank, on the side of positive X, and cleared inwards.
"""

import math

from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.cycle_values import Parameters
from twin.nc.dialects.heidenhain.cycles.holes import heights
from twin.nc.dialects.heidenhain.tools import compensation_radius
from twin.nc.geometry.arcs import Point, turned
from twin.nc.iso.pockets import (
    DIAGONAL,
    Corner,
    CornerKind,
    Passes,
    Pocket,
    insets_of,
    levels_between,
    mill,
    require_room,
)

_BESIDE = 2.0
"""Between the blank of a stud and the tool that plunges beside it [mm]."""
_HELIX, _PITCH = 0.5, 0.1
"""Radius and pitch of the helix on which the tool goes down, as shares of its radius."""
_CORNERS = {0: (0.0, 0.0), 1: (1.0, 1.0), 2: (-1.0, 1.0), 3: (-1.0, -1.0), 4: (1.0, -1.0)}
"""Where the middle lies from the place of the call, by Q367, in halves of length and width."""
_ENDS = {0: (0.0, 0.0), 1: (1.0, 0.0), 2: (1.0, 0.0), 3: (-1.0, 0.0), 4: (-1.0, 0.0)}
"""The same of a slot: its left end, the centre of its left arc, that of its right arc, its right end."""


def _middle(control: Control, given: Parameters, halves: Point, ways: dict[int, Point]) -> Point:
    """The middle of what is milled, turned with it about the place of the call."""
    way = ways.get(int(given.number(367)))
    if way is None:
        control.fail("cycle-word", f"Q367 is 0 to 4, not {given.number(367):g}")
    here = control.modal.plane.point(control.motion.programmed)
    there = (here[0] + way[0] * halves[0], here[1] + way[1] * halves[1])
    return turned(there, here, given.number(224) + given.number(374))


def _operation(control: Control, given: Parameters) -> tuple[bool, bool]:
    """Whether Q215 asks for roughing and for finishing."""
    kind = int(given.number(215))
    if kind not in (0, 1, 2):
        control.fail("cycle-word", f"Q215 is 0, 1 or 2, not {given.number(215):g}")
    return kind != 2, kind != 1


def _mill_pocket(control: Control, given: Parameters, pocket: Pocket, radius: float) -> None:
    surface, reference, bottom, back = heights(control, given)
    roughs, finishes = _operation(control, given)
    stock, floor = given.length(368), given.length(369)
    depth, step = (
        abs(given.length(202)),
        min((given.number(370) or 1.0) * radius, DIAGONAL * radius),
    )
    if depth == 0.0 or stock < 0.0 or not 0.0 <= floor < surface - bottom or step <= 0.0:
        message = f"{given.name} needs passes Q202 and steps Q370 above 0, and no stock below 0"
        control.fail("cycle-depth", message, hint="Q202=+5, Q370=+1, Q368=+0")
    require_room(control, given.name, pocket, stock, (surface - bottom) / depth, step, radius)
    rings = insets_of(pocket, step, stock)
    levels = levels_between(surface, bottom + floor, depth) if roughs else ()
    if finishes and (floor > 0.0 or not roughs):
        levels = (*levels, bottom)
    if not roughs:
        rings = insets_of(pocket, step, 0.0) if floor > 0.0 else (0.0,)
    helix = _HELIX * radius if given.number(366) in (1.0, 2.0) else 0.0
    room = pocket.length if pocket.width is None else min(pocket.length, pocket.width)
    finish_feed = given.feed(385) if 385 in given.values else None
    passes = Passes(
        reference,
        levels,
        rings,
        (0.0,) if finishes and roughs and (stock > 0.0 or floor > 0.0) else (),
        given.feed(206),
        finish_feed or None,
        back,
        pocket.center,
        min(helix, room),
        _PITCH * radius,
    )
    _with_feed(control, given, pocket, passes)


def _with_feed(control: Control, given: Parameters, pocket: Pocket, passes: Passes) -> None:
    feed = control.motion.feed
    control.motion.feed = given.feed(207)
    if control.motion.feed is None or control.motion.feed <= 0.0:
        control.fail("feed-range", f"{given.name} mills with a feed above 0", hint="Q207=+500")
    mill(control, pocket, passes)
    control.motion.feed = feed


def _climbs(given: Parameters) -> bool:
    """Whether Q351 asks for climb milling, which it is with 1, and with 0 as well."""
    return given.number(351, 1.0) >= 0.0


def rectangular_pocket(control: Control, given: Parameters) -> None:
    """251: Q218 by Q219, corners of Q220."""
    radius = compensation_radius(control)
    length, width, corner = given.length(218) / 2.0, given.length(219) / 2.0, given.length(220)
    if corner > min(length, width):
        control.fail("cycle-size", f"the corner Q220 does not fit into the pocket of {given.name}")
    shape = Corner(CornerKind.ROUNDED, max(corner, radius), radius)
    middle = _middle(control, given, (length, width), _CORNERS)
    angle, clockwise = given.number(224), not _climbs(given)
    pocket = Pocket(middle, length - radius, width - radius, angle, clockwise, shape)
    _mill_pocket(control, given, pocket, radius)


def circular_pocket(control: Control, given: Parameters) -> None:
    """252: of the diameter Q223."""
    radius, here = (
        compensation_radius(control),
        control.modal.plane.point(control.motion.programmed),
    )
    wide = given.length(223) / 2.0 - radius
    _mill_pocket(
        control, given, Pocket(here, wide, None, 0.0, not _climbs(given), Corner()), radius
    )


def slot(control: Control, given: Parameters) -> None:
    """253: Q218 long, Q219 wide, with round ends, turned by Q374."""
    radius = compensation_radius(control)
    length, width = given.length(218) / 2.0, given.length(219) / 2.0
    if length < width:
        control.fail("cycle-size", "a slot is at least as long (Q218) as it is wide (Q219)")
    to_end = length - width if given.number(367) in (2.0, 3.0) else length
    middle = _middle(control, given, (to_end, 0.0), _ENDS)
    shape = Corner(CornerKind.ROUNDED, width, radius)
    angle, clockwise = given.number(374), not _climbs(given)
    pocket = Pocket(middle, length - radius, width - radius, angle, clockwise, shape)
    _mill_pocket(control, given, pocket, radius)


# --- studs


def rectangular_stud(control: Control, given: Parameters) -> None:
    """256: from Q424 by Q425 to Q218 by Q219, corners of Q220."""
    radius = compensation_radius(control)
    length, width = given.length(218) / 2.0, given.length(219) / 2.0
    corner = Corner(CornerKind.ROUNDED, given.length(220), -radius)
    if given.length(220) < 0.0:
        control.fail("cycle-size", "Q220 below 0 asks for chamfers, which the twin does not mill")
    middle = _middle(control, given, (length, width), _CORNERS)
    around = Pocket(
        middle, length + radius, width + radius, given.number(224), _climbs(given), corner
    )
    left = max(given.length(424) / 2.0 - length, given.length(425) / 2.0 - width)
    _mill_stud(control, given, around, left, radius)


def circular_stud(control: Control, given: Parameters) -> None:
    """257: from the diameter Q222 to Q223, begun at the angle Q376."""
    radius, here = (
        compensation_radius(control),
        control.modal.plane.point(control.motion.programmed),
    )
    finished = given.length(223) / 2.0
    angle = max(given.number(376), 0.0)
    around = Pocket(here, finished + radius, None, angle, _climbs(given), Corner())
    _mill_stud(control, given, around, given.length(222) / 2.0 - finished, radius)


def _mill_stud(
    control: Control, given: Parameters, around: Pocket, left: float, radius: float
) -> None:
    """Mill around a stud: rings from the blank, which leaves so much of it, inwards."""
    surface, reference, bottom, back = heights(control, given)
    roughs, finishes = _operation(control, given)
    stock, depth = given.length(368), abs(given.length(202))
    step = min((given.number(370) or 1.0) * radius, 2.0 * radius)
    if depth == 0.0 or stock < 0.0 or step <= 0.0 or left < 0.0:
        message = f"{given.name} needs passes Q202 above 0, and a blank no smaller than the stud"
        control.fail("cycle-depth", message)
    count = max(1, math.ceil((left - stock) / step - 1e-9))
    require_room(
        control, given.name, around, 0.0, count * (surface - bottom) / depth, radius, radius
    )
    first = max(left - stock, 0.0)
    rings = tuple(-stock - first * (1.0 - (number + 1) / count) for number in range(count))
    out = around.length + left + radius + _BESIDE
    entry = turned((around.center[0] + out, around.center[1]), around.center, around.angle)
    passes = Passes(
        reference,
        levels_between(surface, bottom, depth) if roughs else (bottom,),
        rings if roughs else (0.0,),
        (0.0,) if finishes and roughs and stock > 0.0 else (),
        given.feed(206),
        (given.feed(385) if 385 in given.values else None) or None,
        back,
        entry,
    )
    _with_feed(control, given, around, passes)
