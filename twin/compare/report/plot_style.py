"""How the plots of the report look: fonts, colours that follow the page's theme, SVG."""

import dataclasses
import io
import re
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes as PlotAxes
from matplotlib.colors import BoundaryNorm, ListedColormap, to_hex
from matplotlib.figure import Figure

from twin.nc.canonical import FloatArray

INK, FRAME_COLOR, GRID_COLOR, LIMIT = "#1d2733", "#9aa5b1", "#dfe4e9", "#b3480a"
BLUE = "#0072b2"
AXIS_STYLES = ((BLUE, "-"), ("#d55e00", "--"), ("#009e73", "-."), ("#cc79a7", ":"))
"""Okabe and Ito's colours, and a dash for each, for those who print in black."""
SHADES = 16
_CIVIDIS = mpl.colormaps["cividis"]
"""Reads the same with and without colour vision, and in grey."""
LIGHT_SHADES = [to_hex(c) for c in _CIVIDIS(np.linspace(0.86, 0.0, SHADES))]
DARK_SHADES = [to_hex(c) for c in _CIVIDIS(np.linspace(0.32, 1.0, SHADES))]
"""Little to much: on white towards dark, on black towards bright, so that much stands out."""
_THEME = {
    INK: ("ink", "#e6ebf0"),
    FRAME_COLOR: ("frame", "#66727f"),
    GRID_COLOR: ("grid", "#2e3842"),
    LIMIT: ("limit", "#ff9d5c"),
    BLUE: ("blue", "#56b4e9"),
    "#d55e00": ("orange", "#ffa366"),
    "#009e73": ("green", "#3fd6a8"),
    "#cc79a7": ("pink", "#eba6cc"),
    **{
        light: (f"shade{index}", dark)
        for index, (light, dark) in enumerate(zip(LIGHT_SHADES, DARK_SHADES, strict=True))
    },
}
"""By colour as drawn: its name in the page's style sheet, and what it is on a dark page."""


def theme_css(*, dark: bool) -> str:
    """The colours as CSS variables."""
    chosen = {name: night if dark else day for day, (name, night) in _THEME.items()}
    return " ".join(f"--{name}: {color};" for name, color in chosen.items())


_STYLE: dict[Any, Any] = {
    "svg.fonttype": "none",
    "svg.hashsalt": "twin",
    "font.size": 9,
    "font.family": "sans-serif",
    "axes.edgecolor": FRAME_COLOR,
    "axes.labelcolor": INK,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.grid": True,
    "grid.color": GRID_COLOR,
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "path.simplify": True,
}


styled = mpl.rc_context(_STYLE)
"""Decorates what draws, so that whatever it makes has the style."""


@dataclasses.dataclass(frozen=True, slots=True)
class Plot:
    """One plot.

    Attributes:
        points: Where the points of the trace lie in its view box, shape (m, 2); empty where
            hovering tells nothing.
    """

    svg: str
    points: FloatArray


def new_figure(width: float, height: float) -> tuple[Figure, PlotAxes]:
    """A figure of the given size [in] with one pair of axes."""
    figure = Figure(figsize=(width, height), layout="constrained")
    axes = figure.add_subplot()
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    return figure, axes


def shades(greatest: float) -> tuple[ListedColormap, BoundaryNorm]:
    """Colours for values from 0 to ``greatest``, in as many steps as the page's theme has."""
    return ListedColormap(LIGHT_SHADES), BoundaryNorm(
        np.linspace(0.0, greatest, SHADES + 1), SHADES
    )


def finish(figure: Figure, axes: PlotAxes | None, points: FloatArray) -> Plot:
    """Draw a figure and find the points of the trace, given in data, in the drawing."""
    drawing = _svg(figure)
    if axes is None or not len(points):
        return Plot(drawing, np.zeros((0, 2)))
    pixels = axes.transData.transform(points)
    height = figure.get_size_inches()[1] * 72.0
    scale = 72.0 / figure.dpi
    return Plot(drawing, np.column_stack([pixels[:, 0] * scale, height - pixels[:, 1] * scale]))


_NO_METADATA = {"Date": None, "Creator": None, "Format": None, "Type": None}


def _svg(figure: Figure) -> str:
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata=_NO_METADATA, transparent=True)
    drawing = text.getvalue()
    drawing = drawing[drawing.index("<svg") :]
    drawing = re.sub(r"<metadata>.*?</metadata>", "", drawing, flags=re.DOTALL)
    drawing = re.sub(r' (width|height)="[\d.]+pt"', "", drawing, count=2)
    return re.sub("#[0-9a-f]{6}", lambda found: _themed(found[0]), drawing)


def _themed(color: str) -> str:
    return f"var(--{_THEME[color][0]})" if color in _THEME else color
