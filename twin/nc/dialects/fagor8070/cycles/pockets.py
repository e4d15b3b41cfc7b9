"""Pocket cycles of the Fagor CNC 8070: G87 rectangular, G88 circular.

The words are the manual's: Z reference plane, I depth, D from the reference plane to the surface, J
half length or radius (its sign is the direction: + clockwise), K half width, A angle of the pocket,
B depth of a pass, C width of a pass, L finishing stock, H feed of the finishing pass, V feed of
plunging. Decision, since the manual does not give the path: each pass plunges at the centre and
clears outwards along parallels of the wall, C apart at most; the finishing pass runs once along the
wall at the full depth. The corners of a rectangle are M0 as round as the tool, M1 rounded by the
radius Q, M2 cut off at the distance Q; a radius below the tool's is the tool's.
"""

import math

from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.polar import take_goal
from twin.nc.iso.milling.clearing import Clearing, clear_pocket
from twin.nc.iso.milling.outlines import Circle, CornerKind, Outline, Rectangle, RectangleCorner

_DEFAULT_WIDTH = 0.75
"""Width of a pass where C is missing, of the tool's diameter (manual)."""

_DEFAULT_PLUNGE = 0.5
"""Feed of plunging where V is missing, of the feed (manual)."""


def call_pocket(control: Control, words: str, lengths: str) -> None:
    """Take the words of a pocket where it is called; ``lengths`` are those that count lengths."""
    axis = control.modal.plane.axes[2]
    control.cycle_values = values = {"start": control.motion.programmed[axis]}
    for address in words:
        if (word := control.take(address)) is not None:
            in_mm = address in lengths
            values[address] = control.length(word) if in_mm else control.number(word)
    incremental = control.modal.incremental
    reference = control.take(control.settings.axes.names[axis])
    if reference is not None:
        base = control.motion.programmed[axis] if incremental or reference.incremental else 0.0
        values["Z"] = control.length(reference) + base
    values.setdefault("Z", values["start"])
    depth = control.take("I")
    if depth is not None:
        relative = incremental or depth.incremental
        values["I"] = control.length(depth)
        values["bottom"] = control.length(depth) + (values["Z"] if relative else 0.0)


def _corner(control: Control, name: str, radius: float) -> RectangleCorner:
    """Corners by M and Q."""
    values = control.cycle_values
    kind, size = values.get("M", 0.0), values.get("Q", 0.0)
    if kind not in tuple(CornerKind):
        control.fail("cycle-word", f"{name} knows the corners M0, M1 and M2, not M{kind:g}")
    largest = min(abs(values["J"]), values["K"])
    if kind == CornerKind.CHAMFERED:
        largest -= (math.sqrt(2.0) - 1.0) * radius
    if kind != CornerKind.SQUARE and not 0.0 < size <= largest:
        message = f"{name} needs the size of its corners in Q, above 0 and up to {largest:g}"
        control.fail("cycle-size", message)
    return RectangleCorner(CornerKind(int(kind)), size, radius)


def mill_pocket(control: Control, name: str, *, circular: bool) -> None:
    """Mill a pocket about the point that the block names."""
    values = control.cycle_values
    needed = ["I", "J", "B", *([] if circular else ["K"])]
    missing = [address for address in needed if address not in values]
    if missing:
        size = "J: its radius" if circular else "J and K: half its length and half its width"
        hint = f"I: its depth; {size}; B: the depth of a pass"
        control.fail("cycle-word", f"{name} needs {' and '.join(missing)}", hint=hint)
    tool = control.tools.data(control.tools.spindle)
    if tool is None:
        control.fail("no-such-tool", f"{name} needs a tool, and the job has none")
    radius = tool.radius
    center = control.modal.plane.point(take_goal(control, arc=False).target)
    length, clockwise = abs(values["J"]) - radius, values["J"] > 0.0
    outline: Outline = Circle(center, length, clockwise, values.get("A", 0.0))
    if not circular:
        corner, width = _corner(control, name, radius), values["K"] - radius
        outline = Rectangle(center, length, width, values.get("A", 0.0), clockwise, corner)
    clear_pocket(control, outline, _clearing(control, name, radius))


def _clearing(control: Control, name: str, radius: float) -> Clearing:
    values = control.cycle_values
    surface, bottom = values["Z"] - values.get("D", 0.0), values["bottom"]
    depth, width = abs(values["B"]), values.get("C", 0.0) or _DEFAULT_WIDTH * 2.0 * radius
    if not bottom < surface <= values["Z"] or depth == 0.0:
        message = f"from the surface {surface:g} to {bottom:g} in passes above 0"
        control.fail("cycle-depth", f"{name} must mill downwards, {message}")
    if not 0.0 < width <= 2.0 * radius:
        message = f"{name}: a pass of {width:g} is wider than the tool, {2.0 * radius:g}"
        control.fail("cycle-size", message)
    feed = control.motion.feed
    at_reference = control.modal.return_to_reference
    return Clearing(
        name=name,
        radius=radius,
        reference=values["Z"],
        surface=surface,
        bottom=bottom,
        back=values["Z"] if at_reference else max(values["start"], values["Z"]),
        depth=depth,
        step=width,
        stock=abs(values.get("L", 0.0)),
        feed=feed,
        plunge=values.get("V") or (None if feed is None else feed * _DEFAULT_PLUNGE),
        finish_feed=values.get("H") or None,
    )
