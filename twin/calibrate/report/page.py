"""``--report``: one self-contained page about a calibration."""

import math
from pathlib import Path
from typing import Any

import jinja2
import markupsafe

from twin.calibrate.fit.solve import Interval
from twin.calibrate.report.plots import (
    correlation_plot,
    force_plot,
    has_spectrum,
    lag_plot,
    left_plot,
    spectrum_plot,
)
from twin.calibrate.result import AxisResult, Calibration, LogFigures, verdict_sentence
from twin.compare.report.plot_style import theme_css
from twin.version import __version__

_ROOMS = ("twin.calibrate.report", "twin.compare.report")
"""Where the page's template lies, and the style sheet that it shares with reports of runs."""


def calibration_page(result: Calibration) -> str:
    """The page, as HTML that needs no other file."""
    environment = jinja2.Environment(
        loader=jinja2.ChoiceLoader(
            [jinja2.PackageLoader(room, "page") for room in _ROOMS]
        ),
        autoescape=True, undefined=jinja2.StrictUndefined,
        trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    template = environment.get_template("calibration.html.j2")
    return template.render(
        base=result.base,
        version=__version__,
        light=theme_css(dark=False),
        dark=theme_css(dark=True),
        findings=[
            (Path(log).name, finding.message)
            for log, findings in result.findings.items()
            for finding in findings
        ],
        figures=[_row(figures) for figures in result.logs],
        ramps=[line for figures in result.logs if (line := figures.ramps_line)],
        unexplained=_unexplained(result.logs),
        axes=[_axis(name, axis, result.logs) for name, axis in result.axes.items()],
    )


def _unexplained(logs: tuple[LogFigures, ...]) -> str:
    """What a page says first, of which more than half of a force is left; empty where none is."""
    bad = [f"{Path(one.log).name}, {one.axis}" for one in logs if one.force_is_unexplained]
    if not bad:
        return ""
    return (
        f"More than half of the logged force is left unexplained ({'; '.join(bad)}): mass and friction "
        "are not to be relied upon. Is the column this axis's force, is its unit right, is something "
        "injected that the map does not name (external_force)?"
    )


def _axis(name: str, axis: AxisResult, logs: tuple[LogFigures, ...]) -> dict[str, Any]:
    fit = axis.fit
    conditional = {key: interval for key, (interval, _) in fit.conditional.items()}
    return {
        "name": name,
        "sentence": verdict_sentence(name, axis, logs),
        "values": [
            (key, *_numbers(interval), axis.units[key], given)
            for key, interval, given in [
                *((key, interval, "") for key, interval in fit.fitted.items()),
                *((key, interval, " and ".join(fit.conditional[key][1]))
                  for key, interval in conditional.items()),
            ]
        ],
        "open": list(fit.undetermined.items()),
        "limits": [(key, f"{value:.5g}") for key, value in axis.limits.reached.items()],
        "correlations": _drawing(correlation_plot(fit.names, fit.correlations)),
        "logs": [_log(figures) for figures in logs if figures.axis == name],
    }  # fmt: skip


def _log(figures: LogFigures) -> dict[str, Any]:
    course = figures.course
    drawn = len(course.time) > 1
    return {
        "name": Path(figures.log).name,
        "role": figures.role,
        "lag": _drawing(lag_plot(figures)) if drawn else "",
        "left": _drawing(left_plot(figures)) if drawn else "",
        "force": _drawing(force_plot(figures)) if len(course.logged_force) else "",
        "spectrum": _drawing(spectrum_plot(figures)) if has_spectrum(course) else "",
    }


def _row(figures: LogFigures) -> tuple[str, ...]:
    unit = "µm" if figures.kind == "linear" else "mdeg"
    return (
        Path(figures.log).name, figures.role, figures.axis,
        f"{figures.logged_rms * 1e3:.2f} {unit}", f"{figures.left_rms * 1e3:.2f} {unit}",
        f"{100 * figures.share:.2f} %",
        "" if figures.force_share is None else f"{100 * figures.force_share:.1f} %",
        "" if figures.current_correlation is None else f"{figures.current_correlation:.3f}",
    )  # fmt: skip


def _numbers(interval: Interval) -> tuple[str, str, str]:
    def text(value: float) -> str:
        return "open" if math.isinf(value) else f"{value:.5g}"

    return text(interval.value), text(interval.low), text(interval.high)


def _drawing(svg: str) -> markupsafe.Markup:
    return markupsafe.Markup(svg)  # noqa: S704 (drawn here, texts are escaped by matplotlib)
