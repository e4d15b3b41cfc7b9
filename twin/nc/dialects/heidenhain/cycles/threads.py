"""Helices: bore milling 208, thread milling 262 and 267.

Decisions, since the manuals leave them open: the tool comes to the helix and leaves it on half a turn about the
middle between the axis of the hole and its own place on the helix, which rises or falls with the thread.
"""

import math

from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.cycle_values import Parameters
from twin.nc.dialects.heidenhain.cycles.holes import heights
from twin.nc.dialects.heidenhain.tools import compensation_radius
from twin.nc.geometry.arcs import Point
from twin.nc.iso.hole import go_to_height

_MOST_TURNS = 10_000.0


def _go(control: Control, point: Point, *, rapid: bool = False) -> None:
    plane, target = control.modal.plane, list(control.motion.programmed)
    plane.aim(target, point)
    control.line_to(target, rapid=rapid)


def _turn(control: Control, center: Point, end: Point, sweep: float, height: float) -> None:
    plane, target = control.modal.plane, list(control.motion.programmed)
    plane.aim(target, end)
    target[2] = height
    control.arc_to(target, center, sweep)


def bore_milling(control: Control, given: Parameters) -> None:
    """208: on a helix of the pitch Q334 to the depth, once around there, and out by the middle."""
    _, reference, bottom, back = heights(control, given)
    radius, pitch = given.length(335) / 2.0 - compensation_radius(control), abs(given.length(334))
    if radius <= 0.0 or pitch == 0.0 or (reference - bottom) / pitch > _MOST_TURNS:
        message = "208 needs a hole Q335 that is wider than the tool, and a pitch Q334 above 0"
        control.fail("cycle-size", message)
    center = control.modal.plane.point(control.motion.programmed)
    begin = (center[0] + radius, center[1])
    feed, sense = control.motion.feed, 1.0 if given.number(351, 1.0) >= 0.0 else -1.0
    go_to_height(control, reference)
    control.motion.feed = given.feed(206)
    _go(control, begin)
    turns = (reference - bottom) / pitch
    angle = math.radians(sense * 360.0 * turns)
    end = (center[0] + radius * math.cos(angle), center[1] + radius * math.sin(angle))
    _turn(control, center, end, sense * 360.0 * turns, bottom)
    _turn(control, center, end, sense * 360.0, bottom)
    _go(control, center)
    control.motion.feed = feed
    go_to_height(control, back)


def thread_milling(control: Control, given: Parameters) -> None:
    """262: an inside thread of the diameter Q335."""
    radius = given.length(335) / 2.0 - compensation_radius(control)
    _mill_thread(control, given, radius, inside=True)


def outside_thread_milling(control: Control, given: Parameters) -> None:
    """267: an outside thread.

    Raises:
        ProgramError: It is to be countersunk.
    """
    if given.length(358) != 0.0:
        message = "267 with a countersink (Q358) is not followed"
        control.fail("cycle-word", message, hint="write Q358=+0")
    radius = given.length(335) / 2.0 + compensation_radius(control)
    _mill_thread(control, given, radius, inside=False)


def _mill_thread(control: Control, given: Parameters, radius: float, *, inside: bool) -> None:
    """Mill a thread on a path of a radius: Q355 0 in one turn, 1 in as many as it has, else every so many threads.

    The thread is right-handed with a pitch Q239 above 0; climb milling (Q351=1) of an inside one turns
    counter-clockwise, so that a right-handed one is milled upwards (manual).
    """
    surface, reference, bottom, back = heights(control, given)
    pitch, several = given.length(239), int(given.number(355))
    if radius <= 0.0 or pitch == 0.0 or (surface - bottom) / abs(pitch) > _MOST_TURNS:
        message = f"{given.name} needs a thread Q335 that the tool fits into, and a pitch Q239"
        control.fail("cycle-size", message)
    climbs = given.number(351, 1.0) >= 0.0
    sense = 1.0 if climbs is inside else -1.0
    rise = abs(pitch) if (sense > 0.0) is (pitch > 0.0) else -abs(pitch)
    turns = (surface - bottom) / abs(pitch) if several == 1 else 1.0
    steps = 1 if several in (0, 1) else math.ceil((surface - bottom) / (abs(pitch) * several))
    center = control.modal.plane.point(control.motion.programmed)
    feed, pre, mills = control.motion.feed, given.feed(253), given.feed(207)
    for step in range(steps):
        low = bottom + step * several * abs(pitch) if several > 1 else bottom
        start = low if rise > 0.0 else low + turns * abs(pitch)
        end = start + turns * rise
        outside = radius + abs(given.length(357)) + compensation_radius(control)
        begin = center if inside else (center[0] + outside, center[1])
        go_to_height(control, reference)
        control.motion.feed = pre
        _go(control, begin, rapid=pre is None)
        go_to_height(control, start - rise / 2.0 if inside else start, rapid=pre is None)
        control.motion.feed = mills
        _lead(control, center, begin, radius, sense, start, arrives=True)
        angle = math.radians(sense * 360.0 * turns)
        there = (center[0] + radius * math.cos(angle), center[1] + radius * math.sin(angle))
        _turn(control, center, there, sense * 360.0 * turns, end)
        _lead(control, center, begin, radius, sense, end, arrives=False)
    control.motion.feed = feed
    go_to_height(control, reference)
    _go(control, center, rapid=True)
    go_to_height(control, back)


def _lead(
    control: Control,
    center: Point,
    begin: Point,
    radius: float,
    sense: float,
    height: float,
    *,
    arrives: bool,
) -> None:
    """Half a turn from a place beside the helix onto it, or back."""
    here = control.modal.plane.point(control.motion.programmed)
    end = (center[0] + radius, center[1]) if arrives else begin
    middle = ((here[0] + end[0]) / 2.0, (here[1] + end[1]) / 2.0)
    inside = begin == center
    _turn(control, middle, end, sense * 180.0 if inside else -sense * 180.0, height)
