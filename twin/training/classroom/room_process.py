"""A pupil's room in a process of its own: its pages behind a door, its state through a pipe."""

import contextlib
import dataclasses
import os
import resource
import secrets
import signal
import socket
import threading
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from twin.errors import TwinError
from twin.training.classroom.door import Door, opened_by
from twin.training.classroom.marks import MADE_SCENES, ClassFile
from twin.training.classroom.recorder import Recorder
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.scene.vocabulary import Language
from twin.training.server.app import RoomApp
from twin.training.server.attempts import Attempts
from twin.training.server.driver import Driver, Look
from twin.training.server.launch import prompt_threads
from twin.web.server import SocketServer

MOST_MEMORY = 2_000_000_000
"""Of one room's process [bytes]; a room that is used all day stays below a third of it."""
NICE = 5
"""How much later than the class's server a room gets the processor, where both want it."""
REPORT_EVERY_S = 0.5
"""Between two looks at a room for the teacher's page [s]."""


@dataclasses.dataclass(frozen=True, slots=True)
class RoomOrder:
    """What a room's process is begun with.

    Attributes:
        language: Of the pages; None: the scene's.
        sheets: Folder of the pupil's logs and score sheets.
        socket: Unix socket at which the pages are served; empty: on a port.
        node: What a cluster calls the computer; empty: there is none.
    """

    pupil: str
    scene: str
    language: Language | None
    folder: Path
    sheets: Path
    socket: str = ""
    host: str = ""
    node: str = ""

    def at_socket(self, path: str) -> "RoomOrder":
        """The same with pages at a Unix socket."""
        return dataclasses.replace(self, socket=path)

    def on_port(self, host: str, node: str) -> "RoomOrder":
        """The same with pages on a port of a host."""
        return dataclasses.replace(self, host=host, node=node)


def run_room(order: RoomOrder, pipe: Connection) -> None:
    """Play until the pipe is closed or says so: the body of a room's process.

    Through the pipe go, to the class: ``{"door": where, "node": where}`` or ``{"failed": why}``, then what the teacher is
    shown, where it changes; from the class: a trainer's commands, ``{"attempt": scene}``, ``{"end": True}``.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_DATA, (MOST_MEMORY, MOST_MEMORY))
    os.nice(NICE)
    try:
        scene = read_scene(scene_path(order.scene))
        scenes = order.folder / MADE_SCENES
        attempts = Attempts(order.language or scene.file.language, order.sheets, scenes)
        attempt = attempts.begin(scene)
    except TwinError as error:
        pipe.send({"failed": str(error)})
        return
    driver = Driver(attempt.session, attempt.writer.changed)
    driver.trouble = attempt.writer.trouble
    app = RoomApp(driver, attempts, attempt)
    recorder = Recorder(ClassFile(order.folder), order.pupil, lambda: app.attempt.writer.folder)
    driver.noted = recorder.note
    driver.ask({"do": "sign", "name": order.pupil}, "operator", 0)
    listener, door = _listening(order)
    server = SocketServer(listener)
    server.start(opened_by(door.secret, app.asgi) if door.secret else app.asgi)
    pipe.send({"door": door, "node": order.node})
    threading.Thread(
        target=_serve_class, args=(pipe, driver, app), daemon=True, name="class"
    ).start()
    try:
        with prompt_threads():
            driver.serve()
    finally:
        server.stop()
        with contextlib.suppress(OSError):
            app.attempt.writer.close()


def _listening(order: RoomOrder) -> tuple[socket.socket, Door]:
    if order.socket:
        listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        listener.bind(order.socket)
        listener.listen()
        return listener, Door(order.socket)
    listener = socket.create_server((order.host, 0))
    return listener, Door("", order.host, int(listener.getsockname()[1]), secrets.token_urlsafe(16))


def _serve_class(pipe: Connection, driver: Driver, app: RoomApp) -> None:
    """Report to the class and carry out what it sends; end with the class."""
    sent: dict[str, Any] = {}
    try:
        while True:
            if pipe.poll(REPORT_EVERY_S):
                said = pipe.recv()
                if "end" in said:
                    break
                if "attempt" in said:
                    _begin(said["attempt"], driver, app)
                else:
                    driver.ask(said, "trainer", 0)
            now = _status(driver.look, app, driver)
            if now != sent:
                pipe.send(now)
                sent = now
    except (EOFError, OSError):
        pass  # The class is gone; what it had to know is in its file.
    driver.stop()


def _begin(scene: str, driver: Driver, app: RoomApp) -> None:
    try:
        app.begin("" if scene == app.attempt.scene.name else scene)
    except TwinError as error:
        driver.session.room.fail(str(error))


def _status(look: Look, app: RoomApp, driver: Driver) -> dict[str, Any]:
    """What the teacher's page shows of a room."""
    now, session = look.now, driver.session
    alarm = now.alarm or now.broken
    return {
        "scene": session.scene.name,
        "title": session.scene.file.title,
        "mode": now.mode,
        "running": now.running,
        "held": now.held,
        "frozen": now.frozen,
        "line": now.line,
        "alarm": alarm and alarm.code,
        "block": alarm.block if alarm else "",
        "points": now.score,
        "of": session.scene.points,
        "hints": now.hints,
        "over": now.over,
        "done": len(session.log),
        "refusals": now.refusals,
        "lost_s": round(look.lost_s),
        "trouble": look.trouble,
        "pages": app.connections.count("operator"),
    }
