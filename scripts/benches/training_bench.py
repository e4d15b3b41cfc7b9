"""The training room: does machine time keep up with the wall's, and how soon does it react.

The page is opened in headless Chromium where there is one. Without a graphics card the processor
draws it, on the same cores as the machine: that is the worst case for both figures.
"""

import contextlib
import importlib.util
import statistics
import time
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from benches.row import REPEATS, Row
from benches.training_room import SCENE, RoomProcess, room_process, wait_until
from chromium import CHROMIUM, QUIET

from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.session.session import Session

if TYPE_CHECKING:
    from playwright.sync_api import Page

WATCHED_S = 5.0
WIDTH = 1280
CLICKS = 25
PAGE_FRAME_S = 0.5
"""About how long a page that the processor draws takes for a frame [s]."""
NOTE_CLICKS = """
window.clicks = [];
addEventListener("pointerdown", (e) => clicks.push(performance.timeOrigin + e.timeStamp), true);
"""
"""Notes when the browser itself heard a press [ms since 1970]: whoever leads it is slower."""


def rows() -> Iterator[Row]:
    """Machine time per time without a page; factor and reaction with one."""
    yield Row("training", "headless, in slices of 10 ms", _headless(), "x real time")
    if CHROMIUM is None or importlib.util.find_spec("playwright") is None:
        return
    with room_process() as room, _open_page(room.ask("address")) as page:
        wait_until(lambda: room.ask("width") == WIDTH)
        room.ask("run_steadily")
        time.sleep(3.0)
        factor = statistics.median(_factor(room) for _ in range(REPEATS))
        yield Row("training", "panel open in a browser", factor, "x real time")
        asked = [_reaction_to_request(room) for _ in range(REPEATS)]
        yield Row("training", "panel's request to braking", 1e3 * statistics.median(asked), "ms")
        whim = np.random.default_rng(CLICKS)
        clicked = sorted(_reaction_to_click(room, page, whim) for _ in range(CLICKS))
        median = 1e3 * statistics.median(clicked)
        yield Row("training", "click in the page to braking", median, "ms")
        yield Row("training", "  nine of ten within", 1e3 * clicked[CLICKS * 9 // 10], "ms")
        yield Row("training", f"  the slowest of {CLICKS}", 1e3 * clicked[-1], "ms")
        yield Row("training", "  the page's own frame meanwhile", 1e3 * _frame(room), "ms")


def _headless() -> float:
    session = Session(read_scene(scene_path(SCENE)))
    session.submit({"do": "cycle_start"})
    session.advance(200)
    figures = []
    for _ in range(REPEATS):
        begin = time.perf_counter()
        session.advance(200)
        figures.append(200 * session.room.slice_s / (time.perf_counter() - begin))
    return statistics.median(figures)


@contextlib.contextmanager
def _open_page(address: str) -> "Iterator[Page]":
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=QUIET)
        page = browser.new_context(
            viewport={"width": WIDTH, "height": 760}, device_scale_factor=0.25
        ).new_page()
        page.add_init_script(NOTE_CLICKS)
        page.goto(address)
        yield page
        browser.close()


def _factor(room: RoomProcess) -> float:
    begin, before = time.perf_counter(), room.ask("machine_time")
    time.sleep(WATCHED_S)
    return (room.ask("machine_time") - before) / (time.perf_counter() - begin)


def _reaction_to_request(room: RoomProcess) -> float:
    room.ask("run_steadily")
    return room.ask("reaction_to_request")


def _reaction_to_click(room: RoomProcess, page: "Page", whim: np.random.Generator) -> float:
    """Time from a press of feed hold on the page to the first loss of speed [s]."""
    left, top, right, bottom = room.ask("place", "feed hold")
    while True:
        page.mouse.up()
        page.mouse.move(0.5 * (left + right), 0.5 * (top + bottom))
        # However slow the page is: it has seen the button up.
        seen = room.ask("heard") + 5
        wait_until(lambda seen=seen: room.ask("heard") >= seen)
        room.ask("run_steadily")
        room.begin("braked")
        # An operator presses at any time of the page's frame.
        time.sleep(whim.uniform(0.0, PAGE_FRAME_S))
        page.mouse.down()
        braked = room.end()
        clicked = 1e-3 * float(page.evaluate("clicks.at(-1)"))
        if braked > clicked:
            return braked - clicked
        # The program had come to its end by itself.


def _frame(room: RoomProcess) -> float:
    """How long the page takes for a frame [s]."""
    room.ask("run_steadily")
    begin, before = time.perf_counter(), room.ask("heard")
    time.sleep(WATCHED_S)
    return (time.perf_counter() - begin) / max(1, room.ask("heard") - before)
