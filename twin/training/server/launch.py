"""From a scene to a page, and the files that are left of it."""

import contextlib
import secrets
import ssl
import tempfile
import threading
from collections.abc import Iterator
from pathlib import Path

from mujoco.studio import messages, viewer_handle

from twin.nc.iso.base import jog_block
from twin.training.panel.panel import Panel
from twin.training.panel.studio import PanelPlugin, RoomPlugin
from twin.training.scene.scene_file import Scene
from twin.training.scene.texts import Language, in_language
from twin.training.scene.vocabulary import Words
from twin.training.server.gate import LOOPBACK, Gate
from twin.training.server.page import open_page
from twin.training.server.studio_files import own_files
from twin.training.session.score import SheetWriter
from twin.training.session.session import Session

_EXAMPLE = (10.0, 600.0)
"""Way [mm] and feed [mm/min] of the block that the empty MDI line shows."""
_TOKEN_BYTES = 12
"""Length of the trainer's token, made anew for every session."""


class OpenRoom:
    """A room that is open to the operator.

    Attributes:
        session: What is played.
        driver: Lets its time go on.
        shown: Shows it.
        handle: Studio's side of it.
        gate: Where browsers come in.
        trainer_gate: Where the trainer's browser comes in; None where there is no trainer.
        folder: Where log and score sheet lie; None for nowhere.
    """

    def __init__(
        self,
        session: Session,
        driver: RoomPlugin,
        shown: PanelPlugin,
        handle: viewer_handle.ViewerHandle,
        gate: Gate,
        trainer_gate: Gate | None,
        folder: Path | None,
    ) -> None:
        self.session = session
        self.driver = driver
        self.shown = shown
        self.handle = handle
        self.gate = gate
        self.trainer_gate = trainer_gate
        self.folder = folder
        self._over = threading.Event()

    def serve(self) -> None:
        """Let time go on until Ctrl+C is pressed or the room is stopped."""
        while not self._over.is_set() and self.handle.is_running():
            self.handle.sync()

    def stop(self) -> None:
        """End ``serve``, which runs on another thread, after the slice of time that it is at."""
        self._over.set()


@contextlib.contextmanager
def open_room(
    scene: Scene,
    *,
    language: Language | None = None,
    host: str = LOOPBACK,
    port: int = 0,
    token: str = "",
    tls: ssl.SSLContext | None = None,
    trainer: bool = False,
    plain: bool = False,
    out: Path | None = None,
) -> Iterator[OpenRoom]:
    """Open the training room for a scene.

    Args:
        scene: The scene.
        language: Of the panel; the scene's by default.
        host: Where the page's gate listens.
        port: Its port; 0: the first free one.
        token: What a browser must know.
        tls: Certificate for https.
        trainer: There is a trainer, with an address of their own.
        plain: Draw plainly, for computers without a graphics card.
        out: Folder for log and score sheet; none: none are written.

    Raises:
        TwinError: The scene does not fit its machine, the port is taken.
    """
    dialect = scene.preparation.dialect
    words = Words(language or scene.file.language, dialect.name)
    warm_up(scene)
    session = Session(scene)
    writer = SheetWriter(session, words, out)
    driver = RoomPlugin(session, plain=plain, changed=writer.write)
    title = f"{in_language(scene.file.title, words.language)} - {words['title']}"
    with contextlib.ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="twin-train-")))
        stack.enter_context(own_files(folder))
        inside = folder / "studio.sock"
        gate = Gate(inside, host=host, port=port, token=token, tls=tls)
        trainer_gate = None
        if trainer:
            own = secrets.token_urlsafe(_TOKEN_BYTES)
            trainer_gate = Gate(inside, host=host, token=own, tls=tls)
        gates = [each for each in (gate, trainer_gate) if each is not None]

        def trainer_has_panel() -> bool:
            return trainer_gate is not None and trainer_gate.has_panel and not gate.has_panel

        shown = PanelPlugin(
            Panel(scene.file, words, jog_block(dialect, "X", *_EXAMPLE)),
            driver.display,
            scene.file.picture.camera,
            plain=plain,
            trainer=trainer_has_panel,
            wake=driver.wake,
        )
        handle = open_page(
            title, [shown, driver], inside, lambda: sum(each.heard for each in gates)
        )
        for each in gates:
            stack.enter_context(each)
        stack.enter_context(handle)
        handle.dispatch(messages.LoadModelEvent(path=""))
        try:
            yield OpenRoom(session, driver, shown, handle, gate, trainer_gate, writer.folder)
        finally:
            writer.write(session)


def warm_up(scene: Scene) -> None:
    """Run the first moves on a machine that nobody sees, so that nothing is compiled later."""
    session = Session(scene)
    session.submit({"do": "cycle_start"})
    session.advance(20)
