"""Plots that an engineer judges a loop by: whiteness of what is left, Bode plot, friction over speed."""

import itertools
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.calibrate.fit.parameters import AxisParameters
from twin.calibrate.report.plots import drawn
from twin.calibrate.result import LogFigures, TimeSeries
from twin.compare.report.plot_style import BLUE, INK, LIMIT, new_figure, styled
from twin.nc.canonical import FloatArray
from twin.units import AxisKind, kv_per_second

ComplexArray = npt.NDArray[np.complex128]
_LAGS = 40
"""Samples by which what is left is shifted against itself."""
_SURE = 1.96
"""Standard deviations that hold 95 % of a normal distribution."""
_CLASSES = 12
"""Classes of speed in the plot of friction."""
_STEADY = 0.1
"""Share of the greatest acceleration below which an axis counts as running at one speed."""
_STANDING = 0.02
"""Share of the greatest speed below which it stands."""
_FEW = 5
"""Samples that a class of speed needs."""


class Margins(NamedTuple):
    """What a Bode plot tells: crossover [Hz] and phase margin [deg]."""

    crossover_hz: float
    phase_deg: float


def autocorrelation(course: TimeSeries) -> FloatArray:
    """Of what is left, at shifts from 1 on, shape (_LAGS,); empty where it is too short."""
    left = course.logged - course.predicted
    if len(left) < 4 * _LAGS:
        return np.zeros(0)
    left = left - left.mean()
    power = float(left @ left)
    if power == 0.0:
        return np.zeros(0)
    return np.array([float(left[shift:] @ left[:-shift]) / power for shift in range(1, _LAGS + 1)])


def whiteness(course: TimeSeries) -> str:
    """Whether what is left is noise, in a sentence."""
    found = autocorrelation(course)
    if course.slow or not len(found):
        return "Too few samples in a row tell whether what is left is noise."
    band = _SURE / np.sqrt(len(course.time))
    outside = int(np.count_nonzero(np.abs(found) > band))
    text = (
        f"Neighbours in what is left correlate by {found[0]:.2f}; {outside} of {_LAGS} shifts lie outside "
        f"the 95 % band of ±{band:.3f} (2 would by chance)"
    )
    if outside <= _LAGS // 10:
        return f"{text}: it is as good as noise."
    return f"{text}: something is left that the model does not have, however small."


@styled
def whiteness_plot(figures: LogFigures) -> str:
    """Autocorrelation of what is left, with the band that noise keeps to."""
    found, count = autocorrelation(figures.course), len(figures.course.time)
    figure, axes = new_figure(5.1, 2.6)
    axes.axhspan(-_SURE / count**0.5, _SURE / count**0.5, color=BLUE, alpha=0.25, linewidth=0)
    axes.vlines(np.arange(1, len(found) + 1), 0.0, found, color=INK, linewidth=1.2)
    axes.axhline(0.0, color=INK, linewidth=0.6)
    axes.set_ylim(min(-0.2, float(found.min()) - 0.05), 1.0)
    axes.set_xlabel("shift [samples]")
    axes.set_ylabel("autocorrelation")
    return drawn(figure)


def open_loop(found: AxisParameters, kind: AxisKind, frequency: FloatArray) -> ComplexArray:
    """The position loop of an axis of a kind cut open, at frequencies [Hz].

    The loop is a second-order system of gain ``kv`` and damping (see ``AxisTable``): its velocity loop has the
    gain 2 z w, with w = 2 z kv, an integrator, a filter and a dead time where they were fitted.
    """
    s = 2j * np.pi * frequency
    gain = kv_per_second(found.kv)
    natural = 2.0 * found.damping_ratio * gain
    velocity = 2.0 * found.damping_ratio * natural * np.ones_like(s)
    if found.reset_time_s > 0.0:
        velocity = velocity * (1.0 + 1.0 / (s * found.reset_time_s))
    behind = s / (1.0 + s * found.velocity_filter_s)
    per_si = 1e3 if kind == "linear" else 180.0 / np.pi
    damping = per_si * found.viscous_friction / found.mass if found.mass > 0.0 else 0.0
    return velocity * (gain + behind) * np.exp(-s * found.loop_delay_s) / (s * (s + damping))


def margins(found: AxisParameters, kind: AxisKind) -> Margins:
    """Where the open loop crosses 1, and how far its phase is from -180 degrees there."""
    frequency = np.geomspace(0.05, 2000.0, 4000)
    loop = open_loop(found, kind, frequency)
    last = int(np.flatnonzero(np.abs(loop) >= 1.0)[-1]) if np.any(np.abs(loop) >= 1.0) else 0
    phase = float(np.degrees(np.unwrap(np.angle(loop)))[last])
    return Margins(float(frequency[last]), 180.0 + (phase if phase <= 0.0 else phase - 360.0))


@styled
def bode_plot(found: AxisParameters, kind: AxisKind) -> str:
    """Magnitude and phase of the position loop, cut open."""
    crossover = margins(found, kind).crossover_hz
    frequency = np.geomspace(crossover / 50.0, crossover * 50.0, 200)
    loop = open_loop(found, kind, frequency)
    figure, axes = new_figure(5.1, 3.0)
    axes.semilogx(frequency, 20.0 * np.log10(np.abs(loop)), color=INK, linewidth=1.4)
    axes.axhline(0.0, color=INK, linewidth=0.5)
    axes.axvline(crossover, color=INK, linewidth=0.5, linestyle=":")
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel("magnitude [dB]")
    phase_axes = axes.twinx()
    phase = np.degrees(np.unwrap(np.angle(loop)))
    phase_axes.semilogx(frequency, phase - 360.0 * round((phase[0] + 180.0) / 360.0), color=LIMIT)
    phase_axes.set_ylabel("phase [deg]", color=LIMIT)
    phase_axes.grid(visible=False)
    return drawn(figure)


def friction_points(figures: LogFigures, mass: float) -> tuple[FloatArray, FloatArray]:
    """Speed and force of the drive where an axis runs evenly, a median of each class of speed.

    Args:
        mass: What the motor feels, by which inertia is taken out [kg or kg m²].
    """
    course = figures.course
    if course.slow or len(course.force_time) < 2 or figures.current_correlation is not None:
        return np.zeros(0), np.zeros(0)
    speed = np.interp(course.force_time, course.time, course.speed)
    acceleration = np.gradient(speed, course.force_time)
    fastest = float(np.abs(speed).max())
    steady = np.abs(speed) > _STANDING * fastest
    steady &= np.abs(acceleration) < _STEADY * max(float(np.abs(acceleration).max()), 1e-12)
    si = 1e-3 if figures.kind == "linear" else np.pi / 180.0
    force = course.logged_force - mass * acceleration * si
    borders = np.linspace(-fastest, fastest, _CLASSES + 1)
    found = [
        (float(np.median(speed[rows])), float(np.median(force[rows])))
        for low, high in itertools.pairwise(borders)
        if np.count_nonzero(rows := steady & (speed >= low) & (speed < high)) >= _FEW
    ]
    return (np.array([each[0] for each in found]), np.array([each[1] for each in found]))


@styled
def friction_plot(figures: LogFigures, found: AxisParameters) -> str:
    """What was logged where the axis runs evenly, and the friction that was fitted."""
    speed, force = friction_points(figures, found.mass)
    linear = figures.kind == "linear"
    fastest = 1.1 * float(np.abs(speed).max(initial=1e-9))
    line = np.array([-fastest, -1e-9, 1e-9, fastest])
    model = (
        found.dry_friction * np.sign(line) + found.viscous_friction * line - found.constant_force
    )
    figure, axes = new_figure(5.1, 2.6)
    axes.plot(line, model, color=LIMIT, linewidth=1.2, label="fitted")
    axes.plot(speed, force, "o", color=INK, markersize=4, label="logged, at even speed")
    axes.set_xlabel(f"speed [{'mm/s' if linear else 'deg/s'}]")
    axes.set_ylabel(f"force [{'N' if linear else 'N m'}]")
    axes.legend(frameon=False)
    return drawn(figure)
