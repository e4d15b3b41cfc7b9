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

from twin.training.panel.request import do
from twin.training.panel.studio import RequestEvent
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.server.gate import Gate
from twin.training.server.launch import OpenRoom, open_room
from twin.training.session.snapshot import Snapshot

if TYPE_CHECKING:
    from playwright.sync_api import BrowserContext, Page

PATIENCE_S = 60.0
WIDTH, HEIGHT = 1280, 760
STEAL = (1068.0, 744.0)
"""Where Studio's strip has its key ``Steal control`` on a page of that size [px]."""

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
        self.gate = _gate(self.room, as_trainer=as_trainer)
        panel = self.room.shown.panel
        self.page = self._browser.new_page()
        self.page.goto(self.gate.address, timeout=1e3 * PATIENCE_S)
        self.until(lambda: self.gate.has_panel, "the panel")
        self.idle()
        assert panel.width == WIDTH

    def watch(self, *, as_trainer: bool) -> "Page":
        """Open a second page beside the first; it may only look on."""
        page = self._browser.new_page()
        gate = _gate(self.room, as_trainer=as_trainer)
        page.goto(gate.address, timeout=1e3 * PATIENCE_S)
        page.wait_for_function("window.Module && Module.isSpectator", timeout=1e3 * PATIENCE_S)
        assert self.gate.has_panel
        return page

    def take_control(self, page: "Page") -> None:
        """Press ``Steal control`` on the strip of a page that looks on, and go on at it."""
        gate = _gate(self.room, as_trainer=True)
        end = time.monotonic() + PATIENCE_S
        page.mouse.move(*STEAL)
        while not gate.has_panel:
            assert time.monotonic() < end, "waited for control in vain"
            page.mouse.down()
            page.wait_for_timeout(1000.0)
            page.mouse.up()
            page.wait_for_timeout(2000.0)
        self.left, self.page, self.gate = self.page, page, gate

    def middle(self, name: str) -> tuple[float, float]:
        """The middle of a part of the panel [px]."""
        left, top, right, bottom = self.room.shown.panel.kit.places[name]
        return 0.5 * (left + right), 0.5 * (top + bottom)

    def until(self, come: Callable[[], bool], what: str) -> None:
        """Wait until the room shows it."""
        end = time.monotonic() + PATIENCE_S
        while not come():
            assert time.monotonic() < end, f"waited for {what} in vain: {self.room.session.refusal}"
            time.sleep(0.02)

    def click(self, name: str, share: float = 0.5) -> None:
        """Click a part of the panel, as a hand does: held until the page has shown it."""
        self.point(name, share)
        self._frames(1)
        self.page.mouse.down()
        self._frames(2)
        self.page.mouse.up()
        self._frames(2)

    def tap(self, name: str, share: float = 0.5) -> None:
        """Click a part of the panel, as quickly as a browser can be made to."""
        self.point(name, share)
        self.page.mouse.down()
        self.page.mouse.up()

    def point(self, name: str, share: float = 0.5) -> None:
        """Move the mouse onto a part of the panel."""
        places = self.room.shown.panel.kit.places
        self.until(lambda: name in places, f"the key {name}")
        left, top, right, bottom = places[name]
        self.page.mouse.move(left + share * (right - left), 0.5 * (top + bottom))

    def ask(self, name: str, **arguments: object) -> None:
        """Ask for something as the panel does, without a click."""
        self.room.shown.viewer.send_to_sim(RequestEvent(do(name, **arguments)))

    def shows(self, what: Callable[[Snapshot], bool]) -> bool:
        """Whether the panel shows something of the machine already."""
        now = self.room.shown.now
        return now is not None and what(now)

    def done(self, name: str) -> int:
        """How often a command has been given."""
        log = self.room.session.log
        return sum(entry.command["do"] == name for entry in log)

    def idle(self) -> None:
        """Wait until what was pressed would have been heard a second time."""
        self._frames(6)

    def _frames(self, count: int) -> None:
        gate = self.gate
        goal = gate.heard + count
        self.until(lambda: gate.heard >= goal, "the page's frames")


def _gate(room: OpenRoom, *, as_trainer: bool) -> Gate:
    gate = room.trainer_gate if as_trainer else room.gate
    assert gate is not None
    return gate


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
        room.stop()
        thread.join(timeout=PATIENCE_S)
    # What Studio leaves open is collected here, where it is expected, and not in another test: once
    # its threads, which it waits for no longer than 5 s, have ended.
    for left in set(threading.enumerate()) - before:
        left.join(timeout=PATIENCE_S)
    gc.collect()


def test_a_scene_is_played_in_the_browser_survives_its_loss_and_goes_to_the_trainer(
    operator, tmp_path
):
    room = operator.room.session.room
    operator.click("cycle start")
    operator.until(lambda: room.running == "program", "cycle start")

    # Two presses within one frame of the page are two, and neither counts twice.
    operator.tap("feed override", 0.2)
    operator.tap("feed override", 0.2)
    operator.until(lambda: room.feed_override == 80, "the feed override")
    operator.idle()
    assert (room.feed_override, operator.done("override")) == (80, 2)

    operator.until(lambda: int(room.machine.setpoint.line[0]) == 5 and room.moving, "N40")
    operator.click("feed hold")
    operator.until(lambda: room.held and not room.moving, "the feed hold")
    assert room.alarm is None
    operator.until(lambda: room.judge.verdicts[0].state == "done", "the hold in N40")

    operator.click("mode single")
    operator.until(lambda: room.mode == "single", "single block")
    operator.click("cycle start")
    operator.until(lambda: operator.done("cycle_start") == 2, "cycle start")
    operator.until(lambda: room.held and not room.moving, "the end of N40")
    operator.click("cycle start")
    operator.until(lambda: room.judge.verdicts[1].state == "done", "N50 in single block")

    operator.click("emergency")
    # Until the panel shows it, a second press would press the button again, not turn it free.
    operator.until(lambda: operator.shows(lambda now: now.pressed), "the alarm")
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

    # Keys are as quick as clicks, and heard once.
    modes = operator.done("mode")
    operator.page.keyboard.press("F3")
    operator.until(lambda: room.mode == "jog", "the key of the mode")
    operator.idle()
    assert operator.done("mode") == modes + 1

    operator.page.keyboard.press("F4")
    operator.until(lambda: operator.shows(lambda now: now.mode == "mdi"), "MDI")
    # Faster than the page can draw: what is typed comes in order, between the keys that act on it.
    keyboard = operator.page.keyboard
    keyboard.press("Comma")
    keyboard.press("Enter")
    keyboard.type("G91 G0 Z12")
    keyboard.press("Backspace")
    keyboard.press("Enter")
    operator.until(lambda: operator.done("mdi") == 1, "the MDI block")
    assert room.rapid_override == 90
    assert operator.room.session.log[-1].command["text"] == "G91 G0 Z1"
    operator.until(lambda: not room.running, "its end")
    operator.page.keyboard.press("t")
    operator.until(lambda: operator.room.shown.panel.side.sheet == "offsets", "the next sheet")
    operator.ask("mode", mode="jog")
    operator.until(lambda: room.mode == "jog", "jog again")

    # A lost browser does not stop the machine, and another one finds it as it is.
    place = float(room.machine.position[2])
    operator.ask("jog", axis="Z", direction=1, step=30.0, feed=600.0)
    operator.until(lambda: room.running == "jog", "the jog")
    operator.page.close()
    operator.until(lambda: room.machine.position[2] > place + 29.9, "the end of the jog")
    assert room.alarm is None
    assert operator.room.handle.is_running()
    operator.open()
    operator.click("mode auto")
    operator.until(lambda: room.mode == "auto", "the panel of the second page")
    assert operator.room.session.log[-1].who == "operator"
    assert "tab trainer" not in operator.room.shown.panel.kit.places

    # The trainer watches, can press nothing, and takes control from the operator at the machine.
    trainer = operator.watch(as_trainer=True)
    before = len(operator.room.session.log)
    operator.point("mode single")
    place = operator.middle("mode jog")
    trainer.mouse.click(*place)
    trainer.keyboard.press("F3")
    operator.idle()
    assert len(operator.room.session.log) == before
    operator.take_control(trainer)
    assert operator.gate is operator.room.trainer_gate
    operator.click("tab trainer")
    operator.click("freeze")
    operator.until(lambda: operator.room.session.frozen, "the frozen machine")
    operator.click("go on")
    operator.until(lambda: not operator.room.session.frozen, "the machine that goes on")
    operator.click("mode single")
    operator.until(lambda: room.mode == "single", "the trainer's mode")
    assert operator.room.session.log[-1].who == "trainer"
    # The page that had control presses nothing any more.
    before = len(operator.room.session.log)
    operator.left.mouse.click(*place)
    operator.left.keyboard.press("F1")
    operator.idle()
    assert len(operator.room.session.log) == before
