"""Every scene's solution and mistake, played with the keys of the real page, faster than real time and without its view.

The solution reaches full points, the mistake fails the tasks that the scene names, and every alarm on the way is translated.

``TWIN_TEST_BROWSER=firefox`` plays them in that one.
"""

import importlib.util
import os
from collections.abc import Iterator
from typing import TYPE_CHECKING, get_args

import pytest
from browsers import CHROMIUM, FIREFOX
from panel_player import What, browser, play

from twin.training.scene.phrases import translated
from twin.training.scene.scene_file import scene_names
from twin.training.scene.vocabulary import LANGUAGES
from twin.web.server import THREE

if TYPE_CHECKING:
    from playwright.sync_api import Browser

BROWSER = os.environ.get("TWIN_TEST_BROWSER", "chromium")
pytestmark = [
    pytest.mark.browser,
    pytest.mark.played,
    pytest.mark.skipif(
        (FIREFOX if BROWSER == "firefox" else CHROMIUM) is None, reason=f"no {BROWSER} here"
    ),
    pytest.mark.skipif(
        importlib.util.find_spec("playwright") is None, reason="no playwright to lead the browser"
    ),
    pytest.mark.skipif(
        not THREE.is_dir(), reason="three.js is missing: run scripts/fetch_three.py"
    ),
]


@pytest.fixture(scope="module")
def opened() -> "Iterator[Browser]":
    with browser(BROWSER) as one:
        yield one


@pytest.mark.parametrize("what", get_args(What))
@pytest.mark.parametrize("scene", scene_names())
def test_a_scene_ends_as_intended(opened: "Browser", scene: str, what: What) -> None:
    played = play(opened, scene, what)
    assert played.intended, str(played)
    assert bool(played.expected) == (what == "mistake")
    for message in played.alarms:
        for language in LANGUAGES:
            assert (translated(message, language) == message) == (language == "en"), message
