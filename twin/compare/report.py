"""``report.html``: one self-contained page about a run, for a person."""

import base64
import dataclasses
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import jinja2
import markupsafe
import numpy as np

from twin.compare.figures import ArcFigures, Figures, WorstPlace
from twin.compare.plots import (
    Plot,
    error_plot,
    following_plot,
    path_plot,
    polar_plot,
    speed_plot,
)
from twin.compare.trace import Trace
from twin.compare.verdict import Verdict
from twin.files import write_text
from twin.nc.canonical import IntArray
from twin.recording import RecordingHeader

_HEADINGS = {
    "pass": ("✔", "Pass", "every tolerance holds"),
    "fail": ("✖", "Fail", "a tolerance does not hold"),
    "alarm": ("▲", "Alarm", "the machine stopped"),
}
_HOVER_POINTS = 2000
_CONTEXT_LINES = 2
_WORST_SHOWN = 6
_SMALLEST_SHARE = 0.05
_MEDIA = {".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg"}


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """What a report is made of.

    Attributes:
        header: Header of the recording: program text, machine, versions.
        figures: What the comparison found.
        verdict: How the run came out.
        trace: The run, thinned.
        result: The content of ``result.json``.
        stills: Pictures of the run, PNG or JPEG, with a caption each.
    """

    header: RecordingHeader
    figures: Figures
    verdict: Verdict
    trace: Trace
    result: Mapping[str, Any]
    stills: Sequence[tuple[str, Path]] = ()


def write_report(path: Path, report: Report) -> None:
    """Write the page, complete or not at all.

    Raises:
        OSError: A still cannot be read, or the page not be written.
    """
    write_text(path, render_report(report))


def render_report(report: Report) -> str:
    """The page as text; it needs nothing beside itself, no network and no other file."""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("twin.compare", "."),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    environment.filters["fixed"] = _fixed
    tolerance = float(report.result["tolerance"]["contour_um"])
    source = report.header.program_text.splitlines()
    arcs = _arcs_by_line(report.figures.arcs)
    symbol, heading, meaning = _HEADINGS[report.verdict.outcome]
    return environment.get_template("report.html.j2").render(
        report=report,
        header=report.header,
        figures=report.figures,
        result=report.result,
        verdict={"symbol": symbol, "heading": heading, "meaning": meaning},
        tolerance_um=tolerance,
        hover=markupsafe.Markup(_hover_table(report.trace)),  # noqa: S704 (numbers alone)
        above=_inline(path_plot(report.trace, 0, 1, tolerance), report.trace),
        side=_inline(path_plot(report.trace, 0, 2, tolerance), report.trace),
        error=_inline(error_plot(report.trace, tolerance), report.trace),
        following=_inline(following_plot(report.trace), report.trace),
        speed=_inline(speed_plot(report.trace), report.trace),
        arcs=arcs,
        polars=[
            (arc, _inline(polar_plot(arc, tolerance), report.trace))
            for _, arc in arcs
            if len(arc.polar)
        ],
        worst=[(place, _excerpt(source, place.line)) for place in _worth_showing(report.figures)],
        reason_texts=[_line_text(source, reason.line) for reason in report.verdict.reasons],
        stills=[(caption, _data_address(path)) for caption, path in report.stills],
    )


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
    rows = np.arange(0, count, step)
    error = trace.error_um
    worst = [first + int(error[first : first + step].argmax()) for first in rows]
    return np.array(worst, np.int64)


def _hover_table(trace: Trace) -> str:
    rows = _hover_rows(trace)
    table = zip(trace.time[rows], trace.line[rows], trace.error_um[rows], strict=True)
    return json.dumps(
        [[round(float(t), 4), int(line), round(float(e), 2)] for t, line, e in table],
        separators=(",", ":"),
    )


def _inline(plot: Plot, trace: Trace) -> dict[str, Any]:
    """A plot for the template: the drawing, and where the points to hover over lie."""
    points = plot.points[_hover_rows(trace)] if len(plot.points) else plot.points
    places = json.dumps(np.round(points, 1).tolist(), separators=(",", ":"))
    return {"svg": markupsafe.Markup(plot.svg), "places": markupsafe.Markup(places)}  # noqa: S704 (numbers, and drawings made here, whose texts matplotlib escapes)


def _line_text(source: list[str], line: int) -> str:
    return source[line - 1].strip() if 0 < line <= len(source) else ""


def _excerpt(source: list[str], line: int) -> list[tuple[int, str]]:
    """The source line with its neighbours."""
    first = max(1, line - _CONTEXT_LINES)
    last = min(len(source), line + _CONTEXT_LINES)
    return [(number, source[number - 1]) for number in range(first, last + 1)] if line else []


def _data_address(path: Path) -> str:
    kind = _MEDIA.get(path.suffix.lower(), "application/octet-stream")
    return f"data:{kind};base64,{base64.b64encode(path.read_bytes()).decode('ascii')}"


def _fixed(value: float | None, digits: int = 1) -> str:
    if value is None:
        return "–"
    rounded = round(value, digits) + 0.0  # no minus before a zero
    return f"{rounded:,.{digits}f}".replace(",", "\u202f")
