"""A class served by the real command, and those who come to it."""

import contextlib
import json
import re
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from websockets.sync.client import ClientConnection, connect

PATIENCE_S = 60.0


def until(come: Callable[[], Any], what: str) -> Any:
    """Wait for something; what it is then."""
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        found = come()
        if found:
            return found
        time.sleep(0.05)
    raise AssertionError(f"it did not come: {what}")


def _port_of_its_own() -> int:
    """A port that is free, and is not among those that the command tries by itself."""
    with socket.socket() as bound:
        bound.bind(("127.0.0.1", 0))
        return int(bound.getsockname()[1])


class ClassServer:
    """``twin train --class`` in a process of its own.

    Attributes:
        links: Address by name; the teacher's is ``teacher``.
        origin: Scheme, host and port.
    """

    def __init__(self, roster: Path, out: Path, scene: str = "fagor_first_steps") -> None:
        command = [sys.executable, "-m", "twin", "train", scene, "--class", str(roster)]
        # A class that begins anew keeps its port: one that no other test takes meanwhile.
        port = [] if out.exists() and any(out.iterdir()) else ["--port", str(_port_of_its_own())]
        self._process = subprocess.Popen(
            [*command, *port, "--out", str(out)], stdout=subprocess.PIPE, text=True
        )
        self.links: dict[str, str] = {}
        assert self._process.stdout is not None
        for line in self._process.stdout:
            name, _, address = line.rstrip("\n").rpartition(" ")
            self.links["teacher" if "teacher" in address else name.strip()] = address
            if "teacher" in self.links:
                break
        self.origin = re.sub(r"/teacher/.*", "", self.links["teacher"])

    def role(self, name: str) -> str:
        """First part of somebody's path."""
        return self.links[name].split("/")[3]

    def enter(self, name: str, token: str | None = None) -> str:
        """Hand in somebody's token, or another one; the cookie."""
        given = self.links[name].split("#")[1] if token is None else token
        request = urllib.request.Request(  # noqa: S310 (our own server)
            f"{self.origin}/enter/{self.role(name)}", given.encode(), {"Origin": self.origin}
        )
        with urllib.request.urlopen(request, timeout=PATIENCE_S) as answer:  # noqa: S310 (our own server)
            return str(answer.headers["Set-Cookie"]).split(";")[0]

    def get(self, path: str, cookie: str) -> tuple[int, bytes]:
        """Status and content of an address, for who has a cookie."""
        request = urllib.request.Request(self.origin + path, headers={"Cookie": cookie})  # noqa: S310 (our own server)
        try:
            with urllib.request.urlopen(request, timeout=PATIENCE_S) as answer:  # noqa: S310 (our own server)
                return answer.status, answer.read()
        except urllib.error.HTTPError as error:
            return error.code, error.read()

    def stop(self, number: int = signal.SIGINT) -> int:
        """End it by a signal; its exit code."""
        self._process.send_signal(number)
        assert self._process.stdout is not None
        with self._process.stdout:
            return self._process.wait(PATIENCE_S)

    def rooms(self) -> list[int]:
        """Numbers of the rooms' processes."""
        children = _children(self._process.pid)
        return [room for child in children for room in _children(child)]


@contextlib.contextmanager
def class_server(roster: Path, out: Path) -> Iterator[ClassServer]:
    """A class while it is needed."""
    server = ClassServer(roster, out)
    try:
        yield server
    finally:
        server.stop(signal.SIGTERM)


class Stream:
    """A page's stream, and what it has been told."""

    def __init__(self, line: ClientConnection) -> None:
        self.line = line
        self.told: dict[str, Any] = {}

    def say(self, **what: Any) -> None:
        """Ask for something."""
        self.line.send(json.dumps(what))

    def until(self, come: Callable[[dict[str, Any]], Any], what: str) -> Any:
        """Hear until something has been told; what it is then."""

        def heard() -> Any:
            with contextlib.suppress(TimeoutError):
                message = self.line.recv(timeout=0.1)
                if isinstance(message, str):
                    self.told |= json.loads(message)
            return self.told and come(self.told)

        return until(heard, what)


@contextlib.contextmanager
def stream(server: ClassServer, name: str) -> Iterator[Stream]:
    """The stream of somebody's page while it is open."""
    with connect(
        f"{server.origin.replace('http', 'ws')}/{server.role(name)}/stream", origin=server.origin,  # pyright: ignore[reportArgumentType]
        additional_headers={"Cookie": server.enter(name)}, max_size=None, compression=None,
        open_timeout=PATIENCE_S,
    ) as line:  # fmt: skip
        yield Stream(line)


def _children(process: int) -> list[int]:
    with contextlib.suppress(OSError):
        threads = Path(f"/proc/{process}/task").iterdir()
        texts = [(one / "children").read_text() for one in threads]
        return [int(number) for text in texts for number in text.split()]
    return []
