"""The browsers that tests and benches lead, and how they are started."""

import functools
import shutil
from importlib.util import find_spec

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "chrome"))), None)
FIREFOX = next(filter(None, map(shutil.which, ("firefox-esr", "firefox"))), None)
QUIET = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
"""Flags: without a screen, and without talk to anybody outside."""


@functools.cache
def missing_for_pages() -> dict[str, str]:
    """What a page that draws lacks here, and how it is had."""
    from twin.web.server import THREE  # Of an extra that few tests need.

    return {} if THREE.is_dir() else {"three.js": "run scripts/fetch_three.py"}


@functools.cache
def missing_for_browsers() -> dict[str, str]:
    """What leading a browser to such a page lacks here, and how it is had."""
    missing = dict(missing_for_pages())
    if CHROMIUM is None:
        missing["Chromium"] = "Debian has it in the package chromium"
    if find_spec("playwright") is None:
        missing["playwright"] = "the extra 'exhaustive' brings it"
    return missing
