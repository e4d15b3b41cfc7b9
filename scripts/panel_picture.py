"""A picture of the operator's panel in a browser, taken while a scene's program runs."""

import threading
import time
from collections.abc import Callable
from pathlib import Path

from chromium import CHROMIUM, QUIET

from twin.training.panel.request import do
from twin.training.panel.studio import RequestEvent
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.scene.texts import Language
from twin.training.server.launch import open_room

SCENE = "fagor_first_steps"
LINE = 5
"""Which the program has reached in the picture."""
SIZE = (1280, 760)
PATIENCE_S = 600.0
FRAMES = 4
"""That a slow page is given to show the newest state."""


def take_panel(
    out: Path,
    *,
    scene: str = SCENE,
    language: Language | None = None,
    sheet: str = "tasks",
    plain: bool = False,
    run: bool = True,
) -> None:
    """Open a scene, run its program, and take a picture of the page.

    Args:
        out: PNG to write.
        scene: Name of a shipped scene.
        language: Of the panel; the scene's by default.
        sheet: Which sheet of the side is open.
        plain: Draw plainly.
        run: Whether the program runs.
    """
    from playwright.sync_api import sync_playwright

    with open_room(
        read_scene(scene_path(scene)), language=language, plain=plain, trainer=True
    ) as room:
        thread = threading.Thread(target=room.serve, daemon=True)
        thread.start()
        gate = room.trainer_gate if sheet == "trainer" else room.gate
        assert gate is not None
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=CHROMIUM, args=QUIET)
            page = browser.new_page(viewport={"width": SIZE[0], "height": SIZE[1]})
            page.goto(gate.address, timeout=1e3 * PATIENCE_S)
            _until(lambda: gate.heard > FRAMES)
            room.shown.panel.side.sheet = sheet
            if run:
                room.shown.viewer.send_to_sim(RequestEvent(do("override", dial="feed", percent=20)))
                room.shown.viewer.send_to_sim(RequestEvent(do("cycle_start")))
                at = room.session.room.machine
                _until(lambda: int(at.setpoint.line[0]) == LINE)
            seen = gate.heard + FRAMES
            _until(lambda: gate.heard > seen)
            page.screenshot(path=out)
            browser.close()
        room.stop()
        thread.join(timeout=PATIENCE_S)


def _until(come: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE_S
    while not come():
        if time.monotonic() > end:
            raise TimeoutError("the page did not come so far")
        time.sleep(0.05)
