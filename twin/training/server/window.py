"""The page in a desktop window of its own: an installed browser's application window.

MuJoCo Studio has a desktop window too. The one of MuJoCo 4.0.0 ends on its first frame: it draws to
a target that its renderer does not have (``Target not found``), and off screen it shows neither the
panel nor what moves.
"""

import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator

from twin.errors import UsageError

_BROWSERS = (
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
    "microsoft-edge",
    "microsoft-edge-stable",
    "msedge",
    "brave-browser",
    "vivaldi",
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
    "/Applications/Microsoft Edge.app/Contents/MacOS/Microsoft Edge",
)
"""Browsers that open a page without tabs and address when they are given ``--app``."""
_OTHERWISE = "without --window the room opens in any browser"
_SIZE = "1600,960"
_PATIENCE_S = 5.0


def find_browser() -> str:
    """The browser that can open a window here.

    Raises:
        UsageError: There is no display, or no such browser.
    """
    if sys.platform.startswith("linux") and not (
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    ):
        raise UsageError(f"--window: there is no display here; {_OTHERWISE}")
    for name in _BROWSERS:
        if found := shutil.which(name):
            return found
    raise UsageError(
        f"--window needs Chromium, Chrome, Edge, Brave or Vivaldi, and none is in PATH; {_OTHERWISE}"
    )


@contextlib.contextmanager
def open_window(browser: str, address: str, closed: Callable[[], None]) -> Iterator[None]:
    """Show a page in a window until it is closed, or the block is left.

    Args:
        browser: From ``find_browser``.
        address: Of the page.
        closed: Called, on a thread of its own, when the window is closed.

    Raises:
        UsageError: The browser cannot show a window here; when the block is left.
    """
    with tempfile.TemporaryDirectory(prefix="twin-window-", ignore_cleanup_errors=True) as profile:
        # A profile of its own: else a browser that runs already opens the window, and this process
        # ends at once.
        command = [
            browser,
            f"--app={address}",
            f"--user-data-dir={profile}",
            f"--window-size={_SIZE}",
            "--no-first-run",
            "--no-default-browser-check",
            # The processor may draw where there is no graphics card: no other page comes in here.
            "--enable-unsafe-swiftshader",
        ]
        if sys.platform.startswith("linux") and os.geteuid() == 0:
            command.append("--no-sandbox")  # It refuses to start for root, in a container say.
        quiet = subprocess.DEVNULL
        # A session of its own: Ctrl+C is for this process, which then closes the window.
        with subprocess.Popen(  # noqa: S603 (one of the browsers above)
            command, stdin=quiet, stdout=quiet, stderr=quiet, start_new_session=True
        ) as window:

            def wait() -> None:
                window.wait()
                closed()

            waiting = threading.Thread(target=wait, daemon=True, name="window")
            waiting.start()
            try:
                yield
            finally:
                itself = window.poll()
                window.terminate()
                waiting.join(timeout=_PATIENCE_S)
                window.kill()
            if itself:
                raise UsageError(
                    f"--window: {browser} has ended with {itself}, it cannot show a window here; "
                    f"{_OTHERWISE}"
                )
