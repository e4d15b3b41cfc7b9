"""Milling cycles of the SINUMERIK: pockets, slots, faces, threads.

Decisions, since the manuals leave the path open: pockets and slots are entered at their middle, curved ones at their
first end, and cleared outwards in rings along the wall, straight down with the depth feed or on a helix; faces are
milled in strips to and fro.
"""

from twin.nc.dialects.sinumerik.cycles.calls import CycleCall, CycleForm
from twin.nc.dialects.sinumerik.cycles.drilling import MODES, Heights, heights_of
from twin.nc.geometry.arcs import Point
from twin.nc.iso.cycle_moves import along, at_feed, go, go_to_height
from twin.nc.iso.milling.clearing import Clearing, clear_pocket, levels_between
from twin.nc.iso.milling.facing import MOST_STRIPS, Face, mill_face
from twin.nc.iso.milling.outlines import (
    Circle,
    CornerKind,
    CurvedSlot,
    Outline,
    Rectangle,
    RectangleCorner,
)
from twin.nc.iso.milling.threads import MOST_TURNS, Thread, mill_thread
from twin.nc.iso.tool_compensation import radius_in_spindle

_WIDTH = 0.8
"""Width of a pass where MIDA does not say it, of the tool's diameter (manual)."""
_CLIMBS = (0.0, 3.0)
"""CDIR: with the feed about the tool, as G3; 1 and 2 go against it."""
_BESIDE = 1.0
"""Between an outside thread and the tool that goes down beside it (decision) [mm]."""


def _clear(call: CycleCall, *outlines: Outline) -> None:
    """Mill pockets or slots."""
    clearing = _clearing(call, heights_of(call))
    for outline in outlines:
        clear_pocket(call.control, outline, clearing)


def _clearing(call: CycleCall, heights: Heights) -> Clearing:
    """What the parameters say of the passes."""
    radius, total = radius_in_spindle(call.control), heights.surface - heights.bottom
    kind, plunge = call.get("VARI") % 10.0, int(call.get("VARI") // 10.0 % 10.0)
    if kind not in (0.0, 1.0, 2.0) or call.get("CDIR") not in (0.0, 1.0, 2.0, 3.0):
        call.refuse("cycle-word", "takes VARI 0 to 2 (units) and CDIR 0 to 3")
    floor = abs(call.length("FALD"))
    if floor >= total:
        call.refuse("cycle-depth", f"leaves {floor:g} at the bottom of {total:g}")
    step = abs(call.length("MIDA")) or _WIDTH * 2.0 * radius
    if not 0.0 < step <= 2.0 * radius:
        widest = f"the tool's diameter, {2.0 * radius:g}"
        call.refuse("cycle-size", f"takes passes up to {widest}, not {step:g}")
    if plunge not in (0, 1, 2):
        plunges = "plunges straight down or on a helix (tens of VARI 0, 1, 2)"
        call.refuse("unsupported-word", plunges)
    helix, pitch = abs(call.length("RAD1")), abs(call.length("DP1"))
    if plunge == 2 and not (helix > 0.0 and pitch > 0.0):
        call.refuse("cycle-word", "needs RAD1 and DP1 above 0, radius and pitch of the helix")
    return Clearing(
        name=call.statement.keyword,
        radius=radius,
        reference=heights.safe,
        surface=heights.surface,
        bottom=heights.bottom,
        back=heights.back,
        depth=abs(call.length("MID")) or total,
        step=step,
        stock=abs(call.length("FAL")),
        floor=floor,
        roughs=kind != 2.0,
        finishes=kind == 2.0,
        feed=call.get("FFP1") or call.control.motion.feed,
        plunge=call.get("FFD") or call.control.motion.feed,
        helix=helix if plunge == 2 else 0.0,
        pitch=pitch,
    )


def _clockwise(call: CycleCall) -> bool:
    return call.get("CDIR") not in _CLIMBS


def _rectangle(call: CycleCall) -> None:
    call.need("LENG", "WID", "PA", "PO")
    radius, corner = radius_in_spindle(call.control), call.length("CRAD")
    length, width = call.length("LENG") / 2.0, call.length("WID") / 2.0
    if length <= 0.0 or width <= 0.0:
        call.refuse("unsupported-word", "is measured from its middle: LENG and WID above 0")
    if corner > min(length, width):
        call.refuse("cycle-size", f"has corners of {corner:g} that do not fit into it")
    shape = RectangleCorner(CornerKind.ROUNDED, max(corner, radius), radius)
    sides, angle = (length - radius, width - radius), call.get("STA")
    _clear(call, Rectangle(call.point("PA", "PO"), *sides, angle, _clockwise(call), shape))


def _circle(call: CycleCall) -> None:
    call.need("PRAD", "PA", "PO")
    room = call.length("PRAD") - radius_in_spindle(call.control)
    _clear(call, Circle(call.point("PA", "PO"), room, _clockwise(call)))


def _angles(call: CycleCall) -> list[float]:
    """Where the slots of a circle lie [deg]."""
    call.need("CPA", "CPO")
    count = call.count("NUM")
    step = call.get("INDA") or 360.0 / count
    return [call.get("STA1") + number * step for number in range(count)]


def _slots(call: CycleCall) -> None:
    """SLOT1: slots that point away from a centre, from RAD on."""
    call.need("LENG", "WID")
    radius, center = radius_in_spindle(call.control), call.point("CPA", "CPO")
    length, width = call.length("LENG") / 2.0, call.length("WID") / 2.0
    shape, sides = (
        RectangleCorner(CornerKind.ROUNDED, width, radius),
        (length - radius, width - radius),
    )
    middles = ((along(center, a, call.length("RAD") + length), a) for a in _angles(call))
    _clear(call, *(Rectangle(at, *sides, a, _clockwise(call), shape) for at, a in middles))


def _curved_slots(call: CycleCall) -> None:
    """SLOT2: slots along a circle, AFSL degrees long."""
    call.need("AFSL", "WID", "RAD")
    room = call.length("WID") / 2.0 - radius_in_spindle(call.control)
    radius, opening, center = call.length("RAD"), call.get("AFSL"), call.point("CPA", "CPO")
    if not 0.0 < opening < 360.0 or radius <= call.length("WID") / 2.0:
        call.refuse("cycle-size", "needs AFSL below 360 and RAD above half of WID")
    slots = (center, radius)
    _clear(call, *(CurvedSlot(*slots, a, opening, room, _clockwise(call)) for a in _angles(call)))


def _long_holes(call: CycleCall) -> None:
    """LONGHOLE: slots as wide as the tool, milled to and fro, a pass deeper at each end."""
    call.need("LENG")
    heights, center = heights_of(call), call.point("CPA", "CPO")
    depth = abs(call.length("MID")) or heights.surface - heights.bottom
    radius = radius_in_spindle(call.control)
    first, last = call.length("RAD") + radius, call.length("RAD") + call.length("LENG") - radius
    if last < first:
        call.refuse("cycle-size", "is shorter than the tool is wide")
    for angle in _angles(call):
        ends = [along(center, angle, first), along(center, angle, last)]
        _to_and_fro(call, heights, levels_between(heights.surface, heights.bottom, depth), ends)


def _to_and_fro(
    call: CycleCall, heights: Heights, levels: tuple[float, ...], ends: list[Point]
) -> None:
    control = call.control
    feed = control.motion.feed
    go_to_height(control, max(heights.back, heights.safe))
    go(control, ends[0], rapid=True)
    go_to_height(control, heights.safe)
    for level in levels:
        ends.reverse()
        with at_feed(control, call.get("FFD") or feed):
            go_to_height(control, level, rapid=False)
        with at_feed(control, call.get("FFP1") or feed):
            go(control, ends[0])
    go_to_height(control, heights.back)


def _face(call: CycleCall) -> None:
    """CYCLE71 and CYCLE61: a rectangle in strips along one of its sides, level by level."""
    call.need("PA", "PO", "LENG", "WID", "MIDA")
    radius, heights = radius_in_spindle(call.control), heights_of(call)
    length, width, step = call.length("LENG"), call.length("WID"), abs(call.length("MIDA"))
    strips, kind = int(call.get("VARI") // 10.0 % 10.0), call.get("VARI") % 10.0
    if strips not in (1, 2, 3, 4) or kind not in (1.0, 2.0):
        choices = "1 rough or 2 finish, in tens 1 to 4 the direction of the strips"
        call.refuse("cycle-word", f"takes VARI 11 to 42: {choices}")
    if not 0.0 < step <= 2.0 * radius or not (length and width):
        widest = f"the tool's diameter, {2.0 * radius:g}"
        call.refuse("cycle-size", f"needs a face and strips MIDA up to {widest}")
    along_ordinate = strips in (2, 4)
    rest = 0.0 if kind == 2.0 else abs(call.length("FALD"))
    depth = abs(call.length("MID")) or heights.surface - heights.bottom
    face = Face(
        corner=call.point("PA", "PO"),
        extent=width if along_ordinate else length,
        across=length if along_ordinate else width,
        along_ordinate=along_ordinate,
        angle=call.get("STA"),
        step=step,
        beyond=radius + (abs(call.length("FDP1")) or abs(call.length("SDIS"))),
        one_direction=strips in (1, 2),
        levels=levels_between(heights.surface, heights.bottom + rest, depth),
        safe=heights.safe,
        back=heights.back,
        feed=call.get("FFP1") or None,
    )
    if face.strips * len(face.levels) > MOST_STRIPS:
        call.refuse("cycle-size", f"would need more than {MOST_STRIPS} strips")
    mill_face(call.control, face)


def _thread(call: CycleCall) -> None:
    """CYCLE90: on one helix down to DP, as G2 (CDIR 2) or G3; inside (TYPTH 0) or outside."""
    call.need("DIATH", "PIT", "CPA", "CPO")
    control, heights, tool = call.control, heights_of(call), radius_in_spindle(call.control)
    inside, pitch = call.only("TYPTH", 1.0) == 0.0, abs(call.length("PIT"))
    radius = call.length("DIATH") / 2.0 + (-tool if inside else tool)
    if call.get("CDIR") not in (2.0, 3.0):
        call.refuse("cycle-word", "takes CDIR 2, as G2, or 3, as G3")
    turns = (heights.surface - heights.bottom) / pitch if pitch else 0.0
    if radius <= 0.0 or not 0.0 < turns <= MOST_TURNS:
        call.refuse("cycle-size", "needs a thread DIATH that the tool fits into, and a pitch PIT")
    center = call.point("CPA", "CPO")
    thread = Thread(
        center=center,
        radius=radius,
        pitch=pitch,
        upwards=False,
        clockwise=call.get("CDIR") == 2.0,
        top=heights.surface,
        bottom=heights.bottom,
        beside=0.0 if inside else radius + tool + _BESIDE,
        reference=heights.safe,
        positioning=None,
        feed=call.get("FFR") or control.motion.feed,
    )
    go_to_height(control, heights.back)
    go(control, along(center, 0.0, thread.beside), rapid=True)
    mill_thread(control, thread)
    go_to_height(control, heights.back)


_POCKET_TAIL = "MID FAL FALD FFP1 FFD CDIR VARI MIDA"
_NEW = f"UMODE FS ZFS {MODES}"
_SLOT_HEAD = "RTP RFP SDIS DP DPR NUM"
_SLOT_TAIL = "CPA CPO RAD STA1 INDA FFD FFP1 MID"
_SLOT_END = "CDIR FAL VARI MIDF FFP2 SSF"
MILLING = {
    "POCKET3": CycleForm(
        f"RTP RFP SDIS DP LENG WID CRAD PA PO STA {_POCKET_TAIL} AP1 AP2 AD RAD1 DP1 {_NEW}",
        _rectangle,
    ),
    "POCKET4": CycleForm(
        f"RTP RFP SDIS DP PRAD PA PO {_POCKET_TAIL} AP1 AD RAD1 DP1 {_NEW}", _circle
    ),
    "SLOT1": CycleForm(
        f"{_SLOT_HEAD} LENG WID {_SLOT_TAIL} {_SLOT_END} FALD STA2 DP1 {_NEW}", _slots
    ),
    "SLOT2": CycleForm(
        f"{_SLOT_HEAD} AFSL WID {_SLOT_TAIL} {_SLOT_END} FFCP UMODE FALD", _curved_slots
    ),
    "LONGHOLE": CycleForm(f"{_SLOT_HEAD} LENG {_SLOT_TAIL} VARI UMODE {MODES}", _long_holes),
    "CYCLE61": CycleForm(
        "RTP RFP SDIS DP PA PO LENG WID MID MIDA FALD FFP1 VARI LIM DMODE AMODE", _face
    ),
    "CYCLE71": CycleForm(
        "RTP RFP SDIS DP PA PO LENG WID STA MID MIDA FDP FALD FFP1 VARI FDP1", _face
    ),
    "CYCLE90": CycleForm("RTP RFP SDIS DP DPR DIATH KDIAM PIT FFR CDIR TYPTH CPA CPO", _thread),
}
"""Their parameters in the order of the manual."""
