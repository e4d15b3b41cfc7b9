"""The page in a window of its own; a script stands in for the browser."""

import os
import signal
import stat
import threading
from pathlib import Path

import pytest

from twin.errors import UsageError
from twin.training.server.window import find_browser, open_window

ADDRESS = "http://127.0.0.1:8080/"
PATIENCE_S = 20.0


@pytest.fixture
def on_a_desk(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A computer with a display, and with the browsers of a folder."""
    monkeypatch.setenv("DISPLAY", ":9")
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    return tmp_path


def browser_that(folder: Path, does: str, name: str = "chromium") -> str:
    script = folder / name
    script.write_text(f'#!/bin/sh\necho "$@" > {folder}/given\n{does}\n', encoding="utf-8")
    script.chmod(script.stat().st_mode | stat.S_IXUSR)
    return str(script)


def test_the_first_browser_in_path_is_taken(on_a_desk):
    script = browser_that(on_a_desk, "exit 0")
    assert find_browser() == script


def test_without_a_display_or_a_browser_it_is_refused(on_a_desk, monkeypatch):
    monkeypatch.setenv("PATH", str(on_a_desk))
    with pytest.raises(UsageError, match="needs Chromium, Chrome, Edge"):
        find_browser()
    browser_that(on_a_desk, "exit 0", "microsoft-edge")
    assert find_browser().endswith("microsoft-edge")
    monkeypatch.delenv("DISPLAY")
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(UsageError, match="no display here; without --window the room opens"):
        find_browser()


def test_a_window_that_is_closed_is_told(on_a_desk):
    closed = threading.Event()
    with open_window(browser_that(on_a_desk, "exit 0"), ADDRESS, closed.set):
        assert closed.wait(PATIENCE_S)
    given = (on_a_desk / "given").read_text(encoding="utf-8").split()
    assert given[0] == f"--app={ADDRESS}"
    # What the browser has kept goes with the window.
    profile = next(word for word in given if word.startswith("--user-data-dir="))
    assert not Path(profile.partition("=")[2]).exists()


def test_a_window_is_closed_when_the_room_is_left(on_a_desk):
    closed = threading.Event()
    browser = browser_that(on_a_desk, f"echo $$ > {on_a_desk}/number; exec sleep 600")
    with open_window(browser, ADDRESS, closed.set):
        while not (on_a_desk / "number").is_file() or not (on_a_desk / "number").read_text():
            assert not closed.wait(0.01)
        number = int((on_a_desk / "number").read_text())
        os.kill(number, signal.SIGCONT)  # It runs.
    with pytest.raises(ProcessLookupError):
        os.kill(number, signal.SIGCONT)


def test_a_browser_that_cannot_open_a_window_is_named(on_a_desk):
    closed = threading.Event()
    browser = browser_that(on_a_desk, "exit 3")
    with (
        pytest.raises(UsageError, match="has ended with 3, it cannot show a window here"),
        open_window(browser, ADDRESS, closed.set),
    ):
        assert closed.wait(PATIENCE_S)
