"""Smooth leads of the SINUMERIK (SAR): G147, G247, G347 to a contour, G148, G248, G348 away from it.

They go straight, on a quarter or on half a circle: DISR is the distance from the tool's edge to the contour, or the radius of
the centre's path. DISCL is the height above the contour at which the rapid move down ends: with G340 the lead itself
goes down from there, with G341 the tool does so before it, at the feed FAD (programming manual fundamentals, 2.10.4).
"""

from twin.nc.control.codes import Action, GCode
from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik.memory import memory_of
from twin.nc.dialects.sinumerik.targets import POLAR_WORDS, take_target
from twin.nc.iso.cycle_moves import go_to_height
from twin.nc.iso.declared import replacement
from twin.nc.iso.leads import Lead, LeadKind, approach, depart, stand_at_height
from twin.nc.iso.tool_compensation import radius_in_spindle
from twin.nc.path.move_columns import RAPID

_SHAPES = {
    1: ("straight", LeadKind.TANGENT, 0.0),
    2: ("on a quarter circle", LeadKind.ARC, 90.0),
    3: ("on half a circle", LeadKind.ARC, 180.0),
}
_SIDES = {41.0: 1.0, 42.0: -1.0}
LEADS: dict[float, GCode] = {}
"""The codes of leads."""


def is_led(control: Control) -> bool:
    """Whether a lead of the block begins or ends compensation in the place of its next line."""
    return any(word.value in LEADS for word, _ in control.codes)


def _lead(shape: int, *, arrives: bool) -> Action:
    """The lead of a code, in the place of a move."""

    def action(control: Control) -> None:
        _, kind, angle = _SHAPES[shape]
        side = _SIDES.get(control.modal.active.get("compensation") or 0.0, 0.0)
        if arrives is (side == 0.0):
            message = f"a lead {'begins' if arrives else 'ends'} radius compensation in its block"
            hint = "write G41 or G42 in the block of G147, G247 or G347; G40 in that of G148, G248 or G348"
            control.fail("contour-lead", message, hint=hint)
        if arrives:
            _approach(control, kind, angle, side)
        else:
            _depart(control, kind, angle)

    return action


def _approach(control: Control, kind: LeadKind, angle: float, side: float) -> None:
    memory, across, in_plane = memory_of(control), control.modal.plane.axes[2], _in_plane(control)
    target = take_target(control)
    offset = (radius_in_spindle(control) if memory.tool_on else 0.0) + memory.allowance
    lead = _take_lead(control, kind, angle, side, offset, target[across])
    memory.lead_offset = offset
    if in_plane:
        approach(control, lead, target)
        return
    approach(control, lead, None)
    stand_at_height(control, target[across])


def _depart(control: Control, kind: LeadKind, angle: float) -> None:
    memory, across, in_plane = memory_of(control), control.modal.plane.axes[2], _in_plane(control)
    side = memory.lead_side
    height, target = control.motion.programmed[across], take_target(control)
    lead = _take_lead(control, kind, angle, side, memory.lead_offset, height)
    mode = control.modal.interpolation
    rapid = mode is not None and mode.rapid
    depart(control, lead, None)
    if in_plane:
        go_to_height(control, max(target[across], control.motion.programmed[across]), rapid=rapid)
    else:
        control.modal.plane.aim(target, control.modal.plane.point(control.motion.programmed))
    control.line_to(target, rapid=rapid)


def _in_plane(control: Control) -> bool:
    """The block names a point of the plane."""
    names = control.settings.axes.names
    words = {*POLAR_WORDS, *(names[axis] for axis in control.modal.plane.axes[:2])}
    return not words.isdisjoint(control.words)


def _take_lead(
    control: Control, kind: LeadKind, angle: float, side: float, offset: float, height: float
) -> Lead:
    """Take DISR, DISCL and FAD."""
    size, above, down = control.take("DISR"), control.take("DISCL"), control.take("FAD")
    length = control.length(size)
    if length <= 0.0:
        control.fail("contour-lead", "a lead needs its length or radius DISR", size, "DISR=5")
    clearance = control.length(above)
    if above is not None and above.mark == "AC":
        clearance -= height
    if clearance < 0.0:
        control.fail("contour-lead", "DISCL lies above the contour", above, "DISCL=3")
    memory_of(control).lead_side = side
    last, feed = control.motion.last, control.motion.feed
    return Lead(
        kind=kind,
        size=length + (offset if kind is LeadKind.TANGENT else 0.0),
        angle=angle,
        side=side,
        offset=offset,
        feed_before=feed,
        feed=feed,
        rapid=last is None or last.motion == RAPID,
        above=clearance,
        spatial=control.modal.active.get("leads") != 341.0,
        feed_down=None if down is None else control.length(down),
    )


LEADS |= {
    100.0 * shape + 47.0: replacement(f"lead to the contour, {name}", _lead(shape, arrives=True))
    for shape, (name, _, _) in _SHAPES.items()
}
LEADS |= {
    100.0 * shape + 48.0: replacement(f"lead from the contour, {name}", _lead(shape, arrives=False))
    for shape, (name, _, _) in _SHAPES.items()
}
