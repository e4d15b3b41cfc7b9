"""How blocks of a Fanuc control move: lines, arcs, polar coordinates (G16), blended corners, and what F counts.

With G16 the plane's first axis is a radius and its second an angle. In G90 the radius counts from the
origin and the angle from the first axis; in G91 the radius counts from where the tool is, and the
angle from the last one.

What F counts. Fanuc, feed per minute and per revolution: a line counts all its axes together, a degree as much as 1 mm, or as
1 inch in G20 (operator's manual, linear interpolation: ``G91 G1 X20. C40. F300.`` takes 0.149 min); an arc counts
the circle in its plane, unless parameter 1403 #5 (HTG) lets it count the path of all axes. Inverse time (G93): F of
an arc is its speed by its radius, since the manual computes it of the radius and not of the distance.

Haas: rotary axes count by the surface whose diameter setting 34 holds; F of a helix counts the helix; F of G93 is
strokes per minute in every move (manual, G2, G93 and settings).
"""

import math
import re
from collections.abc import Callable
from typing import TypeVar

from twin.nc.control.control import Control
from twin.nc.control.modal import ArcRule
from twin.nc.control.settings import ControlSettings
from twin.nc.dialects.fanuc.frames import cylinder
from twin.nc.dialects.fanuc.frames.transformations import refuse_uneven_arc
from twin.nc.dialects.fanuc.memory import Variant, memory_of
from twin.nc.geometry.arcs import direction
from twin.nc.iso import base
from twin.nc.iso.circular import BOUNDS, arc_center, both_senses, plane_center_letters, sweep_arc
from twin.nc.iso.drilling.drilling import Holes, repeats_of
from twin.nc.path.blends import BlendKind
from twin.nc.path.feed_rates import FeedRule

_Kind = TypeVar("_Kind")
_CALLS = (97.0, 98.0)
"""Functions whose L says how often they call."""


def target(control: Control) -> list[float]:
    """Take the axis words; the programmed position that they ask for, shape (k,)."""
    if not memory_of(control).polar:
        return control.target()
    abscissa, ordinate, _ = control.modal.plane.axes
    names = control.settings.axes.names
    radius, angle = control.take(names[abscissa]), control.take(names[ordinate])
    goal = control.target()
    if radius is None and angle is None:
        return goal
    memory, incremental = memory_of(control), control.modal.incremental
    here = (control.motion.programmed[abscissa], control.motion.programmed[ordinate])
    if radius is not None:
        memory.polar_center = here if incremental else (0.0, 0.0)
        memory.polar_radius = control.axis_value(abscissa, radius)
    away = here[0] - memory.polar_center[0], here[1] - memory.polar_center[1]
    length = math.hypot(*away) if memory.polar_radius is None else memory.polar_radius
    turned = memory.polar_angle
    if turned is None:
        turned = math.degrees(math.atan2(away[1], away[0])) if any(away) else 0.0
    if angle is not None:
        turned = control.number(angle) + (turned if incremental else 0.0)
    memory.polar_angle = turned
    cosine, sine = direction(turned)
    goal[abscissa] = memory.polar_center[0] + length * cosine
    goal[ordinate] = memory.polar_center[1] + length * sine
    return goal


def holes_of(variant: Variant) -> Holes:
    """How blocks of a control of the family name the holes of a cycle."""
    return Holes(target, "manual", variant.counting)


def begin_polar(control: Control) -> None:
    """G16: origin and angle begin again."""
    memory = memory_of(control)
    memory.polar, memory.polar_center = True, (0.0, 0.0)
    memory.polar_radius = memory.polar_angle = None


def end_polar(control: Control) -> None:
    """G15."""
    memory_of(control).polar = False


def _as_often_as_l(move: Callable[[Control, _Kind], None]) -> Callable[[Control, _Kind], None]:
    """A motion that goes as often as L says, where the control repeats motions (Haas manual, thread milling)."""

    def perform(control: Control, kind: _Kind) -> None:
        calls = any(word.address == "M" and word.value in _CALLS for word in control.block.words)
        repeats = memory_of(control).variant.repeats_motion and not calls
        count = repeats_of(control, "L", 1) if repeats else 1
        given = dict(control.words)
        for _ in range(count):
            control.words = dict(given)
            move(control, kind)

    return perform


def _line(control: Control, rapid: bool) -> None:
    goal = target(control)
    if rapid:
        control.line_to(goal, rapid=True)
    else:
        cylinder.line_to(control, goal)


def _arc(control: Control, rule: ArcRule) -> None:
    """An arc by I, J, K or R; where both are written R alone counts (manual)."""
    refuse_uneven_arc(control)
    if "R" in control.words:
        for letter in plane_center_letters(control):
            control.take(letter)
    goal = target(control)
    if cylinder.arc_to(control, goal, clockwise=rule.clockwise):
        return
    sweep_arc(control, goal, arc_center(control, goal, rule), clockwise=rule.clockwise)


POSITIONING, LINEAR = base.straight(_as_often_as_l(_line))
CLOCKWISE, COUNTER_CLOCKWISE = both_senses(_as_often_as_l(_arc), ArcRule(bounds=BOUNDS))


_CORNER_WORDS = re.compile(rb",[CR]", re.IGNORECASE)
_CORNERS = {",R": BlendKind.FILLET, ",C": BlendKind.CHAMFER}


def prepare_corners(control: Control) -> None:
    """Hold moves until their successor is known, where the program blends corners at all."""
    if control.program_counter.lines.any_holds(_CORNER_WORDS):
        control.path.hold_for_blends()


def blend_corner(control: Control) -> None:
    """,R rounds and ,C chamfers the corner between the block's move and the next."""
    words = [control.words.pop(address) for address in _CORNERS if address in control.words]
    if not words:
        return
    if len(words) > 1:
        control.fail("blend", "a corner is rounded or chamfered, not both", words[1])
    (word,) = words
    size = control.length(word)
    if size <= 0.0:
        control.fail("blend", f"{word.text} is no size of a corner", word)
    scale = memory_of(control).scale
    if scale is not None:
        size *= abs(scale[0][control.modal.plane.axes[0]])
    base.blend_corner_behind(control, _CORNERS[word.address], size, word)


DEGREE_AS_LENGTH = 1.0
"""What a degree counts together with linear axes, in programmed units of length (Fanuc's manual). Decision: of a Haas
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
