"""The agent on HTTP: one document a request, or a stream of them as parts of one answer."""

import asyncio
import contextlib
import dataclasses
import secrets
from collections.abc import AsyncIterator, Callable, Coroutine
from typing import Any

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response, StreamingResponse
from starlette.routing import Route

from twin.serve.agent import LEAST_INTERVAL_MS, REQUESTS, Agent, Query, RequestError

_XML = "text/xml"
_CODES = {404: "INVALID_URI", 405: "UNSUPPORTED"}
MS_PER_S = 1000.0


def application(agent: Agent, feed: Callable[[], Coroutine[Any, Any, None]]) -> Starlette:
    """The HTTP side of an agent.

    Args:
        agent: What answers.
        feed: Observes the machine until it is cancelled; runs as long as the server does.
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
        _require_device(agent, request)
        return Response(agent.probe(), media_type=_XML)

    async def observations(request: Request) -> Response:
        _require_device(agent, request)
        query = agent.query(request.url.path.rpartition("/")[2], dict(request.query_params))
        document, following, _ = agent.answer(query)
        if query.interval_ms is None:
            return Response(document, media_type=_XML)
        boundary = secrets.token_hex(16)
        return StreamingResponse(
            _parts(agent, query, boundary, document, following),
            media_type=f"multipart/x-mixed-replace;boundary={boundary}",
        )

    async def refuse(_: Request, error: Exception) -> Response:
        if isinstance(error, HTTPException):
            code = _CODES.get(error.status_code, "INVALID_REQUEST")
            message = f"this agent answers GET of {', '.join(f'/{name}' for name in REQUESTS)}"
            error = RequestError(code, message, error.status_code)
        assert isinstance(error, RequestError)
        return Response(agent.error(error), error.status, media_type=_XML)

    routes = [Route("/", probe, methods=["GET"])]
    for name in REQUESTS:
        endpoint = probe if name == "probe" else observations
        routes += [
            Route(f"/{name}", endpoint, methods=["GET"]),
            Route(f"/{{device}}/{name}", endpoint, methods=["GET"]),
        ]
    handlers = {RequestError: refuse, HTTPException: refuse}
    return Starlette(routes=routes, exception_handlers=handlers, lifespan=lifespan)


def _require_device(agent: Agent, request: Request) -> None:
    name = request.path_params.get("device")
    if name is not None:
        agent.require_device(name)


async def _parts(
    agent: Agent, query: Query, boundary: str, document: bytes, following: int
) -> AsyncIterator[bytes]:
    """The documents of a stream: one when something was observed, one when nothing was for long.

    A client that reads so slowly that the buffer has passed it by is told so, and the stream ends.
    """
    yield _part(boundary, document)
    interval = max(query.interval_ms or 0, LEAST_INTERVAL_MS) / MS_PER_S
    heartbeat = query.heartbeat_ms / MS_PER_S
    quiet = 0.0
    while True:
        await asyncio.sleep(interval)
        quiet += interval
        if query.request == "sample":
            query = dataclasses.replace(query, first=following)
        try:
            document, following, any_observed = agent.answer(query)
        except RequestError as error:
            yield _part(boundary, agent.error(error))
            yield f"--{boundary}--\r\n".encode()
            return
        if any_observed or quiet >= heartbeat:
            quiet = 0.0
            yield _part(boundary, document)


def _part(boundary: str, document: bytes) -> bytes:
    head = f"--{boundary}\r\nContent-type: {_XML}\r\nContent-length: {len(document)}\r\n\r\n"
    return head.encode() + document + b"\r\n"
