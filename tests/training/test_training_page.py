"""The whole room in a browser: what is clicked on the page happens at the machine.

The page is drawn by whatever draws WebGL here, on a computer without a graphics card by the
processor, which takes a good part of a second for a picture. So every step waits for the room.
"""

import gc
import importlib.util
import json
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from chromium import CHROMIUM, QUIET

from twin.training.launch import OpenRoom, open_room
from twin.training.panel.request import do
from twin.training.scene import read_scene, scene_path
from twin.training.studio import RequestEvent

if TYPE_CHECKING:
    from playwright.sync_api import BrowserContext

PATIENCE_S = 180.0
WIDTH, HEIGHT = 1280, 760

pytestmark = [
    # Studio leaves the sockets of its own server to the collector.
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
    pytest.mark.skipif(
        CHROMIUM is None, reason="no Chromium here; Debian has it in the package chromium"
    ),
    pytest.mark.skipif(
        importlib.util.find_spec("playwright") is None, reason="no playwright to lead the browser"
    ),
]


class Operator:
    """Somebody at the page."""

    def __init__(self, room: OpenRoom, browser: "BrowserContext") -> None:
        self.room = room
        self._browser = browser
        self.open()

    def open(self, *, as_trainer: bool = False) -> None:
        """Go to the page; the panel stands where the page's width puts it once it is there."""
        self._gate = self.room.trainer_gate if as_trainer else self.room.gate
        gate, panel = self._gate, self.room.shown.panel
        assert gate is not None
        panel.width = 0.0
        self.page = self._browser.new_page()
        self.page.goto(gate.address, timeout=1e3 * PATIENCE_S)
        self.until(lambda: panel.width == WIDTH, "the page")

    def until(self, come: Callable[[], bool], what: str) -> None:
        """Wait until the room shows it."""
        end = time.monotonic() + PATIENCE_S
        while not come():
            assert time.monotonic() < end, f"waited for {what} in vain: {self.room.session.refusal}"
            time.sleep(0.02)

    def click(self, name: str, share: float = 0.5) -> None:
        """Click a part of the panel, long enough for a slow page to see it."""
        places = self.room.shown.panel.kit.places
        self.until(lambda: name in places, f"the key {name}")
        left, top, right, bottom = places[name]
        mouse = self.page.mouse
        mouse.move(left + share * (right - left), 0.5 * (top + bottom))
        self._frames(1)
        mouse.down()
        self._frames(2)
        mouse.up()
        self._frames(2)

    def ask(self, name: str, **arguments: object) -> None:
        """Ask for something as the panel does, without a click."""
        self.room.shown.viewer.send_to_sim(RequestEvent(do(name, **arguments)))

    def _frames(self, count: int) -> None:
        gate = self._gate
        assert gate is not None
        goal = gate.heard + count
        self.until(lambda: gate.heard >= goal, "the page's next frame")


def _slow_copy(folder: Path) -> Path:
    """The first scene with a feed that leaves a slow page its time, and little to draw."""
    shipped = scene_path("fagor_first_steps")
    folder.mkdir()
    program = shipped.with_suffix(".nc").read_text(encoding="utf-8")
    (folder / "fagor_first_steps.nc").write_text(program.replace("F1200", "F300"), encoding="utf-8")
    scene = folder / shipped.name
    text = shipped.read_text(encoding="utf-8")
    scene.write_text(f"{text}\n[picture]\ncolumns = 4\n", encoding="utf-8")
    return scene


@pytest.fixture
def operator(tmp_path) -> Iterator[Operator]:
    from playwright.sync_api import sync_playwright

    scene = read_scene(_slow_copy(tmp_path / "scene"))
    before = set(threading.enumerate())
    with open_room(scene, plain=True, trainer=True, out=tmp_path) as room:
        thread = threading.Thread(target=room.serve, daemon=True)
        thread.start()
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=CHROMIUM, args=QUIET)
            # A quarter of the dots each way: little work for a processor that has to draw them.
            context = browser.new_context(
                viewport={"width": WIDTH, "height": HEIGHT}, device_scale_factor=0.25
            )
            yield Operator(room, context)
            browser.close()
        room.handle.close()
        thread.join(timeout=PATIENCE_S)
    # What Studio leaves open is collected here, where it is expected, and not in another test: once
    # its threads, which it waits for no longer than 5 s, have ended.
    for left in set(threading.enumerate()) - before:
        left.join(timeout=PATIENCE_S)
    gc.collect()


def test_a_scene_is_played_in_the_browser_and_survives_its_loss(operator, tmp_path):
    room = operator.room.session.room
    operator.click("cycle start")
    operator.until(lambda: room.running == "program", "cycle start")

    operator.click("feed override", 0.2)
    operator.until(lambda: room.feed_override == 90, "the feed override")

    operator.until(lambda: int(room.machine.setpoint.line[0]) == 5 and room.moving, "N40")
    operator.click("feed hold")
    operator.until(lambda: room.held and not room.moving, "the feed hold")
    assert room.alarm is None
    operator.until(lambda: room.judge.verdicts[0].state == "done", "the hold in N40")

    operator.click("mode single")
    operator.until(lambda: room.mode == "single", "single block")
    operator.click("cycle start")
    operator.until(lambda: room.held and not room.moving, "the end of N40")
    operator.click("cycle start")
    operator.until(lambda: room.judge.verdicts[1].state == "done", "N50 in single block")

    operator.click("emergency")
    operator.until(lambda: room.alarm is not None, "the alarm")
    assert room.alarm is not None
    assert room.alarm.code == "emergency-stop"
    operator.click("emergency")
    operator.until(lambda: not room.pressed, "the button turned free")
    operator.click("reset")
    operator.until(lambda: room.judge.verdicts[2].state == "done", "the alarm cleared")

    operator.click("finish")
    operator.until(lambda: room.judge.over, "the score")
    assert [verdict.state for verdict in room.judge.verdicts] == [
        "done", "done", "done", "failed", "done",
    ]  # fmt: skip
    sheet = next(tmp_path.glob("fagor_first_steps_*/score.json"))
    operator.until(lambda: json.loads(sheet.read_text())["handed_in"], "the sheet")
    read = json.loads(sheet.read_text())
    assert (read["points"], read["of"]) == (8, 10)
    assert [action["command"]["do"] for action in read["actions"]][:2] == [
        "cycle_start",
        "override",
    ]

    # A lost browser does not stop the machine, and another one finds it as it is.
    place = float(room.machine.position[2])
    operator.ask("mode", mode="jog")
    operator.ask("jog", axis="Z", direction=1, step=30.0, feed=600.0)
    operator.until(lambda: room.running == "jog", "the jog")
    operator.page.close()
    operator.until(lambda: room.machine.position[2] > place + 29.9, "the end of the jog")
    assert room.alarm is None
    assert operator.room.handle.is_running()

    # Only the trainer's own page has the trainer's sheet.
    assert "tab trainer" not in operator.room.shown.panel.kit.places
    operator.open(as_trainer=True)
    operator.click("mode auto")
    operator.until(lambda: room.mode == "auto", "the panel of the second page")
    assert operator.room.session.log[-1].who == "trainer"
    operator.click("tab trainer")
    operator.click("freeze")
    operator.until(lambda: operator.room.session.frozen, "the frozen machine")
