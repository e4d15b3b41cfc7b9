"""Threads and holes that a milling tool cuts on helices.

Decision, since the manuals say no more than tangentially and in a helix: the tool comes to its helix and leaves it on
half a turn about the middle between where it is and the point of the helix on the abscissa.
"""

import dataclasses
import math

from twin.nc.control.control import Control
from twin.nc.geometry.arcs import Point
from twin.nc.iso.cycle_moves import along, at_feed, go, go_to_height, turn

MOST_TURNS = 10_000
"""Turns of one helix: more is a slip of the pen."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Thread:
    """A thread; heights are programmed coordinates of the tool's tip.

    Attributes:
        center: Its axis, in the plane [mm].
        radius: Of the path of the tool's centre [mm].
        pitch: Of the thread, above 0 [mm].
        upwards: Whether it is milled from the bottom upwards.
        clockwise: Whether the tool goes clockwise about the axis.
        top: Where the thread begins [mm].
        bottom: Where it ends [mm].
        threads_per_step: How many threads the tool, with as many teeth, cuts in one turn; 0: all of them, 1: one,
            on a helix all along the thread.
        beside: How far from the axis the tool goes down, 0 for in it [mm].
        reference: Over which the tool moves rapidly [mm].
        positioning: Feed of coming to the helix; None: rapidly.
        feed: Feed of the tool's centre on the helix.
    """

    center: Point
    radius: float
    pitch: float
    upwards: bool
    clockwise: bool
    top: float
    bottom: float
    threads_per_step: int = 1
    beside: float = 0.0
    reference: float
    positioning: float | None
    feed: float | None


def right_handed_goes_up(pitch: float, *, clockwise: bool) -> bool:
    """Whether a thread is milled upwards; a left-handed one has a pitch below 0."""
    return (pitch > 0.0) is not clockwise


def mill_thread(control: Control, thread: Thread) -> None:
    """Mill a thread; the tool ends over its axis at the reference height.

    Helices all along the thread have whole turns, the last of which goes beyond its begin.
    """
    pitch, step = thread.pitch, thread.threads_per_step
    turns = math.ceil((thread.top - thread.bottom) / pitch - 1e-9) if step == 1 else 1
    helices = math.ceil((thread.top - thread.bottom) / (pitch * step) - 1e-9) if step > 1 else 1
    for number in range(helices):
        order = number if thread.upwards else helices - 1 - number
        low = thread.bottom + order * step * pitch if step > 1 else thread.bottom
        _mill_helix(control, thread, low, turns)
    go_to_height(control, thread.reference)
    go(control, thread.center, rapid=True)


def _mill_helix(control: Control, thread: Thread, low: float, turns: int) -> None:
    """One helix from or to a height, with its approach and retraction."""
    sweep = -360.0 * turns if thread.clockwise else 360.0 * turns
    rise = turns * thread.pitch if thread.upwards else -turns * thread.pitch
    start = low if thread.upwards else low + turns * thread.pitch
    aside, on_helix = thread.center[0] + thread.beside, thread.center[0] + thread.radius
    begin, point = (aside, thread.center[1]), (on_helix, thread.center[1])
    middle = ((aside + on_helix) / 2.0, thread.center[1])
    half = math.copysign(180.0, sweep if thread.beside == 0.0 else -sweep)
    before = start - rise / turns / 2.0 if thread.beside == 0.0 else start
    rapid = thread.positioning is None
    go_to_height(control, thread.reference)
    with at_feed(control, thread.positioning):
        go(control, begin, rapid=rapid)
        go_to_height(control, before, rapid=rapid)
    with at_feed(control, thread.feed):
        turn(control, middle, point, half, start)
        turn(control, thread.center, point, sweep, start + rise)
        turn(control, middle, begin, half)


def mill_hole(
    control: Control, radius: float, pitch: float, bottom: float, *, clockwise: bool
) -> None:
    """Bore by milling: from here on one helix to the bottom, once around there, and back to the axis there.

    Args:
        control: The control, over the axis of the hole.
        radius: Of the path of the tool's centre [mm].
        pitch: Of the helix [mm].
        bottom: Height at which it ends [mm].
        clockwise: Whether the tool goes clockwise about the axis.
    """
    plane = control.modal.plane
    center, height = (
        plane.point(control.motion.programmed),
        control.motion.programmed[plane.axes[2]],
    )
    whole = -360.0 if clockwise else 360.0
    turns = (height - bottom) / pitch
    end = along(center, whole * turns, radius)
    go(control, along(center, 0.0, radius))
    turn(control, center, end, whole * turns, bottom)
    turn(control, center, end, whole)
    go(control, center)
