"""The agent on HTTP: one document a request, or a stream of them as parts of one answer."""

import asyncio
import contextlib
import dataclasses
import logging
import secrets
import urllib.parse
import xml.etree.ElementTree as ET  # only a type here
from collections.abc import AsyncIterator, Callable, Coroutine
from typing import Any, NamedTuple

from h11 import LocalProtocolError
from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response, StreamingResponse
from starlette.routing import Route

from twin.serve.agent import LEAST_INTERVAL_MS, REQUESTS, Agent, Query, RequestError
from twin.serve.forms import DocumentFormat, accepted_form
from twin.web.origin_check import LOCAL_NAMES

_CODES = {404: "INVALID_URI", 405: "UNSUPPORTED"}
MS_PER_S = 1000.0


def application(
    agent: Agent, feed: Callable[[], Coroutine[Any, Any, None]], *, local: bool = True
) -> Starlette:
    """The HTTP side of an agent.

    Args:
        feed: Observes the machine until it is cancelled; runs as long as the server does.
        local: Whether it listens to this computer alone. A browser that was sent here by another
            name, by the page of a stranger, is then refused.
    """

    @contextlib.asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        feeding = asyncio.create_task(feed())
        try:
            yield
        finally:
            feeding.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await feeding

    async def probe(request: Request) -> Response:
        _admit(agent, request, local=local)
        return _response(request, agent.probe())

    async def assets(request: Request) -> Response:
        _admit(agent, request, local=local)
        identifiers = request.path_params.get("identifiers")
        return _response(request, agent.assets(dict(request.query_params), identifiers))

    async def observations(request: Request) -> Response:
        _admit(agent, request, local=local)
        query = agent.query(request.url.path.rpartition("/")[2], dict(request.query_params))
        document, following, _ = agent.answer(query)
        if query.interval_ms is None:
            return _response(request, document)
        boundary = secrets.token_hex(16)
        kind = f"multipart/x-mixed-replace;boundary={boundary}"
        if request.method == "HEAD":
            return Response(media_type=kind)  # A stream would go on, though nobody receives it.
        writer = _PartWriter(_form(request), boundary)
        parts = _parts(agent, query, writer, document, following)
        return StreamingResponse(parts, media_type=kind)

    async def refuse(request: Request, error: Exception) -> Response:
        if isinstance(error, HTTPException):
            code = _CODES.get(error.status_code, "INVALID_REQUEST")
            message = f"this agent answers GET of {', '.join(f'/{name}' for name in REQUESTS)}"
            error = RequestError(code, message, error.status_code)
        assert isinstance(error, RequestError)
        return _response(request, agent.error(error), error.status)

    routes = [
        Route("/", probe, methods=["GET"]),
        Route("/asset/{identifiers}", assets, methods=["GET"]),
        Route("/assets/{identifiers}", assets, methods=["GET"]),
    ]
    endpoints = {"probe": probe, "assets": assets}
    for name in REQUESTS:
        endpoint = endpoints.get(name, observations)
        routes += [
            Route(f"/{name}", endpoint, methods=["GET"]),
            Route(f"/{{device}}/{name}", endpoint, methods=["GET"]),
        ]
    handlers = {RequestError: refuse, HTTPException: refuse}
    app = Starlette(routes=routes, exception_handlers=handlers, lifespan=lifespan)
    app.router.redirect_slashes = False
    return app


def without_broken_requests(record: logging.LogRecord) -> bool:
    """A filter of the server's log: a request that breaks off is the client's fault, and no error here."""
    return record.exc_info is None or not isinstance(record.exc_info[1], LocalProtocolError)


def _admit(agent: Agent, request: Request, *, local: bool) -> None:
    """Refuse who comes by another name than this computer's, or asks for another device."""
    host = request.headers.get("host", "")
    if local and host and _name(host) not in LOCAL_NAMES:
        names = ", ".join(LOCAL_NAMES)
        raise RequestError("UNAUTHORIZED", f"this agent is known as {names} alone", 403)
    device = request.path_params.get("device")
    if device is not None:
        agent.require_device(device)


def _name(host: str) -> str:
    """A host without its port; empty where it is none."""
    try:
        return urllib.parse.urlsplit(f"//{host}").hostname or ""
    except ValueError:
        return ""


def _form(request: Request) -> DocumentFormat:
    return accepted_form(request.headers.get("accept", ""))


def _response(request: Request, document: ET.Element, status: int = 200) -> Response:
    form = _form(request)
    return Response(form.written(document), status, media_type=form.media_type)


class _PartWriter(NamedTuple):
    """How the documents of a stream are written."""

    form: DocumentFormat
    boundary: str

    def part(self, document: ET.Element) -> bytes:
        """A document with its heading."""
        text = self.form.written(document)
        kind, length = self.form.media_type, len(text)
        head = f"--{self.boundary}\r\nContent-type: {kind}\r\nContent-length: {length}\r\n\r\n"
        return head.encode() + text + b"\r\n"

    def end(self) -> bytes:
        """What is behind the last one."""
        return f"--{self.boundary}--\r\n".encode()


async def _parts(
    agent: Agent, query: Query, writer: _PartWriter, document: ET.Element, following: int
) -> AsyncIterator[bytes]:
    """The documents of a stream: one when something was observed, one when nothing was for long.

    Where a client reads so slowly that observations are overwritten, it gets the error, and the stream ends.
    """
    yield writer.part(document)
    interval = max(query.interval_ms or 0, LEAST_INTERVAL_MS) / MS_PER_S
    heartbeat = query.heartbeat_ms / MS_PER_S
    idle = 0.0
    while True:
        await asyncio.sleep(interval)
        idle += interval
        if query.request == "sample":
            query = dataclasses.replace(query, first=following)
        try:
            document, following, any_observed = agent.answer(query)
        except RequestError as error:
            yield writer.part(agent.error(error))
            yield writer.end()
            return
        if any_observed or idle >= heartbeat:
            idle = 0.0
            yield writer.part(document)
