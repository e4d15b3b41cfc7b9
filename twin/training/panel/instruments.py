"""What the panel shows by drawing: bars, dials, the mushroom button."""

import math

from mujoco.studio.dear_imgui import dear_imgui as imgui

from twin.training.panel.kit import (
    BLACK,
    CYAN,
    GREEN,
    KEY,
    QUIET,
    RED,
    TEXT,
    YELLOW,
    Kit,
    centred,
    dimmed,
    packed,
)

_FIRST_ANGLE, _ANGLE = 135.0, 270.0
"""A dial begins at the lower left and goes clockwise over the top to the lower right [deg]."""
_STEP = 10
"""Of a dial [%]."""


def bar(share: float, text: str, width: float, height: float = 16.0) -> None:
    """A bar with its figure in it; it turns yellow at two thirds and red near its end."""
    colour = RED if share > 0.9 else YELLOW if share > 0.66 else GREEN
    corner = imgui.GetCursorScreenPos()
    right, bottom = corner.x + width, corner.y + height
    draw = imgui.GetWindowDrawList()
    draw.AddRectFilled(corner, imgui.Vec2(right, bottom), packed(BLACK), 2.0)
    filled = imgui.Vec2(corner.x + width * min(max(share, 0.0), 1.0), bottom)
    draw.AddRectFilled(corner, filled, packed(colour), 2.0)
    start = right - imgui.CalcTextSize(text).x - 4.0
    draw.AddText(imgui.Vec2(start, corner.y), packed(TEXT), text)
    imgui.Dummy(imgui.Vec2(width, height))


def dial(kit: Kit, name: str, label: str, value: int, highest: int, size: float) -> int:
    """A rotary switch in steps of 10 %: a click turns it to the side of the click, as the wheel does.

    Returns:
        Where it stands now.
    """
    imgui.BeginGroup()
    corner = imgui.GetCursorScreenPos()
    imgui.InvisibleButton(f"###{name}", imgui.Vec2(size, size))
    kit.note(name)
    clicked, hovered = imgui.IsItemClicked(), imgui.IsItemHovered()
    middle = imgui.Vec2(corner.x + 0.5 * size, corner.y + 0.5 * size)
    radius = 0.36 * size
    draw = imgui.GetWindowDrawList()
    for step in range(0, highest + 1, _STEP):
        lit = CYAN if step <= value else KEY
        reach = 1.34 if step % 50 == 0 else 1.22
        ends = (_on(middle, step, highest, r * radius) for r in (1.1, reach))
        draw.AddLine(*ends, packed(lit), 2.5)
    draw.AddCircleFilled(middle, radius, packed(KEY), 48)
    draw.AddCircleFilled(middle, 0.86 * radius, packed(BLACK), 48)
    hand = (_on(middle, value, highest, r * radius) for r in (0.35, 0.95))
    draw.AddLine(*hand, packed(CYAN), 4.0)
    below = corner.y + size - 20.0
    centred(f"{value} %", corner.x, below, corner.x + size, below + 16.0, CYAN)
    low = corner.y + size
    centred(label, corner.x, low, corner.x + size, low + 34.0, QUIET)
    imgui.Dummy(imgui.Vec2(size, 34.0))
    imgui.EndGroup()
    wheel = imgui.GetIO().MouseWheel if hovered else 0.0
    turned = value
    if clicked:
        turned += _STEP if imgui.GetMousePos().x > middle.x else -_STEP
    elif wheel:
        turned += _STEP if wheel > 0 else -_STEP
    return min(max(turned, 0), highest)


def mushroom(kit: Kit, name: str, label: str, *, pressed: bool, size: float) -> bool:
    """The emergency stop button on its yellow plate; smaller and darker while it is pressed.

    Returns:
        Whether it has just been hit.
    """
    corner = imgui.GetCursorScreenPos()
    imgui.InvisibleButton(f"###{name}", imgui.Vec2(size, size))
    hit = imgui.IsItemActivated()
    kit.note(name)
    middle = imgui.Vec2(corner.x + 0.5 * size, corner.y + 0.5 * size)
    draw = imgui.GetWindowDrawList()
    draw.AddCircleFilled(middle, 0.5 * size, packed(YELLOW), 64)
    draw.AddCircleFilled(middle, 0.43 * size, packed(BLACK), 64)
    cap = 0.38 if pressed else 0.41
    draw.AddCircleFilled(middle, cap * size, packed(dimmed(RED) if pressed else RED), 64)
    draw.AddCircle(middle, 0.8 * cap * size, packed(dimmed(RED)), 64, 2.0)
    inset = 0.11 * size
    centred(label, corner.x + inset, corner.y, corner.x + size - inset, corner.y + size, TEXT)
    return hit


def _on(middle: imgui.Vec2, value: int, highest: int, radius: float) -> imgui.Vec2:
    """Where a value stands on a circle about the middle of a dial."""
    angle = math.radians(_FIRST_ANGLE + _ANGLE * value / highest)
    return imgui.Vec2(middle.x + radius * math.cos(angle), middle.y + radius * math.sin(angle))
