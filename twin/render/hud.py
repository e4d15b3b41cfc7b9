"""The head-up display: program, axes, feed, error and time over the picture."""

import dataclasses
import functools
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import matplotlib as mpl
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from twin.nc.canonical import Axes, FloatArray
from twin.render.drawing.canvas import Pixels
from twin.render.scene.trail import error_palette

INK = (24, 33, 42, 255)
MUTED = (92, 105, 118, 255)
ACCENT = (0, 96, 143, 255)
ALERT = (196, 40, 27, 255)
PAPER = (250, 252, 253, 225)
WHITE = (255, 255, 255, 255)
TROUGH = (214, 221, 227, 255)
LOAD_INKS = ((0.7, (38, 132, 88, 255)), (1.0, (214, 137, 16, 255)), (math.inf, ALERT))
"""Colours of a load's bar below these shares of what is borne."""
PANEL_WIDTH = 262
"""Of the panels at the right [px]."""
UNIT_WIDTH = 38
"""From the end of an axis's value to the panel's padding [px]."""

BASE_HEIGHT = 720
"""Height of a picture for which the sizes below are written [px]."""

LINES_SHOWN = 5
COLUMNS_SHOWN = 34

Font = ImageFont.FreeTypeFont


class LoadBar(NamedTuple):
    """How much of what it bears a tool or the spindle is given.

    Attributes:
        share: Of what breaks or stalls it; above 1 the bar is full.
    """

    name: str
    text: str
    share: float


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class HudValues:
    """What the display shows in one frame."""

    line: int
    """Source line of the running block; 0 before the first."""
    position: FloatArray
    """As the control counts: program coordinates, shape (k,) [mm or deg]."""
    feed: float
    """Speed along the path [mm/min, or deg/min where only rotary axes move]."""
    feed_unit: str
    tool: int
    """Number of the tool in the spindle."""
    spindle: float | None
    """Its speed [1/min], negative counter-clockwise, 0 at rest; None where it is not known."""
    error_um: float
    """What ``error_name`` says [µm]."""
    time_s: float
    loads: tuple[LoadBar, ...] = ()
    """What the cut asks for; none where its force was not simulated."""
    alarm: str = ""
    """What is wrong; empty for nothing."""


@functools.cache
def font(name: str, size: int) -> Font:
    """A DejaVu font, which has Cyrillic and Czech letters; matplotlib brings it along."""
    folder = Path(mpl.get_data_path()) / "fonts" / "ttf"
    return ImageFont.truetype(str(folder / f"{name}.ttf"), size)


class Display:
    """Draws the display onto frames.

    Its panels are at the lower corners, its title at the upper left.
    """

    def __init__(
        self,
        *,
        title: str,
        source: Sequence[str],
        axes: Axes,
        size: tuple[int, int],
        speed: float | None,
        error_name: str = "lag",
        error_scale_um: float | None = None,
    ) -> None:
        """Lay the panels out.

        Args:
            size: Width and height of the frames [px].
            speed: How much faster than in reality the film runs; None for a still.
            error_scale_um: Error that has the trail's last colour [µm]; None: no error colours it.
        """
        self._source = [_printable(line) for line in source]
        self._axes = axes
        self._size = size
        self._scale = min(size[1] / BASE_HEIGHT, size[0] / 1280)
        self._title = title if speed is None else f"{title}   ×{speed:.3g}"
        self._error_name = error_name
        self._error_scale = error_scale_um
        self._mono = font("DejaVuSansMono", self._px(17))
        self._bold = font("DejaVuSansMono-Bold", self._px(23))
        self._small = font("DejaVuSans", self._px(14))
        self._heading = font("DejaVuSans-Bold", self._px(17))

    def _px(self, value: float) -> int:
        return max(1, round(value * self._scale))

    def draw(self, frame: Pixels, reading: HudValues) -> Pixels:
        """A copy of a frame with the display on it.

        Args:
            frame: Shape (height, width, 3).
        """
        result = frame.copy()
        margin = self._px(18)
        width, height = self._size
        title = self._title_panel()
        lay_over(result, title, margin, margin)
        if reading.alarm:
            alarm = self._chip(reading.alarm, ALERT, WHITE)
            lay_over(result, alarm, (width - alarm.width) // 2, margin)
        axes = self._axes_panel(reading)
        lay_over(result, axes, width - margin - axes.width, height - margin - axes.height)
        if reading.loads:
            loads = self._load_panel(reading.loads)
            top = height - margin - axes.height - self._px(10) - loads.height
            lay_over(result, loads, width - margin - loads.width, top)
        if self._source:
            program = self._program_panel(reading.line)
            lay_over(result, program, margin, height - margin - program.height)
        return result

    @functools.lru_cache(maxsize=1)  # noqa: B019 (a display lives as long as its film)
    def _title_panel(self) -> Image.Image:
        return self._chip(self._title, PAPER, INK)

    def _chip(self, text: str, paper: tuple[int, ...], ink: tuple[int, ...]) -> Image.Image:
        padding = self._px(12)
        text = self._fitting(text, self._heading, self._size[0] // 2)
        panel, draw = self._panel(
            round(self._heading.getlength(text)) + 2 * padding, self._px(38), paper
        )
        draw.text((padding, self._px(19)), text, font=self._heading, fill=ink, anchor="lm")
        return panel

    @functools.lru_cache(maxsize=32)  # noqa: B019 (a display lives as long as its film)
    def _program_panel(self, line: int) -> Image.Image:
        padding, row = self._px(12), self._px(25)
        shown = min(LINES_SHOWN, len(self._source))
        first = min(max(0, line - 1 - LINES_SHOWN // 2), len(self._source) - shown)
        digits = len(str(len(self._source)))
        character = self._mono.getlength("0")
        width = round(character * (digits + 2 + COLUMNS_SHOWN)) + 2 * padding
        panel, draw = self._panel(width, shown * row + 2 * padding, PAPER)
        for offset, text in enumerate(self._source[first : first + shown]):
            number = first + offset + 1
            middle = padding + offset * row + row // 2
            running = number == line
            if running:
                box = (self._px(5), middle - row // 2, width - self._px(5), middle + row // 2)
                draw.rounded_rectangle(box, self._px(4), fill=ACCENT)
            ink = WHITE if running else INK
            draw.text(
                (padding, middle),
                f"{number:>{digits}}",
                font=self._mono,
                fill=WHITE if running else MUTED,
                anchor="lm",
            )
            if len(text) > COLUMNS_SHOWN:
                text = text[: COLUMNS_SHOWN - 1] + "…"
            place = (padding + character * (digits + 2), middle)
            draw.text(place, text, font=self._mono, fill=ink, anchor="lm")
        return panel

    def _axes_panel(self, reading: HudValues) -> Image.Image:
        panel = self._axes_form.copy()
        draw = ImageDraw.Draw(panel)
        right = panel.width - self._px(14)
        middle = self._px(14) + self._px(30) // 2
        for value in reading.position:
            text = f"{value:.3f}" if abs(value) < 1e6 else f"{value:.6g}"
            place = (right - self._px(UNIT_WIDTH), middle)
            number = text.replace("-0.000", "0.000")
            draw.text(place, number, font=self._bold, fill=INK, anchor="rm")
            middle += self._px(30)
        middle = self._first_small_row
        draw.text(
            (self._px(14), middle + self._px(23)),
            f"tool {reading.tool}",
            font=self._small,
            fill=MUTED,
            anchor="lm",
        )
        for text in (
            f"{reading.feed:.0f} {reading.feed_unit}",
            _turning(reading.spindle),
            f"{reading.error_um:.1f} µm",
            _clock(reading.time_s),
        ):
            draw.text((right, middle), text, font=self._mono, fill=INK, anchor="rm")
            middle += self._px(23)
        return panel

    @property
    def _first_small_row(self) -> int:
        """Middle of the first row below the axes."""
        row, small_row = self._px(30), self._px(23)
        axes = self._px(14) + row // 2 + len(self._axes.names) * row
        return axes + self._px(10) - (row - small_row) // 2

    @functools.cached_property
    def _axes_form(self) -> Image.Image:
        """What the panel of the axes shows in every frame: names, units, the scale of the trail."""
        padding, row, small_row = self._px(14), self._px(30), self._px(23)
        small = ("feed", "", self._error_name, "time")
        legend = self._error_scale is not None
        rows = len(self._axes.names) * row + self._px(10) + (len(small) + legend) * small_row
        panel, draw = self._panel(self._px(PANEL_WIDTH), rows + 2 * padding, PAPER)
        middle, right = padding + row // 2, panel.width - padding
        for name, kind in zip(self._axes.names, self._axes.kinds, strict=True):
            draw.text((padding, middle), name, font=self._bold, fill=ACCENT, anchor="lm")
            place = (right - self._px(UNIT_WIDTH) + self._px(8), middle)
            unit = "mm" if kind == "linear" else "°"
            draw.text(place, unit, font=self._small, fill=MUTED, anchor="lm")
            middle += row
        middle = self._first_small_row
        for name in small:
            draw.text((padding, middle), name, font=self._small, fill=MUTED, anchor="lm")
            middle += small_row
        if self._error_scale is not None:
            scale = f"{self._error_scale:.3g} µm"
            draw.text((padding, middle), "trail 0", font=self._small, fill=MUTED, anchor="lm")
            draw.text((right, middle), scale, font=self._small, fill=MUTED, anchor="rm")
            left = padding + round(self._small.getlength("trail 0")) + self._px(8)
            width = right - round(self._small.getlength(scale)) - self._px(8) - left
            bar = np.tile(error_palette(max(1, width))[None], (self._px(10), 1, 1))
            panel.paste(Image.fromarray(bar), (left, middle - self._px(5)))
        return panel

    def _load_panel(self, loads: Sequence[LoadBar]) -> Image.Image:
        """A bar for each load, with its value; its end is where tool or spindle give up."""
        padding, row = self._px(14), self._px(25)
        width = self._px(PANEL_WIDTH)
        panel, draw = self._panel(width, len(loads) * row + 2 * padding, PAPER)
        left, right = padding + self._px(64), width - padding - self._px(94)
        for number, load in enumerate(loads):
            middle = padding + number * row + row // 2
            draw.text((padding, middle), load.name, font=self._small, fill=MUTED, anchor="lm")
            draw.text((width - padding, middle), load.text, font=self._mono, fill=INK, anchor="rm")
            box = (left, middle - self._px(5), right, middle + self._px(5))
            draw.rectangle(box, fill=TROUGH)
            filled = left + round(min(max(load.share, 0.0), 1.0) * (right - left))
            if filled > left:
                ink = next(ink for limit, ink in LOAD_INKS if load.share < limit)
                draw.rectangle((left, box[1], filled, box[3]), fill=ink)
        return panel

    def _panel(
        self, width: int, height: int, paper: tuple[int, ...]
    ) -> tuple[Image.Image, ImageDraw.ImageDraw]:
        panel = Image.new("RGBA", (width, height), (*paper[:3], 0))
        draw = ImageDraw.Draw(panel)
        draw.rounded_rectangle((0, 0, width - 1, height - 1), self._px(8), fill=paper)
        return panel, draw

    def _fitting(self, text: str, font: Font, width: int) -> str:
        while len(text) > 1 and font.getlength(text) > width:
            text = text[:-2] + "…"
        return text


def lay_over(frame: Pixels, panel: Image.Image, left: int, top: int) -> None:
    """Lay a panel over a frame, as much of it as fits."""
    left, top = max(0, left), max(0, top)
    part = frame[top : top + panel.height, left : left + panel.width]
    under = Image.fromarray(part)
    under.paste(panel, mask=panel)
    part[:] = np.asarray(under)


def _printable(line: str) -> str:
    """A source line for the panel: wide gaps before comments are closed."""
    shown = "".join(character if character.isprintable() else " " for character in line)
    return re.sub(r" {3,}", "  ", shown.strip())


def _turning(spindle: float | None) -> str:
    if spindle is None:
        return "-"
    return f"{abs(spindle):.0f} min⁻¹ {'↺' if spindle < 0 else '↻'}" if spindle else "stands still"


def _clock(seconds: float) -> str:
    minutes, rest = divmod(seconds, 60.0)
    hours, minutes = divmod(int(minutes), 60)
    return f"{hours}:{minutes:02d}:{rest:04.1f}" if hours else f"{minutes}:{rest:05.2f}"
