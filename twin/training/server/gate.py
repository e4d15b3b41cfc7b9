"""The gate before Studio's page: the only thing that listens on a port, and it looks at who comes.

Studio's own server asks nobody for anything. So it listens on a private Unix socket, and the gate
passes on only what the page needs: reading its files, and its two streams. Requests from other
sites' pages are turned away (``Host`` and ``Origin`` must name the gate itself), and where a host is
given, whoever has no token.
"""

import asyncio
import contextlib
import hmac
import http.cookies
import socket
import ssl
import threading
import urllib.parse
from collections.abc import Coroutine
from pathlib import Path

from twin.errors import UsageError
from twin.training.server.request_head import OPERATOR_STREAM, RequestHead

LOOPBACK = "127.0.0.1"
FIRST_PORT = 8080
PORTS = 20
"""How many ports from the first on are tried."""

_HEAD_LIMIT = 16384
_HEAD_TIME_S = 10.0
_COOKIE = "twin_token"
"""Name of the cookie that keeps the token, before the port: browsers share cookies between ports."""
_LOCAL_NAMES = ("localhost", LOOPBACK, "[::1]")
_PIECE = 65536
_BINARY = b"\x82"
"""Beginning of a whole binary message (RFC 6455, 5.2)."""


class Gate:
    """Listens for browsers and leads them to a room.

    Attributes:
        host: Where it listens.
        port: The port.
        token: What a browser must know, empty for nothing.
        heard: How often the page that has the panel has spoken: once a frame while it is shown.
    """

    def __init__(
        self,
        inside: Path,
        *,
        host: str = LOOPBACK,
        port: int = 0,
        token: str = "",
        tls: ssl.SSLContext | None = None,
    ) -> None:
        """Bind the port.

        Args:
            inside: The Unix socket of Studio's server.
            host: Address to listen on.
            port: Port; 0: the first free one from ``FIRST_PORT``.
            token: What a browser must know; needed unless only this computer can come.
            tls: Certificate and key, for https.

        Raises:
            UsageError: The host is open to others and there is no token, or no port is free.
        """
        if host not in _LOCAL_NAMES and not token:
            raise UsageError(f"--host {host} lets other computers in: give a --token too")
        self.host = host
        self.token = token
        self.heard = 0
        self._panels = 0
        self._guests: set[asyncio.Task[None] | None] = set()
        self._inside = inside
        self._tls = tls
        self._socket = _bound(host, port)
        self.port = int(self._socket.getsockname()[1])
        self._loop = asyncio.new_event_loop()
        self._server: asyncio.Server | None = None
        self._open = threading.Event()
        self._thread = threading.Thread(target=self._serve, daemon=True, name="gate")

    @property
    def address(self) -> str:
        """What to type into a browser."""
        scheme = "http" if self._tls is None else "https"
        query = f"?token={urllib.parse.quote(self.token)}" if self.token else ""
        shown = f"[{self.host}]" if ":" in self.host else self.host
        return f"{scheme}://{shown}:{self.port}/{query}"

    @property
    def has_panel(self) -> bool:
        """Whether it is a browser of this gate that has the panel."""
        return self._panels > 0

    @property
    def _cookie(self) -> str:
        return f"{_COOKIE}_{self.port}"

    def __enter__(self) -> "Gate":
        """Open it."""
        self._thread.start()
        self._open.wait()
        return self

    def __exit__(self, *_: object) -> None:
        """Close it."""
        self._loop.call_soon_threadsafe(self._stop)
        self._thread.join(timeout=5.0)
        self._socket.close()

    def _serve(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._server = self._loop.run_until_complete(
            asyncio.start_server(self._welcome, sock=self._socket, ssl=self._tls)
        )
        self._open.set()
        self._loop.run_forever()
        pending = asyncio.all_tasks(self._loop)
        for task in pending:
            task.cancel()
        self._loop.run_until_complete(asyncio.gather(*pending, return_exceptions=True))
        self._loop.close()

    def _stop(self) -> None:
        if self._server is not None:
            self._server.close()
        self._loop.stop()

    async def _welcome(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        guest = asyncio.current_task()
        # asyncio forgets the task of a line that was hung up, even while it still works.
        self._guests.add(guest)
        try:
            head = await asyncio.wait_for(reader.readuntil(b"\r\n\r\n"), _HEAD_TIME_S)
            await self._lead(head, reader, writer)
        except (TimeoutError, asyncio.IncompleteReadError, asyncio.LimitOverrunError, OSError):
            pass  # Whoever came has gone, or says nothing that could be understood.
        except asyncio.CancelledError:
            pass  # The gate closes; asyncio's streams would report this as an error.
        finally:
            self._guests.discard(guest)
            with contextlib.suppress(OSError):
                writer.close()

    async def _lead(
        self, head: bytes, reader: asyncio.StreamReader, writer: asyncio.StreamWriter
    ) -> None:
        request = RequestHead(head) if len(head) <= _HEAD_LIMIT else None
        if request is None or not request.valid:
            return await _answer(writer, "400 Bad Request")
        if not self._may_come(request):
            return await _answer(writer, "403 Forbidden")
        if not self._knows_token(request):
            return await _answer(writer, "401 Unauthorized")
        if request.token and self.token:
            cookie = f"{self._cookie}={urllib.parse.quote(self.token)}; HttpOnly; SameSite=Strict; Path=/"
            return await _answer(writer, "303 See Other", Location="/", **{"Set-Cookie": cookie})
        if not request.wanted:
            return await _answer(writer, "404 Not Found")
        inside_reader, inside_writer = await asyncio.open_unix_connection(str(self._inside))
        try:
            inside_writer.write(head)
            await inside_writer.drain()
            await _until_first(
                self._show(inside_reader, writer, request),
                # Only a stream has anything more to say; a second request on this line has not
                # been looked at.
                self._listen(reader, inside_writer, request) if request.is_stream else None,
            )
        finally:
            inside_writer.close()

    async def _listen(
        self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, request: RequestHead
    ) -> None:
        """Pass on what a page says."""
        with contextlib.suppress(OSError):
            while piece := await reader.read(_PIECE):
                self.heard += request.path == OPERATOR_STREAM
                writer.write(piece)
                await writer.drain()

    async def _show(
        self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, request: RequestHead
    ) -> None:
        """Pass on what Studio says, and note whether it gives the panel to this page.

        Every page asks for the operator's stream. Studio opens it to one at a time, which gets the
        panel's first message; to the others it says goodbye.
        """
        with contextlib.suppress(OSError, asyncio.IncompleteReadError):
            if not (request.is_stream and request.path == OPERATOR_STREAM):
                return await _pass_on(reader, writer)
            writer.write(await reader.readuntil(b"\r\n\r\n"))
            first = await reader.read(_PIECE)
            given = first.startswith(_BINARY)
            self._panels += given
            try:
                writer.write(first)
                await _pass_on(reader, writer)
            finally:
                self._panels -= given

    def _may_come(self, request: RequestHead) -> bool:
        """Whether the request is meant for this gate, by a page of this gate."""
        names = {f"{name}:{self.port}" for name in _LOCAL_NAMES}
        if self.host not in _LOCAL_NAMES:
            # Behind an open host the token is what protects; any name may lead here.
            names.add(request.headers.get("host", ""))
        origin = urllib.parse.urlsplit(request.headers.get("origin", "")).netloc
        host = request.headers.get("host", "")
        return host in names and (not origin or origin == host)

    def _knows_token(self, request: RequestHead) -> bool:
        if not self.token:
            return True
        cookie = http.cookies.SimpleCookie()
        with contextlib.suppress(http.cookies.CookieError):
            cookie.load(request.headers.get("cookie", ""))
        kept = cookie[self._cookie].value if self._cookie in cookie else ""
        shown = [request.token, urllib.parse.unquote(kept)]
        return any(hmac.compare_digest(each.encode(), self.token.encode()) for each in shown)


async def _answer(writer: asyncio.StreamWriter, status: str, **fields: str) -> None:
    fields |= {"Content-Length": "0", "Connection": "close"}
    lines = [f"HTTP/1.1 {status}", *(f"{name}: {value}" for name, value in fields.items())]
    writer.write(("\r\n".join(lines) + "\r\n\r\n").encode("latin-1"))
    await writer.drain()


async def _pass_on(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    with contextlib.suppress(OSError):
        while piece := await reader.read(_PIECE):
            writer.write(piece)
            await writer.drain()


async def _until_first(*works: Coroutine[None, None, None] | None) -> None:
    """Work until one of several has ended."""
    tasks = [asyncio.ensure_future(work) for work in works if work is not None]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()


def _bound(host: str, port: int) -> socket.socket:
    """A socket that listens on a port of a host.

    Raises:
        UsageError: There is no such host, or no such port is free.
    """
    name = host.strip("[]")
    ports = [port] if port else range(FIRST_PORT, FIRST_PORT + PORTS)
    reason = ""
    for candidate in ports:
        try:
            family = socket.getaddrinfo(name, candidate, type=socket.SOCK_STREAM)[0][0]
            bound = socket.socket(family, socket.SOCK_STREAM)
        except OSError as error:
            raise UsageError(f"no host '{host}': {error}") from error
        bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            bound.bind((name, candidate))
            # At once: until somebody listens on it, another gate could bind the same port.
            bound.listen()
        except OSError as error:
            bound.close()
            reason = error.strerror or str(error)
            continue
        return bound
    shown = f"port {port}" if port else f"ports {FIRST_PORT} to {FIRST_PORT + PORTS - 1}"
    raise UsageError(f"cannot listen on {host}, {shown}: {reason}")
