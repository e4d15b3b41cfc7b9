"""Pocket cycles of the Fagor CNC 8070: G87 rectangular, G88 circular.

The words are the manual's: Z reference plane, I depth, D from the reference plane to the surface, J
half length or radius (its sign is the direction: + clockwise), K half width, A angle of the pocket,
B depth of a pass, C width of a pass, L finishing stock, H feed of the finishing pass, V feed of
plunging. Decision, since the manual does not give the path: each pass plunges at the centre and
clears outwards along parallels of the wall, C apart at most; the finishing pass runs once along the
wall at the full depth. The corners of a rectangle are M0 as round as the tool, M1 rounded by the
radius Q, M2 cut off at the distance Q; a radius below the tool's is the tool's.
"""

import dataclasses
import enum
import math

from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.polar import take_goal
from twin.nc.geometry.arcs import Point, turned

_DEFAULT_WIDTH = 0.75
"""Width of a pass where C is missing, of the tool's diameter (manual)."""

_DEFAULT_PLUNGE = 0.5
"""Feed of plunging where V is missing, of the feed (manual)."""

_DIAGONAL = 1.7
"""Rings lie at most this many radii apart, so that nothing stays between their corners.

Two corners of rings s apart are s times the root of 2 apart; the tool in the inner one reaches what
the outer ring leaves up to s = r (1 + 1 / root of 2).
"""

_MOST_PASSES = 10_000
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
        kind: What they are.
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
        clockwise: Direction of machining.
        corner: Of a rectangle.
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
        surface: Height of the part's surface [mm].
        bottom: Height of the pocket's bottom [mm].
        depth: Of one pass at most [mm].
        step: Width of one pass at most [mm].
        stock: Left for the finishing pass [mm].
        finish: Feed of the finishing pass, or None for the feed.
        plunge: Feed of plunging, or None for its default.
    """

    reference: float
    surface: float
    bottom: float
    depth: float
    step: float
    stock: float
    finish: float | None
    plunge: float | None


def call_pocket(control: Control, words: str, lengths: str) -> None:
    """Take the words of a pocket where it is called; ``lengths`` are those that count lengths."""
    axis = control.modal.plane.axes[2]
    control.cycle_values = values = {"start": control.motion.programmed[axis]}
    for address in words:
        if (word := control.take(address)) is not None:
            in_mm = address in lengths
            values[address] = control.length(word) if in_mm else control.number(word)
    incremental = control.modal.incremental
    reference = control.take(control.settings.axes.names[axis])
    if reference is not None:
        base = control.motion.programmed[axis] if incremental or reference.incremental else 0.0
        values["Z"] = control.length(reference) + base
    values.setdefault("Z", values["start"])
    depth = control.take("I")
    if depth is not None:
        relative = incremental or depth.incremental
        values["I"] = control.length(depth)
        values["bottom"] = control.length(depth) + (values["Z"] if relative else 0.0)


def _corner(control: Control, name: str, radius: float) -> Corner:
    """Corners by M and Q.

    Raises:
        ProgramError: M is none of them, or Q does not fit into the pocket.
    """
    values = control.cycle_values
    kind, size = values.get("M", 0.0), values.get("Q", 0.0)
    if kind not in tuple(CornerKind):
        control.fail("cycle-word", f"{name} knows the corners M0, M1 and M2, not M{kind:g}")
    largest = min(abs(values["J"]), values["K"])
    if kind == CornerKind.CHAMFERED:
        largest -= (math.sqrt(2.0) - 1.0) * radius
    if kind != CornerKind.SQUARE and not 0.0 < size <= largest:
        message = f"{name} needs the size of its corners in Q, above 0 and up to {largest:g}"
        control.fail("cycle-size", message)
    return Corner(CornerKind(int(kind)), size, radius)


def mill_pocket(control: Control, name: str, *, circular: bool) -> None:
    """Mill a pocket about the point that the block names."""
    values = control.cycle_values
    needed = ["I", "J", "B", *([] if circular else ["K"])]
    missing = [address for address in needed if address not in values]
    if missing:
        control.fail("cycle-word", f"{name} needs {' and '.join(missing)}")
    tool = control.tools.data(control.tools.spindle)
    if tool is None:
        control.fail("no-such-tool", f"{name} needs a tool, and the job has none")
    goal = take_goal(control, arc=False).target
    passes = _passes(control, name, tool.radius)
    plane = control.modal.plane
    pocket = Pocket(
        plane.point(goal),
        abs(values["J"]) - tool.radius,
        None if circular else values["K"] - tool.radius,
        values.get("A", 0.0),
        values["J"] > 0.0,
        Corner() if circular else _corner(control, name, tool.radius),
    )
    least = min(pocket.length, math.inf if pocket.width is None else pocket.width)
    if least - passes.stock < 0.0:
        message = f"the tool's radius {tool.radius:g} and the stock leave no room in the pocket"
        control.fail("cycle-size", f"{name}: {message}")
    rings = math.ceil(least / passes.step) + 1
    if rings * (passes.surface - passes.bottom) / passes.depth > _MOST_PASSES:
        control.fail("cycle-size", f"{name} would need more than {_MOST_PASSES} passes")
    _mill(control, pocket, passes)


def _passes(control: Control, name: str, radius: float) -> Passes:
    values = control.cycle_values
    reference, surface = values["Z"], values["Z"] - values.get("D", 0.0)
    width = values.get("C", 0.0) or _DEFAULT_WIDTH * 2.0 * radius
    passes = Passes(
        reference,
        surface,
        values["bottom"],
        abs(values["B"]),
        min(width, _DIAGONAL * radius),
        abs(values.get("L", 0.0)),
        values.get("H") or None,
        values.get("V") or None,
    )
    if not passes.bottom < surface <= reference or passes.depth == 0.0:
        message = f"from the surface {surface:g} to {passes.bottom:g} in passes above 0"
        control.fail("cycle-depth", f"{name} must mill downwards, {message}")
    if not 0.0 < width <= 2.0 * radius:
        message = f"{name}: a pass of {width:g} is wider than the tool, {2.0 * radius:g}"
        control.fail("cycle-size", message)
    return passes


def _mill(control: Control, pocket: Pocket, passes: Passes) -> None:
    axis = control.modal.plane.axes[2]
    start_height = max(control.motion.programmed[axis], passes.reference)
    feed = control.motion.feed
    _rise(control, start_height)
    _go(control, pocket.center, rapid=True)
    _rise(control, passes.reference)
    height = passes.surface
    while height > passes.bottom:
        height = max(height - passes.depth, passes.bottom)
        if passes.bottom < height < passes.bottom + 1e-6:
            height = passes.bottom
        if feed is not None or passes.plunge is not None:
            control.motion.feed = passes.plunge or (feed or 0.0) * _DEFAULT_PLUNGE
        _rise(control, height, rapid=False)
        control.motion.feed = feed
        for inset in _insets(pocket, passes.step, passes.stock):
            _ring(control, pocket, inset)
        if height > passes.bottom:
            _go(control, pocket.center, rapid=False)
    if passes.stock > 0.0:
        control.motion.feed = passes.finish or feed
        _ring(control, pocket, 0.0)
        control.motion.feed = feed
    back = control.cycle_values["start"]
    reference_only = control.modal.return_to_reference
    _rise(control, passes.reference if reference_only else max(back, passes.reference))
    _go(control, pocket.center, rapid=True)


def _insets(pocket: Pocket, step: float, stock: float) -> list[float]:
    """How far the rings lie from the tool's path along the wall, from inside to outside [mm].

    The innermost ring of a rectangle is the line along its middle; a circle begins with the plunge.
    """
    inner = pocket.length if pocket.width is None else min(pocket.length, pocket.width)
    room = inner - stock
    count = math.ceil(room / step - 1e-9)
    if count == 0:
        return [stock]
    first = 1 if pocket.width is None else 0
    return [stock + room * (1.0 - number / count) for number in range(first, count + 1)]


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
