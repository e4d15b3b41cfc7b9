"""Origin check: host, origin and cookie of every request, and the security headers of every response."""

import urllib.parse
from pathlib import Path

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import FileResponse, PlainTextResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from twin.web.authentication import Authentication

ASSETS = Path(__file__).resolve().parent / "assets"
"""Files of the entry and of the view."""
LOCAL_NAMES = ("localhost", "127.0.0.1", "::1")

HEADERS = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; worker-src 'self'; style-src 'self'; "
        "img-src 'self' data:; connect-src 'self'; font-src 'self'; base-uri 'none'; "
        "form-action 'none'; frame-ancestors 'none'"
    ),
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Cache-Control": "no-store",
}

IN_LOCAL_PAGES = "frame-ancestors http://localhost:* http://127.0.0.1:*"
"""What may hold a page that only shows: pages of this computer, such as a notebook."""

ENTRY = "/enter"
"""Where a page hands in its token: ``/enter/ROLE``."""
_TOKEN_LIMIT = 200


class OriginCheck:
    """Passes on requests of our own pages alone, from browsers that have shown a token."""

    def __init__(
        self, app: ASGIApp, authentication: Authentication, *, local: bool, framed: bool = False
    ) -> None:
        """Wrap an application.

        Args:
            app: What is wrapped; its paths begin with ``/ROLE/``.
            local: Whether only this computer's names lead here.
            framed: Whether pages of this computer may hold its pages in a frame.
        """
        self._headers = dict(HEADERS)
        if framed:
            del self._headers["X-Frame-Options"]
            policy = self._headers["Content-Security-Policy"]
            self._headers["Content-Security-Policy"] = policy.replace(
                "frame-ancestors 'none'", IN_LOCAL_PAGES
            )
        self._app = app
        self._authentication = authentication
        self._local = local

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or pass it on."""
        if scope["type"] == "lifespan":
            return await self._app(scope, receive, send)
        headers = Headers(scope=scope)
        refusal = self._refusal(scope, headers)
        if refusal is not None:
            return await self._refuse(scope, receive, send, refusal)
        path = scope["path"]
        if scope["type"] == "http":
            send = self._with_headers(send)
            if path.startswith(f"{ENTRY}/"):
                answer = await self._entry(path.removeprefix(f"{ENTRY}/"), scope, receive)
                return await answer(scope, receive, send)
        role = path.split("/")[1] if path.startswith("/") else ""
        if not self._authentication.knows(role, headers.get("cookie", "")):
            if (
                scope["type"] == "http"
                and path == f"/{role}/"
                and role in self._authentication.tokens
            ):
                return await FileResponse(ASSETS / "enter.html")(scope, receive, send)
            return await self._refuse(scope, receive, send, 401)
        scope["twin_role"] = role
        return await self._app(scope, receive, send)

    def _refusal(self, scope: Scope, headers: Headers) -> int | None:
        """The status of a request that comes from elsewhere; None: it may come."""
        host = headers.get("host", "")
        name = urllib.parse.urlsplit(f"//{host}").hostname or ""
        if not name or (self._local and name not in LOCAL_NAMES):
            return 403
        scheme = {"ws": "http", "wss": "https"}.get(scope["scheme"], scope["scheme"])
        origin = headers.get("origin")
        if origin is not None and origin != f"{scheme}://{host}":
            return 403
        if scope["type"] == "websocket":
            return 403 if origin is None else None
        if scope["method"] == "POST":
            return 403 if origin is None else None
        return None if scope["method"] in ("GET", "HEAD") else 405

    async def _entry(self, what: str, scope: Scope, receive: Receive) -> Response:
        """The script of the entry page, or a token that is handed in."""
        if scope["method"] != "POST":
            return (
                FileResponse(ASSETS / "enter.js")
                if what == "enter.js"
                else Response(status_code=404)
            )
        body = b""
        more = True
        while more and len(body) <= _TOKEN_LIMIT:
            message = await receive()
            body += message.get("body", b"")
            more = message.get("more_body", False) and message["type"] == "http.request"
        token = body[:_TOKEN_LIMIT].decode("ascii", "replace")
        cookie = self._authentication.admit(what, token)
        if cookie is None:
            return PlainTextResponse("", 429 if self._authentication.rate_limited else 401)
        return Response(status_code=204, headers={"Set-Cookie": cookie})

    async def _refuse(self, scope: Scope, receive: Receive, send: Send, status: int) -> None:
        if scope["type"] == "websocket":
            # Before the handshake is accepted, this answers it with 403.
            await receive()
            return await send({"type": "websocket.close", "code": 1008})
        return await PlainTextResponse("", status)(scope, receive, self._with_headers(send))

    def _with_headers(self, send: Send) -> Send:
        async def sent(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in self._headers.items():
                    headers.setdefault(name, value)
            await send(message)

        return sent
