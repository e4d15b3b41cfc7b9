"""Studio's web viewer behind closed doors: only the gate can reach it, and nothing can be uploaded."""

import contextlib
import io
import logging
import socket
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from mujoco.studio import (
    endpoints,
    launch_thread,
    messages,
    plugin,
    viewer_handle,
    viewer_protocol,
    web_viewer,
)

_LONGEST_WAIT_S = 0.25
"""How long a frame of the panel waits for a page that says nothing [s]."""
_ON_ITS_WAY_S = 0.010
"""How long what the gate has passed on mostly takes through Studio's server [s]. A frame that begins
before it has come costs the press a whole frame more: Studio begins none sooner than a 60th of a
second after the last."""
_LOOKS_AFTER_S = (_ON_ITS_WAY_S, 0.025, 0.045, 0.065, 0.090, 0.140)
"""When the panel has a frame after each word of the page, for what takes longer [s]: a press and its
answer need three, those of the first 40 ms do not count in the page's script, and Studio's server
can be late."""
_POLL_S = 0.001


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
        self._looks: list[float] = []
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
        """Begin a frame when the page has spoken: when it has shown the last one, or at a press.

        Every frame of the panel reaches the page, in order. Were they made as fast as they can be,
        a slow page would fall behind by minutes.
        """
        end = time.perf_counter() + _LONGEST_WAIT_S
        while time.perf_counter() < min([end, *self._looks[:1]]):
            heard = self._heard()
            if heard != self._answered:
                self._answered = heard
                now = time.perf_counter()
                looks = [now + after for after in _LOOKS_AFTER_S]
                # A quick page speaks again before the first: that one stays where it is.
                self._looks = [min([*self._looks[:1], looks[0]]), *looks[1:]]
            time.sleep(_POLL_S)
        del self._looks[:1]
        return super().prepare_next_frame()

    def close(self) -> None:
        """End as Studio does, and let its panel go: beside it no other of this process would begin."""
        super().close()
        del self._headless_ui

    def get_drop_file(self) -> str:
        """There is no upload."""
        return ""
