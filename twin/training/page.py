"""Studio's web viewer behind closed doors: only the gate can reach it, and nothing can be uploaded."""

import contextlib
import io
import logging
import os
import socket
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl
from mujoco.studio import (
    endpoints,
    launch_thread,
    messages,
    plugin,
    viewer_handle,
    viewer_protocol,
    web_viewer,
)

_FONTS = {
    "AtkinsonHyperlegibleMono-Regular.ttf": "DejaVuSansMono.ttf",
    "AtkinsonHyperlegibleNext[wght].ttf": "DejaVuSans.ttf",
}
"""Studio's fonts, which have no Cyrillic, and what stands in for them."""


_LONGEST_WAIT_S = 0.25
"""How long a frame of the panel waits for a page that says nothing [s]."""


def open_page(
    title: str, plugins: list[plugin.Plugin], inside: Path, heard: Callable[[], int]
) -> viewer_handle.ViewerHandle:
    """Open the page on a thread of its own.

    Args:
        title: Of the page.
        plugins: What it shows and what drives it.
        inside: Where its server shall listen: a path for a Unix socket.
        heard: How often the page has spoken; it does so once a frame.
    """
    viewer_plugins, sim_plugins = plugin.split_plugins(plugins)
    config = viewer_protocol.ViewerConfig(gfx="web", title=title)

    def show(endpoint: endpoints.ViewerEndpoint) -> None:
        # Studio prints an address that nobody can reach.
        with contextlib.redirect_stdout(io.StringIO()):
            viewer = RoomViewer(config, endpoint, viewer_plugins, inside, heard)
        ready.set()
        viewer_protocol.run_viewer_loop(viewer)

    ready = threading.Event()
    logging.getLogger("WebServer").setLevel(logging.WARNING)
    handle = launch_thread.launch_thread(show, sim_plugins=list(sim_plugins))
    while not ready.wait(0.05):
        # Raises what ended the page's thread, if something did.
        handle.is_running()
    return handle


class RoomViewer(web_viewer.WebViewer):
    """A web viewer that listens on a Unix socket in a private folder instead of on a port."""

    def __init__(
        self,
        config: viewer_protocol.ViewerConfig,
        endpoint: endpoints.ViewerEndpoint,
        plugins: list[Any],
        inside: Path,
        heard: Callable[[], int],
    ) -> None:
        self._inside = inside
        self._heard = heard
        self._answered = 0
        super().__init__(config, endpoint, plugins=plugins)

    def _start_server(self) -> None:
        self._http_sock.close()
        self._http_sock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._http_sock.bind(str(self._inside))
        # Whoever comes before Studio's thread has begun to serve waits, and is not turned away.
        self._http_sock.listen()
        super()._start_server()
        # What is dropped onto the page is thrown away.
        if self._web_server is not None:
            self._web_server.drop_queue = None

    @messages.handler(priority=messages.Priority.INTERNAL)
    def _on_post_model(self, event: messages.PostModelEvent) -> None:
        """Serve another model: as Studio does, without its line on the operator's terminal."""
        del event
        self._update_model()

    def prepare_next_frame(self) -> bool:
        """Begin a frame when the page has shown the last one.

        Every frame of the panel reaches the page, in order. Were they made faster than a slow page
        shows them, it would fall behind by minutes.
        """
        end = time.perf_counter() + _LONGEST_WAIT_S
        while self._heard() == self._answered and time.perf_counter() < end:
            time.sleep(0.002)
        self._answered = self._heard()
        return super().prepare_next_frame()

    def get_drop_file(self) -> str:
        """There is no upload."""
        return ""


@contextlib.contextmanager
def readable_fonts(folder: Path) -> Iterator[None]:
    """Give Studio fonts that know Cyrillic and Czech, through its own setting.

    Args:
        folder: An empty folder of our own.
    """
    own = Path(web_viewer.__file__).parent / "assets"
    fonts = Path(mpl.get_data_path()) / "fonts" / "ttf"
    for file in own.iterdir():
        (folder / file.name).symlink_to(fonts / _FONTS[file.name] if file.name in _FONTS else file)
    before = os.environ.get("MUJOCO_STUDIO_ASSETS_DIR")
    os.environ["MUJOCO_STUDIO_ASSETS_DIR"] = str(folder)
    try:
        yield
    finally:
        if before is None:
            del os.environ["MUJOCO_STUDIO_ASSETS_DIR"]
        else:
            os.environ["MUJOCO_STUDIO_ASSETS_DIR"] = before
