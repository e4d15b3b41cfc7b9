"""What the panel is built of: colours, lit keys, bars, dials; and a note of where each one is."""

import contextlib
import math
from collections.abc import Iterator

from mujoco.studio.dear_imgui import dear_imgui as imgui

Colour = tuple[float, float, float, float]

PAPER: Colour = (0.075, 0.095, 0.115, 0.96)
FIELD: Colour = (0.125, 0.155, 0.185, 1.0)
KEY: Colour = (0.20, 0.235, 0.27, 1.0)
TEXT: Colour = (0.90, 0.93, 0.95, 1.0)
QUIET: Colour = (0.56, 0.62, 0.67, 1.0)
GREEN: Colour = (0.16, 0.62, 0.30, 1.0)
BRIGHT_GREEN: Colour = (0.45, 0.95, 0.55, 1.0)
YELLOW: Colour = (0.88, 0.66, 0.10, 1.0)
RED: Colour = (0.80, 0.13, 0.12, 1.0)
BLUE: Colour = (0.10, 0.45, 0.68, 1.0)
CYAN: Colour = (0.45, 0.85, 0.98, 1.0)
BLACK: Colour = (0.03, 0.04, 0.05, 1.0)

_STYLE = (
    ("WindowBg", PAPER), ("ChildBg", FIELD), ("Text", TEXT), ("TextDisabled", QUIET),
    ("FrameBg", FIELD), ("FrameBgHovered", KEY), ("FrameBgActive", KEY), ("Button", KEY),
    ("ButtonHovered", (0.28, 0.32, 0.36, 1.0)), ("ButtonActive", BLUE), ("Header", BLUE),
    ("HeaderHovered", KEY), ("HeaderActive", BLUE), ("Tab", FIELD), ("TabHovered", KEY),
    ("TabSelected", BLUE), ("CheckMark", CYAN), ("SliderGrab", CYAN), ("SliderGrabActive", TEXT),
    ("Border", KEY), ("TableHeaderBg", FIELD), ("TableBorderLight", KEY), ("PopupBg", PAPER),
    ("ScrollbarBg", PAPER), ("ScrollbarGrab", KEY),
)  # fmt: skip


class Kit:
    """Draws the panel's parts and remembers where they lie.

    Attributes:
        places: Where each named part was last drawn: left, top, right, bottom [px].
    """

    def __init__(self) -> None:
        self.places: dict[str, tuple[float, float, float, float]] = {}
        self._broken: dict[str, tuple[float, list[str]]] = {}

    @contextlib.contextmanager
    def dressed(self) -> Iterator[None]:
        """The colours of a control's screen, whatever theme the page has."""
        pushed = 0
        for name, colour in _STYLE:
            if hasattr(imgui.Col, name):
                imgui.PushStyleColor(int(getattr(imgui.Col, name)), imgui.Vec4(*colour))
                pushed += 1
        imgui.PushStyleVar(int(imgui.StyleVar.WindowRounding), 4.0)
        imgui.PushStyleVar(int(imgui.StyleVar.FrameRounding), 3.0)
        yield
        imgui.PopStyleVar(2)
        imgui.PopStyleColor(pushed)

    @contextlib.contextmanager
    def window(self, name: str, left: float, top: float, width: float, height: float) -> Iterator[None]:  # fmt: skip
        """A window that stands where it is put."""
        imgui.SetNextWindowPos(imgui.Vec2(left, top))
        imgui.SetNextWindowSize(imgui.Vec2(width, height))
        flags = imgui.WindowFlags
        fixed = flags.NoTitleBar, flags.NoResize, flags.NoMove, flags.NoCollapse, flags.NoDocking
        total = int(flags.NoSavedSettings) | int(flags.NoNav) | int(flags.NoBringToFrontOnFocus)
        imgui.Begin(f"###{name}", flags=total | sum(int(flag) for flag in fixed))
        yield
        imgui.End()

    def key(
        self,
        name: str,
        label: str,
        *,
        lit: Colour | None = None,
        width: float = 0.0,
        height: float = 0.0,
        at_once: bool = False,
    ) -> bool:
        """A push-button.

        Args:
            name: What it is found by.
            label: What stands on it.
            lit: Its colour while its lamp is on.
            width: [px]; 0: as the label needs.
            height: [px]; 0: as the label needs.
            at_once: Whether it acts when it is pressed, not when it is let go.
        """
        if lit is not None:
            imgui.PushStyleColor(int(imgui.Col.Button), imgui.Vec4(*lit))
            imgui.PushStyleColor(int(imgui.Col.ButtonHovered), imgui.Vec4(*lit))
        clicked = imgui.Button(f"{label}###{name}", imgui.Vec2(width, height))
        if lit is not None:
            imgui.PopStyleColor(2)
        self.note(name)
        return imgui.IsItemActivated() if at_once else clicked

    def note(self, name: str) -> None:
        """Remember where the last item lies."""
        low, high = imgui.GetItemRectMin(), imgui.GetItemRectMax()
        self.places[name] = (low.x, low.y, high.x, high.y)

    @staticmethod
    def text(text: str, colour: Colour = TEXT, scale: float = 1.0) -> None:
        """A line of text."""
        if scale != 1.0:
            imgui.SetWindowFontScale(scale)
        imgui.PushStyleColor(int(imgui.Col.Text), imgui.Vec4(*colour))
        imgui.TextUnformatted(text)
        imgui.PopStyleColor()
        if scale != 1.0:
            imgui.SetWindowFontScale(1.0)

    @staticmethod
    def right(text: str, colour: Colour = TEXT, scale: float = 1.0) -> None:
        """A number at the right edge of its column."""
        imgui.SetWindowFontScale(scale)
        free = imgui.GetContentRegionAvail().x - imgui.CalcTextSize(text).x
        imgui.SetCursorPosX(imgui.GetCursorPosX() + max(0.0, free))
        imgui.PushStyleColor(int(imgui.Col.Text), imgui.Vec4(*colour))
        imgui.TextUnformatted(text)
        imgui.PopStyleColor()
        imgui.SetWindowFontScale(1.0)

    def wrapped(self, text: str, colour: Colour = TEXT) -> None:
        """A paragraph, broken between words."""
        width = imgui.GetContentRegionAvail().x
        known = self._broken.get(text)
        if known is None or known[0] != width:
            known = self._broken[text] = (width, _break(text, width))
        for line in known[1]:
            self.text(line, colour)

    @staticmethod
    def bar(share: float, width: float, height: float = 10.0) -> None:
        """A bar that turns yellow at two thirds and red near its end."""
        colour = RED if share > 0.9 else YELLOW if share > 0.66 else GREEN
        corner = imgui.GetCursorScreenPos()
        top = corner.y + 0.5 * (imgui.GetTextLineHeight() - height)
        draw = imgui.GetWindowDrawList()
        low, high = imgui.Vec2(corner.x, top), imgui.Vec2(corner.x + width, top + height)
        draw.AddRectFilled(low, high, _packed(BLACK), 2.0)
        filled = imgui.Vec2(corner.x + width * min(max(share, 0.0), 1.0), top + height)
        draw.AddRectFilled(low, filled, _packed(colour), 2.0)
        imgui.Dummy(imgui.Vec2(width, imgui.GetTextLineHeight()))

    def dial(self, name: str, label: str, value: int, highest: int, size: float) -> int:
        """A rotary switch in steps of 10 %; click left or right of it, or drag up and down.

        Returns:
            Where it stands now.
        """
        imgui.BeginGroup()
        corner = imgui.GetCursorScreenPos()
        middle = imgui.Vec2(corner.x + 0.5 * size, corner.y + 0.5 * size)
        imgui.InvisibleButton(f"###{name}", imgui.Vec2(size, size))
        self.note(name)
        clicked, hovered = imgui.IsItemClicked(), imgui.IsItemHovered()
        radius = 0.36 * size
        draw = imgui.GetWindowDrawList()
        for step in range(0, highest + 1, 10):
            angle = _angle(step, highest)
            reach = radius * (1.32 if step % 50 == 0 else 1.22)
            at = [(middle.x + r * math.cos(angle), middle.y + r * math.sin(angle))
                  for r in (1.08 * radius, reach)]  # fmt: skip
            lit = CYAN if step == value else QUIET
            draw.AddLine(imgui.Vec2(*at[0]), imgui.Vec2(*at[1]), _packed(lit), 2.0)
        draw.AddCircleFilled(middle, radius, _packed(KEY), 40)
        draw.AddCircleFilled(middle, 0.82 * radius, _packed(BLACK), 40)
        angle = _angle(value, highest)
        tip = imgui.Vec2(
            middle.x + 0.95 * radius * math.cos(angle), middle.y + 0.95 * radius * math.sin(angle)
        )
        draw.AddLine(middle, tip, _packed(CYAN), 3.0)
        wheel = imgui.GetIO().MouseWheel if hovered else 0.0
        turned = value
        if clicked:
            turned += 10 if imgui.GetMousePos().x > middle.x else -10
        elif wheel:
            turned += 10 if wheel > 0 else -10
        imgui.SameLine()
        imgui.BeginGroup()
        self.text(label, QUIET)
        self.text(f"{value} %", CYAN, 1.5)
        imgui.EndGroup()
        imgui.EndGroup()
        return min(max(turned, 0), highest)


def _break(text: str, width: float) -> list[str]:
    """The lines of a paragraph that is so wide [px]."""
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and imgui.CalcTextSize(longer).x <= width:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


def _angle(value: int, highest: int) -> float:
    """Where a value stands on a dial, from the lower left clockwise over the top [rad]."""
    return math.radians(135.0 + 270.0 * value / highest)


def _packed(colour: Colour) -> int:
    return imgui.ColorConvertFloat4ToU32(imgui.Vec4(*colour))
