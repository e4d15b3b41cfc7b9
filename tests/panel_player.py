"""An operator at the real page: plays a scene's steps with the keys that the panel has."""

import contextlib
import dataclasses
import itertools
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Literal
from unittest import mock

from browsers import CHROMIUM, FIREFOX, QUIET

from twin.training.scene.scene_file import Scene, StepTable, read_scene, scene_path
from twin.training.server import launch
from twin.training.server.launch import OpenRoom, open_room

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, Page, Playwright

PATIENCE_S = 90.0
STEPS = (10.0, 1.0, 0.1, 0.01)
PLAYED_FASTER = 5.0
"""Machine time per time on the wall in a play; a machine that cannot keep it runs as fast as it can."""

What = Literal["solution", "mistake"]


_rooms = itertools.count()


@contextlib.contextmanager
def served(scene: Scene, out: Path | None = None) -> Iterator[OpenRoom]:
    """A room whose machine runs on a thread of its own."""
    with contextlib.ExitStack() as stack:
        if next(_rooms):  # What the first has warmed up in this process is warm for all.
            stack.enter_context(mock.patch.object(launch, "warm_up"))
        room = stack.enter_context(open_room(scene, out=out))
        thread = threading.Thread(target=room.serve, daemon=True)
        thread.start()
        try:
            yield room
        finally:
            room.stop()
            thread.join(timeout=PATIENCE_S)


def opened_browser(playwright: "Playwright", name: str) -> "Browser":
    """A headless browser: Chromium, or the Firefox of the system, led by WebDriver BiDi."""
    if name == "firefox":
        return playwright.firefox.launch(executable_path=FIREFOX, channel="moz-firefox")
    return playwright.chromium.launch(executable_path=CHROMIUM, args=QUIET)


@contextlib.contextmanager
def browser(name: str = "chromium") -> Iterator["Browser"]:
    """A headless browser while it is used."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        opened = opened_browser(playwright, name)
        yield opened
        opened.close()


def open_page(
    room: OpenRoom, context: "Browser | BrowserContext", role: str = "operator", query: str = ""
) -> "Page":
    """Open the page of a role and wait for its panel; what its scripts say wrong is an error."""
    page = context.new_page()
    page.set_default_timeout(1e3 * PATIENCE_S)
    place, token = room.addresses[role].split("#")
    page.goto(f"{place}{query}#{token}")
    page.wait_for_selector("body[data-ready=yes]")
    return page


def without_view(page: "Page | BrowserContext") -> None:
    """Leave the view out: drawing by a processor is what costs."""
    page.route("**/view_worker.js", lambda route: route.abort())


@dataclasses.dataclass(frozen=True, slots=True)
class Played:
    """What became of a play.

    Attributes:
        failed: Numbers of the tasks that failed.
        expected: Those that must fail by the scene's own word.
        score: Points reached.
        full: What all tasks are worth.
        alarms: Messages of those that came.
    """

    failed: tuple[int, ...]
    expected: tuple[int, ...]
    score: int
    full: int
    alarms: tuple[str, ...]

    @property
    def intended(self) -> bool:
        """Whether it ended as the scene says; only a solution reaches full points."""
        return self.failed == self.expected and (self.score == self.full) == (not self.expected)


def play(opened: "Browser", name: str, what: What, out: Path | None = None) -> Played:
    """Play a scene's solution or its mistake on the operator's page, without its view."""
    scene = read_scene(scene_path(name))
    with served(scene, out) as room:
        room.driver.speed = PLAYED_FASTER
        context = opened.new_context()
        without_view(context)
        player = Player(room, open_page(room, context))
        player.play(getattr(scene.file, what))
        judge = player.machine.judge
        alarms = tuple(notice.message for notice in player.machine.alarms.history)
        context.close()
    states = [verdict.state for verdict in judge.verdicts]
    return Played(
        failed=tuple(number for number, state in enumerate(states, 1) if state == "failed"),
        expected=scene.file.mistake_fails if what == "mistake" else (),
        score=judge.score,
        full=scene.points,
        alarms=alarms,
    )


class Player:
    """Somebody at the page."""

    def __init__(self, room: OpenRoom, page: "Page") -> None:
        self.room = room
        self.page = page

    @property
    def machine(self):
        """The machine as it is."""
        return self.room.session.room

    def until(self, come: Callable[[], bool], what: str) -> None:
        """Wait until the room shows it."""
        end = time.monotonic() + PATIENCE_S
        while not come():
            alarm = self.machine.alarm
            assert time.monotonic() < end, f"waited for {what}: {self.room.session.refusal} {alarm}"
            time.sleep(0.005)

    def done(self, name: str) -> int:
        """How often a command has been done."""
        return sum(e.command["do"] == name and not e.refusal for e in self.room.session.log)

    def press(self, name: str, does: str) -> None:
        """Click a key, and wait until the machine has done what it does."""
        before = self.done(does)
        self.page.click(f'[data-key="{name}"]')
        self.until(lambda: self.done(does) > before, name)

    def play(self, steps: tuple[StepTable, ...]) -> None:
        """Play steps to their end, and hand in."""
        for number, step in enumerate(steps):
            if step.wait is not None:
                if step.wait != "contact":
                    self._wait(step)
            elif not self._is_let_go(step):
                after = steps[number + 1] if number + 1 < len(steps) else None
                feels = after is not None and after.wait == "contact"
                self._do(step.do or "", step.give, feels=feels)
        self.page.click("#tab-tasks")
        self.hand_in()

    def hand_in(self) -> None:
        """Hand the scene in: the page asks once."""
        self.page.click('[data-key="finish"]')
        self.press("finish yes", "finish")

    @staticmethod
    def _is_let_go(step: StepTable) -> bool:
        return step.do == "jog_stop"

    def _do(self, name: str, give: dict, *, feels: bool) -> None:
        page = self.page
        if name == "mode":
            self.press(f"mode_{give['mode']}", "mode")
        elif name == "override":
            before = self.done("override")
            page.locator(f"[data-key={give['dial']}_override]").fill(str(give["percent"]))
            self.until(lambda: self.done("override") > before, "the dial")
        elif name == "emergency_stop":
            before = self.done("emergency_stop")
            # As an operator does: the button is pressed again once it shows that it is pressed.
            page.wait_for_selector(
                f"#emergency[aria-pressed={'false' if give.get('pressed', True) else 'true'}]"
            )
            page.click("#emergency")
            self.until(lambda: self.done("emergency_stop") > before, "the emergency stop")
        elif name == "jog":
            self._jog(give, feels=feels)
        elif name == "set_zero":
            page.click("#tab-offsets")
            page.fill(f"#reading-{give['axis']}", str(give["reading"]))
            self.press(f"preset {give['axis']}", "set_zero")
        elif name == "set_tool":
            page.click("#tab-tools")
            self.press("touch off", "set_tool")
        elif name == "answer":
            page.click("#tab-tasks")
            self.press(f"answer {give['task']} {give['choice']}", "answer")
        elif name == "edit":
            self._edit(give)
        elif name == "handwheel":
            page.click("#tab-manual")
            page.select_option("#wheel-axis", give["axis"])
            page.select_option("#wheel-step", f"{give['step']:g}")
            before, clicks = self.done("handwheel"), give["clicks"]
            for count in range(abs(clicks)):
                page.press("#wheel", "ArrowUp" if clicks > 0 else "ArrowDown")
                self.until(lambda count=count: self.done("handwheel") > before + count or self.machine.alarm is not None, "a click")  # fmt: skip
                if self.machine.alarm is not None:
                    return
        elif name == "switch":
            page.click("#tab-run")
            page.set_checked(f"[data-key='switch {give['name']}']", give["on"])
            self.until(lambda: getattr(self.machine.panel, give["name"]) == give["on"], name)
        elif name == "search":
            page.click("#tab-run")
            page.click(f"#line{give['line']}")
            self.press("search", "search")
        elif name == "change_tool":
            page.click("#tab-tools")
            self.press(f"change tool {give['number']}", "change_tool")
        elif name in ("spindle", "coolant"):
            stands = (
                self.machine.auxiliaries.spindle.started
                if name == "spindle"
                else self.machine.auxiliaries.coolant
            )
            if stands != give["on"]:
                self.press(name, name)
        else:
            self.press(name, name)

    def _edit(self, give: dict) -> None:
        """A line, and lines below it one by one."""
        page, text = self.page, give["text"].split("\n")
        page.click(f"#line{give['line']}")
        for number, line in enumerate(text):
            page.fill("[data-key=edited]", line)
            self.press("insert" if number else "edit", "edit")
            page.wait_for_selector(f"#line{give['line'] + number} >> text={line.strip()[:12]}")

    def _jog(self, give: dict, *, feels: bool) -> None:
        axis, direction = give["axis"], give["direction"]
        name = f"jog {axis}{'+' if direction > 0 else '-'}"
        left = give.get("step")
        if feels:
            left = self._free_way(axis, direction)
        assert left is not None
        for step in STEPS:
            self.page.click(f'[data-key="step {step:g}"]')
            while left > step - 1e-6 and not (
                feels and self.machine.setup.touches(self.machine.auxiliaries.spindle)
            ):
                self.press(name, "jog")
                self.until(
                    lambda: self.machine.slot.run is None and not self.machine.machine.moving,
                    "rest",
                )
                left -= step
        while feels and not self.machine.setup.touches(self.machine.auxiliaries.spindle):
            self.press(name, "jog")
            self.until(
                lambda: self.machine.slot.run is None and not self.machine.machine.moving, "rest"
            )

    def _free_way(self, axis: str, direction: int) -> float:
        """What an eye sees: about how far the tool is from the blank."""
        room = self.machine
        work, column = room.setup.work, room.machine.machine.axes.names.index(axis)
        assert work is not None
        low, high = 0.0, 200.0
        for _ in range(40):
            middle = 0.5 * (low + high)
            place = room.machine.position - room.setup.tables.length_difference
            place[column] += direction * middle
            low, high = (low, middle) if work.touches(place) else (middle, high)
        return max(0.0, low - 0.005)

    def _wait(self, step: StepTable) -> None:
        room = self.machine
        begin = room.time_s
        come = {
            "rest": lambda: not room.machine.moving and (room.slot.run is None or room.slot.held),
            "moving": lambda: room.machine.moving,
            "alarm": lambda: room.alarm is not None and not room.machine.moving,
            "line": lambda: int(room.machine.setpoint.line[0]) == step.value,
            "end": lambda: room.slot.run is None and not room.machine.moving,
            "seconds": lambda: room.time_s >= begin + step.value,
        }[step.wait or "rest"]
        self.until(come, f"{step.wait} {step.value:g}")
