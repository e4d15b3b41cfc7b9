"""The report in a real browser: nothing is asked for, nothing goes wrong, hovering tells."""

from collections.abc import Iterator
from pathlib import Path
from typing import Literal

import pytest
from browsers import CHROMIUM, QUIET
from playwright.sync_api import Browser, Page, sync_playwright

from tests.compare.report.test_report import MOVES, report_of
from twin.compare.report.report import write_report

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        found = playwright.chromium.launch(executable_path=CHROMIUM, headless=True, args=QUIET)
        yield found
        found.close()


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("page") / "report.html"
    write_report(path, report_of(tolerance=5.0))
    return path


@pytest.fixture
def page(browser: Browser, report: Path) -> Iterator[Page]:
    """The page, which has asked for itself and nothing else, and had nothing to complain about."""
    context = browser.new_context(viewport={"width": 1280, "height": 900})
    page = context.new_page()
    asked: list[str] = []
    complaints: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.on("console", lambda message: complaints.append(message.text))
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.goto(report.as_uri())
    yield page
    assert asked == [report.as_uri()]
    assert complaints == []
    context.close()


def test_the_verdict_comes_first_with_its_line(page: Page):
    first = page.locator("section").first
    assert first.locator("h1").inner_text() == "✖ Fail: часть.nc"
    assert "exceeds contour_um = 5" in first.inner_text()
    line = first.locator("b").first.inner_text().split(",")[0].removeprefix("Line ")
    assert first.locator(".at").first.inner_text().split()[0] == line
    box = first.locator("ul.reasons").bounding_box()
    assert box is not None
    assert box["y"] < 200.0
    assert page.locator("figure.hover svg").count() == 5


def test_hovering_tells_line_time_and_error_and_marks_all_plots(page: Page):
    for index, told in enumerate(["µm", "µm", "µm", "mdeg", "mm/min"]):
        figure = page.locator("figure.hover").nth(index)
        figure.scroll_into_view_if_needed()
        box = figure.bounding_box()
        assert box is not None
        page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
        tip = figure.locator(".tip")
        assert tip.is_visible()
        assert tip.inner_text().startswith("line ")
        assert told in tip.inner_text()
        assert any(text in tip.inner_text() for text in ("G1 X50", "G2 J20", "G1 Y-30", "G1 X20"))
        seen = page.locator(".cursor").evaluate_all(
            "all => all.map(one => getComputedStyle(one).visibility)"
        )
        assert seen == ["visible"] * 5
    page.mouse.move(1, 1)
    assert not page.locator(".tip").nth(4).is_visible()


def test_hovering_over_the_ring_tells_the_worst_place(page: Page):
    """The error plot's highest point, told by the page itself, is the one in the verdict."""
    worst = page.evaluate("run.error.indexOf(Math.max(...run.error))")
    figure = page.locator("figure.hover").nth(2)
    figure.scroll_into_view_if_needed()
    box = figure.bounding_box()
    assert box is not None
    x, width = page.evaluate(f"[plots[2].places[{worst}][0], plots[2].svg.viewBox.baseVal.width]")
    page.mouse.move(box["x"] + x / width * box["width"], box["y"] + box["height"] / 2)
    greatest = page.evaluate(f"run.error[{worst}]")
    assert f"{greatest:.2f} µm" in figure.locator(".tip").inner_text()


def test_no_part_of_the_page_is_wider_than_the_window(page: Page):
    for width in (1280, 420):
        page.set_viewport_size({"width": width, "height": 900})
        assert page.evaluate("document.documentElement.scrollWidth") <= width


def brightness(page: Page, of: str, what: str) -> float:
    """Of a colour of the page, 0 to 1."""
    color = page.locator(of).first.evaluate(f"one => getComputedStyle(one).{what}")
    numbers = [float(part) for part in color[color.index("(") + 1 : -1].split(",")[:3]]
    return sum(numbers) / 3.0 / 255.0


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_stands_out_on_a_light_and_on_a_dark_page(
    page: Page, scheme: Literal["light", "dark"]
):
    page.emulate_media(color_scheme=scheme)
    paper = brightness(page, "section", "backgroundColor")
    assert (paper > 0.5) == (scheme == "light")
    for of, what in (("h1", "color"), ("svg text", "fill"), (".soft", "color")):
        assert abs(brightness(page, of, what) - paper) > 0.35


def test_on_paper_it_is_light_and_whole(page: Page, tmp_path: Path):
    page.emulate_media(media="print", color_scheme="dark")
    assert brightness(page, "section", "backgroundColor") > 0.9
    pdf = page.pdf(path=tmp_path / "report.pdf", format="A4")
    assert pdf.startswith(b"%PDF")
    page.set_viewport_size({"width": 690, "height": 900})
    assert page.evaluate("document.documentElement.scrollWidth") <= 690


def test_a_page_without_motion_needs_no_script(browser: Browser, tmp_path: Path):
    write_report(tmp_path / "still.html", report_of(MOVES[:0]))
    context = browser.new_context()
    page = context.new_page()
    page.goto((tmp_path / "still.html").as_uri())
    assert page.locator("script").count() == 0
    assert "no motion" in page.locator("section").first.inner_text()
    context.close()
