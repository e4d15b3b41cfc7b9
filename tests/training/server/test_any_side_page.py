"""A part of two sides on the page: drawn as it was cut, and measured by a click."""

import time

import pytest
from panel_player import PATIENCE_S, PLAYED_FASTER, Player, browser, open_page, served

from twin.training.scene.scene_file import read_scene, scene_path

pytestmark = pytest.mark.browser


def test_a_part_of_two_sides_is_drawn_and_measured():
    scene = read_scene(scene_path("fanuc_second_side"))
    with served(scene) as room, browser() as opened:
        room.driver.speed = PLAYED_FASTER
        page = open_page(room, opened)
        page.wait_for_selector("body[data-view=ready]")
        player = Player(room, page)
        player.play(scene.file.solution)
        page.click("[data-key=close_sheet]")
        page.click("[data-key='view top']")
        page.click("[data-key='tab display']")
        page.check("[data-key='show measure']")
        box = page.locator("#canvas").bounding_box()
        assert box is not None
        middle = box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"]
        end = time.monotonic() + PATIENCE_S
        # The slot's floor, 4 mm below program zero, in the middle of the part.
        while "Z -4.000" not in page.inner_text("#measure-note"):
            assert time.monotonic() < end, page.inner_text("#measure-note")
            page.mouse.click(*middle)
            time.sleep(1.0)
        assert room.session.room.judge.score == scene.points
