"""A picture of the operator's panel in a browser, taken while a scene's program runs."""

import time
from collections.abc import Callable
from pathlib import Path

from panel_player import browser, open_page, served

from twin.training.scene.scene_file import read_scene, scene_path

SCENE = "fagor_first_steps"
LINE = 7
"""Which the program has reached in the picture."""
SIZE = (1366, 768)
PATIENCE_S = 600.0
SETTLED_S = 20.0
"""That a page which a processor draws is given to show the newest state [s]."""


def take_panel(
    out: Path,
    *,
    scene: str = SCENE,
    language: str = "en",
    role: str = "operator",
    line: int = LINE,
    size: tuple[int, int] = SIZE,
) -> None:
    """Open a scene, run its program to a line, and take a picture of the page.

    Args:
        line: Of the program, where it is held; 0: it is not started.
        size: Of the page [px].
    """
    with served(read_scene(scene_path(scene))) as room, browser() as opened:
        context = opened.new_context(viewport={"width": size[0], "height": size[1]})
        page = open_page(room, context, role, f"?language={language}&quality=fine")
        page.wait_for_selector("body[data-view=ready]")
        if line:
            machine = room.session.room
            room.driver.ask({"do": "coolant", "on": True}, "operator", 0)
            room.driver.ask({"do": "cycle_start"}, "operator", 0)
            _until(lambda: int(machine.machine.setpoint.line[0]) == line)
            time.sleep(0.8)
            # Frozen in the midst of it: whoever draws slowly shows what it was.
            room.driver.ask({"do": "override", "dial": "feed", "percent": 0}, "operator", 0)
            _until(lambda: not machine.machine.moving)
        page.click('[data-key="view part"]')
        time.sleep(SETTLED_S)
        before = _pictures(page)
        _until(lambda: _pictures(page) > before + 2, look_s=0.5)
        page.screenshot(path=out)


def _pictures(page) -> int:
    return int(page.get_attribute("body", "data-pictures") or 0)


def _until(come: Callable[[], bool], look_s: float = 0.005) -> None:
    end = time.monotonic() + PATIENCE_S
    while not come():
        if time.monotonic() > end:
            raise TimeoutError("the page did not come so far")
        time.sleep(look_s)
