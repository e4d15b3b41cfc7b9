"""A recorded run on a page: what it is sent, and that it can be played and scrubbed."""

import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
import trimesh
from panel_player import browser

from twin.commands.live.view import report_of, view
from twin.commands.runs.run import run_and_print
from twin.cutting.heights.patches import LEVELS
from twin.cutting.recut import recut
from twin.errors import UsageError
from twin.run.replay import open_scene
from twin.view.app import open_view
from twin.view.recorded_run import RecordedRun, _feeds

SCREENS = ((1440, 900), (1280, 640), (800, 600), (390, 844), (844, 390))
"""Width and height of the pages that are looked at [px]."""

PROGRAM = "%SQUARE\nN10 G90 G17 T1 S3000 M03\nN20 G00 X0 Y0 Z5\nN30 G01 Z-2 F600\nN40 X20 F2000\nN50 Y10\nN60 M30\n"
JOB = """
program = "square.nc"
dialect = "fagor8070"
[stock]
shape = "box"
size = [60.0, 40.0, 20.0]
cell = 0.5
[[tools]]
number = 1
diameter = 8.0
"""


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    folder = tmp_path_factory.mktemp("view")
    (folder / "square.nc").write_text(PROGRAM, encoding="utf-8")
    (folder / "square.toml").write_text(JOB, encoding="utf-8")
    out = folder / "out"
    run_and_print(
        folder / "square.toml", out, dialect=None, machine=None, video=False, strict=False
    )
    with open_scene(out / "recording.h5") as (scene, preparation):
        yield RecordedRun(scene, preparation.machine), scene


@pytest.fixture
def report(recorded) -> Path:
    _, scene = recorded
    found = report_of(scene, scene.recording.path)
    assert found is not None
    return found


@pytest.mark.seconds("a program is run to be viewed")
def test_the_report_of_another_program_is_not_shown(recorded, report, tmp_path):
    _, scene = recorded
    assert report_of(scene, tmp_path / "recording.h5") is None
    text = report.read_text("utf-8")
    (tmp_path / "report.html").write_text(text.replace(scene.recording.header.program_sha256, "0"))
    assert report_of(scene, tmp_path / "recording.h5") is None


def columns(content: bytes) -> np.ndarray:
    count, axes = struct.unpack("<II", content[:8])
    return np.frombuffer(content[8:], "<f4").reshape(9 + axes, count)


@pytest.mark.seconds("a program is run to be viewed")
def test_the_samples_are_those_of_the_recording(recorded):
    run, scene = recorded
    found = columns(run.samples())
    recording = scene.recording
    assert found.shape[1] == len(recording)
    assert np.allclose(found[0], recording.column("time"), atol=1e-4)
    assert np.array_equal(found[1], recording.column("line"))
    assert np.allclose(found[9:].T, recording.column("joint/position"), atol=1e-3)
    errors = recording.contour_um(0, len(recording))
    assert found[3].max() == pytest.approx(errors.max(), rel=1e-5)
    assert set(found[4]) == {3000.0}, "S of the program"
    feeds = {line: float(np.median(found[5][found[1] == line])) for line in (4, 5)}
    assert feeds == pytest.approx({4: 600.0, 5: 2000.0}, rel=0.02), "F of the program"


def test_of_many_samples_a_part_is_sent_that_keeps_the_greatest_error(recorded, monkeypatch):
    run, scene = recorded
    monkeypatch.setattr("twin.view.recorded_run.MOST_SAMPLES", 500)
    thinned = RecordedRun(scene, run._machine)
    found = columns(thinned.samples())
    errors = scene.recording.contour_um(0, len(scene.recording))
    whole = len(errors) // thinned._every * thinned._every
    assert found.shape[1] <= 500
    assert found[3].max() == pytest.approx(errors[:whole].max(), rel=1e-5)


def test_the_cuts_end_with_the_part_as_it_was_cut(recorded):
    run, scene = recorded
    grid = run.stock_grid()
    shown = np.zeros((grid["rows"], grid["columns"]))
    times = []
    for cut in run.cuts():
        length, time_s = struct.unpack("<If", cut[:8])
        assert length == len(cut) - 8
        row, column, rows, width = struct.unpack("<HHHH", cut[16:24])
        cells = zlib.decompress(cut[24:])
        levels = np.frombuffer(cells, "<u2", rows * width).reshape(rows, width)
        if times:
            tools = set(cells[2 * rows * width :])
            assert tools <= {0, *run.description()["tools"]}
            assert tools != {0}
        shown[row : row + rows, column : column + width] = levels
        times.append(time_s)
    part = recut(scene.recording, scene.summary, scene.stock).map
    heights = part.bottom + (part.top - part.bottom) * shown / LEVELS
    assert times == sorted(times)
    assert len(times) > 20
    # A cut is reckoned a little otherwise where a chunk of samples ends.
    assert np.abs(heights - part.heights).max() < 1e-3


@pytest.mark.seconds("a run on a machine with a rotary table")
def test_a_part_that_is_cut_from_several_sides_is_seen_as_it_is_cut(tmp_path):
    shipped = (Path(__file__).parents[2] / "programs/fanuc/four_sides.toml").read_text("utf-8")
    job, out = tmp_path / "turned.toml", tmp_path / "out"
    job.write_text(shipped.replace("four_sides.nc", "turned.nc"), encoding="utf-8")
    (tmp_path / "turned.nc").write_text(
        "%\nO1\nG21 G90 G94 G54\nT1 M6\nG43 H1\nS3000 M3\nG0 X40. Y0 Z60.\nG0 A90.\n"
        "G1 Z22. F800.\nG0 Z60.\nM30\n%\n",
        encoding="utf-8",
    )
    run_and_print(job, out, dialect=None, machine=None, video=False, strict=False)
    with open_scene(out / "recording.h5") as (scene, preparation):
        run = RecordedRun(scene, preparation.machine)
        assert (run.has_part_mesh, run.stock_grid()) == (True, None)
        content = b"".join(run.cuts())
    times, volumes = [], []
    while content:
        length, time = struct.unpack_from("<If", content)
        message, content = content[8 : 8 + length], content[8 + length :]
        _, vertices, faces = struct.unpack_from("<BxxxII", message)
        inflated = zlib.decompress(message[12:])
        points = np.frombuffer(inflated, "<f4", 3 * vertices).reshape(-1, 3)
        part = trimesh.Trimesh(
            points, np.frombuffer(inflated, "<u4", 3 * faces, 12 * vertices).reshape(-1, 3)
        )
        assert part.is_watertight
        times.append(time)
        volumes.append(float(part.volume))
    taken = np.pi * 8.0**2 * 3.0
    assert (times[0], times) == (0.0, sorted(times))
    assert len(times) > 3
    assert pytest.approx(volumes[0], rel=1e-5) == 345.0 * 50.0 * 50.0
    assert volumes[0] - volumes[-1] == pytest.approx(taken, rel=0.15)


def test_what_cannot_be_viewed_is_refused(tmp_path):
    with pytest.raises(UsageError, match="no such file"):
        view(tmp_path / "nothing.h5", 0)


@pytest.mark.browser
def test_a_run_is_played_and_scrubbed_on_its_page(recorded):
    run, _ = recorded
    wrong: list[str] = []
    with open_view(run) as address, browser() as opened:
        page = opened.new_page(viewport={"width": 800, "height": 500})
        page.on("console", lambda message: wrong.append(message.text))
        page.goto(address)
        assert "#" not in page.url
        page.wait_for_selector("body[data-ready=yes]")
        page.wait_for_selector("body[data-view=ready]")
        assert "Z" in page.inner_text("#axes")
        page.click("#line5")
        page.wait_for_selector("body[data-line='5']")
        page.locator("#time").fill("0")
        page.click("#play")
        page.wait_for_selector("body[data-line='4']")
        page.click("#play")
        assert page.inner_text("#play") == "Play"
        page.click("text=Worst")
        assert page.inner_text("body").count("Worst 2 of") == 1
        page.locator("#time").fill("0")
        seen = []
        for _ in range(4):
            seen.append(page.get_attribute("body", "data-line"))
            page.click("#on")
        assert seen == ["2", "3", "4", "5"], "block by block"
        page.click("#back")
        page.click("#back")
        assert page.get_attribute("body", "data-line") == "4"
        box = page.locator("#chart").bounding_box()
        assert box is not None
        page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
        assert "mm/min · S 3000 /min · contour error" in page.inner_text("#pointed")
        page.mouse.down()
        page.mouse.up()
        end = float(page.get_attribute("#time", "max") or 0)
        shown = float(page.evaluate("document.getElementById('time').value"))
        assert shown == pytest.approx(0.5 * end, abs=0.1 * end)
        for width, height in SCREENS:
            page.set_viewport_size({"width": width, "height": height})
            for name in ("play", "on", "back", "time", "chart", "program", "canvas"):
                found = page.locator(f"#{name}").bounding_box()
                assert found is not None
                assert found["x"] >= 0
                assert found["x"] + found["width"] <= width, (name, width, height)
                assert found["y"] + found["height"] <= height, (name, width, height)
                assert min(found["width"], found["height"]) > 10, (name, width, height)
    assert not wrong


@pytest.mark.browser
def test_the_report_leads_to_its_places_in_the_viewer(recorded, report):
    run, scene = recorded
    wrong: list[str] = []
    with open_view(run, report=report) as address, browser() as opened:
        page = opened.new_page(viewport={"width": 1100, "height": 800})
        page.on("console", lambda message: wrong.append(message.text))
        page.goto(address)
        page.wait_for_selector("body[data-ready=yes]")
        page.click("#report")
        page.wait_for_selector("h1")
        link = page.locator("table a.in-viewer").first
        assert link.is_visible()
        assert not page.locator(".alone").is_visible()
        asked = float((link.get_attribute("href") or "").partition("t=")[2])
        link.click()
        page.wait_for_selector("body[data-ready=yes]")
        shown = float(page.evaluate("document.getElementById('time').value"))
        assert shown == pytest.approx(asked, abs=2.0 * scene.recording.header.period_s)
        page.goto(report.as_uri())
        assert not page.locator("a.in-viewer").first.is_visible()
    assert not wrong


@pytest.mark.browser
def test_a_machine_that_makes_the_run_again_is_followed_until_somebody_scrubs(recorded):
    run, _ = recorded
    place = [0.2005]
    with open_view(run, now=lambda: {"time": place[0]}) as address, browser() as opened:
        page = opened.new_page(viewport={"width": 1100, "height": 800})
        page.goto(address)
        page.wait_for_selector("body[data-ready=yes]")
        page.wait_for_selector("#time[aria-valuetext^='0.200 s']")
        place[0] = 0.4005
        page.wait_for_selector("#time[aria-valuetext^='0.400 s']")
        page.click("#back")
        assert page.get_attribute("#live", "aria-pressed") == "false"
        before = page.evaluate("document.getElementById('time').value")
        place[0] = 0.6005
        page.wait_for_timeout(200)
        assert page.evaluate("document.getElementById('time').value") == before
        page.click("#live")
        page.wait_for_selector("#time[aria-valuetext^='0.600 s']")


@pytest.mark.parametrize(("columns_each", "jump"), [(1, 0.0), (2, 50.0)])
def test_feed_is_that_of_the_tip_over_the_part_and_a_change_of_tool_is_none(
    columns_each: int, jump: float
) -> None:
    time = 0.001 * columns_each * np.arange(6, dtype=np.float64)
    tool = np.array([1, 1, 1, 2, 2, 2])
    tips = np.zeros((3, 6))
    tips[0] = 20.0 * time
    tips[2] = np.where(tool == 2, jump, 0.0)
    feeds = _feeds(time, tool, tips)
    assert feeds[[1, 2, 4, 5]] == pytest.approx(1200.0)
    assert feeds[0] == feeds[3] == 0.0
