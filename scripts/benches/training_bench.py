"""The training room: does machine time keep up with the wall's, and how soon does it react.

The page is opened in headless Chromium where there is one, with three that look on while the stock
is cut. Without a graphics card the processor draws, on the same cores as the machine: that is the
worst case for all figures.
"""

import importlib.util
import statistics
import time
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from benches.row import REPEATS, Row
from browsers import CHROMIUM
from panel_player import browser, without_view

from tests.training.server.measured_room import SCENE, MeasuredRoom, RoomProcess, room_process
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.session.session import SceneSession

if TYPE_CHECKING:
    from playwright.sync_api import Page

WATCHED_S = 5.0
WATCHERS = 3
CLICKS = 200
BETWEEN_S = 0.3
"""An operator presses at any time within this [s]."""
NOTE_CLICKS = """
window.clicks = [];
addEventListener("pointerdown", (e) => clicks.push(performance.timeOrigin + e.timeStamp), true);
"""
"""Notes when the browser itself heard a press [ms since 1970]: whoever leads it is slower."""


def rows() -> Iterator[Row]:
    """Machine time per time without a page; all the rest with pages."""
    yield Row("training", "headless, in slices of 10 ms", _headless(), "x real time")
    if CHROMIUM is None or importlib.util.find_spec("playwright") is None:
        return
    with room_process() as room, browser() as opened:
        context = opened.new_context(viewport={"width": 1280, "height": 720})
        page = context.new_page()
        page.add_init_script(NOTE_CLICKS)
        addresses = room.ask(MeasuredRoom.addresses)
        begin = time.perf_counter()
        page.goto(addresses["operator"])
        page.wait_for_selector("body[data-ready=yes]")
        yield Row("training", "first usable panel", time.perf_counter() - begin, "s")
        looking_on = opened.new_context()
        without_view(looking_on)
        for _ in range(WATCHERS):
            watcher = looking_on.new_page()
            watcher.goto(addresses["watcher"])
            watcher.wait_for_selector("body[data-ready=yes]")
        page.wait_for_selector("body[data-view=ready]")
        room.ask(MeasuredRoom.run_steadily)
        time.sleep(3.0)
        yield from _steady_rows(room, page)
        yield from _click_rows(room, page)


def _steady_rows(room: RoomProcess, page: "Page") -> Iterator[Row]:
    factors, sent, pictures = [], [], []
    for _ in range(REPEATS):
        room.ask(MeasuredRoom.run_steadily)
        before = (
            room.ask(MeasuredRoom.machine_time),
            room.ask(MeasuredRoom.bytes_sent),
            _pictures(page),
        )
        begin = time.perf_counter()
        time.sleep(WATCHED_S)
        passed = time.perf_counter() - begin
        factors.append((room.ask(MeasuredRoom.machine_time) - before[0]) / passed)
        sent.append((room.ask(MeasuredRoom.bytes_sent) - before[1]) / passed / (1 + WATCHERS))
        pictures.append((_pictures(page) - before[2]) / passed)
    yield Row(
        "training", f"a page and {WATCHERS} watchers", statistics.median(factors), "x real time"
    )
    yield Row("training", "  sent to each page", 1e-3 * statistics.median(sent), "kB/s")
    yield Row("training", "  pictures, drawn by the processor", statistics.median(pictures), "/s")
    yield Row(
        "training",
        "  its threads with precedence",
        room.ask(MeasuredRoom.preceding_threads),
        "of 2",
    )
    yield Row("training", "  memory of the room at most", room.ask(MeasuredRoom.memory_mb), "MB")


def _click_rows(room: RoomProcess, page: "Page") -> Iterator[Row]:
    whim = np.random.default_rng(CLICKS)
    reactions = [_reaction_to_click(room, page, whim) for _ in range(CLICKS)]
    for what, seconds in zip(
        ("click in the page", "its message"), zip(*reactions, strict=True), strict=True
    ):
        taken = sorted(1e3 * each for each in seconds)
        yield Row("training", f"{what} to braking", statistics.median(taken), "ms")
        yield Row("training", "  nine of ten within", taken[CLICKS * 9 // 10], "ms")
        yield Row("training", f"  the slowest of {CLICKS}", taken[-1], "ms")


def _pictures(page: "Page") -> int:
    return int(page.get_attribute("body", "data-pictures") or 0)


def _headless() -> float:
    session = SceneSession(read_scene(scene_path(SCENE)))
    session.submit({"do": "cycle_start"})
    session.advance(200)
    figures = []
    for _ in range(REPEATS):
        begin = time.perf_counter()
        session.advance(200)
        figures.append(200 * session.room.slice_s / (time.perf_counter() - begin))
    return statistics.median(figures)


def _reaction_to_click(
    room: RoomProcess, page: "Page", whim: np.random.Generator
) -> tuple[float, float]:
    """Times from a press of feed hold on the page, and from its message, to the first loss of speed [s]."""
    while True:
        page.mouse.up()
        page.hover("[data-key=feed_hold]")
        room.ask(MeasuredRoom.run_steadily)
        room.begin(MeasuredRoom.wait_for_braking)
        time.sleep(whim.uniform(0.0, BETWEEN_S))
        page.mouse.down()
        braked = room.end()
        clicked = 1e-3 * float(page.evaluate("() => clicks.at(-1)"))
        if braked > clicked:
            return braked - clicked, braked - room.ask(MeasuredRoom.asked)
        # The program had come to its end by itself.
