import dataclasses
import html.parser
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.compare.paths import AXES, UP, arc, line, moves_of
from tests.compare.runs import FRAME, PART_ZERO, samples, setpoints
from twin.compare.comparison import Comparison
from twin.compare.report.report import Report, render_report, write_report
from twin.compare.result import RunSummary, result
from twin.compare.trace import Trace
from twin.compare.verdict import Reason, judge
from twin.job.tolerance import ToleranceTable
from twin.nc.canonical import Moves
from twin.nc.text.lines import Lines
from twin.recording.reader import RecordingHeader

pytestmark = pytest.mark.seconds("a program is run and its page drawn")

CORNER = np.array([50.0, 0, 0, 0])
MOVES = moves_of(
    line(np.zeros(4), CORNER),
    arc(CORNER, np.array([50.0, 20.0, 0]), UP, 360.0),
    line(CORNER, np.array([50.0, -30.0, -5.0, 0])),
    line(np.array([50.0, -30.0, -5.0, 0]), np.array([20.0, -30.0, -5.0, 90.0])),
)
TEXT = "G1 X50 <b>\nG2 J20 & more\nG1 Y-30 Z-5\nG1 X20 C90 $ комментарий\n"


def report_of(
    moves: Moves = MOVES, per_move: int = 700, tolerance: float = 20.0, text: str = TEXT
) -> Report:
    asked = setpoints(moves, per_move=per_move) if len(moves) else setpoints(MOVES)[:0]
    joint = asked.position.copy()
    joint[:, 0] += 0.015 * np.sin(np.linspace(0, 20, len(joint)))
    joint[:, 1] -= 1e-4 * asked.velocity[:, 1]
    comparison, trace = Comparison(AXES, FRAME, PART_ZERO), Trace(AXES, FRAME, PART_ZERO)
    comparison.expect(moves)
    run = samples(asked, joint)
    trace.add(run, comparison.add(run))
    figures = comparison.result()
    table = ToleranceTable(contour_um=tolerance)
    verdict = judge(figures, table)
    header = RecordingHeader(
        axes=AXES, period_s=0.001, part_zero=PART_ZERO, part_frame=FRAME, program="часть.nc",
        program_text=text, program_sha256="ab" * 32, dialect="gost", machine="mill4",
        twin_version="0.1.0", mujoco_version="4.0.0",
    )  # fmt: skip
    summary = RunSummary(
        program="часть.nc", dialect="gost", machine="mill4", duration_s=2.8, wall_s=1.0, stages={},
        cut={"removed_mm3": 12.5, "gouges": []}, commanded={}, simulated={},
        tools=[{"number": 7, "kind": "ball", "diameter_mm": 6.0, "length_mm": 60.0, "time_s": 2.5, "removed_mm3": 12.5}],
    )  # fmt: skip
    content = result(summary, figures, table, verdict)
    return Report(
        header=header, source=Lines([text.encode()]), figures=figures, verdict=verdict, tolerance=table, trace=trace,
        result=content,
    )  # fmt: skip


class Page(html.parser.HTMLParser):
    """Text and addresses of a page; complains about tags that do not close."""

    VOID = frozenset({"meta", "br", "img", "link"})

    def __init__(self, page: str) -> None:
        super().__init__()
        self.text: list[str] = []
        self.addresses: list[str] = []
        self.open: list[str] = []
        self.source = page
        self.feed(page)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.addresses += [value or "" for name, value in attrs if name in ("src", "href")]
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        pass

    def handle_data(self, data: str) -> None:
        self.text.append(data)


def test_the_page_says_how_it_came_out_and_why():
    page = Page(render_report(report_of(tolerance=5.0)))
    text = " ".join(" ".join(page.text).split())
    assert page.open == []
    assert "Fail: часть.nc" in text
    assert "exceeds contour_um = 5" in text
    assert "G2 J20 & more" in text
    assert "комментарий" in text
    assert "circular deviation [µm]" in text


def test_a_run_within_its_tolerance_says_so():
    text = render_report(report_of(MOVES[:1], tolerance=500.0))
    assert "Pass" in text
    assert 'class="reasons"' not in text


def test_a_tolerance_that_judged_nothing_is_in_the_table():
    made = report_of(MOVES[:1], tolerance=500.0)
    unjudged = made.verdict.with_more([Reason("corner_um", "no corner", 0, 0.0)])
    tolerance = made.tolerance.model_copy(update={"corner_um": 7.5})
    page = Page(render_report(dataclasses.replace(made, verdict=unjudged, tolerance=tolerance)))
    assert "– – 7.5 – – corner_um ✖ judged nothing" in " ".join(" ".join(page.text).split())


def test_the_page_needs_no_network(tmp_path: Path):
    Image.new("RGB", (8, 8)).save(tmp_path / "still.png")
    report = dataclasses.replace(report_of(), stills=[("The end", tmp_path / "still.png")])
    page = Page(render_report(report))
    elsewhere = [a for a in page.addresses if not a.startswith(("data:", "#", "./"))]
    assert elsewhere == ["recording.h5"], "the recording beside the page, for twin view"
    in_viewer = {a for a in page.addresses if a.startswith("./")}
    assert all(re.fullmatch(r"\./(#t=[\d.]+)?", address) for address in in_viewer)
    assert sum(a.startswith("data:image/png;base64,") for a in page.addresses) == 1
    urls = set(re.findall(r"https?://[^\s\"'<>]+", page.source))
    assert urls <= {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"}


def test_the_program_cannot_put_tags_into_the_page():
    text = "G1 X50 <script>alert(1)</script>\n" * 4
    page = render_report(report_of(MOVES[:1], text=text))
    assert "<script>alert" not in page
    assert "&lt;script&gt;alert(1)" in page


def test_a_long_run_stays_small(tmp_path: Path):
    write_report(tmp_path / "report.html", report_of(per_move=40_000))
    assert (tmp_path / "report.html").stat().st_size < 2_000_000


@pytest.mark.parametrize("count", [0, 1])
def test_a_run_of_hardly_anything_has_a_page(count: int):
    assert Page(render_report(report_of(MOVES[:count], per_move=1))).open == []


def test_the_same_run_gives_the_same_page():
    assert render_report(report_of(MOVES[:1])) == render_report(report_of(MOVES[:1]))


def test_lines_are_counted_and_shown_as_the_interpreter_counts_them():
    """A form feed ends no line; a line longer than anybody reads is cut."""
    text = "G1\x0cX50\r\nG2 J20" + "0" * 5000 + "\rG1 Y-30\nG1 X20\n"
    page = render_report(report_of(tolerance=5.0, text=text))
    shown = re.findall(r'<span(?: class="at")?> +(\d)  (.*?)</span>', page)
    assert ("3", "G1 Y-30") in shown
    assert ("4", "G1 X20") in shown
    assert max(len(line) for _, line in shown) == 200


def test_the_tools_and_the_part_are_shown() -> None:
    page = render_report(dataclasses.replace(report_of(), part=b"\x89PNG picture"))
    row = re.search(r"<td>T7</td>.*?</tr>", page, re.DOTALL)
    assert row is not None
    assert re.findall(r">([^<>]+)</td>", row[0]) == ["T7", "ball", "6.00", "60.0", "2.5", "0.01"]
    assert 'alt="the part from above' in page
    assert 'alt="the part from above' not in render_report(report_of())


def test_the_time_of_a_reason_is_followed_by_its_colon_and_pictures_come_before_tables(
    tmp_path: Path,
) -> None:
    Image.new("RGB", (8, 8)).save(tmp_path / "collision.png")
    made = report_of(MOVES[:1], tolerance=0.001)
    made = dataclasses.replace(made, stills=[("Line 1", tmp_path / "collision.png")])
    source = render_report(made)
    assert re.search(r"<b>Line \d+, [\d.]+ s<a class=\"in-viewer\"[^>]*>show</a>:</b>", source)
    assert source.index("<figcaption>Line 1<") < source.index("<h2>Tolerances</h2>")
