"""Every scene's solution and mistake, played with the keys of the real page, faster than real time and without its view.

The solution reaches full points, the mistake fails the tasks that the scene names, and every alarm on the way is translated.

``TWIN_TEST_BROWSER=firefox`` plays them in that one.
"""

import os
from collections.abc import Iterator
from typing import TYPE_CHECKING, get_args

import pytest
from browsers import FIREFOX
from panel_player import What, browser, play

from twin.training.scene.phrases import translated
from twin.training.scene.scene_file import scene_names
from twin.training.scene.vocabulary import LANGUAGES

if TYPE_CHECKING:
    from playwright.sync_api import Browser

BROWSER = os.environ.get("TWIN_TEST_BROWSER", "chromium")
pytestmark = [
    pytest.mark.browser,
    pytest.mark.played,
]


@pytest.fixture(scope="module")
def opened() -> "Iterator[Browser]":
    if BROWSER == "firefox" and FIREFOX is None:
        pytest.skip("no Firefox here; Debian has it in the package firefox-esr")
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
