"""Cycles of pockets, slots and studs: 251 to 254, 256, 257, and the old 4 and 5.

Decisions, since the manuals leave the path open: pockets are entered in their middle, curved slots at their first end,
and cleared outwards in rings along the wall, Q370 radii apart at most; with Q366=1 or 2 the tool goes down on a helix
of half its radius, by a tenth of that radius a turn; studs are entered 2 mm beside the blank, on the side of positive
X, and cleared inwards.
"""

from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.cycles.holes import heights
from twin.nc.dialects.heidenhain.memory import CycleParameters
from twin.nc.dialects.heidenhain.tools import compensation_radius
from twin.nc.geometry.arcs import Point, turned
from twin.nc.iso.cycle_moves import along
from twin.nc.iso.milling.clearing import Clearing, clear_around, clear_pocket
from twin.nc.iso.milling.outlines import (
    Circle,
    CornerKind,
    CurvedSlot,
    Outline,
    Rectangle,
    RectangleCorner,
)

_BESIDE = 2.0
"""Between the blank of a stud and the tool that plunges beside it (TNC 640 cycle programming, 5.6) [mm]."""
_HELIX, _PITCH = 0.5, 0.1
"""Radius and pitch of the helix on which the tool goes down, as shares of its radius."""
_CORNERS = {0: (0.0, 0.0), 1: (1.0, 1.0), 2: (-1.0, 1.0), 3: (-1.0, -1.0), 4: (1.0, -1.0)}
"""Where the middle lies from the place of the call, by Q367, in halves of length and width."""
_ENDS = {0: (0.0, 0.0), 1: (1.0, 0.0), 2: (1.0, 0.0), 3: (-1.0, 0.0), 4: (-1.0, 0.0)}
"""The same of a slot: its left end, the centre of its left arc, that of its right arc, its right end."""
_PLACES = {1: 0.0, 2: 0.5, 3: 1.0}
"""At which share of a curved slot the tool is when it is called, by Q367."""


def _choice(
    control: Control, given: CycleParameters, parameter: int, known: dict[int, Point]
) -> Point:
    """What a parameter asks for by its number."""
    chosen = known.get(int(given.number(parameter)))
    if chosen is None:
        message = f"Q{parameter} is 0 to {max(known)}, not {given.number(parameter):g}"
        control.fail("cycle-word", message)
    return chosen


def _middle(
    control: Control, given: CycleParameters, halves: Point, corners: dict[int, Point]
) -> Point:
    """The middle of what is milled, turned with it about the place of the call."""
    corner = _choice(control, given, 367, corners)
    here = _here(control)
    there = (here[0] + corner[0] * halves[0], here[1] + corner[1] * halves[1])
    return turned(there, here, given.number(224) + given.number(374))


def _here(control: Control) -> Point:
    return control.modal.plane.point(control.motion.programmed)


def _clearing(control: Control, given: CycleParameters, floor: float) -> Clearing:
    """What the parameters say of the passes; the floor of a stud has no stock."""
    surface, reference, bottom, back = heights(control, given)
    kind, radius = int(given.number(215)), compensation_radius(control)
    if kind not in (0, 1, 2):
        control.fail("cycle-word", f"Q215 is 0, 1 or 2, not {given.number(215):g}")
    depth, step = abs(given.length(202)), (given.number(370) or 1.0) * radius
    stock, feed = given.length(368), given.feed(207)
    if depth == 0.0 or stock < 0.0 or not 0.0 <= floor < surface - bottom or step <= 0.0:
        message = f"{given.name} needs passes Q202 and steps Q370 above 0, and no stock below 0"
        control.fail("cycle-depth", message, hint="Q202=+5, Q370=+1, Q368=+0")
    if feed is None or feed <= 0.0:
        control.fail("feed-range", f"{given.name} mills with a feed above 0", hint="Q207=+500")
    return Clearing(
        name=given.name,
        radius=radius,
        reference=reference,
        surface=surface,
        bottom=bottom,
        back=back,
        depth=depth,
        step=step,
        stock=stock,
        floor=floor,
        roughs=kind != 2,
        finishes=kind != 1,
        feed=feed,
        plunge=given.feed(206),
        finish_feed=given.feed(385) if 385 in given.values else None,
        helix=_HELIX * radius if given.number(366) in (1.0, 2.0) else 0.0,
        pitch=_PITCH * radius,
    )


def _clear(control: Control, given: CycleParameters, outline: Outline) -> None:
    clear_pocket(control, outline, _clearing(control, given, given.length(369)))


def _clockwise(given: CycleParameters) -> bool:
    """Direction around a pocket: Q351 asks for climb milling with 1, and with 0 as well."""
    return given.number(351, 1.0) < 0.0


def rectangular_pocket(control: Control, given: CycleParameters) -> None:
    """251: Q218 by Q219, corners of Q220."""
    radius = compensation_radius(control)
    length, width, corner = given.length(218) / 2.0, given.length(219) / 2.0, given.length(220)
    if corner > min(length, width):
        control.fail("cycle-size", f"the corner Q220 does not fit into the pocket of {given.name}")
    shape = RectangleCorner(CornerKind.ROUNDED, max(corner, radius), radius)
    middle, angle = _middle(control, given, (length, width), _CORNERS), given.number(224)
    sides = (length - radius, width - radius)
    _clear(control, given, Rectangle(middle, *sides, angle, _clockwise(given), shape))


def circular_pocket(control: Control, given: CycleParameters) -> None:
    """252: of the diameter Q223."""
    room = given.length(223) / 2.0 - compensation_radius(control)
    _clear(control, given, Circle(_here(control), room, _clockwise(given)))


def slot(control: Control, given: CycleParameters) -> None:
    """253: Q218 long, Q219 wide, with round ends, turned by Q374."""
    radius = compensation_radius(control)
    length, width = given.length(218) / 2.0, given.length(219) / 2.0
    if length < width:
        control.fail("cycle-size", "a slot is at least as long (Q218) as it is wide (Q219)")
    to_end = length - width if given.number(367) in (2.0, 3.0) else length
    middle, angle = _middle(control, given, (to_end, 0.0), _ENDS), given.number(374)
    shape, sides = (
        RectangleCorner(CornerKind.ROUNDED, width, radius),
        (length - radius, width - radius),
    )
    _clear(control, given, Rectangle(middle, *sides, angle, _clockwise(given), shape))


def curved_slot(control: Control, given: CycleParameters) -> None:
    """254: slots Q219 wide on the pitch circle Q375, from Q376 on Q248 long, Q377 of them Q378 apart.

    With Q367 0 the pitch circle lies about Q216 and Q217; with 1, 2 or 3 the tool is over the first end, the middle
    or the last end of the first slot, at the angle Q376 of it.
    """
    radius, width = given.length(375) / 2.0, given.length(219) / 2.0
    opening, begin, place = given.number(248), given.number(376), int(given.number(367))
    room, count = width - compensation_radius(control), given.number(377, 1.0)
    if not 0.0 < opening < 360.0 or radius <= width:
        message = "254 needs an angle Q248 above 0 and below 360, and a pitch circle Q375 wider than its slot"
        control.fail("cycle-size", message)
    if count != int(count) or not 1.0 <= count <= _MOST_SLOTS or place not in (0, *_PLACES):
        message = f"254 takes 1 to {_MOST_SLOTS} slots Q377, and Q367 0 to 3"
        control.fail("cycle-word", message)
    center = (given.length(216), given.length(217))
    if place:
        center = along(_here(control), begin + 180.0, radius)
        begin -= _PLACES[place] * opening
    for number in range(int(count)):
        angle = begin + number * given.number(378)
        outline = CurvedSlot(center, radius, angle, opening, room, _clockwise(given))
        _clear(control, given, outline)


_MOST_SLOTS = 360


# --- studs


def rectangular_stud(control: Control, given: CycleParameters) -> None:
    """256: from Q424 by Q425 to Q218 by Q219, corners of Q220."""
    radius = compensation_radius(control)
    length, width = given.length(218) / 2.0, given.length(219) / 2.0
    if given.length(220) < 0.0:
        control.fail("cycle-size", "Q220 below 0 asks for chamfers, which the twin does not mill")
    corner = RectangleCorner(CornerKind.ROUNDED, given.length(220), -radius)
    middle, angle = _middle(control, given, (length, width), _CORNERS), given.number(224)
    sides = (length + radius, width + radius)
    outline = Rectangle(middle, *sides, angle, not _clockwise(given), corner)
    left = max(given.length(424) / 2.0 - length, given.length(425) / 2.0 - width)
    _clear_around(control, given, outline, length + left, angle)


def circular_stud(control: Control, given: CycleParameters) -> None:
    """257: from the diameter Q222 to Q223, begun at the angle Q376."""
    room = given.length(223) / 2.0 + compensation_radius(control)
    angle = max(given.number(376), 0.0)
    outline = Circle(_here(control), room, not _clockwise(given), angle)
    _clear_around(control, given, outline, given.length(222) / 2.0, angle)


def _clear_around(
    control: Control,
    given: CycleParameters,
    outline: Rectangle | Circle,
    blank: float,
    angle: float,
) -> None:
    """Mill around a stud; how far its blank reaches at the angle where the tool goes down."""
    clearing = _clearing(control, given, 0.0)
    finished = outline.room if isinstance(outline, Circle) else outline.length
    left = blank + clearing.radius - finished
    if left < 0.0:
        control.fail("cycle-size", f"{given.name} needs a blank no smaller than the stud")
    entry = along(outline.entry, angle, blank + 2.0 * clearing.radius + _BESIDE)
    clear_around(control, outline, clearing, left, entry)
