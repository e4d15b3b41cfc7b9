"""Plots of a calibration: overlays, what is left, its spectrum, correlations."""

import numpy as np
from matplotlib.figure import Figure

from twin.calibrate.result import LogFigures, TimeSeries
from twin.compare.report.plot_style import BLUE, INK, LIMIT, finish, new_figure, styled
from twin.nc.canonical import FloatArray

_POINTS = 600
"""Of a course so many points are drawn at most: of each group its lowest and highest."""
_CLASSES = 240
"""Classes of frequency that a spectrum is drawn in, even in its logarithm."""
_SEGMENTS = 8
"""Pieces that a spectrum is averaged over."""
_WIDE, _HIGH = 10.5, 2.7


@styled
def lag_plot(figures: LogFigures) -> str:
    """Logged and predicted lag over time."""
    course, unit = figures.course, _small(figures)
    figure, axes = new_figure(_WIDE, _HIGH)
    mark = "o" if course.slow else ""
    line = "none" if course.slow else "-"
    scale = 1.0 if course.slow else 1e3
    for values, color, label, width in (
        (course.logged, INK, "logged", 1.4),
        (course.predicted, LIMIT, "predicted", 0.8),
    ):
        time, thin = _thinned(course.time, values * scale)
        axes.plot(time, thin, color=color, linewidth=width, label=label, linestyle=line,
                  marker=mark, markersize=4)  # fmt: skip
    what = f"lag of velocity [{_speed(figures)}]" if course.slow else f"following error [{unit}]"
    axes.set_ylabel(what)
    axes.set_xlabel("time [s]")
    axes.legend(loc="upper right", frameon=False, ncols=2)
    return drawn(figure)


@styled
def left_plot(figures: LogFigures) -> str:
    """What the model leaves, over time."""
    course = figures.course
    figure, axes = new_figure(_WIDE, 1.9)
    scale = 1.0 if course.slow else 1e3
    time, thin = _thinned(course.time, (course.logged - course.predicted) * scale)
    style = {"linestyle": "none", "marker": "o", "markersize": 4} if course.slow else {}
    axes.plot(time, thin, color=BLUE, linewidth=0.8, **style)
    axes.set_ylabel(f"left [{_speed(figures) if course.slow else _small(figures)}]")
    axes.set_xlabel("time [s]")
    return drawn(figure)


@styled
def spectrum_plot(figures: LogFigures) -> str:
    """Spectral density of the logged lag and of what is left of it."""
    course, unit = figures.course, _small(figures)
    figure, axes = new_figure(5.1, 2.6)
    step = float(np.median(np.diff(course.time)))
    for values, color, label in (
        (course.logged, INK, "logged lag"),
        (course.logged - course.predicted, BLUE, "left"),
    ):
        frequency, density = _spectrum(values * 1e3, step)
        axes.loglog(frequency, density, color=color, linewidth=1.0, label=label)
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel(f"density [{unit}/√Hz]")
    axes.legend(frameon=False)
    return drawn(figure)


@styled
def force_plot(figures: LogFigures) -> str:
    """Logged and predicted force or current."""
    course = figures.course
    figure, axes = new_figure(_WIDE, _HIGH)
    for values, color, label, width in (
        (course.logged_force, INK, "logged", 1.2),
        (course.predicted_force, LIMIT, "predicted", 0.8),
    ):
        if course.slow:
            axes.plot(values, color=color, linewidth=width, label=label)
        else:
            time, thin = _thinned(course.force_time, values)
            axes.plot(time, thin, color=color, linewidth=width, label=label)
    amperes = figures.current_correlation is not None
    axes.set_ylabel(
        "as shown [A]" if amperes else f"force [{'N' if figures.kind == 'linear' else 'N m'}]"
    )
    axes.set_xlabel("sample that moves" if course.slow else "time [s]")
    axes.legend(loc="upper right", frameon=False, ncols=2)
    return drawn(figure)


@styled
def correlation_plot(names: tuple[str, ...], correlations: FloatArray) -> str:
    """How alike the parameters act on the log."""
    side = max(2.8, 0.6 * len(names) + 1.4)
    figure, axes = new_figure(5.1, side)
    axes.grid(visible=False)
    places = np.arange(len(names))
    for row in range(len(names)):
        for column in range(len(names)):
            value = float(correlations[row, column])
            size = min(1.0, abs(value))
            axes.scatter(column, row, s=60 + 620 * size, color=LIMIT if value < 0 else BLUE,
                         alpha=0.1 + 0.35 * size, linewidths=0)  # fmt: skip
            axes.text(column, row, f"{value:.2f}", ha="center", va="center", fontsize=9, color=INK)
    axes.set_xticks(places, names, rotation=40, ha="right")
    axes.set_yticks(places, names)
    axes.set_xlim(-0.6, len(names) - 0.4)
    axes.set_ylim(len(names) - 0.4, -0.6)
    return drawn(figure)


def has_spectrum(course: TimeSeries) -> bool:
    """Whether a course is even and long enough for a spectrum."""
    return not course.slow and len(course.time) >= 16 * _SEGMENTS


def _small(figures: LogFigures) -> str:
    return "µm" if figures.kind == "linear" else "mdeg"


def _speed(figures: LogFigures) -> str:
    return "mm/s" if figures.kind == "linear" else "deg/s"


def drawn(figure: Figure) -> str:
    """A figure as a drawing for the page."""
    return finish(figure, None, np.zeros((0, 2))).svg


def _thinned(time: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Of every group of samples the lowest and the highest, so that no peak is lost."""
    group = 2 * len(values) // _POINTS
    if group < 4:
        return time, values
    rows = len(values) // group
    parts = values[: rows * group].reshape(rows, group)
    first = np.arange(rows) * group
    both = np.sort(np.stack([parts.argmin(axis=1), parts.argmax(axis=1)]), axis=0) + first
    place = both.T.ravel()
    return time[place], values[place]


def _spectrum(values: FloatArray, step: float) -> tuple[FloatArray, FloatArray]:
    """Amplitude density by Welch's averaging of windowed pieces that overlap by half."""
    size = 2 * len(values) // (_SEGMENTS + 1)
    window = np.hanning(size)
    pieces = [values[i : i + size] for i in range(0, len(values) - size + 1, size // 2)]
    power = np.mean(
        [np.abs(np.fft.rfft((piece - piece.mean()) * window)) ** 2 for piece in pieces], axis=0
    )
    density = np.asarray(np.sqrt(2.0 * power * step / np.sum(window**2)), dtype=np.float64)
    frequency = np.asarray(np.fft.rfftfreq(size, step), dtype=np.float64)
    borders = np.unique(np.geomspace(1, len(frequency) - 1, _CLASSES).astype(np.int64))
    # Of every class of frequencies the highest, so that no peak is lost.
    return frequency[borders], np.maximum.reduceat(density, borders)
