"""Where a room serves its pages to the class's server: a Unix socket, or a port of another computer with a secret."""

import http.client
import socket
from contextlib import AbstractAsyncContextManager
from secrets import compare_digest
from typing import Any, NamedTuple

from starlette.types import ASGIApp, Receive, Scope, Send
from websockets.asyncio.client import ClientConnection, connect, unix_connect

ANSWER_S = 60.0
"""Longest that a room takes for an answer, as for the machine's drawing [s]."""
HEADER = "x-room"
"""Header that carries a door's secret."""


class Door(NamedTuple):
    """A door.

    Attributes:
        path: Of the Unix socket; empty: it is a port.
        secret: What opens it; of a Unix socket the file's rights do.
    """

    path: str = ""
    host: str = ""
    port: int = 0
    secret: str = ""

    def connection(self) -> http.client.HTTPConnection:
        """A connection for requests; close it."""
        return _Connection(self)

    def stream(self, path: str) -> AbstractAsyncContextManager[ClientConnection]:
        """The stream at a path."""
        given: dict[str, Any] = {"max_size": None, "compression": None, "ping_interval": None}
        if self.path:
            return unix_connect(self.path, f"ws://room{path}", **given)
        address = f"ws://{self.host}:{self.port}{path}"
        return connect(address, additional_headers={HEADER: self.secret}, proxy=None, **given)


class _Connection(http.client.HTTPConnection):
    def __init__(self, door: Door) -> None:
        super().__init__(door.host or "room", door.port or None, timeout=ANSWER_S)
        self._door = door

    def connect(self) -> None:
        if not self._door.path:
            super().connect()
            return
        self.sock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.sock.settimeout(self.timeout)
        self.sock.connect(self._door.path)


def opened_by(secret: str, app: ASGIApp) -> ASGIApp:
    """An application that only answers who sends a secret in the header ``HEADER``; others are disconnected."""

    async def guarded(scope: Scope, receive: Receive, send: Send) -> None:
        given = dict(scope.get("headers", ())).get(HEADER.encode(), b"")
        if scope["type"] == "lifespan" or compare_digest(given, secret.encode()):
            await app(scope, receive, send)
        elif scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1008})
        else:
            await send({"type": "http.response.start", "status": 403, "headers": []})
            await send({"type": "http.response.body", "body": b""})

    return guarded
