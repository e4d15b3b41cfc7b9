"""Milling cycles of the SINUMERIK: POCKET3, POCKET4, SLOT1, SLOT2, LONGHOLE, CYCLE61 and CYCLE71.

Decisions, since the manuals leave the path open: pockets and slots are entered at their middle and cleared outwards
in rings along the wall, straight down with the depth feed or on a helix; faces are milled in strips to and fro.
"""

import math
from typing import NamedTuple

from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik.cycles.calls import CycleCall, CycleForm
from twin.nc.dialects.sinumerik.cycles.drilling import NEW_MODES, Heights, heights_of
from twin.nc.geometry.arcs import Point, direction, turned
from twin.nc.iso.hole import go_to_height
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
from twin.nc.iso.tool_compensation import radius_in_spindle

_WIDTH = 0.8
"""Width of a pass where _MIDA does not say it, of the tool's diameter (manual)."""
_MOST_STRIPS = 10_000


class _Operation(NamedTuple):
    """Roughing or finishing, with what it leaves.

    Attributes:
        heights: Of the surface, the bottom and around them [mm].
        depth: Of one pass at most [mm].
        edge: Left at the wall [mm].
        floor: Left at the bottom [mm].
        finishes: The allowances are taken away.
        climbs: It goes with the feed about the tool, not against it.
    """

    heights: Heights
    depth: float
    edge: float
    floor: float
    finishes: bool
    climbs: bool


def _operation(call: CycleCall, names: dict[str, str]) -> _Operation:
    """What the parameters of a pocket or slot say; their names differ from cycle to cycle."""
    heights = heights_of(
        call, names["DP"], names.get("DPR", ""), names["RTP"], names["RFP"], names["SDIS"]
    )
    total = heights.surface - heights.bottom
    depth = abs(call.length(names["MID"])) or total
    kind = call.get(names["VARI"]) % 10.0
    turn = call.get(names["CDIR"])
    if kind not in (0.0, 1.0, 2.0) or turn not in (0.0, 1.0, 2.0, 3.0):
        call.refuse(
            "cycle-word", f"takes {names['VARI']} 0 to 2 (units) and {names['CDIR']} 0 to 3"
        )
    edge, floor = abs(call.length(names["FAL"])), abs(call.length(names["FALD"]))
    if floor >= total:
        call.refuse("cycle-depth", f"leaves {floor:g} at the bottom of {total:g}")
    return _Operation(heights, depth, edge, floor, kind == 2.0, turn in (0.0, 3.0))


_POCKET = {
    name: f"_{name}" for name in ("RTP", "RFP", "SDIS", "DP", "MID", "FAL", "FALD", "VARI", "CDIR")
}
_SLOT = {
    **{name: name for name in ("RTP", "RFP", "SDIS", "DP", "DPR", "MID", "FAL", "VARI", "CDIR")},
    "FALD": "_FALD",
}


def _clear(
    call: CycleCall, pocket: Pocket, operation: _Operation, feeds: tuple[str, str], radius: float
) -> None:
    """Mill a pocket; ``feeds``: parameters of the feeds in the plane and down."""
    control, heights = call.control, operation.heights
    step = abs(call.length("_MIDA")) or _WIDTH * 2.0 * radius
    if not 0.0 < step <= 2.0 * radius:
        call.refuse(
            "cycle-size", f"takes passes up to the tool's diameter, {2.0 * radius:g}, not {step:g}"
        )
    step = min(step, DIAGONAL * radius)
    levels = (heights.surface - heights.bottom) / operation.depth
    edge, floor = operation.edge, operation.floor
    name = call.statement.keyword
    require_room(control, name, pocket, 0.0 if operation.finishes else edge, levels, step, radius)
    plunge = int(call.get("_VARI", call.get("VARI")) // 10.0 % 10.0)
    if plunge not in (0, 1, 2):
        call.refuse(
            "unsupported-word", "plunges straight down or on a helix (tens of _VARI 0, 1, 2)"
        )
    helix, pitch = (
        (abs(call.length("_RAD1")), abs(call.length("_DP1"))) if plunge == 2 else (0.0, 1.0)
    )
    if plunge == 2 and not (helix > 0.0 and pitch > 0.0):
        call.refuse("cycle-word", "needs _RAD1 and _DP1 above 0, radius and pitch of the helix")
    rings = insets_of(pocket, step, edge)
    if operation.finishes:
        rings = insets_of(pocket, step, 0.0) if floor > 0.0 else (0.0,)
    reached = levels_between(heights.surface, heights.bottom + floor, operation.depth)
    room = pocket.length if pocket.width is None else min(pocket.length, pocket.width)
    passes = Passes(
        heights.safe,
        (heights.bottom,) if operation.finishes else reached,
        rings,
        (),
        call.get(feeds[1]) or None,
        None,
        heights.back,
        pocket.center,
        min(helix, room),
        pitch,
    )
    kept, control.motion.feed = control.motion.feed, call.get(feeds[0]) or control.motion.feed
    mill(control, pocket, passes)
    control.motion.feed = kept


def _rectangle(call: CycleCall) -> None:
    call.need("_LENG", "_WID", "_PA", "_PO")
    radius = radius_in_spindle(call.control)
    length, width, corner = (
        call.length("_LENG") / 2.0,
        call.length("_WID") / 2.0,
        call.length("_CRAD"),
    )
    if length <= 0.0 or width <= 0.0:
        call.refuse("unsupported-word", "is measured from its middle: _LENG and _WID above 0")
    if corner > min(length, width):
        call.refuse("cycle-size", f"has corners of {corner:g} that do not fit into it")
    operation, center = _operation(call, _POCKET), (call.length("_PA"), call.length("_PO"))
    shape = Corner(CornerKind.ROUNDED, max(corner, radius), radius)
    angle = call.get("_STA")
    pocket = Pocket(center, length - radius, width - radius, angle, not operation.climbs, shape)
    _clear(call, pocket, operation, ("_FFP1", "_FFD"), radius)


def _circle(call: CycleCall) -> None:
    call.need("_PRAD", "_PA", "_PO")
    radius = radius_in_spindle(call.control)
    operation, center = _operation(call, _POCKET), (call.length("_PA"), call.length("_PO"))
    pocket = Pocket(
        center, call.length("_PRAD") - radius, None, 0.0, not operation.climbs, Corner()
    )
    _clear(call, pocket, operation, ("_FFP1", "_FFD"), radius)


def _angles(call: CycleCall) -> list[float]:
    """Where the slots of a circle lie [deg]."""
    call.need("NUM", "CPA", "CPO")
    count = call.get("NUM")
    if count != int(count) or not 1.0 <= count <= _MOST_STRIPS:
        call.refuse("cycle-word", f"needs NUM, 1 to {_MOST_STRIPS} slots")
    step = call.get("INDA") or 360.0 / count
    return [call.get("STA1") + number * step for number in range(int(count))]


def _along(call: CycleCall, angle: float, way: float) -> Point:
    """The point so far from the centre of the circle of slots at an angle."""
    cosine, sine = direction(angle)
    return (call.length("CPA") + way * cosine, call.length("CPO") + way * sine)


def _slots(call: CycleCall) -> None:
    """SLOT1: slots that point away from a centre, from RAD on."""
    call.need("LENG", "WID")
    operation, radius = _operation(call, _SLOT), radius_in_spindle(call.control)
    length, width = call.length("LENG") / 2.0, call.length("WID") / 2.0
    shape = Corner(CornerKind.ROUNDED, width, radius)
    for angle in _angles(call):
        middle = _along(call, angle, call.length("RAD") + length)
        pocket = Pocket(middle, length - radius, width - radius, angle, not operation.climbs, shape)
        _clear(call, pocket, operation, ("FFP1", "FFD"), radius)


def _long_holes(call: CycleCall) -> None:
    """LONGHOLE: slots as wide as the tool, milled to and fro, a pass deeper at each end."""
    call.need("LENG")
    heights = heights_of(call)
    depth = abs(call.length("MID")) or heights.surface - heights.bottom
    radius = radius_in_spindle(call.control)
    first, last = call.length("RAD") + radius, call.length("RAD") + call.length("LENG") - radius
    if last < first:
        call.refuse("cycle-size", "is shorter than the tool is wide")
    for angle in _angles(call):
        ends = [_along(call, angle, first), _along(call, angle, last)]
        _to_and_fro(call, heights, levels_between(heights.surface, heights.bottom, depth), ends)


def _to_and_fro(
    call: CycleCall, heights: Heights, levels: tuple[float, ...], ends: list[Point]
) -> None:
    control = call.control
    kept, plane_feed, down = control.motion.feed, call.get("FFP1"), call.get("FFD")
    go_to_height(control, max(heights.back, heights.safe))
    _go(control, ends[0], rapid=True)
    go_to_height(control, heights.safe)
    for level in levels:
        control.motion.feed = down or kept
        go_to_height(control, level, rapid=False)
        control.motion.feed = plane_feed or kept
        ends.reverse()
        _go(control, ends[0], rapid=False)
    control.motion.feed = kept
    go_to_height(control, heights.back)


def _curved_slots(call: CycleCall) -> None:
    """SLOT2: slots along a circle, AFSL degrees long."""
    call.need("AFSL", "WID", "RAD")
    operation, radius, control = (
        _operation(call, _SLOT),
        radius_in_spindle(call.control),
        call.control,
    )
    half, heights, opening = call.length("WID") / 2.0 - radius, operation.heights, call.get("AFSL")
    if half < operation.edge or not 0.0 < opening < 360.0 or call.length("RAD") <= half:
        call.refuse(
            "cycle-size", "needs WID as wide as the tool, AFSL below 360 and RAD above half of WID"
        )
    rest = 0.0 if operation.finishes else operation.edge
    count = max(1, math.ceil((half - rest) / (_WIDTH * 2.0 * radius) - 1e-9))
    sides = (
        [half - rest]
        if operation.finishes
        else [(half - rest) * n / count for n in range(1, count + 1)]
    )
    levels = levels_between(heights.surface, heights.bottom, operation.depth)
    if operation.finishes:
        levels = (heights.bottom,)
    kept, down, feed = control.motion.feed, call.get("FFD"), call.get("FFP1")
    center = (call.length("CPA"), call.length("CPO"))
    for angle in _angles(call):
        go_to_height(control, max(heights.back, heights.safe))
        _go(control, _along(call, angle, call.length("RAD")), rapid=True)
        go_to_height(control, heights.safe)
        for level in levels:
            control.motion.feed = down or kept
            go_to_height(control, level, rapid=False)
            control.motion.feed = feed or kept
            for side in sides:
                _round_slot(control, center, call.length("RAD"), (angle, opening), side)
        control.motion.feed = kept
        go_to_height(control, heights.back)


def _round_slot(
    control: Control, center: Point, radius: float, span: tuple[float, float], side: float
) -> None:
    """Go once around a curved slot, so far beside its middle; ends where it began: in the middle of its first end."""
    begin, opening = span

    def at(way: float, angle: float) -> Point:
        return turned((center[0] + way, center[1]), center, angle)

    first, last = at(radius, begin), at(radius, begin + opening)
    _go(control, at(radius + side, begin), rapid=False)
    _arc(control, at(radius + side, begin + opening), center, opening)
    if side > 0.0:
        _arc(control, at(radius - side, begin + opening), last, 180.0)
    _arc(control, at(radius - side, begin), center, -opening)
    if side > 0.0:
        _arc(control, at(radius + side, begin), first, 180.0)
        _go(control, first, rapid=False)


def _face(call: CycleCall) -> None:
    """CYCLE71 and CYCLE61: a rectangle in strips along one of its sides, level by level."""
    call.need("_PA", "_PO", "_LENG", "_WID", "_MIDA")
    control, radius = call.control, radius_in_spindle(call.control)
    heights = heights_of(call, "_DP", "", "_RTP", "_RFP", "_SDIS")
    length, width, step = call.length("_LENG"), call.length("_WID"), abs(call.length("_MIDA"))
    way = int(call.get("_VARI") // 10.0 % 10.0)
    if way not in (1, 2, 3, 4) or call.get("_VARI") % 10.0 not in (1.0, 2.0):
        call.refuse(
            "cycle-word",
            "takes _VARI 11 to 42: 1 rough or 2 finish, in tens 1 to 4 the way of the strips",
        )
    if not 0.0 < step <= 2.0 * radius or not (length and width):
        call.refuse(
            "cycle-size",
            f"needs a face and strips _MIDA up to the tool's diameter, {2.0 * radius:g}",
        )
    along_width, one_way = way in (2, 4), way in (1, 2)
    extent, across = (width, length) if along_width else (length, width)
    count = max(1, math.ceil(abs(across) / step - 1e-9))
    rest = 0.0 if call.get("_VARI") % 10.0 == 2.0 else abs(call.length("_FALD"))
    depth = abs(call.length("_MID")) or heights.surface - heights.bottom
    levels = levels_between(heights.surface, heights.bottom + rest, depth)
    if count * len(levels) > _MOST_STRIPS:
        call.refuse("cycle-size", f"would need more than {_MOST_STRIPS} strips")
    beyond = math.copysign(
        radius + (abs(call.length("_FDP1")) or abs(call.length("_SDIS"))), extent
    )
    corner = (call.length("_PA"), call.length("_PO"))

    def at(along: float, sideways: float) -> Point:
        place = (sideways, along) if along_width else (along, sideways)
        return turned((corner[0] + place[0], corner[1] + place[1]), corner, call.get("_STA"))

    kept, feed = control.motion.feed, call.get("_FFP1")
    for level in levels:
        go_to_height(
            control, max(heights.safe, control.motion.programmed[control.modal.plane.axes[2]])
        )
        _go(control, at(-beyond, across / count / 2.0), rapid=True)
        go_to_height(control, level)
        control.motion.feed = feed or kept
        for strip in range(count):
            back, sideways = strip % 2 == 1 and not one_way, across * (strip + 0.5) / count
            if one_way and strip:
                go_to_height(control, heights.safe)
                _go(control, at(-beyond, sideways), rapid=True)
                go_to_height(control, level)
            _go(control, at(extent + beyond if back else -beyond, sideways), rapid=False)
            _go(control, at(-beyond if back else extent + beyond, sideways), rapid=False)
        control.motion.feed = kept
        go_to_height(control, heights.back)


def _go(control: Control, point: Point, *, rapid: bool) -> None:
    target = list(control.motion.programmed)
    control.modal.plane.aim(target, point)
    control.line_to(target, rapid=rapid)


def _arc(control: Control, end: Point, center: Point, sweep: float) -> None:
    target = list(control.motion.programmed)
    control.modal.plane.aim(target, end)
    control.arc_to(target, center, sweep)


_POCKET_HEAD, _POCKET_TAIL = (
    ("_RTP", "_RFP", "_SDIS", "_DP"),
    ("_MID", "_FAL", "_FALD", "_FFP1", "_FFD", "_CDIR", "_VARI", "_MIDA"),
)
_NEW = ("_UMODE", "_FS", "_ZFS", *NEW_MODES)
_SLOT_HEAD = ("RTP", "RFP", "SDIS", "DP", "DPR", "NUM")
_SLOT_TAIL = ("CPA", "CPO", "RAD", "STA1", "INDA", "FFD", "FFP1", "MID")
_SLOT_END = ("CDIR", "FAL", "VARI", "MIDF", "FFP2", "SSF")
MILLING = {
    "POCKET3": CycleForm(
        (*_POCKET_HEAD, "_LENG", "_WID", "_CRAD", "_PA", "_PO", "_STA", *_POCKET_TAIL, "_AP1", "_AP2", "_AD", "_RAD1", "_DP1", *_NEW),
        _rectangle,
    ),
    "POCKET4": CycleForm(
        (*_POCKET_HEAD, "_PRAD", "_PA", "_PO", *_POCKET_TAIL, "_AP1", "_AD", "_RAD1", "_DP1", *_NEW), _circle
    ),
    "SLOT1": CycleForm((*_SLOT_HEAD, "LENG", "WID", *_SLOT_TAIL, *_SLOT_END, "_FALD", "_STA2", "_DP1", *_NEW), _slots),
    "SLOT2": CycleForm((*_SLOT_HEAD, "AFSL", "WID", *_SLOT_TAIL, *_SLOT_END, "_FFCP", "_UMODE", "_FALD"), _curved_slots),
    "LONGHOLE": CycleForm((*_SLOT_HEAD, "LENG", *_SLOT_TAIL, "_VARI", "_UMODE", *NEW_MODES), _long_holes),
    "CYCLE61": CycleForm(
        (*_POCKET_HEAD, "_PA", "_PO", "_LENG", "_WID", "_MID", "_MIDA", "_FALD", "_FFP1", "_VARI", "_LIM", "_DMODE", "_AMODE"), _face
    ),
    "CYCLE71": CycleForm(
        (*_POCKET_HEAD, "_PA", "_PO", "_LENG", "_WID", "_STA", "_MID", "_MIDA", "_FDP", "_FALD", "_FFP1", "_VARI", "_FDP1"), _face
    ),
}  # fmt: skip
"""Their parameters in the order of the manual."""
