"""G107 of a Fanuc control (G7.1): contours on a cylinder that a rotary axis turns.

``G107 C30.`` begins on the radius 30, ``G107 C0`` ends. The rotary axis stays programmed in degrees; F
counts along the surface, and G2 and G3 with R draw arcs on it, between the rotary axis and the linear
axis of the plane that the block names. Decision: the rotary axis replaces the plane's other
axis (parameter 1022), and an arc is driven in chords that leave it by 0.001 mm at most.
"""

import math

from twin.nc.control.control import Control
from twin.nc.dialects.fanuc.memory import memory_of
from twin.nc.geometry.arcs import sweep_between
from twin.nc.iso.circular import center_of_radius
from twin.nc.path.feed_rates import FeedMode, FeedRule

CHORD_ERROR = 0.001
"""How far a chord may leave its arc [mm]."""


def begin_or_end(control: Control) -> None:
    """G107 C30., G107 C0."""
    words, memory = control.take_axis_words(), memory_of(control)
    if control.path.compensation.in_force:
        message = "the cylinder cannot change while compensation is in force"
        control.fail("compensation-change", message, hint="end it by G40 first")
    if len(words) != 1 or control.motion.linear[words[0][0]]:
        code = control.codes[-1][0]
        message = f"{code.text} needs its rotary axis with the radius"
        control.fail("cylinder", message, code, "G107 C30.")
    ((index, word),) = words
    radius = control.length(word)
    if radius < 0.0:
        control.fail("cylinder", f"{word.text} is no radius", word)
    memory.cylinder = (index, radius) if radius else None


def line_to(control: Control, goal: list[float]) -> None:
    """Move straight on the surface, F along it."""
    memory = memory_of(control)
    if memory.cylinder is None:
        control.line_to(goal, rapid=False)
        return
    kept = control.motion.feed_rule
    control.motion.feed_rule = FeedRule(math.radians(memory.cylinder[1]), surface=True)
    control.line_to(goal, rapid=False)
    control.motion.feed_rule = kept


def arc_to(control: Control, goal: list[float], *, clockwise: bool) -> bool:
    """Move on an arc on the surface; False where the block does not turn the cylinder.

    Raises:
        ProgramError: It has no radius, or its plane holds no axis that goes along the cylinder.
    """
    memory, plane = memory_of(control), control.modal.plane
    if (
        memory.cylinder is None
        or goal[memory.cylinder[0]] == control.motion.programmed[memory.cylinder[0]]
    ):
        return False
    axis, radius = memory.cylinder
    word = control.take("R")
    if word is None:
        control.fail("cylinder", "an arc on a cylinder needs its radius R")
    if control.modal.feed_mode is FeedMode.BLOCKS_PER_MINUTE:
        message = "what F of G93 counts in an arc on a cylinder is not known"
        control.fail("cylinder", message, word, "write G94 and F along the surface")
    abscissa, ordinate, _ = plane.axes
    named = [each for each in (abscissa, ordinate) if goal[each] != control.motion.programmed[each]]
    if len(named) > 1:
        message = "an arc on a cylinder has one linear axis and the rotary one"
        control.fail("cylinder", message, word)
    along = named[0] if named else abscissa
    per_degree = math.radians(radius)

    def seen(position: list[float]) -> tuple[float, float]:
        around = position[axis] * per_degree
        return (position[along], around) if along == abscissa else (around, position[along])

    start, end = seen(control.motion.programmed), seen(goal)
    center = center_of_radius(control, start, end, control.length(word), word, clockwise=clockwise)
    sweep = sweep_between(start, end, center, clockwise=clockwise)
    size = math.dist(start, center)
    step = 2.0 * math.acos(1.0 - min(CHORD_ERROR / size, 1.0))
    count = max(1, math.ceil(math.radians(abs(sweep)) / step))
    begin = math.atan2(start[1] - center[1], start[0] - center[0])
    origin = list(control.motion.programmed)
    for number in range(1, count + 1):
        share = number / count
        angle = begin + math.radians(sweep) * share
        point = (center[0] + size * math.cos(angle), center[1] + size * math.sin(angle))
        there = [old + (new - old) * share for old, new in zip(origin, goal, strict=True)]
        there[along], around = point if along == abscissa else (point[1], point[0])
        there[axis] = around / per_degree
        line_to(control, goal if number == count else there)
    return True
