"""A crash and a break as the page shows them: where they happened, in red, and cut open to be measured."""

import io
import re
import time

import numpy as np
import pytest
from panel_player import browser, open_page, served
from PIL import Image

from twin.training.scene.scene_file import read_scene, scene_path

pytestmark = pytest.mark.browser
RED, ORANGE = (255, 42, 31), (217, 130, 43)
PATIENCE_S = 90.0


def dots(page, colour: tuple[int, int, int]) -> int:
    """How many dots of the view have a colour."""
    picture = Image.open(io.BytesIO(page.locator("#canvas").screenshot())).convert("RGB")
    return int((np.abs(np.asarray(picture, int) - colour).max(axis=2) < 12).sum())


def wait_for(come, what: str) -> None:
    end = time.monotonic() + PATIENCE_S
    while not come():
        assert time.monotonic() < end, f"it did not come: {what}"
        time.sleep(0.2)


def test_a_crash_is_marked_looked_at_and_measured():
    with served(read_scene(scene_path("codesys_long_tool"))) as room, browser() as opened:
        page = open_page(room, opened, query="?language=en")
        page.wait_for_selector("body[data-view=ready]")
        page.click("[data-key=mode_mdi]")
        page.fill("[data-key=mdi]", "G0 X0 Y0 Z-60")
        page.click("[data-key=enter]")
        page.click("[data-key=cycle_start]")
        wait_for(lambda: room.session.room.alarm, "the crash")
        wait_for(lambda: dots(page, RED) > 100, "the mark")
        page.click("[data-key='tab display']")
        page.select_option("[data-key=section]", "y")
        page.click("[data-key='view part']")
        wait_for(lambda: dots(page, ORANGE) > 500, "the section")
        page.check("[data-key='show measure']")
        box = page.locator("#canvas").bounding_box()
        assert box
        middle = box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"]
        for aside in (-30, 30):
            page.mouse.click(middle[0] + aside, middle[1])
        told = page.locator("#measure-note")
        wait_for(lambda: "distance" in told.inner_text(), "what was measured")
        values = {
            name: float(value)
            for name, value in re.findall(r"(Δ[XYZ]|distance) (-?[\d.]+)", told.inner_text())
        }
        way = np.hypot(np.hypot(values["ΔX"], values["ΔY"]), values["ΔZ"])
        assert values["distance"] == pytest.approx(way, abs=0.002)
        assert 5.0 < way < 60.0
        page.click("[data-key=reset]")
        wait_for(lambda: dots(page, RED) == 0, "the end of the mark")
