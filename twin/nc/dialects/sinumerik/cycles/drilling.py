"""Drilling cycles of the SINUMERIK: CYCLE81 to CYCLE89, CYCLE84 and CYCLE840.

RTP is the height to which they return, RFP the surface, SDIS the safety distance above it; DP the bottom, or DPR below
the surface. They drill where the tool is.
"""

import math
from typing import NamedTuple

from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik.cycles.calls import CycleCall, CycleForm, require_no_compensation
from twin.nc.iso.cycle_moves import at_feed, go_to_height
from twin.nc.iso.drilling.hole import turn_spindle

_HEIGHTS = "RTP RFP SDIS DP DPR"
MODES = "GMODE DMODE AMODE"
_CHIP_BREAK = 1.0
"""How far chip breaking withdraws where VRT does not say it (manual) [mm]."""
_ANTICIPATION, _ANTICIPATION_SHARE, _MOST_ANTICIPATION = 0.6, 1.0 / 50.0, 7.0
"""How far above its last depth deep drilling ends its rapid return, where DIS1 does not say it (manual) [mm]:
up to 30 mm of depth always the same, then a share of the depth, up to a limit."""
_MOST_PECKS = 10_000
_PITCHES = {3: 0.5, 4: 0.7, 5: 0.8, 6: 1.0, 8: 1.25, 10: 1.5, 12: 1.75, 14: 2.0, 16: 2.0, 18: 2.5, 20: 2.5,
            22: 2.5, 24: 3.0, 27: 3.0, 30: 3.5, 33: 3.5, 36: 4.0, 39: 4.0, 42: 4.5, 45: 4.5, 48: 5.0}  # fmt: skip
"""Pitch of a metric thread by its size, MPIT (ISO 261) [mm]."""


class Heights(NamedTuple):
    """Programmed heights of a hole [mm].

    Attributes:
        back: Where the tool returns to.
        safe: As far above it as SDIS says: where the feed begins.
    """

    back: float
    surface: float
    safe: float
    bottom: float


def heights_of(call: CycleCall) -> Heights:
    """The heights that a call gives."""
    require_no_compensation(call)
    if call.get("AXN") not in (0.0, call.control.modal.plane.axes[2] + 1.0):
        call.refuse("unsupported-word", "drills along the axis across the plane alone (AXN)")
    call.need("RTP", "RFP")
    if "DP" not in call.values and "DPR" not in call.values:
        hint = f"{call.statement.keyword}(10, 0, 2, -20): RTP, RFP, SDIS, DP"
        call.refuse("cycle-word", "needs DP, the bottom, or DPR, the depth", hint)
    back, above, bottom = call.length("RTP"), call.length("RFP"), call.length("DP")
    if "DP" not in call.values:
        bottom = above - abs(call.length("DPR"))
    elif call.get("AMODE") % 10.0 == 1.0:  # the depth is incremental
        bottom = above - abs(bottom)
    if not bottom < above <= back:
        message = f"must go down: RTP {back:g}, RFP {above:g}, bottom {bottom:g}"
        call.refuse("cycle-depth", message)
    return Heights(back, above, above + abs(call.length("SDIS")), bottom)


def _approach(call: CycleCall) -> Heights:
    heights = heights_of(call)
    go_to_height(call.control, heights.safe)
    return heights


def _wait(call: CycleCall, name: str) -> None:
    """Seconds; below 0 revolutions of the spindle (manual)."""
    control, time = call.control, call.get(name)
    if time < 0.0:
        if not control.motion.spindle:
            call.refuse("dwell", f"waits for revolutions ({name} below 0), and no S is programmed")
        time = -time * 60.0 / control.motion.spindle
    if time > 0.0:
        control.dwell(time)


def _feed(control: Control, height: float, feed: float | None = None) -> None:
    """Go to a height with a feed [mm/min], or the one in force."""
    with at_feed(control, feed or control.motion.feed):
        go_to_height(control, height, rapid=False)


def _drill(call: CycleCall) -> None:
    heights = _approach(call)
    call.control.tools.drills = not call.get("DTB")
    _feed(call.control, heights.bottom)
    _wait(call, "DTB")
    go_to_height(call.control, heights.back)


def pecks(total: float, first: float, degression: float, least: float = 0.0) -> list[float]:
    """Depths of the pecks of deep drilling, one after the other [mm].

    Each is less deep than the one before by the degression, but not less than it, nor than the least; below 0 that is
    a factor. As the manual has it, the last two are equally deep where less than two of the degression would be left.
    """
    depths, rest, peck = list[float](), total, first
    while rest > 1e-9:
        if len(depths) > _MOST_PECKS:
            return depths
        if (
            degression > 0.0
            and depths
            and peck <= degression
            and degression < rest < 2.0 * degression
        ):
            peck = rest / 2.0
        peck = min(peck, rest)
        depths.append(peck)
        rest -= peck
        if degression > 0.0:
            peck = max(peck - degression, min(degression, peck))
        elif degression < 0.0:
            peck = peck * -degression
        peck = max(peck, least)
    return depths


def _deep(call: CycleCall) -> None:
    heights = heights_of(call)
    control, surface = call.control, heights.surface
    control.tools.drills = True
    total = surface - heights.bottom
    first = (
        surface - call.length("FDEP") if "FDEP" in call.values else abs(call.length("FDPR", total))
    )
    if not first > 0.0:
        call.refuse("cycle-depth", "needs a first depth FDEP below RFP, or FDPR above 0")
    degression = call.get("DAM")
    if degression < -1.0:
        call.refuse("cycle-depth", "takes DAM from -1, a factor, upwards, an amount")
    degression = degression * control.modal.unit if degression > 0.0 else degression
    depths = pecks(total, min(first, total), degression, abs(call.length("MDEP")))
    if len(depths) > _MOST_PECKS:
        call.refuse("cycle-depth", f"would need more than {_MOST_PECKS} pecks")
    clears = call.only("VARI", 1.0) == 1.0
    lift = abs(call.length("VRT")) or _CHIP_BREAK
    gap = abs(call.length("DIS1")) or max(
        _ANTICIPATION, min(total * _ANTICIPATION_SHARE, _MOST_ANTICIPATION)
    )
    factor = call.get("FRF") or 1.0
    if not 0.001 <= factor <= 1.0:
        call.refuse("cycle-word", "takes FRF from 0.001 to 1")
    go_to_height(control, heights.safe)
    if clears:
        _wait(call, "DTS")
    depth = surface
    for number, peck in enumerate(depths):
        depth = heights.bottom if number == len(depths) - 1 else depth - peck
        _feed(
            control,
            depth,
            control.motion.feed * factor if control.motion.feed and number == 0 else None,
        )
        _wait(call, "DTB" if number < len(depths) - 1 or not call.get("DTD") else "DTD")
        if number == len(depths) - 1:
            break
        if clears:
            go_to_height(control, heights.safe)
            _wait(call, "DTS")
            go_to_height(control, min(depth + gap, heights.safe))
        else:
            _feed(control, min(depth + lift, heights.safe))
    go_to_height(control, heights.back)


def _pitch(call: CycleCall) -> float:
    """Pitch of a thread, below 0 for a left one [mm]."""
    size, pitch = call.get("MPIT"), call.length("PIT")
    if call.get("PITA") not in (0.0, 1.0):
        call.refuse("unsupported-word", "takes pitches in millimetres alone (PITA 0 or 1)")
    if size and int(abs(size)) not in _PITCHES:
        call.refuse("cycle-word", "takes MPIT from 3 to 48, sizes of the coarse metric threads")
    by_size = math.copysign(_PITCHES[int(abs(size))], size) if size else 0.0
    if size and pitch and abs(pitch - by_size) > 1e-9:
        call.refuse("cycle-word", f"gives two pitches: MPIT {by_size:g} mm and PIT {pitch:g} mm")
    if not (by_size or pitch):
        call.refuse("cycle-word", "needs MPIT, the size of the thread, or PIT, its pitch")
    return by_size or pitch


def _turn(control: Control, left: bool) -> None:
    turn_spindle(control, "M4" if left else "M3")


def _tap(call: CycleCall) -> None:
    """CYCLE84: tapping with the spindle's position under control."""
    control, pitch = call.control, _pitch(call)
    speed = call.get("SST") or (control.motion.spindle or 0.0)
    if not speed > 0.0:
        call.refuse("feed-per-revolution", "needs SST, the speed of tapping")
    call.only("VARI")
    heights, kept = _approach(call), control.motion.spindle
    control.function("SPOS", {"ANGLE": call.get("POSS")})
    out = call.get("SST1") or speed
    control.motion.spindle = speed
    _turn(control, pitch < 0.0)
    _feed(control, heights.bottom, abs(pitch) * speed / control.modal.unit)
    _wait(call, "DTB")
    control.motion.spindle = out
    _turn(control, pitch > 0.0)
    _feed(control, heights.safe, abs(pitch) * out / control.modal.unit)
    control.motion.spindle = kept
    _end_spindle(call)
    go_to_height(control, heights.back)


def _end_spindle(call: CycleCall) -> None:
    """The spindle behind the cycle: SDAC says 3, 4 or 5; left out it turns as before, or stands."""
    control, turn = call.control, call.get("SDAC")
    if turn not in (0.0, 3.0, 4.0, 5.0):
        call.refuse("cycle-word", "takes SDAC 3, 4 or 5")
    if turn == 0.0:
        turn = 3.0 if control.motion.spindle_turns else 5.0
    control.motion.spindle_turns = turn != 5.0
    if turn == 5.0:
        control.function("M5", {})
    else:
        _turn(control, turn == 4.0)


def _tap_in_chuck(call: CycleCall) -> None:
    """CYCLE840: tapping in a compensating chuck; the feed follows from pitch and speed, else F counts."""
    control = call.control
    gives_pitch = bool(call.get("MPIT") or call.get("PIT"))
    if not control.motion.spindle:
        call.refuse("feed-per-revolution", "needs the spindle's speed S before")
    if not gives_pitch and call.only("ENC", 1.0, 11.0, 20.0) not in (1.0, 11.0):
        _pitch(call)
    pitch = _pitch(call) if gives_pitch else 0.0
    call.only("SDR", 3.0, 4.0)
    feed = abs(pitch) * control.motion.spindle / control.modal.unit if pitch else None
    left = pitch < 0.0 or (not pitch and call.get("SDAC") == 4.0)
    heights = _approach(call)
    _turn(control, left)
    _feed(control, heights.bottom, feed)
    _wait(call, "DTB")
    _turn(control, not left)
    _feed(control, heights.safe, feed)
    _end_spindle(call)
    go_to_height(control, heights.back)


def _ream(call: CycleCall) -> None:
    """CYCLE85: down with FFR, back with RFF; CYCLE89: both with the feed."""
    control, heights = call.control, _approach(call)
    _feed(control, heights.bottom, call.get("FFR") or None)
    _wait(call, "DTB")
    _feed(control, heights.safe, call.get("RFF") or None)
    go_to_height(control, heights.back)


def _bore(call: CycleCall) -> None:
    """CYCLE86: the spindle stops at an angle, the tool leaves the wall and comes back without turning."""
    control, heights = call.control, _approach(call)
    if call.get("SDIR", 3.0) not in (3.0, 4.0):
        call.refuse("cycle-word", "takes SDIR 3 or 4")
    _turn(control, call.get("SDIR", 3.0) == 4.0)
    _feed(control, heights.bottom)
    _wait(call, "DTB")
    control.function("SPOS", {"ANGLE": call.get("POSS")})
    place = list(control.motion.programmed)
    plane, here = control.modal.plane, control.modal.plane.local(control.motion.programmed)
    lifted = list(place)
    point = (here.abscissa + call.length("RPA"), here.ordinate + call.length("RPO"))
    lifted[:3] = plane.world(*point, here.height + call.length("RPAP"))
    control.line_to(lifted, rapid=True)
    go_to_height(control, heights.back)
    back = list(control.motion.programmed)
    plane.aim(back, (here.abscissa, here.ordinate))
    control.line_to(back, rapid=True)
    _turn(control, call.get("SDIR", 3.0) == 4.0)
    control.motion.spindle_turns = True


def _bore_and_stop(call: CycleCall) -> None:
    """CYCLE87, CYCLE88: spindle and program stop at the bottom, then the tool comes back rapidly."""
    control, heights = call.control, _approach(call)
    if call.get("SDIR", 3.0) not in (3.0, 4.0):
        call.refuse("cycle-word", "takes SDIR 3 or 4")
    left = call.get("SDIR", 3.0) == 4.0
    _turn(control, left)
    _feed(control, heights.bottom)
    _wait(call, "DTB")
    control.function("M5", {})
    control.function("M0", {})
    go_to_height(control, heights.back)
    _turn(control, left)
    control.motion.spindle_turns = True


_PITCHES_IN_TURNS = "PITM PTAB PTABA"
DRILLING = {
    "CYCLE81": CycleForm(f"{_HEIGHTS} DTB {MODES}", _drill),
    "CYCLE82": CycleForm(f"{_HEIGHTS} DTB {MODES} VARI S_ZA S_FA S_ZD S_FD", _drill),
    "CYCLE83": CycleForm(
        f"{_HEIGHTS} FDEP FDPR DAM DTB DTS FRF VARI AXN MDEP VRT DTD DIS1 {MODES}", _deep
    ),
    "CYCLE84": CycleForm(
        f"{_HEIGHTS} DTB SDAC MPIT PIT POSS SST SST1 AXN PITA TECHNO VARI DAM VRT "
        f"{_PITCHES_IN_TURNS} {MODES}",
        _tap,
    ),
    "CYCLE840": CycleForm(
        f"{_HEIGHTS} DTB SDR SDAC ENC MPIT PIT AXN PITA TECHNO {_PITCHES_IN_TURNS} {MODES}",
        _tap_in_chuck,
    ),
    "CYCLE85": CycleForm(f"{_HEIGHTS} DTB FFR RFF {MODES}", _ream),
    "CYCLE86": CycleForm(f"{_HEIGHTS} DTB SDIR RPA RPO RPAP POSS {MODES}", _bore),
    "CYCLE87": CycleForm(f"{_HEIGHTS} SDIR", _bore_and_stop),
    "CYCLE88": CycleForm(f"{_HEIGHTS} DTB SDIR", _bore_and_stop),
    "CYCLE89": CycleForm(f"{_HEIGHTS} DTB {MODES}", _ream),
}
