"""The server: uvicorn on a thread of its own, on one port, with limits on clients."""

import asyncio
import collections
import contextlib
import logging
import socket
import ssl
import threading
from pathlib import Path
from typing import Any, ClassVar

import uvicorn
from starlette.types import ASGIApp
from uvicorn.protocols.http.h11_impl import H11Protocol

from twin.errors import UsageError
from twin.processor import take_precedence
from twin.web.origin_check import ASSETS, LOCAL_NAMES

THREE = ASSETS / "three"
"""The view's library: put there by ``scripts/fetch_three.py``, not committed."""
LOOPBACK = "127.0.0.1"
FIRST_PORT = 8080
PORTS = 20
"""How many ports from the first on are tried."""

FIRST_REQUEST_S = 5.0
"""Time for a line to say what it wants."""
LINE_S = 30.0
"""Longest that a line lasts which is no stream."""
MOST_WAITING = 64
"""Connections that may be open without a request; of more the oldest is closed."""
LONGEST_MESSAGE = 262_144
"""Of a page [bytes]: a program of 60,000 letters."""


class BoundedProtocol(H11Protocol):
    """HTTP with a timeout for connections that send nothing, or too slowly."""

    _waiting: ClassVar["collections.OrderedDict[BoundedProtocol, None]"] = collections.OrderedDict()

    def connection_made(self, transport: asyncio.Transport) -> None:
        """A line was opened."""
        super().connection_made(transport)
        self._waiting[self] = None
        if len(self._waiting) > MOST_WAITING:
            oldest, _ = self._waiting.popitem(last=False)
            oldest.transport.abort()
        self._timers = [
            self.loop.call_later(FIRST_REQUEST_S, self._end_if_silent),
            self.loop.call_later(LINE_S, self._end_if_no_stream),
        ]

    def data_received(self, data: bytes) -> None:
        """Something was said."""
        super().data_received(data)
        if self.cycle is not None or self._is_stream:
            self._waiting.pop(self, None)

    def connection_lost(self, exc: Exception | None) -> None:
        """The line was closed."""
        super().connection_lost(exc)
        self._waiting.pop(self, None)
        for timer in self._timers:
            timer.cancel()

    @property
    def _is_stream(self) -> bool:
        return self.transport.get_protocol() is not self

    def _end_if_silent(self) -> None:
        if self in self._waiting:
            self._waiting.pop(self)
            self.transport.abort()

    def _end_if_no_stream(self) -> None:
        if not self._is_stream:
            self.transport.abort()


class SocketServer:
    """Serves an application on a socket while it is open."""

    def __init__(
        self, listener: socket.socket, certificate: Path | None = None, key: Path | None = None
    ) -> None:
        """Take a socket.

        Args:
            listener: Listens already; it is closed with the server.
            key: None: it is in the certificate's file.
        """
        self._certificate, self._key = certificate, key
        self._socket = listener
        self._server: uvicorn.Server | None = None
        self._thread: threading.Thread | None = None

    def start(self, app: ASGIApp, *, promptly: bool = False) -> None:
        """Serve an application until ``stop``.

        Args:
            promptly: Whether to ask the system for precedence, as messages must not wait.
        """
        config = uvicorn.Config(
            app,
            http=BoundedProtocol,
            ws="websockets-sansio",
            ws_max_size=LONGEST_MESSAGE,
            ws_per_message_deflate=False,
            ws_ping_interval=5.0,
            ws_ping_timeout=10.0,
            timeout_graceful_shutdown=1,
            lifespan="off",
            log_config=None,
            access_log=False,
            server_header=False,
            proxy_headers=False,
            ssl_certfile=self._certificate,
            ssl_keyfile=self._key,
        )
        # Malformed requests are not logged on the terminal.
        logging.getLogger("uvicorn.error").setLevel(logging.CRITICAL)
        self._server = uvicorn.Server(config)
        self._thread = threading.Thread(
            target=self._serve, args=(promptly,), daemon=True, name="web"
        )
        self._thread.start()

    def _serve(self, promptly: bool) -> None:
        assert self._server is not None
        if promptly:
            take_precedence()
        with asyncio.Runner() as runner, contextlib.suppress(asyncio.CancelledError):
            runner.get_loop().set_exception_handler(_ignore_lost_lines)
            runner.run(self._server.serve(sockets=[self._socket]))

    def stop(self) -> None:
        """Hang up on everybody and close the port."""
        if self._server is not None and self._thread is not None:
            self._server.should_exit = True
            self._thread.join(timeout=5.0)
        self._socket.close()


class WebServer(SocketServer):
    """Serves an application at a port while it is open."""

    def __init__(
        self,
        host: str = LOOPBACK,
        port: int = 0,
        certificate: Path | None = None,
        key: Path | None = None,
    ) -> None:
        """Bind the port.

        Args:
            port: Port; 0: the first free one from ``FIRST_PORT``.
            key: None: it is in the certificate's file.

        Raises:
            UsageError: The host is open to others and there is no certificate, the certificate
                cannot be used, or no port is free.
        """
        self.host = host.strip("[]")
        self.local = self.host in LOCAL_NAMES
        _require_certificate(host, certificate, key, local=self.local)
        super().__init__(listening(self.host, port), certificate, key)
        self.port = int(self._socket.getsockname()[1])

    @property
    def origin(self) -> str:
        """Scheme, host and port of its addresses."""
        scheme = "http" if self._certificate is None else "https"
        name = f"[{self.host}]" if ":" in self.host else self.host
        return f"{scheme}://{name}:{self.port}"


def _ignore_lost_lines(loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
    if not isinstance(context.get("exception"), OSError):
        loop.default_exception_handler(context)


def _require_certificate(
    host: str, certificate: Path | None, key: Path | None, *, local: bool
) -> None:
    if certificate is None:
        if key is not None:
            raise UsageError("--key belongs to a --certificate, and there is none")
        if not local:
            raise UsageError(
                f"--host {host} is reachable from other computers: give --certificate and --key, without "
                "which tokens are sent unencrypted; or forward the port with ssh -L"
            )
        return
    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(certificate, key)
    except (OSError, ssl.SSLError) as error:
        raise UsageError(f"{certificate}: no certificate with its key: {error}") from error


def listening(
    host: str, port: int, free: range = range(FIRST_PORT, FIRST_PORT + PORTS)
) -> socket.socket:
    """A socket that listens on a port of a host.

    Args:
        port: 0: the first that is free.
        free: Where that is looked for.

    Raises:
        UsageError: There is no such host, or no such port is free.
    """
    ports = [port] if port else free
    reason = ""
    for candidate in ports:
        try:
            family = socket.getaddrinfo(host, candidate, type=socket.SOCK_STREAM)[0][0]
            bound = socket.socket(family, socket.SOCK_STREAM)
        except OSError as error:
            raise UsageError(f"no host '{host}': {error}") from error
        bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            bound.bind((host, candidate))
            # At once: until somebody listens on it, another server could bind the same port.
            bound.listen()
        except OSError as error:
            bound.close()
            reason = error.strerror or str(error)
            continue
        return bound
    shown = f"port {port}" if port else f"ports {free.start} to {free.stop - 1}"
    raise UsageError(f"cannot listen on {host}, {shown}: {reason}")


def server_of_views(
    host: str = LOOPBACK, port: int = 0, certificate: Path | None = None, key: Path | None = None
) -> WebServer:
    """A server of pages that show a machine in three dimensions.

    Raises:
        UsageError: As for ``WebServer``, or the view's library is not there.
    """
    server = WebServer(host, port, certificate, key)
    if not (THREE / "three.module.js").is_file():
        server.stop()
        raise UsageError(
            "three.js is missing, which a checkout fetches when it is set up: "
            "run scripts/setup.sh, or python scripts/fetch_three.py"
        )
    return server
