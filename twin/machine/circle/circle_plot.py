"""The polar plot of a circular test, as a user of a ball bar knows it."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from twin.files.atomic import complete_or_absent
from twin.machine.circle.circular_test import CircularTest
from twin.nc.canonical import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_DIVISIONS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0)
"""Round scales [µm per division]."""
_RINGS = 4
"""Divisions that the largest deviation fills at most."""
_BASE = 6.0
"""Radius of the commanded circle in divisions."""


def write_circle_plot(result: CircularTest, path: Path) -> None:
    """Draw both directions with their deviation magnified; SVG or PNG by the suffix.

    Raises:
        OSError: The file cannot be written.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    scale = _scale(result)
    figure = Figure(figsize=(8.0, 8.8), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    axes.axis("off")
    turn = np.linspace(0.0, 2.0 * np.pi, 721)
    for ring in range(-_RINGS, _RINGS + 1):
        radius = _BASE + ring
        width, colour = (1.4, "#404850") if ring == 0 else (0.6, "#c4ccd4")
        axes.plot(radius * np.cos(turn), radius * np.sin(turn), color=colour, lw=width, zorder=1)
    _cross(axes, result)
    for deviation, colour, label, arrow in (
        (result.counter_clockwise_um, "#0072b2", "counter-clockwise", 40.0),
        (result.clockwise_um, "#d55e00", "clockwise", -40.0),
    ):
        x, y = _drawn(result.angle_deg, deviation, scale)
        axes.plot(x, y, color=colour, lw=1.6, label=label, zorder=3)
        _show_direction(axes, result.angle_deg, (x, y), colour, arrow)
    _name_peaks(axes, result)
    figure.suptitle(
        f"{result.machine}: circle {result.plane}, R {result.radius_mm:g} mm, F {result.feed:g} mm/min\n"
        f"{scale:g} µm per division",
        fontsize=13,
    )
    axes.legend(loc="upper right", frameon=False)
    reach = _BASE + _RINGS + 0.9
    axes.set_xlim(-reach, reach)
    axes.set_ylim(-reach, reach)
    figure.supxlabel(_figures(result), fontsize=11)
    with complete_or_absent(path) as temporary:
        figure.savefig(temporary, metadata={"Date": None} if path.suffix == ".svg" else None)


def _scale(result: CircularTest) -> float:
    """The finest round scale on which the deviations fit."""
    largest = max(abs(value) for value in result.radial_deviation_um)
    return next((step for step in _DIVISIONS if largest <= _RINGS * step), _DIVISIONS[-1])


def _drawn(angle: FloatArray, deviation: FloatArray, scale: float) -> tuple[FloatArray, FloatArray]:
    """The closed curve of a direction in divisions."""
    radius = _BASE + np.append(deviation, deviation[0]) / scale
    turned = np.deg2rad(np.append(angle, angle[0]))
    return radius * np.cos(turned), radius * np.sin(turned)


def _cross(axes: "Axes", result: CircularTest) -> None:
    reach = _BASE + _RINGS + 0.15
    for name, angle in zip(result.quadrant_names, (0.0, 90.0, 180.0, 270.0), strict=True):
        x, y = np.cos(np.deg2rad(angle)), np.sin(np.deg2rad(angle))
        axes.plot([x, x * reach], [y, y * reach], color="#c4ccd4", lw=0.6, zorder=1)
        axes.text(x * (reach + 0.4), y * (reach + 0.4), name, ha="center", va="center", fontsize=12)


def _show_direction(
    axes: "Axes", angle: FloatArray, curve: tuple[FloatArray, FloatArray], colour: str, at: float
) -> None:
    """An arrow on a curve, in its direction of travel; it points away from 0°."""
    here = int(np.argmin(np.abs(angle - at % 360.0)))
    there = here + round(np.sign(at) * len(angle) / 180.0)
    x, y = curve
    axes.annotate(
        "", (x[there], y[there]), (x[here], y[here]),
        arrowprops={"arrowstyle": "-|>,head_width=0.35,head_length=0.7", "color": colour}, zorder=4,
    )  # fmt: skip


def _name_peaks(axes: "Axes", result: CircularTest) -> None:
    """Name each quadrant peak after the axis that turns round there, next to its place."""
    named = zip(result.quadrant_names, result.quadrant_peaks_um, (0, 90, 180, 270), strict=True)
    for name, peak, angle in named:
        turned = np.deg2rad(angle + 11.0)
        radius = _BASE + _RINGS - 0.9
        axes.text(
            radius * np.cos(turned), radius * np.sin(turned), f"peak {name}\n{peak:+.1f} µm",
            ha="center", va="center", fontsize=9, color="#404850", linespacing=1.3, zorder=5,
            bbox={"boxstyle": "round,pad=0.2", "fc": "white", "ec": "none", "alpha": 0.8},
        )  # fmt: skip


def _figures(result: CircularTest) -> str:
    largest, smallest = result.radial_deviation_um
    return (
        f"circular deviation G(b)  {result.circular_deviation_um:.2f} µm    "
        f"hysteresis H  {result.hysteresis_um:.2f} µm\n"
        f"radial deviation F  {largest:+.2f} / {smallest:+.2f} µm    "
        f"mean radius error  {result.mean_radius_error_um:+.2f} µm"
    )
