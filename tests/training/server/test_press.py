"""The script that tells presses at once, alone in a browser: what it puts on Studio's stream and when.

Studio's page is stood in for by messages of its form, its server by the pictures it makes.
"""

import importlib.util
import itertools
import time
from collections.abc import Callable, Iterator
from importlib import resources
from typing import TYPE_CHECKING, Any

import pytest
from chromium import CHROMIUM, QUIET

if TYPE_CHECKING:
    from playwright.sync_api import Page

WEB = resources.files("twin.training") / "web"
SCRIPT = "".join(
    (WEB / name).read_text(encoding="utf-8") for name in ("studio_input.js", "press.js")
)
HEIGHT = 300
"""Of the panel on the page [px]; Studio's own strip lies below."""
LEFT, RIGHT = 1, 2
ENTER, KEY_H, KEY_S, ARROW_LEFT, INSERT = 13, 41, 52, 1, 9

STAND_IN = """
<canvas id="canvas" style="width:600px;height:400px;display:block"></canvas>
<script>
  document.body.style.margin = 0;
  const sent = [];
  class Stream {
    constructor(path) { this.url = "ws://127.0.0.1:1" + path; this.readyState = Stream.OPEN; }
    send(message) {
      if (typeof message === "string") return;
      if (message.length < 616) return sent.push({ length: message.length, buttons: 0, keys: [] });
      const view = new DataView(message.buffer, message.byteOffset, message.byteLength);
      const keys = [];
      for (let bit = 0; bit < 192; bit++)
        if (view.getUint8(560 + (bit >> 3)) & (1 << (bit & 7))) keys.push(bit);
      sent.push({ stream: this.url, own: view.getFloat32(16, true), length: message.length,
        x: view.getInt16(12, true), y: view.getInt16(14, true),
        text: String.fromCharCode(...Array.from({ length: view.getUint16(536, true) },
          (_, place) => view.getUint16(24 + 2 * place, true))), keyframe: view.getUint8(539),
        buttons: view.getUint32(552, true), keys, time: performance.now() });
    }
  }
  Stream.OPEN = 1;
  window.WebSocket = Stream;
</script>
<script>%s</script>
<script>
  let stream = new Stream("/ui?sid=1");
  const pictures = new Stream("/state?sid=1");
  let count = 0;
  // What Studio's page sends once a frame; the wheel's total tells the page's messages apart.
  function frame({ x = 5, y = 5, buttons = 0, keys = [], text = "", length = 616 } = {}) {
    const message = new Uint8Array(length);
    const view = new DataView(message.buffer);
    view.setUint32(0, length, true);
    view.setUint8(4, 2);
    if (length < 616) return stream.send(message);
    view.setUint16(8, 600, true);
    view.setUint16(10, 300, true);
    view.setInt16(12, x, true);
    view.setInt16(14, y, true);
    view.setFloat32(16, ++count, true);
    view.setUint16(536, text.length, true);
    [...text].forEach((letter, place) => view.setUint16(24 + 2 * place, letter.charCodeAt(0), true));
    view.setUint8(539, 1);
    view.setUint32(552, buttons, true);
    for (const bit of keys)
      view.setUint8(560 + (bit >> 3), view.getUint8(560 + (bit >> 3)) | (1 << (bit & 7)));
    stream.send(message);
  }
  function picture() { pictures.send("state_ack"); }
  const wait = (ms) => new Promise((done) => setTimeout(done, ms));
  async function looked() { await wait(50); picture(); picture(); picture(); }
</script>
"""

pytestmark = [
    pytest.mark.skipif(
        CHROMIUM is None, reason="no Chromium here; Debian has it in the package chromium"
    ),
    pytest.mark.skipif(
        importlib.util.find_spec("playwright") is None, reason="no playwright to lead the browser"
    ),
]


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=CHROMIUM, args=QUIET)
        yield started
        started.close()


@pytest.fixture
def page(browser) -> Iterator["Page"]:
    opened = browser.new_page(viewport={"width": 600, "height": 400})
    opened.set_content(STAND_IN % SCRIPT)
    opened.evaluate("frame()")
    yield opened
    opened.close()


def told(page: "Page") -> list[dict[str, Any]]:
    return page.evaluate("sent")


def states(page: "Page") -> list[tuple[int, list[int]]]:
    """Buttons and keys as the server hears them, without what does not change them."""
    heard = [(each["buttons"], each["keys"]) for each in told(page)]
    return [now for before, now in zip([None, *heard], heard, strict=False) if now != before]


def until(come: Callable[[], bool]) -> None:
    end = time.monotonic() + 10.0
    while not come():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.01)


def test_a_press_is_told_at_once_where_it_happened(page):
    page.mouse.move(100, 50)
    page.mouse.down()
    last = told(page)[-1]
    assert (last["buttons"], last["x"], last["y"]) == (LEFT, 100, 50)
    # A copy of the page's message, without what must not be said twice.
    assert (last["own"], last["length"], last["text"], last["keyframe"]) == (1, 616, "", 0)
    assert last["stream"].endswith("/ui?sid=1")


def test_a_move_alone_tells_nothing(page):
    page.mouse.move(100, 50)
    page.mouse.move(200, 60)
    assert len(told(page)) == 1


def test_the_pages_own_messages_do_not_press_twice(page):
    page.mouse.move(100, 50)
    page.mouse.down()
    page.evaluate("frame()")  # It has not heard of the press yet,
    page.evaluate("frame({ buttons: 1 })")  # now it has,
    page.evaluate("looked()")
    page.mouse.up()
    until(lambda: told(page)[-1]["buttons"] == 0)
    page.evaluate("frame({ buttons: 1 })")  # and has not heard of the release,
    page.evaluate("frame()")
    assert states(page) == [(0, []), (LEFT, []), (0, [])]


def test_a_press_and_its_release_wait_for_the_server_to_look(page):
    # In one go, however slow the browser is: the pictures had been waiting for the page.
    page.evaluate("""() => {
        for (const [kind, buttons] of
             [["pointerdown", 1], ["pointerup", 0], ["pointerdown", 1], ["pointerup", 0]])
          dispatchEvent(new PointerEvent(kind, { clientX: 100, clientY: 50, isPrimary: true, buttons }));
        picture(); picture(); picture();
    }""")
    assert states(page) == [(0, []), (LEFT, [])]
    page.evaluate("wait(50).then(picture)")
    assert states(page)[-1] == (LEFT, [])
    for wanted in (0, LEFT, 0):
        page.evaluate("looked()")
        until(lambda wanted=wanted: states(page)[-1] == (wanted, []))
    assert states(page) == [(0, []), (LEFT, []), (0, []), (LEFT, []), (0, [])]
    moments = [each["time"] for each in told(page)]
    assert min(late - early for early, late in itertools.pairwise(moments[1:])) >= 39


def test_a_server_that_makes_no_picture_is_told_all_the_same(page):
    page.mouse.move(100, 50)
    page.mouse.down()
    page.mouse.up()
    until(lambda: states(page)[-1] == (0, []))
    pressed, released = told(page)[1:]
    assert released["time"] - pressed["time"] >= 1999


def test_the_panels_keys_are_told_and_others_are_left_to_the_page(page):
    page.keyboard.down("h")
    assert states(page)[-1] == (0, [KEY_H])
    page.keyboard.down("Insert")
    page.evaluate("frame({ keys: [9] })")
    assert states(page)[-1] == (0, [INSERT, KEY_H])
    page.evaluate("looked()")
    page.keyboard.up("h")
    until(lambda: KEY_H not in states(page)[-1][1])


def test_a_browsers_own_shortcut_is_no_press(page):
    page.keyboard.down("Control")
    page.keyboard.down("r")
    page.evaluate("frame({ keys: [51] })")
    assert states(page) == [(0, [])]


def test_what_is_typed_is_told_at_once_and_once(page):
    page.keyboard.press("x")
    assert [each["text"] for each in told(page)] == ["", "x"]
    page.evaluate("frame(); frame({ text: 'x' }); frame({ text: 'xé' })")
    # The page's own word of it is taken away; what it alone knows of is left to it.
    assert [each["text"] for each in told(page)] == ["", "x", "", "", "xé"]


def test_the_page_cannot_overtake_what_waits(page):
    page.keyboard.type("xyz")
    page.evaluate("frame({ text: 'xyz' })")
    page.evaluate("looked()")
    until(lambda: told(page)[-1]["text"] == "yz")
    assert "".join(each["text"] for each in told(page)) == "xyz"


def test_a_key_that_acts_on_a_text_waits_for_what_was_typed_before_it(page):
    page.keyboard.press("s")
    page.keyboard.press("Enter")
    page.keyboard.type("G0")
    for _ in range(5):
        page.evaluate("looked()")
    until(lambda: told(page)[-1]["text"] == "G0")
    page.evaluate("frame({ text: 's' }); frame({ text: 'G0' })")
    told_ = [(each["keys"], each["text"]) for each in told(page)]
    assert told_ == [
        ([], ""), ([KEY_S], "s"), ([], ""), ([ENTER], ""), ([], "G0"), ([], ""), ([], "")
    ]  # fmt: skip


def test_quick_typing_needs_few_words(page):
    page.keyboard.type("G1 X10")
    for _ in range(9):
        page.evaluate("looked()")
    until(lambda: "".join(each["text"] for each in told(page)) == "G1 X10")
    assert len(told(page)) <= 7


def test_a_letter_of_the_third_level_is_a_letter(page):
    page.evaluate("""dispatchEvent(new KeyboardEvent("keydown", {
        key: "[", keyCode: 56, ctrlKey: true, altKey: true, modifierAltGraph: true }))""")
    assert told(page)[-1]["text"] == "["


def test_the_strip_of_studio_is_the_pages_own(page):
    page.mouse.move(100, HEIGHT + 20)
    page.mouse.down()
    page.mouse.up()
    page.keyboard.down(" ")  # Into a field on the strip, which keeps the keys.
    page.evaluate("frame({ x: -1, y: -1 })")
    assert states(page) == [(0, [])]
    page.keyboard.up(" ")
    page.mouse.move(100, 50)
    page.mouse.down()  # The first press back in the panel takes the page's way.
    assert states(page) == [(0, [])]
    page.evaluate("frame({ x: 100, y: 50, buttons: 1 })")
    assert states(page) == [(0, []), (LEFT, [])]
    page.evaluate("looked()")
    page.mouse.up()
    until(lambda: states(page)[-1] == (0, []))


def test_under_a_menu_of_the_strip_nothing_is_pressed(page):
    page.mouse.move(100, 50)
    page.evaluate("frame({ x: -1, y: -1 })")
    page.mouse.down()
    page.mouse.up()
    page.evaluate("frame({ x: -1, y: -1 }); frame({ x: 100, y: 50 })")
    assert states(page) == [(0, [])]


def test_a_press_on_the_way_from_the_strip_is_told_at_once(page):
    page.mouse.move(100, HEIGHT + 20)
    page.evaluate("frame({ x: -1, y: -1 })")
    page.mouse.move(100, 50)
    page.mouse.down()
    assert states(page)[-1] == (LEFT, [])


def test_what_is_held_is_let_go_when_the_page_is_left(page):
    page.mouse.move(100, 50)
    page.mouse.down(button="right")
    assert states(page)[-1] == (RIGHT, [])
    page.evaluate("looked().then(() => dispatchEvent(new Event('blur')))")
    until(lambda: states(page)[-1] == (0, []))


def test_a_spectators_press_and_one_after_the_stream_was_lost_are_told_to_nobody(browser, page):
    spectator = browser.new_page(viewport={"width": 600, "height": 400})
    spectator.set_content(STAND_IN % SCRIPT)
    spectator.evaluate("picture()")
    spectator.mouse.click(100, 50)
    assert told(spectator) == []
    spectator.close()
    page.evaluate("stream.readyState = 3")
    page.mouse.move(100, 50)
    page.mouse.down()
    assert len(told(page)) == 1
    # A new stream begins with the page's own word, and goes on from there.
    page.evaluate("stream = new Stream('/ui?sid=2'); frame({ x: 100, y: 50, buttons: 1 })")
    assert states(page) == [(0, []), (LEFT, [])]
    page.evaluate("looked()")
    page.mouse.up()
    until(lambda: states(page)[-1] == (0, []))
    assert told(page)[-1]["stream"].endswith("sid=2")


def test_messages_of_another_form_are_left_alone(page):
    page.evaluate("frame({ length: 120 })")
    assert told(page)[-1]["length"] == 120
    page.mouse.move(100, 50)
    page.mouse.down()
    assert told(page)[-1]["length"] == 616
