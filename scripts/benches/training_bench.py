"""The training room: does machine time keep up with the wall's, and how soon does it react.

The page is opened in headless Chromium where there is one. Without a graphics card the processor
draws it, on the same cores as the machine: that is the worst case for both figures.
"""

import contextlib
import importlib.util
import statistics
import threading
import time
from collections.abc import Callable, Iterator

from benches.row import REPEATS, Row
from chromium import CHROMIUM, QUIET

from twin.training.launch import OpenRoom, open_room
from twin.training.panel.request import do
from twin.training.scene import read_scene, scene_path
from twin.training.session import Session
from twin.training.studio import RequestEvent

SCENE = "mefi_helix_hold"
OVERRIDE = 20
"""Feed override, so that the program lasts [%]."""
FEED = 400.0
"""The helix's feed at this override [mm/min]."""
WATCHED_S = 5.0
PATIENCE_S = 60.0
GONE = 0.02
"""Share of the speed that is gone when the machine counts as having reacted."""
CLICKS = 15
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
    with _open_page() as (room, click):
        room.session.room.feed_override = OVERRIDE
        _ask(room, "cycle_start")
        _until(lambda: _speed(room) > 10.0)
        time.sleep(3.0)
        factor = statistics.median(_factor(room) for _ in range(REPEATS))
        yield Row("training", "panel open in a browser", factor, "x real time")
        asked = [_reaction(room, lambda: _ask(room, "feed_hold")) for _ in range(REPEATS)]
        yield Row("training", "panel's request to braking", 1e3 * statistics.median(asked), "ms")
        clicked = [_reaction(room, click) for _ in range(CLICKS)]
        yield Row(
            "training", "click in the page to braking", 1e3 * statistics.median(clicked), "ms"
        )
        yield Row("training", f"  the slowest of {CLICKS}", 1e3 * max(clicked), "ms")
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
def _open_page() -> Iterator[tuple[OpenRoom, Callable[[], float]]]:
    """A room with its page; and how to press feed hold on it."""
    from playwright.sync_api import sync_playwright

    with open_room(read_scene(scene_path(SCENE)), plain=True) as room:
        thread = threading.Thread(target=room.serve, daemon=True)
        thread.start()
        gate = room.gate
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=CHROMIUM, args=QUIET)
            page = browser.new_context(
                viewport={"width": 1280, "height": 760}, device_scale_factor=0.25
            ).new_page()
            page.add_init_script(NOTE_CLICKS)
            page.goto(gate.address)
            _until(lambda: room.shown.panel.width == 1280)

            def click() -> float:
                left, top, right, bottom = room.shown.panel.kit.places["feed hold"]
                page.mouse.up()
                page.mouse.move(0.5 * (left + right), 0.5 * (top + bottom))
                # However slow the page is: it has seen the button up.
                seen = gate.heard + 5
                _until(lambda: gate.heard >= seen)
                page.mouse.down()
                clicked_s = 1e-3 * float(page.evaluate("clicks.at(-1)"))
                return clicked_s - time.time() + time.perf_counter()

            yield room, click
            browser.close()
        room.stop()
        thread.join(timeout=10.0)


def _factor(room: OpenRoom) -> float:
    begin, before = time.perf_counter(), room.session.room.time_s
    time.sleep(WATCHED_S)
    return (room.session.room.time_s - before) / (time.perf_counter() - begin)


def _reaction(room: OpenRoom, hold: Callable[[], float]) -> float:
    """Time from a hold to the first loss of speed, from a steady feed [s].

    Args:
        room: Where.
        hold: Asks for the hold, and says when it began to.
    """
    if not room.session.room.running:
        _ask(room, "cycle_start")
    _until(lambda: abs(_speed(room) - FEED) < 0.001 * FEED)
    steady = _speed(room)
    braked: list[float] = []

    def watch() -> None:
        _until(lambda: _speed(room) < (1.0 - GONE) * steady)
        braked.append(time.perf_counter())

    # Beside the click: whoever leads the browser hears late that it has happened.
    watcher = threading.Thread(target=watch)
    watcher.start()
    begin = hold()
    watcher.join()
    _until(lambda: not room.session.room.moving)
    _ask(room, "cycle_start")
    return braked[0] - begin


def _frame(room: OpenRoom) -> float:
    """How long the page takes for a frame [s]."""
    gate = room.gate
    begin, before = time.perf_counter(), gate.heard
    time.sleep(WATCHED_S)
    return (time.perf_counter() - begin) / max(1, gate.heard - before)


def _speed(room: OpenRoom) -> float:
    velocity = room.session.room.samples.joint_velocity[-1, :3]
    return 60.0 * float((velocity @ velocity) ** 0.5)


def _ask(room: OpenRoom, name: str) -> float:
    """Ask for something as the panel does; returns when."""
    begin = time.perf_counter()
    room.shown.viewer.send_to_sim(RequestEvent(do(name)))
    return begin


def _until(come: Callable[[], bool]) -> None:
    end = time.perf_counter() + PATIENCE_S
    while not come():
        if time.perf_counter() > end:
            raise TimeoutError("the training room did not do what it was asked for")
        time.sleep(0.001)
