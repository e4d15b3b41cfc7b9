"""The pages of a recorded run, behind the origin check."""

import asyncio
import contextlib
import functools
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import anyio
import anyio.to_thread
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import FileResponse, HTMLResponse, JSONResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.websockets import WebSocket, WebSocketDisconnect

from twin.view.live_run import LiveRun
from twin.view.recorded_run import RecordedRun
from twin.web.authentication import Authentication, new_tokens
from twin.web.origin_check import ASSETS, OriginCheck
from twin.web.server import server_of_views

ROLE = "viewer"
PAGE = Path(__file__).resolve().parent / "page"
FOLLOWED_EVERY_S = 0.04
"""Between two messages of where a machine is that makes the run again [s]."""
REPORT_POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
"""Of the report, whose scripts and styles are within it: it can load nothing and call nowhere."""


def view_app(
    run: RecordedRun | LiveRun,
    report: Path | None = None,
    now: Callable[[], dict[str, Any]] | None = None,
) -> Starlette:
    """The application that serves the page of a run; each response is made once, on demand.

    Args:
        report: Its report, to be read beside it; None: there is none.
        now: Where a machine is that makes the run: ``time`` [s], and where the run goes on what ``LiveRun.now``
            says; None: none does.
    """
    samples = functools.cache(run.samples)
    cuts = functools.cache(lambda: b"".join(run.cuts()))
    description = functools.cache(run.description)
    grid = functools.cache(run.stock_grid)
    drawn = functools.cache(run.drawn)

    def bytes_of(make: Callable[[], bytes]) -> Callable[[Request], object]:
        async def answer(_request: Request) -> Response:
            content = await anyio.to_thread.run_sync(make)
            return Response(content, media_type="application/octet-stream")

        return answer

    async def page(_request: Request) -> Response:
        return FileResponse(PAGE / "player.html")

    async def run_json(_request: Request) -> Response:
        found = await anyio.to_thread.run_sync(description)
        extras = {"has_report": report is not None, "is_live": now is not None}
        return JSONResponse(found | extras)

    async def report_page(_request: Request) -> Response:
        if report is None:
            return Response(status_code=404)
        text = await anyio.Path(report).read_text("utf-8")
        text = text.replace("<html ", '<html class="viewed" ', 1)
        return HTMLResponse(text, headers={"Content-Security-Policy": REPORT_POLICY})

    async def follow(page: WebSocket) -> None:
        if now is None:
            await page.close()
            return
        await page.accept()
        with contextlib.suppress(WebSocketDisconnect):
            while True:
                await page.send_json(now())
                await asyncio.sleep(FOLLOWED_EVERY_S)

    async def machine(request: Request) -> Response:
        number = request.query_params.get("tool", "")
        found = None
        if number.isdecimal():
            found = await anyio.to_thread.run_sync(drawn, int(number))
        if found is None:
            return Response(status_code=404)
        if request.url.path.endswith(".glb"):
            content = await anyio.to_thread.run_sync(found.glb)
            return Response(content, media_type="model/gltf-binary")
        stock = await anyio.to_thread.run_sync(grid)
        part = {"part_mesh": run.has_part_mesh} if stock is None else {"stock": stock}
        return JSONResponse(found.description() | part)

    routes = [
        Route("/", page),
        Route("/report.html", report_page),
        WebSocketRoute("/now", follow),
        Route("/run.json", run_json),
        Route("/samples.bin", bytes_of(samples)),
        Route("/cuts.bin", bytes_of(cuts)),
        Route("/machine.json", machine),
        Route("/machine.glb", machine),
        Mount("/view", StaticFiles(directory=ASSETS, follow_symlink=False)),
        Mount("/page", StaticFiles(directory=PAGE, follow_symlink=False)),
    ]
    return Starlette(routes=[Mount(f"/{ROLE}", routes=routes)])


@contextlib.contextmanager
def open_view(
    run: RecordedRun | LiveRun,
    port: int = 0,
    *,
    framed: bool = False,
    report: Path | None = None,
    now: Callable[[], dict[str, Any]] | None = None,
) -> Iterator[str]:
    """Serve a run on this computer while it is open; gives the page's address.

    Args:
        port: 0: the first free one.
        framed: Whether a page of this computer, such as a notebook, may hold it.
        report: As for ``view_app``.
        now: As for ``view_app``.

    Raises:
        UsageError: The port is taken, or the view's library is missing.
    """
    server = server_of_views(port=port)
    authentication = Authentication(new_tokens((ROLE,)), server.port)
    server.start(
        OriginCheck(view_app(run, report, now), authentication, local=server.local, framed=framed)
    )
    try:
        yield f"{server.origin}/{ROLE}/#{authentication.tokens[ROLE]}"
    finally:
        server.stop()
