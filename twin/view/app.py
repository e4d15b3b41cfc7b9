"""The pages of a recorded run, behind the guard."""

import contextlib
import functools
from collections.abc import Callable, Iterator
from pathlib import Path

import anyio.to_thread
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles

from twin.view.recorded_run import RecordedRun
from twin.web.doorkeeper import Doorkeeper, new_tokens
from twin.web.guard import ASSETS, Guard
from twin.web.server import WebServer, require_three

ROLE = "viewer"
PAGE = Path(__file__).resolve().parent / "page"


def view_app(run: RecordedRun) -> Starlette:
    """What the page of a run is served; everything is made once, when it is asked for."""
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
        return JSONResponse(await anyio.to_thread.run_sync(description))

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
        return JSONResponse(found.description() | ({} if stock is None else {"stock": stock}))

    routes = [
        Route("/", page),
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
def open_view(run: RecordedRun, port: int = 0, *, framed: bool = False) -> Iterator[str]:
    """Serve a run on this computer while it is open; gives the page's address.

    Args:
        run: The run.
        port: 0: the first free one.
        framed: Whether a page of this computer, such as a notebook, may hold it.

    Raises:
        UsageError: The port is taken, or the view's library is missing.
    """
    require_three()
    server = WebServer(port=port)
    doorkeeper = Doorkeeper(new_tokens((ROLE,)), server.port)
    server.start(Guard(view_app(run), doorkeeper, local=server.local, framed=framed))
    try:
        yield f"{server.origin}/{ROLE}/#{doorkeeper.tokens[ROLE]}"
    finally:
        server.stop()
