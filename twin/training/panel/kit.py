"""What the panel is built of: colours, keys, lamps, texts; and a note of where each one is."""

import contextlib
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


_SMALLEST = 0.7
"""Scale of letters that can still be read."""
GROUP_GAP = 22.0
"""Between two groups of the desk [px]."""


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

    def hard_key(
        self,
        name: str,
        label: str,
        width: float,
        height: float,
        *,
        lamp: Colour,
        lit: bool,
        at_once: bool = False,
    ) -> bool:
        """A key of the machine's desk, with a lamp along its upper edge.

        Args:
            name: What it is found by.
            label: What stands on it, in as many lines as it takes.
            width: [px].
            height: [px].
            lamp: Colour of its lamp.
            lit: Whether the lamp is on.
            at_once: Whether it acts when it is pressed, not when it is let go.
        """
        clicked = imgui.Button(f"###{name}", imgui.Vec2(width, height))
        acted = imgui.IsItemActivated() if at_once else clicked
        self.note(name)
        left, top, right, bottom = self.places[name]
        shade = lamp if lit else dimmed(lamp)
        draw = imgui.GetWindowDrawList()
        low, high = imgui.Vec2(left + 6.0, top + 5.0), imgui.Vec2(right - 6.0, top + 9.0)
        draw.AddRectFilled(low, high, packed(shade), 2.0)
        if lit:
            corner = imgui.Vec2(left, top), imgui.Vec2(right, bottom)
            draw.AddRect(*corner, packed(lamp), 3.0, 1.5)
        centred(label, left, top + 7.0, right, bottom, TEXT)
        return acted

    @contextlib.contextmanager
    def group(self, caption: str, height: float) -> Iterator[None]:
        """Parts that belong together, below a caption, with a line at their right."""
        imgui.BeginGroup()
        # Without this the captions of groups beside each other would stand at different heights.
        imgui.AlignTextToFramePadding()
        self.text(caption, QUIET)
        yield
        imgui.EndGroup()
        low, high = imgui.GetItemRectMin(), imgui.GetItemRectMax()
        right = high.x + 0.5 * GROUP_GAP
        imgui.GetWindowDrawList().AddLine(
            imgui.Vec2(right, low.y), imgui.Vec2(right, low.y + height), packed(KEY), 1.0
        )
        imgui.SameLine(0.0, GROUP_GAP)

    @staticmethod
    def chip(text: str, colour: Colour, scale: float = 1.0) -> None:
        """A word on a coloured ground."""
        imgui.SetWindowFontScale(scale)
        size, corner = imgui.CalcTextSize(text), imgui.GetCursorScreenPos()
        high = imgui.Vec2(corner.x + size.x + 16.0, corner.y + size.y + 4.0)
        draw = imgui.GetWindowDrawList()
        draw.AddRectFilled(corner, high, packed(colour), 3.0)
        draw.AddText(imgui.Vec2(corner.x + 8.0, corner.y + 2.0), packed(TEXT), text)
        imgui.Dummy(imgui.Vec2(size.x + 16.0, size.y + 4.0))
        imgui.SetWindowFontScale(1.0)

    def note(self, name: str) -> None:
        """Remember where the last item lies."""
        low, high = imgui.GetItemRectMin(), imgui.GetItemRectMax()
        self.places[name] = (low.x, low.y, high.x, high.y)

    def entered(self, name: str) -> bool:
        """Note where the last field lies; whether it was left with Enter."""
        self.note(name)
        keys = imgui.Key.Enter, imgui.Key.KeypadEnter
        return imgui.IsItemDeactivated() and any(imgui.IsKeyPressed(key) for key in keys)

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

    @staticmethod
    def fitting(text: str, colour: Colour = TEXT) -> None:
        """A line of text, in smaller letters where its room is too narrow for it."""
        width = imgui.CalcTextSize(text).x
        scale = min(1.0, imgui.GetContentRegionAvail().x / max(width, 1.0))
        Kit.text(text, colour, max(scale, _SMALLEST))

    @staticmethod
    def beside(label: str) -> None:
        """Go on beside the last part where a key with this label has room there, else below it."""
        imgui.SameLine()
        needed = imgui.CalcTextSize(label).x + 2.0 * imgui.GetStyle().FramePadding.x
        if needed > imgui.GetContentRegionAvail().x:
            imgui.NewLine()

    def wrapped(self, text: str, colour: Colour = TEXT) -> None:
        """A paragraph, broken between words."""
        width = imgui.GetContentRegionAvail().x
        known = self._broken.get(text)
        if known is None or known[0] != width:
            known = self._broken[text] = (width, _break(text, width))
        for line in known[1]:
            self.text(line, colour)


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


def centred(
    label: str, left: float, top: float, right: float, bottom: float, colour: Colour
) -> None:
    """A label in the middle of a field, in as many lines as it takes."""
    lines = _break(label, right - left - 8.0)
    height = imgui.GetTextLineHeight()
    y = 0.5 * (top + bottom - height * len(lines))
    draw = imgui.GetWindowDrawList()
    for line in lines:
        x = 0.5 * (left + right - imgui.CalcTextSize(line).x)
        draw.AddText(imgui.Vec2(x, y), packed(colour), line)
        y += height


def dimmed(colour: Colour) -> Colour:
    """The colour of a lamp that is out."""
    return (0.3 * colour[0], 0.3 * colour[1], 0.3 * colour[2], colour[3])


def packed(colour: Colour) -> int:
    """A colour as the draw list takes it."""
    return imgui.ColorConvertFloat4ToU32(imgui.Vec4(*colour))
