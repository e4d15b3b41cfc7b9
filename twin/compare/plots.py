"""The plots of the report, as SVG that stands inside a page."""

import dataclasses
import io
import re
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes as PlotAxes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.projections.polar import PolarAxes

from twin.compare.figures import ArcFigures
from twin.compare.trace import Trace, line_changes
from twin.nc.canonical import FloatArray

COLORS = mpl.colormaps["cividis"]
"""Reads the same with and without colour vision, and in grey."""
INK, FRAME_COLOR, LIMIT = "#1d2733", "#9aa5b1", "#b3480a"
AXIS_STYLES = (("#0072b2", "-"), ("#d55e00", "--"), ("#009e73", "-."), ("#cc79a7", ":"))
"""Okabe and Ito's colours, and a dash for each, for those who print in black."""
_SHADES = 16
_SMALLEST_SPAN = 1.0
"""Of the drawn part of a coordinate [mm]."""
_SMALLEST_ERROR = 1e-3
"""Upper end of an error scale on which there is nothing to see [µm]."""
_LINE_LABELS = 24
_STANDS_STILL = 1e-3
"""A rotary axis that shows no more than this [mdeg or deg/min] gets no scale of its own."""


@dataclasses.dataclass(frozen=True, slots=True)
class Plot:
    """One plot.

    Attributes:
        svg: The drawing.
        width: Of its view box.
        height: Of its view box.
        points: Where the points of the trace lie in the view box, shape (m, 2); empty where
            hovering tells nothing.
    """

    svg: str
    width: float
    height: float
    points: FloatArray


def path_plot(trace: Trace, across: int, up: int, tolerance_um: float) -> Plot:
    """The tool's path on the part, coloured and widened by contour error.

    Args:
        trace: The run.
        across: Column of the coordinate that runs to the right: 0 for X.
        up: The one that runs up.
        tolerance_um: Marks the colour scale.
    """
    figure, axes = _figure(5.4, 4.6)
    points, error = trace.tool[:, [across, up]], trace.error_um
    greatest = max(float(error.max(initial=0.0)), _SMALLEST_ERROR)
    scale = Normalize(0.0, greatest)
    lines, shades = _shaded_lines(points, scale(error) if len(error) else error)
    collection = LineCollection(
        lines, colors=COLORS(shades), linewidths=1.0 + 2.2 * shades, capstyle="round"
    )
    axes.add_collection(collection)
    if len(points):
        low, high = points.min(axis=0), points.max(axis=0)
        # A path in one plane seen from the side is a line; it gets a band to lie in.
        middle, span = (low + high) / 2, np.maximum((high - low) * 1.08, _SMALLEST_SPAN)
        span = np.maximum(span, 0.25 * span.max())
        axes.set_xlim(middle[0] - span[0] / 2, middle[0] + span[0] / 2)
        axes.set_ylim(middle[1] - span[1] / 2, middle[1] + span[1] / 2)
        worst = int(error.argmax())
        axes.plot(*points[worst], "o", ms=11, mfc="none", mec=LIMIT, mew=1.8)
        axes.plot(*points[0], "s", ms=5, mfc="white", mec=INK)
    axes.set_aspect("equal")
    axes.set_xlabel(f"{'XYZ'[across]} [mm]")
    axes.set_ylabel(f"{'XYZ'[up]} [mm]")
    bar = figure.colorbar(
        ScalarMappable(scale, COLORS), ax=axes, orientation="horizontal",
        fraction=0.05, pad=0.02, aspect=40,
    )  # fmt: skip
    bar.set_label("contour error [µm]")
    if tolerance_um <= greatest:
        bar.ax.axvline(tolerance_um, color=LIMIT, lw=2)
    return _finished(figure, axes, points)


def error_plot(trace: Trace, tolerance_um: float) -> Plot:
    """Contour error over time, with the program lines along the top."""
    figure, axes = _figure(11.0, 3.2)
    time, error = trace.time, trace.error_um
    axes.fill_between(time, error, color="#0072b2", alpha=0.18, lw=0)
    axes.plot(time, error, color="#0072b2", lw=1.0)
    greatest = max(float(error.max(initial=0.0)), _SMALLEST_ERROR)
    axes.axhline(tolerance_um, color=LIMIT, ls=(0, (6, 3)), lw=1.4)
    near = tolerance_um <= 4.0 * greatest
    axes.set_ylim(0.0, 1.25 * (max(greatest, tolerance_um) if near else greatest))
    axes.text(
        1.0, tolerance_um if near else 1.17 * greatest,
        f"tolerance {tolerance_um:g} µm" + ("" if near else ", above this plot"),
        color=LIMIT, ha="right", va="bottom", transform=axes.get_yaxis_transform(),
    )  # fmt: skip
    axes.set_ylabel("contour error [µm]")
    _mark_lines(axes, trace)
    return _finished(figure, axes, np.column_stack([time, error]))


def following_plot(trace: Trace) -> Plot:
    """Following error of every axis over time."""
    return _axes_plot(trace, trace.lag * 1e3, ("following error [µm]", "rotary axes [mdeg]"))


def speed_plot(trace: Trace) -> Plot:
    """Commanded speed of the path and of every axis over time."""
    path = np.linalg.norm(trace.velocity[:, :3], axis=1)
    return _axes_plot(
        trace, trace.velocity * 60.0, ("speed [mm/min]", "rotary axes [deg/min]"), path * 60.0
    )


def polar_plot(arc: ArcFigures, tolerance_um: float) -> Plot:
    """Radial deviation of one arc by angle, drawn far larger than the circle itself."""
    with mpl.rc_context(_STYLE):
        figure = Figure(figsize=(3.4, 3.4), layout="constrained")
        axes = figure.add_subplot(projection="polar")
        assert isinstance(axes, PolarAxes)
        angle, deviation = np.deg2rad(arc.polar[:, 0]), arc.polar[:, 1]
        span = max(abs(arc.radial_max_um), abs(arc.radial_min_um), 0.1) * 1.2
        every = np.linspace(0.0, 2.0 * np.pi, 181)
        axes.plot(every, np.zeros_like(every), color=INK, lw=1.2)
        if tolerance_um <= span:
            for limit in (-tolerance_um, tolerance_um):
                axes.plot(every, np.full_like(every, limit), color=LIMIT, ls="--", lw=1)
        gaps = np.flatnonzero(np.diff(angle) > np.deg2rad(10.0)) + 1
        for piece_a, piece_d in zip(np.split(angle, gaps), np.split(deviation, gaps), strict=True):
            axes.plot(piece_a, piece_d, color="#0072b2", lw=1.6)
        axes.set_rlim(-3.0 * span, span)
        axes.set_rgrids(
            [-span / 1.2, 0.0, span / 1.2],
            labels=[f"{-span / 1.2:.2g}", "0", f"{span / 1.2:.2g} µm"],
        )
        axes.tick_params(labelsize=7)
        return Plot(*_svg(figure), np.zeros((0, 2)))


_STYLE: dict[Any, Any] = {
    "svg.fonttype": "none",
    "svg.hashsalt": "twin",
    "font.size": 9,
    "axes.edgecolor": FRAME_COLOR,
    "axes.labelcolor": INK,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.grid": True,
    "grid.color": "#dfe4e9",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "path.simplify": True,
}


def _figure(width: float, height: float) -> tuple[Figure, PlotAxes]:
    with mpl.rc_context(_STYLE):
        figure = Figure(figsize=(width, height), layout="constrained")
        axes = figure.add_subplot()
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
        return figure, axes


def _axes_plot(
    trace: Trace, values: FloatArray, labels: tuple[str, str], path: FloatArray | None = None
) -> Plot:
    figure, axes = _figure(11.0, 2.9)
    turning = np.array(trace.axes.kinds) == "rotary"
    shown = np.abs(values).max(axis=0, initial=0.0) > _STANDS_STILL
    other = axes.twinx() if (turning & shown).any() else None
    handles: list[Line2D] = []
    if path is not None:
        handles += axes.plot(trace.time, path, color=INK, lw=1.6, label="path")
    for index, (name, kind) in enumerate(zip(trace.axes.names, trace.axes.kinds, strict=True)):
        color, dash = AXIS_STYLES[index % len(AXIS_STYLES)]
        if kind == "rotary" and not shown[index]:
            continue
        on = other if kind == "rotary" and other is not None else axes
        handles += on.plot(trace.time, values[:, index], color=color, ls=dash, lw=1.1, label=name)
    axes.set_xlabel("time [s]")
    axes.set_ylabel(labels[0])
    if other is not None:
        other.set_ylabel(labels[1])
        other.grid(visible=False)
        other.spines["top"].set_visible(False)
    axes.legend(
        handles=handles, ncols=len(handles), loc="lower left", bbox_to_anchor=(0, 1), frameon=False
    )
    return _finished(figure, axes, np.zeros((0, 2)))


def _mark_lines(axes: PlotAxes, trace: Trace) -> None:
    """Program lines along the upper edge, as many as have room, the longest first."""
    axes.set_xlabel("time [s]")
    changes = [change for change in line_changes(trace) if change[1] > 0]
    if not changes:
        return
    ends = [time for time, _ in changes[1:]] + [float(trace.time[-1])]
    stays = [end - time for (time, _), end in zip(changes, ends, strict=True)]
    room = (trace.time[-1] - trace.time[0]) / _LINE_LABELS
    marks: list[tuple[float, int]] = []
    for index in np.argsort(stays)[::-1]:
        if all(abs(changes[index][0] - time) >= room for time, _ in marks):
            marks.append(changes[index])
    upper = axes.secondary_xaxis("top")
    upper.set_xticks([time for time, _ in marks], [str(line) for _, line in marks])
    upper.tick_params(labelsize=7)
    upper.set_xlabel("program line", fontsize=8)


def _shaded_lines(points: FloatArray, share: FloatArray) -> tuple[list[FloatArray], FloatArray]:
    """Split a path where its shade changes: few long lines instead of many short ones."""
    if len(points) < 2:
        return [], np.zeros(0)
    shade = np.minimum((share * _SHADES).astype(int), _SHADES - 1)
    pair = np.maximum(shade[:-1], shade[1:])
    starts = np.flatnonzero(np.diff(pair, prepend=-1))
    ends = np.append(starts[1:], len(pair))
    lines = [points[start : end + 1] for start, end in zip(starts, ends, strict=True)]
    return lines, pair[starts] / (_SHADES - 1)


def _finished(figure: Figure, axes: PlotAxes, points: FloatArray) -> Plot:
    svg, width, height = _svg(figure)
    pixels = axes.transData.transform(points) if len(points) else points
    scale = 72.0 / figure.dpi
    placed = np.column_stack([pixels[:, 0] * scale, height - pixels[:, 1] * scale])
    return Plot(svg, width, height, placed)


_NO_METADATA = {"Date": None, "Creator": None, "Format": None, "Type": None}


def _svg(figure: Figure) -> tuple[str, float, float]:
    text = io.StringIO()
    with mpl.rc_context(_STYLE):
        figure.savefig(text, format="svg", metadata=_NO_METADATA)
    drawing = text.getvalue()
    drawing = drawing[drawing.index("<svg") :]
    drawing = re.sub(r"<metadata>.*?</metadata>", "", drawing, flags=re.DOTALL)
    drawing = re.sub(r' (width|height)="[\d.]+pt"', "", drawing, count=2)
    width, height = figure.get_size_inches() * 72.0
    return drawing, float(width), float(height)
