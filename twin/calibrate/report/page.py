"""``--report``: one self-contained page about a calibration."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import jinja2
import markupsafe

from twin.calibrate.fit.ball_bar import circle_line
from twin.calibrate.fit.parameters import AxisParameters
from twin.calibrate.fit.solve import Interval
from twin.calibrate.fit.structure import Tried
from twin.calibrate.report.loop_plots import (
    autocorrelation,
    bode_plot,
    friction_plot,
    friction_points,
    margins,
    whiteness,
    whiteness_plot,
)
from twin.calibrate.report.plots import (
    correlation_plot,
    force_plot,
    has_spectrum,
    lag_plot,
    left_plot,
    spectrum_plot,
)
from twin.calibrate.report.record import Record
from twin.calibrate.result import AxisResult, Calibration, LogFigures, verdict_sentence
from twin.compare.report.plot_style import theme_css
from twin.version import __version__

_WELL = 0.15
"""Share of a logged force that a good model may leave."""
_MOST_TRIED = 12
"""Structures that the page lists."""
_FEWEST = 2
"""Points of friction that are no course yet."""
_ROOMS = ("twin.calibrate.report", "twin.compare.report")
"""Where the page's template lies, and the style sheet that it shares with reports of runs."""


def calibration_page(result: Calibration, record: Record | None = None) -> str:
    """The page, as HTML that needs no other file.

    Args:
        record: From what it was made; None: nobody signs for it.
    """
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
        record=record,
        forces=[line for figures in result.logs if (line := _judged_force(figures))],
        circles=[circle_line(circle) for circle in result.ball_bars],
    )


def _unexplained(logs: tuple[LogFigures, ...]) -> list[str]:
    """What a page says first: of which logs more than half of the lag or of the force is left."""

    def places(bad: Sequence[LogFigures]) -> str:
        return "; ".join(f"{Path(one.log).name}, {one.axis}" for one in bad)

    warnings = []
    if lags := [one for one in logs if one.lag_is_unexplained]:
        warnings.append(
            f"More than half of the logged lag is left unexplained ({places(lags)}): what was fitted is "
            "not to be relied upon. What the log lacks is listed below."
        )
    if forces := [one for one in logs if one.force_is_unexplained]:
        warnings.append(
            f"More than half of the logged force is left unexplained ({places(forces)}): mass and "
            "friction are not to be relied upon. Is the column this axis's force, is its unit right, is "
            "something injected that the map does not name (external_force)?"
        )
    return warnings


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
        "tried": _tried(fit.tried),
        "bode": _drawing(bode_plot(fit.parameters, axis.kind)) if fit.fitted else "",
        "margins": margins(fit.parameters, axis.kind),
        "logs": [_log(figures, fit.parameters) for figures in logs if figures.axis == name],
    }  # fmt: skip


def _tried(tried: Sequence[Tried]) -> list[tuple[str, str]]:
    """Structures that competed and what each left, the least first; the chosen one is said."""
    chosen = tried[0].extras if tried else ()
    best: dict[tuple[str, ...], float] = {}
    for each in tried:
        extras = tuple(sorted(each.extras))
        best[extras] = min(best.get(extras, math.inf), each.left)
    rows = sorted(best.items(), key=lambda item: item[1])[:_MOST_TRIED]
    least = rows[0][1] if rows else 1.0
    return [
        (
            (", ".join(extras) or "nothing more")
            + (" (chosen)" if extras == tuple(sorted(chosen)) else ""),
            f"{left / least:.3f}",
        )
        for extras, left in rows
    ]


def _judged_force(figures: LogFigures) -> str:
    """What a logged force is worth, in a sentence; empty where none is logged."""
    name, share = f"{Path(figures.log).name}, {figures.axis}", figures.force_share
    if share is None or not len(figures.course.logged_force):
        return ""
    if share <= _WELL:
        return f"{name}: the model gives the logged force to {100 * share:.2g} %: mass and friction rest on it."
    if not figures.force_is_unexplained:
        return (
            f"{name}: {100 * share:.0f} % of the logged force are left: mass and friction are of that order; "
            "cut, cogging or a force of other axes may be in it."
        )
    return f"{name}: {100 * share:.0f} % of the logged force are left: mass and friction are not to be relied upon."


def _log(figures: LogFigures, found: AxisParameters) -> dict[str, Any]:
    course = figures.course
    drawn = len(course.time) > 1
    points = friction_points(figures, found.mass)[0]
    return {
        "name": Path(figures.log).name,
        "role": figures.role,
        "lag": _drawing(lag_plot(figures)) if drawn else "",
        "left": _drawing(left_plot(figures)) if drawn else "",
        "force": _drawing(force_plot(figures)) if len(course.logged_force) else "",
        "spectrum": _drawing(spectrum_plot(figures)) if has_spectrum(course) else "",
        "whiteness": whiteness(course),
        "white": _drawing(whiteness_plot(figures))
        if not course.slow and len(autocorrelation(course))
        else "",
        "friction": _drawing(friction_plot(figures, found)) if len(points) > _FEWEST else "",
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
