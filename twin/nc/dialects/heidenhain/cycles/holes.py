"""Cycles of holes: 200 to 209, 240, 241, and the old 1 and 2.

Decisions, since the manuals leave them open or the twin does not follow them: the rapid return into a hole ends
0.2 mm above where the tool was (203: Q256, 205: Q258); Q395 is 0, the depth counts at the tip.
"""

from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.memory import CycleParameters
from twin.nc.iso.cycle_moves import at_feed, descend, go, go_to_height
from twin.nc.iso.drilling.hole import (
    MOST_PECKS,
    Hole,
    Retract,
    count_passes,
    drill,
    turn_spindle,
)

ADVANCE = 0.2
"""How far above its last depth a rapid return ends [mm]."""
_ASIDE = {0: (0.0, 0.0), 1: (-1.0, 0.0), 2: (0.0, -1.0), 3: (1.0, 0.0), 4: (0.0, 1.0)}
"""Direction in which the tool leaves the wall, by Q214."""


def heights(control: Control, given: CycleParameters) -> tuple[float, float, float, float]:
    """Surface, reference plane, bottom, and where the tool goes back to [mm]."""
    surface = given.length(203)
    reference, bottom = surface + given.length(200), surface + given.length(201)
    if not bottom < surface or given.length(200) < 0.0:
        message = f"{given.name} goes down: Q201 is below 0 and Q200 not"
        control.fail("cycle-depth", message, hint="Q200=+2, Q201=-20")
    return surface, reference, bottom, max(reference, surface + given.length(204))


def _hole(control: Control, given: CycleParameters, **changes: object) -> Hole:
    """A hole that is drilled at once; changes are fields of it."""
    surface, reference, bottom, back = heights(control, given)
    dwell = _seconds(control, given, 211)
    plain = Hole(reference, bottom, back, dwell, surface, clearance=ADVANCE)
    return plain._replace(**changes)


def _seconds(control: Control, given: CycleParameters, parameter: int) -> float:
    seconds = given.number(parameter)
    if seconds < 0.0:
        control.fail("dwell", f"{given.name} cannot wait {seconds:g} seconds (Q{parameter})")
    return seconds


def _pecked(
    control: Control, given: CycleParameters, hole: Hole, reduction: float = 0.0, least: float = 0.0
) -> Hole:
    """A hole in pecks of Q202, each less deep than the one before by a reduction, down to a least."""
    peck = given.length(202)
    if peck <= 0.0 or reduction < 0.0 or (reduction > 0.0 and least <= 0.0):
        message = f"{given.name} needs Q202 above 0, and with Q212 also Q205"
        control.fail("cycle-depth", message, hint="Q202=+5")
    hole = hole._replace(peck=peck, reduction=reduction, least=least).with_stops()
    if hole.stops > MOST_PECKS:
        message = f"the hole would need more than {MOST_PECKS} pecks"
        control.fail("cycle-depth", message, hint="write a larger Q202")
    return hole


def _drill(control: Control, hole: Hole, feed: float | None) -> None:
    """Drill with a feed, which the program's own survives."""
    mode = control.modal.feed_mode
    with at_feed(control, _drilling_feed(control, feed)):
        drill(control, hole)
    control.modal.feed_mode = mode


def _drilling_feed(control: Control, feed: float | None) -> float:
    """A feed that a hole is drilled with."""
    if feed is None or feed <= 0.0:
        message = "a hole is drilled with a feed above 0"
        control.fail("feed-range", message, hint="Q206=+150")
    return feed


def drilling(control: Control, given: CycleParameters) -> None:
    """200: in pecks, each time back to the clearance, where it waits Q210."""
    hole = _hole(control, given, rest=_seconds(control, given, 210))
    _drill(control, _pecked(control, given, hole), given.feed(206))


def reaming(control: Control, given: CycleParameters) -> None:
    """201: back with Q208, or 0 as it went down."""
    down, back = given.feed(206), given.feed(208)
    retract = Retract.RAPID if back is None else Retract.FEED
    faster = back / down if back and down else 1.0
    _drill(control, _hole(control, given, retract=retract, faster=faster), down)


def universal_drilling(control: Control, given: CycleParameters) -> None:
    """203: chips are broken Q213 times by a lift of Q256 before the tool comes out; out with Q208."""
    breaks, lift = int(given.number(213)), given.length(256)
    hole = _hole(control, given, rest=_seconds(control, given, 210))
    hole = _pecked(control, given, hole, given.length(212), given.length(205))
    if breaks > 0:
        lift = lift or ADVANCE
        hole = hole._replace(lift=lift, full_every=breaks + 1, clearance=ADVANCE)
    down, back = given.feed(206), given.feed(208)
    if back:
        hole = hole._replace(retract=Retract.FEED, faster=back / (down or back))
    _drill(control, hole, down)


def universal_pecking(control: Control, given: CycleParameters) -> None:
    """205: in pecks, in each of which the chip is broken every Q257; back into the hole to Q258 above its bottom."""
    hole = _hole(control, given, clearance=given.length(258))
    start = given.length(379)
    if start > 0.0:
        hole = hole._replace(surface=hole.surface - start)
    hole = _pecked(control, given, hole, given.length(212), given.length(205))
    breaking = given.length(257)
    if 0.0 < breaking < hole.peck:
        _break_chips(control, given, hole, breaking)
    else:
        _drill(control, hole, given.feed(206))


def _break_chips(control: Control, given: CycleParameters, hole: Hole, breaking: float) -> None:
    """Deep drilling whose pecks are made of shorter ones."""
    lift, depth, peck = given.length(256) or ADVANCE, hole.surface, hole.peck
    if (hole.surface - hole.bottom) / breaking > MOST_PECKS:
        message = f"the hole would need more than {MOST_PECKS} chips"
        control.fail("cycle-depth", message, hint="write a larger Q257")
    feed = _drilling_feed(control, given.feed(206))
    go_to_height(control, hole.reference)
    while depth > hole.bottom:
        if depth < hole.surface:
            go_to_height(control, min(depth + hole.clearance, hole.reference))
        goal = max(depth - peck, hole.bottom)
        while depth > goal:
            depth = max(depth - breaking, goal)
            descend(control, depth, feed)
            if depth > goal:
                go_to_height(control, depth + lift)
        if depth == hole.bottom and hole.dwell > 0.0:
            control.dwell(hole.dwell)
        go_to_height(control, hole.back if depth == hole.bottom else hole.reference)
        peck = max(peck - hole.reduction, hole.least)


def boring(control: Control, given: CycleParameters) -> None:
    """202: at the bottom the spindle is stopped, the tool leaves the wall by Q214, and comes back with Q208."""
    direction = _ASIDE.get(int(given.number(214)))
    if direction is None:
        control.fail("cycle-word", f"Q214 is 0 to 4, not {given.number(214):g}")
    _, reference, bottom, back = heights(control, given)
    x, y = control.modal.plane.point(control.motion.programmed)
    down, up = _drilling_feed(control, given.feed(206)), given.feed(208)
    go_to_height(control, reference)
    descend(control, bottom, down)
    if (seconds := _seconds(control, given, 211)) > 0.0:
        control.dwell(seconds)
    control.function("M5", {})
    with at_feed(control, down):
        go(control, (x + ADVANCE * direction[0], y + ADVANCE * direction[1]))
    descend(control, reference, up if up is None else up or down)
    go_to_height(control, back)
    turn_spindle(control, "M3")
    go(control, (x, y), rapid=True)


def back_boring(control: Control, given: CycleParameters) -> None:
    """204: beside its axis, the spindle standing at Q336, the tool goes through the hole, and bores from below.

    Its tooth lies Q252 above its tip and reaches Q251 beyond its shank. Decision: it comes out of the counterbore with
    the feed of positioning, Q253.
    """
    direction, thickness, deep = (
        _ASIDE.get(int(given.number(214))),
        given.length(250),
        given.length(249),
    )
    if (
        not direction
        or direction == _ASIDE[0]
        or not 0.0 < deep <= thickness
        or given.length(200) < 0.0
    ):
        message = "cycle 204 needs Q214 1 to 4, and a depth Q249 above 0, in the thickness Q250"
        control.fail("cycle-word", message)
    surface, clearance, offset = given.length(203), given.length(200), given.length(251)
    reference, under = surface + clearance, surface - thickness - given.length(252)
    x, y = control.modal.plane.point(control.motion.programmed)
    beside = (x + offset * direction[0], y + offset * direction[1])
    positioning, stands = given.feed(253), {"R": given.number(336)}
    go_to_height(control, reference)
    control.function("M19", stands)
    go(control, beside, rapid=True)
    descend(control, under - clearance, positioning)
    with at_feed(control, positioning):
        go(control, (x, y), rapid=positioning is None)
    turn_spindle(control, "M3")
    descend(control, under + deep, _drilling_feed(control, given.feed(254)))
    if (seconds := _seconds(control, given, 255)) > 0.0:
        control.dwell(seconds)
    descend(control, under - clearance, positioning)
    control.function("M19", stands)
    with at_feed(control, positioning):
        go(control, beside, rapid=positioning is None)
    descend(control, reference, positioning)
    go_to_height(control, max(reference, surface + given.length(204)))
    turn_spindle(control, "M3")
    go(control, (x, y), rapid=True)


def tapping(control: Control, given: CycleParameters) -> None:
    """206: with a floating chuck, at the feed Q206."""
    _drill(control, _hole(control, given, retract=Retract.REVERSED), given.feed(206))


def rigid_tapping(control: Control, given: CycleParameters) -> None:
    """207: the feed follows from the pitch Q239, below 0 of a left-hand thread."""
    _tap(control, given, _hole(control, given, dwell=0.0))


def tapping_with_breaks(control: Control, given: CycleParameters) -> None:
    """209: the chip is broken every Q257; back by Q256 times the pitch, or out of the hole; out Q403 times as fast."""
    hole, depth = _hole(control, given, dwell=0.0), given.length(257)
    if depth > 0.0:
        passes = count_passes(hole.surface, hole.bottom, depth)
        if passes > MOST_PECKS:
            message = f"the thread would need more than {MOST_PECKS} passes"
            control.fail("cycle-depth", message, hint="write a larger Q257")
        lift = abs(given.length(239)) * given.number(256)
        full = 0 if lift > 0.0 else 1
        hole = hole._replace(passes=True, stops=passes - 1, peck=depth, lift=lift, full_every=full)
    _tap(control, given, hole._replace(faster=given.number(403) or 1.0))


def _tap(control: Control, given: CycleParameters, hole: Hole) -> None:
    """Tap with the spindle's speed."""
    pitch, speed = given.length(239), control.motion.spindle
    if pitch == 0.0:
        control.fail("cycle-word", f"{given.name} needs the pitch Q239", hint="Q239=+1.5")
    if speed is None or speed <= 0.0:
        message = f"{given.name} needs the speed S of the spindle"
        control.fail("feed-per-revolution", message, hint="write S in TOOL CALL")
    retract = Retract.REVERSED if pitch > 0.0 else Retract.REVERSED_LEFT
    feed = abs(pitch) * speed / control.modal.unit
    turn_spindle(control, "M3" if pitch > 0.0 else "M4")
    _drill(control, hole._replace(retract=retract), feed)


def centring(control: Control, given: CycleParameters) -> None:
    """240: to the depth Q201."""
    if given.number(343) != 0.0:
        message = (
            "Q343=1 computes the depth of the diameter by the tool's point, which the twin does not"
        )
        control.fail("cycle-word", message, hint="write Q343=0 and the depth in Q201")
    _drill(control, _hole(control, given), given.feed(206))


def single_lip_drilling(control: Control, given: CycleParameters) -> None:
    """241: slowly to the deepened start Q379, with Q253; there the speed Q428, and drilled; back with Q208."""
    surface, reference, bottom, back = heights(control, given)
    if 0.0 < given.length(202) < surface - bottom:
        message = "the twin drills a hole of cycle 241 at once"
        control.fail("cycle-word", message, hint="write Q202 as large as the hole is deep")
    down, up = _drilling_feed(control, given.feed(206)), given.feed(208)
    go_to_height(control, reference)
    before = control.motion.spindle
    control.motion.spindle = given.number(427) or before
    turn_spindle(control, {4: "M4"}.get(int(given.number(426)), "M3"))
    descend(control, surface - given.length(379), given.feed(253))
    control.motion.spindle = given.number(428) or before
    control.function("S", {"S": control.motion.spindle or 0.0})
    descend(control, bottom, down)
    if (seconds := _seconds(control, given, 211)) > 0.0:
        control.dwell(seconds)
    descend(control, reference, up if up is None else up or down)
    go_to_height(control, back)
    control.motion.spindle = before
    turn_spindle(control, "M3")
