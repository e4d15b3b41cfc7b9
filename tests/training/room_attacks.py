"""Bad days of a training room: what strangers, pages and the disk can do to it while it is open.

After each of them the room must run in real time, its pages must answer, and its log must be whole.
"""

import contextlib
import http.client
import json
import resource
import shutil
import socket
import tempfile
import time
import urllib.error
import urllib.request
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

from panel_player import served
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.server.launch import OpenRoom
from twin.web.authentication import GUESSES

SCENE = "mefi_helix_hold"
WATCHED_S = 2.0
SLOWEST = 0.97
"""Machine time per time on the wall that counts as real time."""
MORE_MB = 150.0
"""Memory that a bad day may leave behind."""


class Target:
    """An open room and how it is reached."""

    def __init__(self, room: OpenRoom) -> None:
        self.room = room
        self.origin = room.addresses["operator"].split("/operator")[0]
        self.port = int(self.origin.rsplit(":", 1)[1])
        self.cookies = {role: self.enter(role) for role in room.addresses}

    def enter(self, role: str) -> str:
        """Hand in a role's token; its cookie."""
        token = self.room.addresses[role].split("#")[1]
        request = urllib.request.Request(  # noqa: S310 (our own server)
            f"{self.origin}/enter/{role}", token.encode(), {"Origin": self.origin}
        )
        with urllib.request.urlopen(request, timeout=10) as answer:  # noqa: S310 (our own server)
            return str(answer.headers["Set-Cookie"]).split(";")[0]

    def stream(self, role: str, origin: str = "", cookie: str | None = None) -> ClientConnection:
        """A page's stream, as it is or as somebody else would open it."""
        address = f"ws://127.0.0.1:{self.port}/{role}/stream"
        headers = {"Cookie": self.cookies[role] if cookie is None else cookie}
        return connect(
            address, origin=origin or self.origin, additional_headers=headers, max_size=None,  # pyright: ignore[reportArgumentType]
            compression=None, open_timeout=10,
        )  # fmt: skip


def origins(target: Target) -> Iterator[str]:
    """Pages of other sites, frames without an origin, strangers without a cookie."""
    for origin, cookie in (
        ("null", None), ("http://evil.example", None), ("", "twin=1"), ("", ""),
    ):  # fmt: skip
        try:
            with target.stream("operator", origin, cookie):
                yield f"origin {origin!r} with cookie {cookie!r} came in"
        except (InvalidStatus, ConnectionClosed, OSError):
            pass  # Turned away, as it must be.


def half_open(target: Target) -> Iterator[str]:
    """A thousand lines that say nothing, or the half of a request."""
    with contextlib.ExitStack() as stack:
        for number in range(1000):
            with contextlib.suppress(OSError):
                line = stack.enter_context(socket.create_connection(("127.0.0.1", target.port)))
                if number % 2:
                    line.sendall(b"GET /operator/ HTTP/1.1\r\nHost:")
        begin = time.perf_counter()
        target.enter("watcher")
        if time.perf_counter() - begin > 2.0:
            yield f"a page waited {time.perf_counter() - begin:.1f} s beside silent lines"


def flood(target: Target) -> Iterator[str]:
    """A watcher that says ten thousand things a second."""
    with target.stream("watcher") as page:
        try:
            for _ in range(20_000):
                page.send('{"do":"reset"}')
            page.recv(timeout=5)
        except (ConnectionClosed, TimeoutError, OSError):
            pass
    if any(entry.command["do"] == "reset" for entry in target.room.session.log):
        yield "a watcher's command was carried out"


def nonsense(target: Target) -> Iterator[str]:
    """Messages that are none."""
    for said in ("", "{", "[]", "null", '{"do":1}', '{"do":"jog"}', "x" * 100_000, '{"a":' * 2000):
        with contextlib.suppress(ConnectionClosed, OSError), target.stream("operator") as page:
            page.send(said)
            page.recv(timeout=5)
    yield from ()


def slow_readers(target: Target) -> Iterator[str]:
    """Two hundred pages that never read."""
    open_pages = []
    for _ in range(200):
        with contextlib.suppress(Exception):
            line = socket.create_connection(("127.0.0.1", target.port))
            line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            line.sendall(
                f"GET /watcher/stream HTTP/1.1\r\nHost: 127.0.0.1:{target.port}\r\n"
                f"Origin: {target.origin}\r\nCookie: {target.cookies['watcher']}\r\n"
                "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n".encode()
            )
            open_pages.append(line)
    time.sleep(15.0)
    for line in open_pages:
        line.close()
    yield from ()


def vanished_folder(target: Target) -> Iterator[str]:
    """The results' folder is taken away, and something else lies in its place."""
    folder = target.room.folder
    assert folder is not None
    shutil.rmtree(folder, ignore_errors=True)
    folder.write_text("in the way")
    target.room.driver.ask({"do": "coolant", "on": True}, "trainer", 0)
    time.sleep(2.5)
    if not target.room.driver.look.trouble:
        yield "no page was told that nothing can be written"
    folder.unlink()
    time.sleep(2.5)
    if target.room.driver.look.trouble:
        yield f"it is not written again: {target.room.driver.look.trouble}"


def guesses(target: Target) -> Iterator[str]:
    """A thousand wrong tokens; whoever has the right one comes in."""
    answers: Counter[int] = Counter()
    for number in range(1000):
        line = http.client.HTTPConnection("127.0.0.1", target.port, timeout=10)
        line.request("POST", "/enter/trainer", f"guess{number}", {"Origin": target.origin})
        answers[line.getresponse().status] += 1
        line.close()
    if set(answers) != {401, 429} or answers[401] > GUESSES:
        yield f"guesses were answered with {dict(answers)}"
    try:
        target.enter("trainer")
    except urllib.error.HTTPError as refusal:
        yield f"the right token was answered with {refusal.code}"


DAYS: tuple[Callable[[Target], Iterator[str]], ...] = (
    origins, half_open, flood, nonsense, slow_readers, vanished_folder, guesses,
)  # fmt: skip


def complaints() -> Iterator[str]:
    """Live through all of them in one room; what is wrong afterwards."""
    scene = read_scene(scene_path(SCENE))
    with tempfile.TemporaryDirectory() as place, served(scene, Path(place)) as room:
        target = Target(room)
        room.driver.ask({"do": "override", "dial": "feed", "percent": 10}, "trainer", 0)
        room.driver.ask({"do": "cycle_start"}, "trainer", 0)
        time.sleep(1.0)
        before = _memory_mb()
        for day in DAYS:
            yield from (f"{day.__name__}: {each}" for each in day(target))
            yield from (f"after {day.__name__}: {each}" for each in _unwell(target, before))
        room.driver.ask({"do": "feed_hold"}, "trainer", 0)
        time.sleep(2.5)
        assert room.folder is not None
        lines = (room.folder / "log.jsonl").read_text(encoding="utf-8").splitlines()
        if [json.loads(line)["command"] for line in lines] != [e.command for e in room.session.log]:
            yield "the log is not whole"


def _unwell(target: Target, before_mb: float) -> Iterator[str]:
    time.sleep(1.0)
    room = target.room
    begin, then = time.perf_counter(), room.session.room.time_s
    time.sleep(WATCHED_S)
    factor = (room.session.room.time_s - then) / (time.perf_counter() - begin)
    if factor < SLOWEST:
        yield f"the machine runs at {factor:.2f} of real time"
    if (grown := _memory_mb() - before_mb) > MORE_MB:
        yield f"{grown:.0f} MB more are in use"
    with target.stream("operator") as page:
        page.recv(timeout=5)


def _memory_mb() -> float:
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * resource.getpagesize() / 1e6
