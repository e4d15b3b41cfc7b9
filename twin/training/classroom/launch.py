"""From a roster to a class that is open."""

import contextlib
import fcntl
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from twin.errors import UsageError
from twin.training.classroom.app import TEACHER, ClassApp
from twin.training.classroom.hosts import ClusterHost, ForkHost
from twin.training.classroom.marks import ClassFile
from twin.training.classroom.rooms import Rooms
from twin.training.classroom.roster import Pupil
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.scene.vocabulary import Language
from twin.web.authentication import Authentication, new_tokens
from twin.web.origin_check import OriginCheck
from twin.web.server import LOOPBACK, server_of_views


class OpenClass(NamedTuple):
    """A class that is open."""

    teacher: str
    pupils: tuple[tuple[str, str], ...]


@contextlib.contextmanager
def open_class(
    pupils: tuple[Pupil, ...],
    scene: str,
    folder: Path,
    *,
    language: Language | None = None,
    host: str = LOOPBACK,
    port: int = 0,
    certificate: Path | None = None,
    key: Path | None = None,
    cluster: str | None = None,
) -> Iterator[OpenClass]:
    """Open a class while the block runs.

    Links stay as they are from one opening of the same folder to the next: tokens and port are kept in it.

    Args:
        scene: What they begin with: a shipped scene's name, or a scene file.
        language: Of all pages; None: of each scene.
        port: Its port; 0: the one of the last time, else the first free one.
        cluster: Address of the Ray cluster over which rooms are spread; None: they run on this computer.

    Raises:
        TwinError: The scene is wrong, the port is taken, the folder is in use, or no cluster answers.
    """
    first = read_scene(scene_path(scene))
    file = ClassFile(folder)
    with _alone(folder):
        server = server_of_views(host, port or file.number("port"), certificate, key)
        file.keep_number("port", server.port)
        rooms_host = ForkHost() if cluster is None else ClusterHost(cluster)
        rooms = Rooms(pupils, scene, language, file, rooms_host)
        tokens = file.tokens(new_tokens((TEACHER, *rooms.seats)))
        links = {role: f"{server.origin}/{role}/#{token}" for role, token in tokens.items()}
        app = ClassApp(rooms, file, links, language or first.file.language)
        authentication = Authentication(tokens, server.port, encrypted=certificate is not None)
        server.start(OriginCheck(app.asgi, authentication, local=server.local))
        try:
            people = tuple((seat.pupil.name, links[key]) for key, seat in rooms.seats.items())
            yield OpenClass(links[TEACHER], people)
        finally:
            server.stop()
            rooms.close()


@contextlib.contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Keep a class's folder from a second server."""
    with (folder / "class.lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise UsageError(
                f"{folder}: this class is open already; --out names another folder"
            ) from error
        yield
