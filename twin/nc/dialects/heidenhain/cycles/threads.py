"""Cycles of helices: bore milling 208, thread milling 262 to 265 and 267.

Climb milling (Q351=1) of an inside thread turns counter-clockwise, so that a right-handed one (Q239 above 0) is milled
upwards. The feed Q207 counts the edge of the tool (TNC 426 user's manual, 8.3), that of the tool's centre follows.
Decision: 263 with a clearance Q357 beside the wall is refused, since the core diameter is not given.
"""

from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.cycles.holes import heights, universal_pecking
from twin.nc.dialects.heidenhain.memory import CycleParameters
from twin.nc.dialects.heidenhain.tools import compensation_radius
from twin.nc.iso.cycle_moves import at_feed, descend, go_to_height, turn
from twin.nc.iso.milling.threads import (
    MOST_TURNS,
    Thread,
    mill_hole,
    mill_thread,
    right_handed_goes_up,
)


def bore_milling(control: Control, given: CycleParameters) -> None:
    """208: on a helix of the pitch Q334 to the depth, once around there, and out by the middle."""
    _, reference, bottom, back = heights(control, given)
    radius, pitch = given.length(335) / 2.0 - compensation_radius(control), abs(given.length(334))
    if radius <= 0.0 or pitch == 0.0 or (reference - bottom) / pitch > MOST_TURNS:
        message = "208 needs a hole Q335 that is wider than the tool, and a pitch Q334 above 0"
        tool = 2.0 * compensation_radius(control)
        hint = f"the hole is {given.length(335):g} mm wide and the tool {tool:g} mm, the pitch {pitch:g} mm"
        control.fail("cycle-size", message, hint=hint)
    go_to_height(control, reference)
    with at_feed(control, given.feed(206)):
        mill_hole(control, radius, pitch, bottom, clockwise=given.number(351, 1.0) < 0.0)
    go_to_height(control, back)


def thread_milling(control: Control, given: CycleParameters) -> None:
    """262: an inside thread of the diameter Q335."""
    _mill(control, given, clockwise=given.number(351, 1.0) < 0.0)


def thread_milling_and_countersinking(control: Control, given: CycleParameters) -> None:
    """263: the hole is countersunk to Q356, and at its front, then the thread is milled."""
    if given.length(357) != 0.0:
        message = "263 with a clearance beside the wall (Q357) is not followed"
        control.fail("cycle-word", message, hint="write Q357=+0")
    surface, reference, _, _ = heights(control, given)
    deep = surface + given.length(356)
    if given.length(356) < 0.0:
        go_to_height(control, reference)
        descend(control, deep + given.length(200), given.feed(253))
        descend(control, deep, given.feed(254))
    _countersink_front(control, given)
    thread_milling(control, given)


def thread_drilling_and_milling(control: Control, given: CycleParameters) -> None:
    """264: the hole is drilled to Q356 and countersunk at its front, then the thread is milled."""
    if given.length(356) < 0.0:
        universal_pecking(control, given.replaced({201: given.number(356), 204: 0.0}))
    _countersink_front(control, given.replaced({254: given.number(206)}))
    thread_milling(control, given)


def helical_thread_drilling(control: Control, given: CycleParameters) -> None:
    """265: the thread is milled downwards on one helix, its front countersunk before (Q360=0) or after it."""
    after = given.number(360) != 0.0
    if not after:
        _countersink_front(control, given)
    _, reference, _, back = heights(control, given)
    _mill(control, given.replaced({355: 1.0, 204: 0.0}), clockwise=given.number(239) > 0.0)
    if after:
        _countersink_front(control, given)
    go_to_height(control, max(reference, back))


def outside_thread_milling(control: Control, given: CycleParameters) -> None:
    """267: an outside thread."""
    if given.length(358) != 0.0:
        message = "267 with a countersink (Q358) is not followed"
        control.fail("cycle-word", message, hint="write Q358=+0")
    _mill(control, given, clockwise=given.number(351, 1.0) >= 0.0, inside=False)


def _mill(
    control: Control, given: CycleParameters, *, clockwise: bool, inside: bool = True
) -> None:
    """Mill a thread: Q355 0 in one turn, 1 in as many as it has, else every so many threads."""
    surface, reference, bottom, back = heights(control, given)
    tool, nominal, pitch = compensation_radius(control), given.length(335) / 2.0, given.length(239)
    radius, steps = nominal - tool if inside else nominal + tool, int(given.number(355))
    turns = (surface - bottom) / abs(pitch) if pitch else 0.0
    if radius <= 0.0 or not 0.0 < turns <= MOST_TURNS or steps < 0:
        message = f"{given.name} needs a thread Q335 that the tool fits into, and a pitch Q239"
        control.fail("cycle-size", message)
    feed = given.feed(207)
    thread = Thread(
        center=control.modal.plane.point(control.motion.programmed),
        radius=radius,
        pitch=abs(pitch),
        upwards=right_handed_goes_up(pitch, clockwise=clockwise),
        clockwise=clockwise,
        top=surface,
        bottom=bottom,
        threads_per_step=steps,
        beside=0.0 if inside else radius + abs(given.length(357)) + tool,
        reference=reference,
        positioning=given.feed(253),
        feed=None if feed is None else feed * radius / nominal,
    )
    mill_thread(control, thread)
    go_to_height(control, back)


def _countersink_front(control: Control, given: CycleParameters) -> None:
    """Once around on a circle of the radius Q359 at the depth Q358; half circles lead to it and back."""
    depth, offset = given.length(358), given.length(359)
    if depth == 0.0:
        return
    surface, reference, _, _ = heights(control, given)
    center = control.modal.plane.point(control.motion.programmed)
    begin, middle = (center[0] + offset, center[1]), (center[0] + offset / 2.0, center[1])
    go_to_height(control, reference)
    descend(control, surface + depth, given.feed(253))
    if offset:
        with at_feed(control, given.feed(254)):
            turn(control, middle, begin, 180.0)
            turn(control, center, begin, 360.0)
            turn(control, middle, center, 180.0)
    go_to_height(control, reference)
