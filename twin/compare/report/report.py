"""``report.html``: one self-contained page about a run, for a person."""

import base64
import dataclasses
import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import jinja2
import markupsafe
import numpy as np

from twin.compare.figures import ArcFigures, Figures, WorstPlace
from twin.compare.report.plot_style import Plot, theme_css
from twin.compare.report.plots import error_plot, following_plot, path_plot, polar_plot, speed_plot
from twin.compare.trace import Trace
from twin.compare.verdict import Verdict
from twin.files.atomic import write_text
from twin.job.tolerance import ToleranceTable
from twin.nc.canonical import FloatArray, IntArray
from twin.recording.reader import RecordingHeader
from twin.units import SECONDS_PER_MINUTE

_MM3_PER_CM3 = 1000.0
_HEADINGS = {
    "pass": ("✔", "Pass", "every tolerance holds"),
    "fail": ("✖", "Fail", "what the job asks for does not hold"),
    "alarm": ("▲", "Alarm", "the machine raised an alarm"),
}
_HOVER_POINTS = 2000
_HOVER_TEXT = 80
"""Characters of a program line that hovering shows."""
_CONTEXT_LINES = 2
_LINE_SHOWN = 200
"""Characters of a program line that are shown."""
_WORST_SHOWN = 6
_SMALLEST_SHARE = 0.05
_TABLE_ROWS = 100
"""A table shows so many arcs or events; all of them are in result.json."""
_MEDIA = {".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg"}
_CUT_FIGURES: tuple[tuple[str, str, Callable[[Any], str]], ...] = (
    (
        "removed_mm3",
        "Material removed",
        lambda v: f"{v / _MM3_PER_CM3:,.2f} cm³" if v >= _MM3_PER_CM3 else f"{v:,.1f} mm³",
    ),
    ("air_share", "Share of the feed path in air", lambda v: f"{v:.1%}"),
    ("force_n", "Greatest cutting force", lambda v: f"{v:,.0f} N"),
    ("power_w", "Greatest power of the cut", lambda v: f"{v:,.0f} W"),
    ("deflection_um", "Greatest deflection of the tool", lambda v: f"{v:,.0f} µm"),
    ("chip_mm", "Thickest chip", lambda v: f"{v:.3f} mm"),
    ("spindle_load", "Greatest load of the spindle", lambda v: f"{v:.0%}"),
    (
        "material",
        "Forces and power by Kienzle's constants of",
        lambda v: f"{v['name']}: kc1.1 {v['kc']:g} N/mm², mc {v['mc']:g} ({v['source']})",
    ),
    ("force_simulated", "Force of the cut simulated", lambda v: "yes" if v else "no"),
    ("cell_mm", "Grid of the height map", lambda v: f"{v:g} mm"),
)
_CUT_EVENTS = {
    "rapid": "rapid into the stock",
    "arrival": "tool changed in the material",
    "flute": "cut deeper than the flutes are long",
    "shank": "shank in the material",
    "holder": "holder in the material",
}


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """What a report is made of.

    Attributes:
        header: Header of the recording: machine, versions.
        source: Lines of the program, of which the page shows a few.
        trace: The run, thinned; empty for a run in which nothing moved.
        result: The content of ``result.json``.
        stills: Pictures of the run, PNG or JPEG, with a caption each.
        scope: What the verdict looked at, one sentence each.
        warnings: Line, code and message of each.
        part: A picture of the part as it was cut, PNG; empty: there is none.
    """

    header: RecordingHeader
    source: Sequence[str]
    figures: Figures
    verdict: Verdict
    tolerance: ToleranceTable
    trace: Trace
    result: Mapping[str, Any]
    stills: Sequence[tuple[str, Path]] = ()
    scope: Sequence[str] = ()
    warnings: Sequence[tuple[int, str, str]] = ()
    part: bytes = b""


def write_report(path: Path, report: Report) -> None:
    """Write the page, complete or not at all.

    Raises:
        OSError: A still cannot be read, or the page not be written.
    """
    write_text(path, render_report(report))


def render_report(report: Report) -> str:
    """The page as text; it needs nothing but itself, no network and no other file."""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("twin.compare.report", "page"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    environment.filters["fixed"] = _fixed
    environment.filters["written"] = "{:.15g}".format
    source = report.source
    symbol, heading, meaning = _HEADINGS[report.verdict.outcome]
    cut = report.result["cut"] or {}
    return environment.get_template("report.html.j2").render(
        header=report.header,
        figures=report.figures,
        verdict=report.verdict,
        unjudged=_unjudged(report.verdict, report.tolerance),
        scope=report.scope,
        warnings=report.warnings[:_TABLE_ROWS],
        result=report.result,
        outcome={"symbol": symbol, "heading": heading, "meaning": meaning},
        tolerance_um=report.tolerance.contour_um,
        theme={"light": _safe(theme_css(dark=False)), "dark": _safe(theme_css(dark=True))},
        source_line=lambda line: _line_text(source, line),
        excerpt=lambda line: _excerpt(source, line),
        worst=_worth_showing(report.figures),
        arcs=_arcs_by_line(report.figures.arcs)[:_TABLE_ROWS],
        cut_figures=_cut_figures(cut),
        cut_events=_cut_events(cut)[:_TABLE_ROWS],
        stills=[(caption, _data_address(path)) for caption, path in report.stills],
        part=_address_of(report.part, "image/png") if report.part else None,
        tools=report.result["tools"][:_TABLE_ROWS],
        hover=_safe(_hover_data(report.trace, source)) if len(report.trace.time) else None,
        plots=_plots(report) if len(report.trace.time) else None,
    )


def _unjudged(verdict: Verdict, tolerance: ToleranceTable) -> dict[str, float]:
    """Tolerances that are a reason although nothing was held to them, and what they allow, by their keys."""
    judged = {check.what for check in verdict.checks}
    given = tolerance.model_dump(exclude_none=True)
    keys = [reason.what for reason in verdict.reasons if reason.what not in judged]
    return {key: given[key] for key in keys if key in given}


def _plots(report: Report) -> dict[str, Any]:
    trace, tolerance = report.trace, report.tolerance
    rows = _hover_rows(trace)
    drawn = {
        "above": path_plot(trace, 0, 1, tolerance.contour_um),
        "side": path_plot(trace, 0, 2, tolerance.contour_um),
        "error": error_plot(trace, tolerance),
        "following": following_plot(trace),
        "speed": speed_plot(trace),
    }
    limit = tolerance.circular_deviation_um or tolerance.contour_um
    arcs = [arc for _, arc in _arcs_by_line(report.figures.arcs) if len(arc.polar)]
    polars = [(arc, _safe(polar_plot(arc, limit).svg)) for arc in arcs]
    return {name: _inline(plot, rows) for name, plot in drawn.items()} | {"polars": polars}


def _worth_showing(figures: Figures) -> list[WorstPlace]:
    """The worst lines, without those that are hardly off compared with the worst."""
    least = figures.contour.max * _SMALLEST_SHARE
    return [place for place in figures.worst if place.error_um > least][:_WORST_SHOWN]


def _arcs_by_line(arcs: Sequence[ArcFigures]) -> list[tuple[int, ArcFigures]]:
    """For every line with arcs how many there were, and the worst of them."""
    by_line: dict[int, list[ArcFigures]] = {}
    for arc in arcs:
        by_line.setdefault(arc.line, []).append(arc)
    return [
        (len(group), max(group, key=lambda arc: (arc.circular_deviation_um, len(arc.polar))))
        for _, group in sorted(by_line.items())
    ]


def _hover_rows(trace: Trace) -> IntArray:
    """Rows of the trace that hovering tells about; the worst ones among them."""
    count = len(trace.time)
    step = max(1, -(-count // _HOVER_POINTS))
    error = trace.error_um
    worst = [first + int(error[first : first + step].argmax()) for first in range(0, count, step)]
    return np.array(worst, np.int64)


def _hover_data(trace: Trace, source: Sequence[str]) -> str:
    """What hovering tells: columns by point, units of the axes, and the program lines met."""
    rows = _hover_rows(trace)
    line = trace.line[rows]
    texts = {int(number): _line_text(source, int(number))[:_HOVER_TEXT] for number in set(line)}
    content = {
        "axes": [
            [name, "µm" if kind == "linear" else "mdeg"]
            for name, kind in zip(trace.axes.names, trace.axes.kinds, strict=True)
        ],
        "time": _column(trace.time[rows], 4),
        "line": line.tolist(),
        "error": _column(trace.error_um[rows], 2),
        "lag": [_column(row, 1) for row in trace.lag[rows] * 1e3],
        "speed": _column(trace.path_speed[rows] * SECONDS_PER_MINUTE, 0),
        "text": texts,
    }
    # A program may hold what ends a script.
    text = json.dumps(content, separators=(",", ":"), ensure_ascii=False)
    return text.replace("<", "\\u003c").replace("\u2028", " ").replace("\u2029", " ")


def _column(values: FloatArray, digits: int) -> list[float]:
    return [round(float(value), digits) + 0.0 for value in values]


def _inline(plot: Plot, rows: IntArray) -> dict[str, markupsafe.Markup]:
    """A plot for the template: the drawing, and where the points to hover over lie."""
    places = json.dumps(np.round(plot.points[rows], 1).tolist(), separators=(",", ":"))
    return {"svg": _safe(plot.svg), "places": _safe(places)}


def _safe(text: str) -> markupsafe.Markup:
    """Text that goes into the page as it is: made here, its strings escaped where they come in."""
    return markupsafe.Markup(text)  # noqa: S704 (numbers; JSON without '<'; SVG by matplotlib)


def _line_text(source: Sequence[str], line: int) -> str:
    return _shown(source[line - 1].strip()) if 0 < line <= len(source) else ""


def _shown(text: str) -> str:
    """A program line, cut where it is longer than anybody reads."""
    return text if len(text) <= _LINE_SHOWN else text[: _LINE_SHOWN - 1] + "…"


def _excerpt(source: Sequence[str], line: int) -> list[tuple[int, str]]:
    """The source line with its neighbours."""
    first = max(1, line - _CONTEXT_LINES)
    last = min(len(source), line + _CONTEXT_LINES)
    numbers = range(first, last + 1) if line else ()
    return [(number, _shown(source[number - 1])) for number in numbers]


def _data_address(path: Path) -> str:
    return _address_of(
        path.read_bytes(), _MEDIA.get(path.suffix.lower(), "application/octet-stream")
    )


def _address_of(data: bytes, kind: str) -> str:
    return f"data:{kind};base64,{base64.b64encode(data).decode('ascii')}"


def _fixed(value: float | None, digits: int = 1) -> str:
    if value is None:
        return "–"
    rounded = round(value, digits) + 0.0  # no minus before a zero
    return f"{rounded:,.{digits}f}".replace(",", "\u202f")


def _cut_figures(cut: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Name and value of every figure that was computed."""
    return [(name, text(cut[key])) for key, name, text in _CUT_FIGURES if cut.get(key) is not None]


def _cut_events(cut: Mapping[str, Any]) -> Sequence[Mapping[str, Any]]:
    """What the cut must not do, by time: ``what`` in words, ``line``, ``time_s``, ``depth_mm``."""
    events = [*cut.get("gouges", ()), *cut.get("rapid_into_stock", ())]
    events.sort(key=lambda event: event["time_s"])
    return [{**event, "what": _CUT_EVENTS.get(event["what"], event["what"])} for event in events]
