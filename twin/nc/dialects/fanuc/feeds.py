"""What F counts on a Fanuc control, and on a Haas mill.

Fanuc, feed per minute and per revolution: a line counts all its axes together, a degree as much as 1 mm, or as
1 inch in G20 (operator's manual, linear interpolation: ``G91 G1 X20. C40. F300.`` takes 0.149 min); an arc counts
the circle in its plane, unless parameter 1403 #5 (HTG) lets it count the way of all axes. Inverse time (G93): F of
an arc is its speed by its radius, since the manual computes it of the radius and not of the distance.

Haas: rotary axes count by the surface whose diameter setting 34 holds; F of a helix counts the helix; F of G93 is
strokes per minute in every move (manual, G2, G93 and settings).
"""

import math

from twin.nc.control.control import Control
from twin.nc.control.settings import ControlSettings
from twin.nc.dialects.fanuc.memory import acts_on_plain_blocks, letter_patterns, memory_of
from twin.nc.path.paces import FeedRule

DEGREE_AS_LENGTH = 1.0
"""What a degree counts beside linear axes, in programmed units of length (Fanuc's manual). Decision: of a Haas
where nobody gave the diameter of setting 34 as well, which is the surface of 114.6 mm diameter."""


def fanuc_rule(settings: ControlSettings) -> FeedRule:
    """What F counts by the parameters of a Fanuc control."""
    along_path = settings.helical_feed == "path"
    return FeedRule(DEGREE_AS_LENGTH, helix_by_arc=not along_path, arc_by_radius=True)


def haas_rule(settings: ControlSettings) -> FeedRule:
    """What F counts by the settings of a Haas mill."""
    if settings.rotary_diameter is None:
        return FeedRule(DEGREE_AS_LENGTH)
    return FeedRule(math.radians(settings.rotary_diameter / 2.0), surface=True)


OWN_FEEDS = (
    *(each for number in (b"93", b"18", b"19") for each in letter_patterns("G", number)),
    *letter_patterns("G", rb"0+(?:93|18|19)"),
    *letter_patterns("Z", rb"[^\r\nZz]*[IJKRijkr]"),
    *(pattern for axis in "IJKR" for pattern in letter_patterns(axis, rb"[^\r\nIJKRijkr]*[Zz]")),
)
"""Lines that may hold helices or inverse times, which the compiled tier does not know."""


def has_own_feeds(control: Control) -> bool:
    """Whether some line may move so that F counts another length than that of the path in X, Y and Z."""
    lines = control.program_counter.lines
    rotary = (
        name
        for name, linear in zip(control.settings.axes.names, control.linear, strict=True)
        if not linear
    )
    turns = (pattern for name in rotary for pattern in letter_patterns(name, rb"[ \t]*[-+.0-9#\[]"))
    return any(lines.any_holds(pattern) for pattern in (*OWN_FEEDS, *turns))


def needs_interpreter(control: Control) -> bool:
    """Whether plain blocks are more than the compiled tier knows."""
    memory = memory_of(control)
    if memory.own_feeds is None:
        memory.own_feeds = has_own_feeds(control)
    return memory.own_feeds or acts_on_plain_blocks(control)
