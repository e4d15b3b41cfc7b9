"""The whole room in a browser: what is pressed on the page happens at the machine."""

import json
import time
from pathlib import Path

import numpy as np
import pytest
from browsers import FIREFOX
from panel_player import Player, open_page, opened_browser, play, served, without_view

from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.server.attempts import next_scene

pytestmark = pytest.mark.browser

SIZES = [(1024, 768, 1), (1280, 720, 1), (1366, 768, 1), (1920, 1080, 1), (1280, 720, 2), (820, 1180, 2), (1180, 820, 2)]  # fmt: skip
INSIDE = """() => [...document.querySelectorAll(
  "#control-desk button, #control-desk input, #control-desk output, #views button, #tabs button, #axes td, .chip, #clock, #control, #language, #speeds span, #loads [role=meter], #loads .bar, #loads b, #loads .caption"
)].filter((one) => one.checkVisibility()).map((one) => {
  const box = one.getBoundingClientRect(), out = [];
  if (box.width < 1 || box.height < 1) out.push("no size");
  if (box.left < -0.5 || box.top < -0.5 || box.right > innerWidth + 0.5 || box.bottom > innerHeight + 0.5) out.push("off the page");
  if (one.matches("button, .chip, td, .key") && (one.scrollWidth > one.clientWidth + 1 || one.scrollHeight > one.clientHeight + 1)) out.push("cut off");
  for (let up = one.parentElement; up; up = up.parentElement) {
    const outer = up.getBoundingClientRect();
    if (getComputedStyle(up).overflow !== "visible" && (box.right > outer.right + 1 || box.bottom > outer.bottom + 1)) out.push(`beyond ${up.id}`);
  }
  return out.length ? `${one.dataset.key || one.id || one.className || one.textContent}: ${out.join()}` : null;
}).concat((() => {
  const keys = [...document.querySelectorAll("#control-desk .key, #emergency, #steps button, .dial")].filter((one) => one.checkVisibility());
  return keys.flatMap((a, i) => keys.slice(i + 1).map((b) => {
    const [p, q] = [a.getBoundingClientRect(), b.getBoundingClientRect()];
    const over = p.left < q.right - 1 && q.left < p.right - 1 && p.top < q.bottom - 1 && q.top < p.bottom - 1;
    return over ? `${a.dataset.key || a.id || a.className} over ${b.dataset.key || b.id || b.className}` : null;
  }));
})()).filter(Boolean)"""

BESIDE = """() => {
  const outer = document.getElementById("sheet").getBoundingClientRect();
  return [...document.querySelectorAll("#sheet *")].filter((one) => one.checkVisibility() && (
    one.getBoundingClientRect().right > outer.right + 1 || (one.matches("button") && one.scrollWidth > one.clientWidth + 1)
  )).map((one) => one.dataset.key || one.id || one.textContent);
}"""


@pytest.fixture(scope="module")
def leader():
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        yield playwright


@pytest.fixture(scope="module")
def chromium(leader):
    opened = opened_browser(leader, "chromium")
    yield opened
    opened.close()


@pytest.fixture(scope="module", params=["chromium", "firefox"])
def led(request, leader):
    """Each of the browsers, for what they do in ways of their own: keys, wheels, fields, pages that freeze.

    ``TWIN_TEST_BROWSER=firefox`` has every scene played in that one too (``test_played_scenes.py``).
    """
    if request.param == "firefox" and FIREFOX is None:
        pytest.skip("no Firefox here; Debian has it in the package firefox-esr")
    if request.param == "chromium":
        yield request.getfixturevalue("chromium")
        return
    opened = opened_browser(leader, request.param)
    yield opened
    opened.close()


def test_the_first_scene_is_solved_with_the_keys_of_the_page(led, tmp_path):
    assert play(led, "fagor_first_steps", "solution", tmp_path).intended
    sheet = json.loads(next(tmp_path.glob("*/score.json")).read_text(encoding="utf-8"))
    assert (sheet["points"], sheet["of"], sheet["handed_in"]) == (10, 10, True)
    assert sheet["actions"][0]["command"] == {"do": "cycle_start"}


def test_questions_and_edits_are_played_on_the_page(chromium):
    assert play(chromium, "codesys_opening_angle", "mistake").intended


@pytest.fixture
def room(tmp_path):
    with served(read_scene(scene_path("mefi_helix_hold")), tmp_path) as opened:
        yield opened


@pytest.fixture
def context(led):
    yield from _context_of(led)


@pytest.fixture
def chromium_context(chromium):
    yield from _context_of(chromium)


def _context_of(browser):
    opened = browser.new_context()
    without_view(opened)
    yield opened
    opened.close()


@pytest.mark.parametrize("language", ["en", "ru", "it", "cs"])
def test_nothing_is_cut_off_on_any_screen(chromium, room, language):
    room.driver.ask({"do": "emergency_stop"}, "trainer", 0)
    sizes = SIZES if language == "ru" else SIZES[:1]
    for width, height, ratio in sizes:
        context = chromium.new_context(
            viewport={"width": width, "height": height}, device_scale_factor=ratio
        )
        without_view(context)
        page = open_page(room, context, query=f"?language={language}")
        page.wait_for_selector("#emergency[aria-pressed=true]")
        assert page.evaluate(INSIDE) == [], (width, height, ratio, language)
        for tab in page.locator("#tabs button").all() if width == 1024 else ():
            tab.click()
            assert page.evaluate(BESIDE) == [], (tab.inner_text(), width, height, language)
        context.close()


def test_the_emergency_stop_works_from_every_field_and_for_all_who_act(room, context):
    player = Player(room, open_page(room, context))
    page = player.page
    player.press("mode_mdi", "mode")
    page.fill("[data-key=mdi]", "G0 X1")
    page.press("[data-key=mdi]", "Escape")
    player.until(lambda: player.machine.alarm is not None, "the alarm")
    page.wait_for_selector("#emergency.pressed")
    page.click("#emergency")
    player.until(lambda: not player.machine.panel.stop_pressed, "the button turned free")
    player.press("reset", "reset")
    second = open_page(room, context)
    assert second.is_disabled("[data-key=cycle_start]")
    second.keyboard.press("Space")
    second.click("#emergency")
    player.until(lambda: player.machine.alarm is not None, "the second page's stop")
    assert player.done("cycle_start") == 0
    watcher = open_page(room, context, "watcher")
    assert watcher.is_disabled("#emergency")
    assert watcher.is_visible("#axes")
    assert watcher.inner_text("#state-chip") == "ALARM"
    log = len(room.session.log)
    for key in ("F3", "r", "Escape"):
        watcher.keyboard.press(key)
    watcher.wait_for_timeout(200)
    assert len(room.session.log) == log


def test_a_held_key_stops_when_it_is_let_go_or_its_page_freezes(room, context):
    player = Player(room, open_page(room, context))
    page, machine = player.page, player.machine
    player.press("mode_jog", "mode")
    page.click('[data-key="step held"]')
    for lost in (False, True):
        page.hover('[data-key="jog X+"]')
        page.mouse.down()
        player.until(lambda: machine.machine.moving, "the jog")
        if lost:
            # A page that hangs says nothing more, and cannot say so.
            page.evaluate("() => setTimeout(() => { const end = Date.now() + 1500; while (Date.now() < end); }, 0)")  # fmt: skip
        else:
            page.mouse.up()
        player.until(lambda: machine.slot.run is None and not machine.machine.moving, "rest")
        assert room.session.log[-1].command == {"do": "jog_stop"}
        page.mouse.up()


def test_the_machine_is_worked_by_hand_from_the_sheets(room, chromium_context):
    player = Player(room, open_page(room, chromium_context))
    page, machine = player.page, player.machine
    player.press("mode_jog", "mode")
    page.click("#tab-manual")
    page.fill("[data-key='spindle speed']", "2500")
    player.press("counter_clockwise", "spindle")
    page.wait_for_selector("#speeds >> text=S 2500 ↺")
    player.press("spindle_override +", "override")
    page.wait_for_selector("#speeds >> text=S 2750")
    player.press("spindle stop", "spindle")
    before = machine.machine.position[0]
    page.focus("#wheel")
    for way in ("ArrowUp", "ArrowUp", "ArrowDown"):
        page.keyboard.press(way)
    page.hover("#wheel")
    page.mouse.wheel(0, -100)
    player.until(lambda: abs(machine.machine.position[0] - before - 0.2) < 2e-3, "its way")
    player.until(lambda: machine.slot.run is None and not machine.machine.moving, "rest")
    player.press("reference", "reference")
    player.until(lambda: abs(machine.machine.position).max() < 2e-3, "the reference point")
    player.until(lambda: machine.slot.run is None and not machine.machine.moving, "rest")
    player.press("new_blank", "new_blank")
    page.click("#tab-tools")
    page.fill("[data-key='radius 1']", "2.5")
    page.press("[data-key='radius 1']", "Tab")
    player.until(lambda: machine.setup.tables.radii[1] == 2.5, "the radius")
    page.fill("#new-tool-number", "12")
    page.select_option("#new-tool-kind", "drill")
    page.fill("#new-tool-diameter", "8.5")
    page.fill("#new-tool-length", "80")
    player.press("add tool", "add_tool")
    player.until(lambda: 12 in machine.setup.tables.tools, "the row")
    player.press("change tool 12", "change_tool")
    player.until(lambda: machine.setup.tables.spindle == 12, "the tool")
    assert machine.setup.tables.tool.kind == "drill"


def test_zero_is_found_with_the_edge_finder_from_its_sheet(room, chromium_context):
    player = Player(room, open_page(room, chromium_context, query="?language=en"))
    page, machine = player.page, player.machine
    player.press("mode_jog", "mode")
    page.click("#tab-offsets")
    player.press("edge finder", "change_tool")
    page.wait_for_selector("#sheet >> text=CONTACT lights")
    assert not page.locator("[data-key='edge finder']").is_visible()
    player._jog({"axis": "X", "direction": -1, "step": 80.0}, feels=False)
    player._jog({"axis": "Z", "direction": -1, "step": 30.0}, feels=False)
    player._jog({"axis": "X", "direction": 1}, feels=True)
    page.wait_for_selector("#speeds >> text=CONTACT")
    player.press("touched X-", "set_zero")
    tables = machine.setup.tables
    # The left side is zero now: the blank's half from where the program has its own.
    assert tables.zero[0] == pytest.approx(tables.true_zero[0] - 60.0, abs=0.03)


def test_a_handwheel_that_is_spun_is_heard_to_its_last_click(room, context):
    player = Player(room, open_page(room, context))
    page, machine = player.page, player.machine
    player.press("mode_jog", "mode")
    page.click("#tab-manual")
    before = machine.machine.position[0]
    spin = "(wheel) => { for (let i = 0; i < 400; i += 1) wheel.dispatchEvent(new WheelEvent('wheel', { deltaY: -1 })); }"
    page.eval_on_selector("#wheel", spin)
    player.until(lambda: abs(machine.machine.position[0] - before - 40.0) < 2e-3, "its way")
    assert player.done("handwheel") < 20
    assert page.evaluate("document.body.dataset.line") == "up"


def test_what_the_machine_refuses_is_said_and_taken_back_on_the_page(room, chromium_context):
    player = Player(room, open_page(room, chromium_context))
    page, machine = player.page, player.machine
    page.click("#tab-tools")
    length = page.input_value("[data-key='length 1']")
    for typed in ("6O.5", "", "0x10", "1e3", "0"):
        page.fill("[data-key='length 1']", typed)
        page.press("[data-key='length 1']", "Tab")
        page.wait_for_selector("#message.refusal")
        player.until(lambda: page.input_value("[data-key='length 1']") == length, "the length")
    assert machine.setup.tables.lengths[1] == float(length)
    page.fill("[data-key='length 1']", "61,5")
    page.press("[data-key='length 1']", "Tab")
    player.until(lambda: machine.setup.tables.lengths[1] == 61.5, "the length")
    page.click("#tab-run")
    player.press("cycle_start", "cycle_start")
    for _ in range(2):
        page.click("[data-key='switch dry_run']")
        page.wait_for_selector("#message.refusal")
        page.wait_for_selector("[data-key='switch dry_run']:not(:checked)")
    page.click("#emergency")
    page.wait_for_selector("#message b")
    page.click("[data-key=cycle_start]")
    page.wait_for_selector("#message .refusal")


def test_what_is_typed_counts_though_its_sheet_is_drawn_anew(room, context):
    player = Player(room, open_page(room, context))
    page, machine = player.page, player.machine
    length, radius = "[data-key='length 1']", "[data-key='radius 1']"
    page.click("#tab-tools")
    for leave, other, expected in (("Tab", 2.25, 625.0), ("Enter", 3.5, 62.5)):
        page.fill(length, "")
        page.type(length, "625")
        page.press(length, "ArrowLeft")
        before = page.wait_for_selector(length)
        assert before is not None
        room.driver.ask({"do": "set_tool", "number": 1, "radius": other}, "trainer", 0)
        player.until(lambda want=other: float(page.input_value(radius)) == want, "the other value")
        assert not before.evaluate("(one) => one.isConnected")
        assert machine.setup.tables.lengths[1] != expected
        if leave == "Enter":
            page.keyboard.type(".")
        page.keyboard.press(leave)
        player.until(lambda want=expected: machine.setup.tables.lengths[1] == want, "the length")


def test_a_program_is_begun_in_its_midst_and_held_and_left_and_found_again(room, chromium_context):
    player = Player(room, open_page(room, chromium_context))
    page, machine = player.page, player.machine
    page.click("#tab-run")
    page.check("[data-key='switch optional_stop']")
    player.until(lambda: machine.panel.optional_stop, "the switch")
    page.click("#line5")
    player.press("search", "search")
    player.press("cycle_start", "cycle_start")
    player.until(lambda: machine.slot.waiting, "the block's beginning")
    player.press("cycle_start", "cycle_start")
    player.until(lambda: machine.line == 5 and machine.machine.moving, "the block")
    player.press("feed_hold", "feed_hold")
    player.until(lambda: machine.slot.held and not machine.machine.moving, "the hold")
    player.press("mode_jog", "mode")
    player.press("jog Z+", "jog")
    player.until(lambda: machine.slot.run is None and not machine.machine.moving, "rest")
    page.click("#tab-manual")
    player.press("return_to_path", "return_to_path")
    player.until(
        lambda: (
            machine.slot.run is None and not machine.machine.moving and not machine.manual.moves
        ),
        "the path",
    )
    player.press("mode_auto", "mode")
    player.press("cycle_start", "cycle_start")
    player.until(
        lambda: machine.slot.running == "program" and machine.machine.moving, "the program"
    )


def test_the_panel_is_handed_over_and_the_trainer_acts_beside_it(room, chromium_context):
    first = open_page(room, chromium_context)
    second = open_page(room, chromium_context)
    second.click('[data-key="panel ask"]')
    first.click('[data-key="panel give"]')
    second.wait_for_selector("[data-key=cycle_start]:enabled")
    first.wait_for_selector("[data-key=cycle_start]:disabled")
    trainer = Player(room, open_page(room, chromium_context, "trainer"))
    trainer.page.click("#tab-trainer")
    trainer.page.select_option("[data-key='fault kind']", "backlash")
    assert trainer.page.input_value("[data-key='fault value']") == "0.05"
    trainer.press("inject", "inject")
    trainer.page.wait_for_selector("#sheet li.failed")
    trainer.press("repair", "repair")
    trainer.page.wait_for_selector("#sheet li.failed", state="detached")
    trainer.press("freeze", "freeze")
    assert second.is_enabled("[data-key=cycle_start]")
    assert room.session.log[-1].who == "trainer"


def test_a_lost_page_stops_nothing_and_the_next_one_finds_it(room, chromium_context):
    player = Player(room, open_page(room, chromium_context))
    player.press("cycle_start", "cycle_start")
    player.page.close()
    time.sleep(0.2)
    assert player.machine.slot.running == "program"
    again = Player(room, open_page(room, chromium_context))
    again.press("feed_hold", "feed_hold")
    again.until(lambda: again.machine.slot.held, "the hold")


FINGERS = """
window.told = [];
window.Worker = class { postMessage(said) { told.push(said); } };
HTMLCanvasElement.prototype.transferControlToOffscreen = () => null;
"""
"""Notes what the view is told, in place of drawing it."""


class Fingers:
    """Fingers on a page's screen, by their numbers."""

    def __init__(self, page) -> None:
        self._session = page.context.new_cdp_session(page)
        self._down: dict[int, tuple[float, float]] = {}

    def _say(self, kind: str) -> None:
        points = [{"id": i, "x": x, "y": y} for i, (x, y) in self._down.items()]
        self._session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    def put(self, finger: int, x: float, y: float) -> None:
        self._down[finger] = (x, y)
        self._say("touchStart")

    def move(self, **places: tuple[float, float]) -> None:
        self._down |= {int(name[1:]): place for name, place in places.items()}
        self._say("touchMove")

    def end(self, kind: str) -> None:
        self._down = {}
        self._say(kind)


@pytest.fixture
def touched(chromium, room):
    context = chromium.new_context(has_touch=True, viewport={"width": 1180, "height": 820})
    context.add_init_script(FINGERS)
    yield open_page(room, context)
    context.close()


def middle(page, selector: str) -> tuple[float, float]:
    box = page.locator(selector).bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def test_fingers_turn_pinch_and_push_the_view(touched):
    fingers = Fingers(touched)
    x, y = middle(touched, "#canvas")

    def told() -> list[dict]:
        touched.wait_for_timeout(100)
        found = touched.evaluate("() => told.splice(0).filter(([what]) => what === 'turn')")
        return [what for _, what in found]

    told()
    fingers.put(1, x, y)
    fingers.move(f1=(x + 40, y + 10))
    (turned,) = told()
    assert (turned["azimuth"], turned["elevation"]) == pytest.approx((0.32, 0.08))
    fingers.put(2, x + 140, y + 10)
    fingers.move(f1=(x - 10, y + 10))
    (pinched,) = told()
    assert pinched["zoom"] == pytest.approx(100 / 150, rel=0.01)
    fingers.move(f1=(x - 10, y + 90), f2=(x + 140, y + 90))
    pushed = told()
    assert sum(each["pan"][1] for each in pushed) == pytest.approx(160 / 1600)
    assert np.prod([each["zoom"] for each in pushed]) == pytest.approx(1.0, rel=0.01)
    fingers.put(3, x, y)
    fingers.move(f3=(x + 30, y))
    assert told() == []


@pytest.mark.parametrize("end", ["lifted", "cancelled", "second finger"])
def test_a_jog_key_under_a_finger_stops_with_it(touched, room, end):
    player = Player(room, touched)
    machine = player.machine
    player.press("mode_jog", "mode")
    touched.click('[data-key="step held"]')
    fingers = Fingers(touched)
    fingers.put(1, *middle(touched, '[data-key="jog X+"]'))
    player.until(lambda: machine.machine.moving, "the jog")
    if end == "second finger":
        fingers.put(2, *middle(touched, '[data-key="jog Y+"]'))
    else:
        fingers.end("touchEnd" if end == "lifted" else "touchCancel")
    player.until(lambda: machine.slot.run is None and not machine.machine.moving, "rest")
    place = machine.machine.position[1]
    touched.wait_for_timeout(200)
    assert not machine.machine.moving
    assert machine.machine.position[1] == pytest.approx(place, abs=1e-4)
    assert room.session.log[-1].command == {"do": "jog_stop"}


def test_the_view_is_drawn(chromium, room):
    context = chromium.new_context(viewport={"width": 1024, "height": 768})
    page = open_page(room, context)
    wrong: list[str] = []
    page.on("console", lambda message: wrong.append(message.text))
    page.wait_for_selector("body[data-view=ready]")
    page.wait_for_selector("body[data-pictures]:not([data-pictures='0'])")
    page.click('[data-key="view top"]')
    assert not wrong
    context.close()


AXE = Path(__file__).resolve().parents[3] / ".axe" / "axe.min.js"
FINDINGS = """async () => (await axe.run({ runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"] })).violations
  .map((one) => `${one.id}: ${one.nodes.map((node) => node.html).join(" ")}`)"""


def findings(page) -> list[str]:
    """What axe finds wrong with a page; nothing where it was not fetched."""
    if not AXE.is_file():
        return []
    # Evaluated, since the page's policy refuses scripts that are not its own.
    page.evaluate(f"() => {{ {AXE.read_text(encoding='utf-8')} ; window.axe ??= axe; }}")
    return page.evaluate(FINDINGS)


@pytest.mark.skipif(
    not AXE.is_file(), reason="axe-core is missing: run scripts/fetch_three.py --axe"
)
def test_every_sheet_can_be_read_by_everybody(led, room):
    room.driver.ask({"do": "mode", "mode": "mdi"}, "trainer", 0)
    context = led.new_context(viewport={"width": 1280, "height": 720})
    without_view(context)
    for role in ("trainer", "watcher"):
        page = open_page(room, context, role)
        for tab in page.locator("#tabs button").all():
            tab.click()
            assert findings(page) == [], (role, tab.inner_text())
        page.click("#help-key")
        if role == "trainer":
            page.click("[data-key='tab run']")
            page.click("[data-key='edit program']")
        assert findings(page) == [], (role, "help and editor")
    context.close()


def test_the_way_of_the_program_is_told_before_it_runs_and_why_it_is_not(chromium, room):
    context = chromium.new_context()
    without_view(context)
    page = open_page(room, context, query="?language=en")
    page.click("[data-key=preview]")
    note = page.locator("#path-note")
    page.wait_for_selector("#path-note >> text=rapid dashed")
    assert "Z -3.3 … 50.0" in note.inner_text()
    player = Player(room, page)
    page.click("#line2")
    page.fill("[data-key=edited]", "N20 QQ")
    player.press("edit", "edit")
    page.wait_for_selector("#path-note.refusal >> text=line 2")
    page.click("[data-key=preview]")
    page.wait_for_selector("#path-note", state="hidden")
    context.close()


def test_what_cannot_be_taken_back_asks_once_and_the_lesson_is_told_in_the_page(chromium, room):
    context = chromium.new_context(bypass_csp=True, viewport={"width": 390, "height": 844})
    without_view(context)
    page = open_page(room, context, query="?language=en")
    player, first = Player(room, page), room.folder
    page.click("[data-key=hint]")
    page.click("[data-key='hint no']")
    assert player.done("hint") == 0
    page.click("[data-key=finish]")
    page.click("[data-key='finish no']")
    assert player.done("finish") == 0
    player.hand_in()
    page.wait_for_selector("#score >> text=The trap of this scene")
    box = page.locator("#score").bounding_box()
    assert box, "the sheet"
    assert (box["y"] > 0, box["y"] + box["height"] <= 844, box["height"] > 500) == (True,) * 3
    assert findings(page) == []
    page.click("[data-key=close_sheet]")
    page.click("[data-key='score sheet']")
    page.click("#score [data-key=again]")
    player.until(lambda: room.app.attempt.number == 2, "the second attempt")
    page.wait_for_selector("[data-key=finish]")
    assert not room.session.room.judge.over
    sheet = json.loads((first / "score.json").read_text(encoding="utf-8"))
    assert sheet["handed_in"]
    assert room.folder != first
    context.close()


def test_the_next_scene_follows_in_the_same_page_and_only_behind_a_hand_in(chromium, room):
    context = chromium.new_context()
    without_view(context)
    page = open_page(room, context, query="?language=en")
    wrong: list[str] = []
    page.on("pageerror", lambda error: wrong.append(str(error)))
    scene = room.session.scene.name
    for asked in (next_scene(scene), "fagor_climb", "../x"):
        page.evaluate("(name) => { const line = new WebSocket(new URL('stream', location.href).href.replace('http', 'ws')); line.onopen = () => line.send(JSON.stringify({ attempt: name })); }", asked)  # fmt: skip
    player = Player(room, page)
    player.hand_in()
    assert room.app.attempt.number == 1
    page.click("#score [data-key='next scene']")
    player.until(lambda: room.session.scene.name == next_scene(scene), "the next scene")
    page.wait_for_selector(f"#sheet >> text={room.session.scene.file.title['en']}")
    context.close()
    assert not wrong


REACHED = """() => {
  const box = (one) => one.getBoundingClientRect(), out = [];
  if (document.documentElement.scrollWidth > innerWidth + 1) out.push("wider than the screen");
  const stop = box(document.getElementById("emergency"));
  for (const one of document.querySelectorAll("#work button, #work input, #program, #sheet, #language")) {
    if (!one.checkVisibility()) continue;
    one.scrollIntoView({ block: "center", inline: "center" });
    const now = box(one), outer = one.closest("#tabs, #sheet, #control-desk, #views, #screen, #head").getBoundingClientRect();
    const name = one.dataset.key || one.id;
    if (now.right > outer.right + 1 || now.left < outer.left - 1 || now.right > innerWidth + 1) out.push(`${name} cut off`);
    // What is higher than the screen is cut off where its scrolling parent ends.
    const shown = one.closest("#work")?.getBoundingClientRect() ?? now;
    const top = Math.max(now.top, shown.top), right = Math.min(now.right, shown.right);
    if (now.left < stop.right - 1 && stop.left < right - 1 && top < stop.bottom - 1 && stop.top < now.bottom - 1) out.push(`${name} under the emergency stop`);
    if (now.bottom < 1 || now.top > innerHeight - 1) out.push(`${name} out of reach`);
  }
  if (stop.top < -1 || stop.left < -1 || stop.right > innerWidth + 1 || stop.bottom > innerHeight + 1) out.push("emergency stop off the page");
  return out;
}"""
SMALL = [(800, 600), (390, 844), (844, 390), (683, 384), (360, 640)]
"""Old screens, phones both ways, and 1366x768 at 200 % zoom [px]."""


@pytest.mark.parametrize("size", SMALL, ids=str)
def test_a_small_screen_scrolls_and_hides_nothing_under_anything(led, room, size):
    room.driver.ask({"do": "emergency_stop"}, "trainer", 0)
    screen = {"width": size[0], "height": size[1]}
    touch = led.browser_type.name == "chromium"
    context = led.new_context(viewport=screen, has_touch=touch)
    without_view(context)
    page = open_page(room, context, query="?language=ru")
    page.wait_for_selector("#emergency[aria-pressed=true]")
    for tab in page.locator("#tabs button").all():
        tab.click()
        assert page.evaluate(REACHED) == [], tab.inner_text()
        assert findings(page) == [], tab.inner_text()
    context.close()
