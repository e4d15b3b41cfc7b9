"""From a scene to its pages, and the files that are left of it."""

import contextlib
import gc
import sys
from collections.abc import Iterator
from pathlib import Path

from twin.training.scene.scene_file import Scene
from twin.training.scene.vocabulary import Language
from twin.training.server.app import ROLES, RoomApp
from twin.training.server.attempts import Attempts
from twin.training.server.driver import Driver
from twin.training.session.log import Who
from twin.training.session.session import SceneSession
from twin.web.authentication import Authentication, new_tokens
from twin.web.origin_check import OriginCheck
from twin.web.server import LOOPBACK, server_of_views

TURNS_S = 0.0005
"""How long a thread keeps the interpreter while another waits for it [s]: a press must not wait."""
COLLECT_AFTER = 100_000
"""New objects between two searches for garbage, which then takes some milliseconds."""

WARMING: tuple[tuple[Who, dict[str, object]], ...] = (
    ("operator", {"do": "override", "dial": "feed", "percent": 50}),
    ("operator", {"do": "feed_hold"}),
    ("operator", {"do": "cycle_start"}),
    ("operator", {"do": "emergency_stop"}),
    ("operator", {"do": "emergency_stop", "pressed": False}),
    ("operator", {"do": "reset"}),
    ("operator", {"do": "mode", "mode": "jog"}),
    ("operator", {"do": "jog", "axis": "Z", "direction": 1}),
    ("operator", {"do": "jog_stop"}),
    ("operator", {"do": "jog", "axis": "Z", "direction": -1, "step": 0.1}),
    ("operator", {"do": "handwheel", "axis": "Z", "clicks": 1, "step": 0.1}),
    ("operator", {"do": "mode", "mode": "mdi"}),
    ("operator", {"do": "mode", "mode": "single"}),
    ("operator", {"do": "cycle_start"}),
    ("operator", {"do": "reset"}),
    ("operator", {"do": "mode", "mode": "auto"}),
)
"""What must not take longer the first time than later; a machine may refuse some of it."""
RESTARTING: tuple[tuple[Who, dict[str, object]], ...] = (
    ("operator", {"do": "cycle_start"}),
    ("trainer", {"do": "rewind", "seconds": 0.5}),
    ("trainer", {"do": "go_on"}),
)
"""The same, behind a search for a line."""


BETWEEN_KEYS, INTO_THE_CUT = 20, 400
"""Slices of time behind a key, and behind the first start, by which the tool is in the material."""


class OpenRoom:
    """A room that is open.

    Attributes:
        addresses: By role; each has a token of its own.
    """

    def __init__(
        self, driver: Driver, app: RoomApp, addresses: dict[str, str], *, promptly: bool
    ) -> None:
        self._promptly = promptly
        self.driver = driver
        self.app = app
        self.addresses = addresses

    @property
    def session(self) -> SceneSession:
        """What is played now."""
        return self.driver.session

    @property
    def folder(self) -> Path | None:
        """Where log and score sheet of what is played now lie; None for nowhere."""
        return self.app.attempt.writer.folder

    def serve(self) -> None:
        """Let time go on until Ctrl+C is pressed or the room is stopped."""
        self.driver.serve(promptly=self._promptly)

    def stop(self) -> None:
        """End ``serve``, which runs on another thread, after the slice of time that it is at."""
        self.driver.stop()


@contextlib.contextmanager
def open_room(
    scene: Scene,
    *,
    language: Language | None = None,
    host: str = LOOPBACK,
    port: int = 0,
    certificate: Path | None = None,
    key: Path | None = None,
    out: Path | None = None,
    promptly: bool = False,
) -> Iterator[OpenRoom]:
    """Open the training room for a scene.

    Args:
        language: Of the pages; the scene's by default.
        port: Its port; 0: the first free one.
        out: Folder for log and score sheet; none: none are written.
        promptly: Whether to ask the system for precedence over what else runs on this computer.

    Raises:
        TwinError: The scene does not fit its machine, the port is taken.
    """
    server = server_of_views(host, port, certificate, key)
    spoken = language or scene.file.language
    attempts = Attempts(spoken, out)
    warm_up(attempts.prepared(scene))
    attempt = attempts.begin(scene)
    driver = Driver(attempt.session, attempt.writer.changed)
    driver.trouble = attempt.writer.trouble
    app = RoomApp(driver, attempts, attempt)
    authentication = Authentication(
        new_tokens(ROLES), server.port, encrypted=certificate is not None
    )
    addresses = {
        role: f"{server.origin}/{role}/#{token}" for role, token in authentication.tokens.items()
    }
    server.start(OriginCheck(app.asgi, authentication, local=server.local), promptly=promptly)
    try:
        with prompt_threads():
            yield OpenRoom(driver, app, addresses, promptly=promptly)
    finally:
        server.stop()
        app.attempt.writer.close()


@contextlib.contextmanager
def prompt_threads() -> Iterator[None]:
    """Let no thread wait long for another, nor all of them for the search through modules' objects."""
    turns_s, threshold = sys.getswitchinterval(), gc.get_threshold()
    sys.setswitchinterval(TURNS_S)
    gc.set_threshold(COLLECT_AFTER)
    gc.collect()
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()
        gc.set_threshold(*threshold)
        sys.setswitchinterval(turns_s)


def warm_up(scene: Scene) -> None:
    """Work a machine that nobody sees, so that nothing is compiled or loaded when a key is pressed."""
    session = SceneSession(scene)
    middle = len(session.room.program.lines) // 2
    search: tuple[Who, dict[str, object]] = ("operator", {"do": "search", "line": middle})
    session.submit({"do": "mode", "mode": "auto"})
    session.submit({"do": "cycle_start"})
    session.advance(INTO_THE_CUT)
    for who, command in (*WARMING, search, *RESTARTING):
        session.submit(command, who)
        session.advance(BETWEEN_KEYS)
        session.snapshot()
