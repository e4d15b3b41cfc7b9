"""The plots of the report, as SVG that is inside a page."""

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes as PlotAxes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator

from twin.compare.figures import ArcFigures
from twin.compare.report.plot_style import (
    AXIS_STYLES,
    BLUE,
    INK,
    LIGHT_SHADES,
    LIMIT,
    SHADES,
    Plot,
    finish,
    new_figure,
    shades,
    styled,
)
from twin.compare.trace import Trace, line_changes
from twin.job.tolerance import ToleranceTable
from twin.nc.canonical import FloatArray
from twin.units import SECONDS_PER_MINUTE

_SMALLEST_SPAN = 1.0
"""Of the drawn part of a coordinate [mm]."""
_SMALLEST_ERROR = 1e-3
"""Upper end of an error scale on which there is nothing to see [µm]."""
_LINE_LABELS = 24
_STANDS_STILL = 1e-3
"""A rotary axis that shows no more than this [mdeg or deg/min] gets no scale of its own."""


@styled
def path_plot(trace: Trace, across: int, up: int, tolerance_um: float) -> Plot:
    """The tool's path on the part, coloured and widened by contour error.

    Args:
        across: Column of the coordinate that runs to the right: 0 for X.
        up: The one that runs up.
        tolerance_um: Marks the colour scale.
    """
    points, error = trace.tool[:, [across, up]], trace.error_um
    greatest = max(float(error.max(initial=0.0)), _SMALLEST_ERROR)
    low, high = (points.min(axis=0), points.max(axis=0)) if len(points) else (np.zeros(2),) * 2
    # A path in one plane seen from the side is a line; it gets a band to lie in.
    middle, span = (low + high) / 2, np.maximum((high - low) * 1.08, _SMALLEST_SPAN)
    span = np.maximum(span, 0.25 * span.max())
    figure, axes = new_figure(5.4, 1.4 + min(4.4 * span[1] / span[0], 4.4))
    lines, shade = _shaded_lines(points, error / greatest)
    axes.add_collection(
        LineCollection(
            lines,
            colors=[LIGHT_SHADES[index] for index in shade],
            linewidths=1.0 + 2.2 * shade / (SHADES - 1),
            capstyle="round",
        )
    )
    axes.set_xlim(middle[0] - span[0] / 2, middle[0] + span[0] / 2)
    axes.set_ylim(middle[1] - span[1] / 2, middle[1] + span[1] / 2)
    if len(points):
        worst = int(error.argmax())
        axes.plot(*points[worst], "o", ms=11, mfc="none", mec=LIMIT, mew=1.8, clip_on=False)
        axes.plot(*points[0], "s", ms=5, mfc="none", mec=INK, clip_on=False)
    axes.set_aspect("equal")
    axes.set_xlabel(f"{'XYZ'[across]} [mm]")
    axes.set_ylabel(f"{'XYZ'[up]} [mm]")
    colors, steps = shades(greatest)
    bar = figure.colorbar(
        ScalarMappable(steps, colors), ax=axes, orientation="horizontal", aspect=40, pad=0.02,
        fraction=0.05, ticks=_round_steps(greatest), format="%g",
    )  # fmt: skip
    bar.set_label("contour error [µm]")
    bar.minorticks_off()
    assert isinstance(bar.outline, Artist)
    bar.outline.set_visible(False)
    if tolerance_um <= greatest:
        bar.ax.axvline(tolerance_um, color=LIMIT, lw=2)
    return finish(figure, axes, points)


@styled
def error_plot(trace: Trace, tolerance: ToleranceTable) -> Plot:
    """Contour error over time, with the program lines along the top and what they are allowed."""
    figure, axes = new_figure(11.0, 3.2)
    time, error = trace.time, trace.error_um
    axes.fill_between(time, error, color=BLUE, alpha=0.18, lw=0)
    axes.plot(time, error, color=BLUE, lw=1.0)
    greatest = max(float(error.max(initial=0.0)), _SMALLEST_ERROR)
    limit = _limits(trace, tolerance)
    least = float(limit.min(initial=tolerance.contour_um))
    near = least <= 4.0 * greatest
    ends = axes.get_xlim()
    axes.step(
        np.concatenate([ends[:1], time, ends[1:]]), np.pad(limit, 1, mode="edge"), where="post",
        color=LIMIT, ls=(0, (6, 3)), lw=1.4,
    )  # fmt: skip
    axes.set_xlim(*ends)
    axes.set_ylim(0.0, 1.25 * (max(greatest, least) if near else greatest))
    axes.text(
        1.0, least if near else 1.17 * greatest,
        f"tolerance {least:g} µm" + ("" if near else ", above this plot"),
        color=LIMIT, ha="right", va="bottom", transform=axes.get_yaxis_transform(),
    )  # fmt: skip
    axes.set_ylabel("contour error [µm]")
    _mark_lines(axes, trace)
    return finish(figure, axes, np.column_stack([time, error]))


@styled
def following_plot(trace: Trace) -> Plot:
    """Following error of every axis over time."""
    return _axes_plot(trace, trace.lag * 1e3, ("following error [µm]", "rotary axes [mdeg]"))


@styled
def speed_plot(trace: Trace) -> Plot:
    """Commanded speed of the path and of every axis over time."""
    return _axes_plot(
        trace,
        trace.velocity * SECONDS_PER_MINUTE,
        ("speed [mm/min]", "rotary axes [deg/min]"),
        trace.path_speed * SECONDS_PER_MINUTE,
    )


@styled
def polar_plot(arc: ArcFigures, tolerance_um: float) -> Plot:
    """Radial deviation of one arc by angle, drawn far larger than the circle itself."""
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
        axes.plot(piece_a, piece_d, color=BLUE, lw=1.6)
    axes.set_rlim(-3.0 * span, span)
    axes.set_rgrids(
        [-span / 1.2, 0.0, span / 1.2],
        labels=[f"{-span / 1.2:.2g}", "0", f"{span / 1.2:.2g} µm"],
    )
    axes.tick_params(labelsize=8)
    return finish(figure, None, np.zeros((0, 2)))


def _round_steps(greatest: float) -> FloatArray:
    """A few round values from 0 to the greatest."""
    steps = np.asarray(MaxNLocator(5).tick_values(0.0, greatest), np.float64)
    return steps[(steps >= 0.0) & (steps <= greatest)]


def _limits(trace: Trace, tolerance: ToleranceTable) -> FloatArray:
    """Contour tolerance of the line of every point, that of rapids left out [µm]."""
    limit = np.full(len(trace.line), tolerance.contour_um)
    for part in tolerance.blocks:
        first, last = part.lines
        limit[(trace.line >= first) & (trace.line <= last)] = part.contour_um
    return limit


def _axes_plot(
    trace: Trace, values: FloatArray, labels: tuple[str, str], path: FloatArray | None = None
) -> Plot:
    figure, axes = new_figure(11.0, 2.9)
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
    middle = np.full(len(trace.time), 0.5 * sum(axes.get_ylim()))
    return finish(figure, axes, np.column_stack([trace.time, middle]))


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
        if len(marks) == _LINE_LABELS:
            break
    upper = axes.secondary_xaxis("top")
    upper.set_xticks([time for time, _ in marks], [str(line) for _, line in marks])
    upper.tick_params(labelsize=8)
    upper.set_xlabel("program line", fontsize=8)


def _shaded_lines(points: FloatArray, share: FloatArray) -> tuple[list[FloatArray], np.ndarray]:
    """Split a path where its shade changes: few long lines instead of many short ones."""
    if len(points) < 2:
        return [], np.zeros(0, np.int64)
    shade = np.minimum((share * SHADES).astype(np.int64), SHADES - 1)
    pair = np.maximum(shade[:-1], shade[1:])
    starts = np.flatnonzero(np.diff(pair, prepend=-1))
    ends = np.append(starts[1:], len(pair))
    # The strongest are drawn last, over the others.
    order = np.argsort(pair[starts], kind="stable")
    return [points[starts[i] : ends[i] + 1] for i in order], pair[starts[order]]
