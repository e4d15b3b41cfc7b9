"""The application behind the origin check: pages, the drawn machine, and the stream of a running session."""

import asyncio
import contextlib
import functools
import json
import secrets
import threading
from pathlib import Path
from typing import Any

import anyio.to_thread
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import FileResponse, HTMLResponse, JSONResponse, Response
from starlette.routing import BaseRoute, Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.websockets import WebSocket, WebSocketDisconnect

from twin.cutting.heights.patches import grid_of
from twin.errors import TwinError
from twin.nc.iso.base import jog_block
from twin.nc.text.diagnostics.diagnostics import Diagnostic
from twin.render.machine_glb import DrawnMachine, drawn_machine
from twin.training.program.preview import Preview
from twin.training.room.run_settings import path_to_come
from twin.training.room.setup.edge_finder import BODY_MM
from twin.training.scene.phrases import finding_in, translated
from twin.training.scene.scene_file import (
    FAULT_DEFAULTS,
    FEED_OVERRIDES,
    MODES,
    RAPID_OVERRIDES,
    SPINDLE_OVERRIDES,
)
from twin.training.scene.vocabulary import LANGUAGES, Vocabulary
from twin.training.server.attempts import Attempt, Attempts, next_scene
from twin.training.server.connections import Connections, OpenPage
from twin.training.server.driver import Driver, Look
from twin.training.server.frames import (
    Changes,
    StockFeed,
    as_texts,
    panel_words,
    path_message,
    state_message,
)
from twin.training.server.part_mesh import PartMesh
from twin.training.server.program_check import ProgramCheck
from twin.training.server.scene_maker import scene_of, write_scene
from twin.training.session.commands import LONGEST_TEXT
from twin.web.origin_check import ASSETS

ROLES = ("operator", "trainer", "watcher")
PAGE = Path(__file__).resolve().parent.parent / "page"
STATIC = (("/view", ASSETS), ("/page", PAGE))
"""What a room's pages load that is the same in every room."""

PICTURES_PER_S = 30.0
"""How often a page is sent the state of the machine, at most."""
LONGEST_SEND_S = 10.0
"""Time for a page to read what it was sent."""
_EXAMPLE = (10.0, 600.0)
"""Travel [mm] and feed [mm/min] of the block that the empty MDI line shows."""


async def _panel(_request: Request) -> Response:
    return FileResponse(PAGE / "panel.html")


def static_routes() -> list[BaseRoute]:
    """The panel and what it loads, the same for every room."""
    mounts = (
        Mount(path, StaticFiles(directory=folder, follow_symlink=False)) for path, folder in STATIC
    )
    return [Route("/", _panel), *mounts]


class RoomApp:
    """What the pages of a room are served.

    Attributes:
        messages: Received from all pages so far.
    """

    def __init__(self, driver: Driver, attempts: Attempts, attempt: Attempt) -> None:
        self._driver = driver
        self._attempts = attempts
        self.attempt = attempt
        self._changing: asyncio.Task[None] | None = None
        self.connections = Connections()
        self.bytes_sent = 0
        self.messages = 0
        self._stock, self._mesh = StockFeed(), PartMesh(driver)
        self._spoken: tuple[Look | None, dict[str, str]] = None, {}
        # A page that was open before a restart must see that its attempt is another one.
        self._opening = secrets.token_hex(4)
        self._program_check = ProgramCheck(driver)
        self._one_path = asyncio.Lock()
        self._one_change = threading.Lock()
        self._last_path: tuple[Any, bytes] = None, b""
        self._drawn = functools.cache(self._draw)
        inner = [
            Route("/scene.json", self._scene),
            Route("/words/{language}.json", self._words),
            Route("/machine.json", self._machine),
            Route("/machine.glb", self._glb),
            Route("/path.bin", self._path),
            Route("/sheet.html", self._sheet),
            WebSocketRoute("/stream", self._stream),
            *static_routes(),
        ]
        self.asgi = Starlette(routes=[Mount(f"/{role}", routes=inner) for role in ROLES])

    async def _scene(self, _request: Request) -> Response:
        scene = self._driver.session.scene
        file = scene.file
        machine = scene.preparation.machine
        return JSONResponse(
            {
                "name": scene.name,
                "language": self._attempts.language,
                "languages": LANGUAGES,
                "next": next_scene(scene.name),
                "title": file.title,
                "story": file.story,
                "guide": file.guide,
                "tasks": [
                    {
                        "text": task.text,
                        "points": task.points,
                        "choices": None if task.question is None else task.question.choices,
                    }
                    for task in file.tasks
                ],
                "hints": file.hints,
                "hint_cost": file.hint_cost,
                "points": scene.points,
                "modes": MODES,
                "overrides": {
                    "feed": FEED_OVERRIDES,
                    "rapid": RAPID_OVERRIDES,
                    "spindle": SPINDLE_OVERRIDES,
                },
                "fastest": {
                    name: 60.0 * machine.axis(name).velocity for name in machine.axes.names
                },
                "faults": FAULT_DEFAULTS,
                "camera": file.picture.camera,
                "example": jog_block(scene.preparation.dialect, "X", *_EXAMPLE),
            }
        )

    async def _words(self, request: Request) -> Response:
        language = request.path_params["language"]
        if language not in LANGUAGES:
            return Response(status_code=404)
        words = Vocabulary(language, self._driver.session.scene.preparation.dialect.name)
        return JSONResponse(words.as_data())

    async def _sheet(self, request: Request) -> Response:
        """The score sheet as it is now, in the page's language; of what was handed in alone."""
        language = request.query_params.get("language", "")
        if language not in LANGUAGES or not self._driver.session.room.judge.over:
            return Response(status_code=404)
        words = Vocabulary(language, self._driver.session.scene.preparation.dialect.name)
        page = await anyio.to_thread.run_sync(self.attempt.writer.page, words)
        return HTMLResponse(page)

    def _begin_again(self, page: OpenPage, name: str) -> None:
        """Begin the scene again, or the next one, for who has handed in; for a trainer always."""
        over = self._driver.session.room.judge.over
        acts = page.role == "trainer" or (over and self.connections.allows(page, None))
        known = name in ("", next_scene(self.attempt.scene.name))
        if acts and known and (self._changing is None or self._changing.done()):
            self._changing = asyncio.create_task(anyio.to_thread.run_sync(self.begin, name))

    def begin(self, name: str) -> None:
        """Begin another attempt, from any thread but the machine's; it is there when this returns.

        Args:
            name: Of a shipped scene, or its file; empty: the same scene again.

        Raises:
            TwinError: There is no such scene, or something is wrong with it.
        """
        with self._one_change:
            before = self.attempt
            after = self._attempts.after(before, name)
            if before.session.signature:
                after.session.submit({"do": "sign", "name": before.session.signature})
            unwritten = ""
            try:
                before.writer.close()
            except OSError as error:
                unwritten = f"{before.writer.folder}: {error.strerror or error}"
            self._driver.change(
                after.session, after.writer.changed, lambda: unwritten or after.writer.trouble()
            ).result()
            self._drawn.cache_clear()
            self._last_path = None, b""
            self.attempt = after

    async def _machine(self, request: Request) -> Response:
        drawn = await self._drawing(request)
        if drawn is None:
            return Response(status_code=404)
        described = drawn[0].description()
        work = self._driver.session.room.setup.work
        if work is not None:
            described |= {"part_mesh": True} if work.map is None else {"stock": grid_of(work.map)}
        tables = self._driver.session.room.setup.tables
        if request.query_params["tool"] == str(tables.finder):
            described["finder"] = {"body": 0.5 * BODY_MM}
        return JSONResponse(described)

    async def _glb(self, request: Request) -> Response:
        drawn = await self._drawing(request)
        if drawn is None:
            return Response(status_code=404)
        return Response(drawn[1], media_type="model/gltf-binary")

    async def _path(self, _request: Request) -> Response:
        """The program's path, drawn in parallel with the machine's thread; one at a time."""
        path = await asyncio.wrap_future(self._driver.inquire(path_to_come))
        async with self._one_path:
            key, message = self._last_path
            if key != path.key:
                preview = await anyio.to_thread.run_sync(path.drawn)
                message = path_message(preview, _said_of(preview))
                self._last_path = path.key, message
        return Response(message, media_type="application/octet-stream")

    async def _drawing(self, request: Request) -> tuple[DrawnMachine, bytes] | None:
        tools = self._driver.session.room.setup.tables.tools
        number = request.query_params.get("tool", "")
        if not number.isdecimal() or int(number) not in tools:
            return None
        return await anyio.to_thread.run_sync(self._drawn, int(number))

    def _draw(self, number: int) -> tuple[DrawnMachine, bytes]:
        room = self._driver.session.room
        scene = room.scene.preparation
        drawn = drawn_machine(
            scene.machine,
            room.setup.tables.tools[number],
            room.setup.part_frame,
            scene.job.file.stock,
            room.setup.tables.true_zero,
        )
        return drawn, drawn.glb()

    async def _stream(self, socket: WebSocket) -> None:
        role = socket.scope["path"].split("/")[1]
        page = self.connections.open(role)
        await socket.accept()
        if page is None:
            return await socket.close(1013)
        tell = asyncio.create_task(self._tell_until_gone(socket, page))
        try:
            await self._hear(socket, page)
        except (WebSocketDisconnect, RuntimeError):
            pass  # The page is gone; nothing is left to say to it.
        finally:
            tell.cancel()
            self.connections.close(page)
            self._driver.leave(page.number)

    async def _hear(self, socket: WebSocket, page: OpenPage) -> None:
        """Do what a page asks for, until it goes or says too much."""
        while True:
            text = await socket.receive_text()
            self.messages += 1
            if not page.within_rate_limit():
                return await socket.close(1008)
            try:
                said = json.loads(text)
            except ValueError:
                return await socket.close(1008)
            if not isinstance(said, dict):
                return await socket.close(1008)
            if "beat" in said:
                self._driver.beat(page.number)
            elif "check" in said:
                self._program_check.soon(page.number, said["check"], socket.send_text)
            elif "make_scene" in said:
                await self._make_scene(socket, page, said["make_scene"])
            elif "panel" in said:
                self.connections.hand_over(page, str(said["panel"]))
            elif "attempt" in said:
                self._begin_again(page, str(said["attempt"]))
            elif self.connections.allows(page, said):
                who = "trainer" if page.role == "trainer" else "operator"
                self._driver.ask(said, who, page.number)

    async def _make_scene(self, socket: WebSocket, page: OpenPage, given: Any) -> None:
        """Write the room down as a scene, for a trainer, and say where it lies."""
        folder, language = self._attempts.scenes, self._attempts.language
        if page.role != "trainer" or folder is None or not isinstance(given, dict):
            return
        title, story = (str(given.get(key, ""))[:LONGEST_TEXT] for key in ("title", "story"))
        try:
            scene = await asyncio.wrap_future(
                self._driver.inquire(lambda room: scene_of(room, language, title, story))
            )
            path = await anyio.to_thread.run_sync(write_scene, scene, folder)
        except TwinError as error:
            made = {"refused": _in_all(str(error))}
        else:
            made = {"path": str(path)}
        await socket.send_text(json.dumps({"made": made}))

    async def _tell_until_gone(self, socket: WebSocket, page: OpenPage) -> None:
        """Show a page the machine until it is gone, or reads no more."""
        try:
            await self._tell(socket, page)
        except (WebSocketDisconnect, RuntimeError):
            pass  # The page is gone; the receiving task notices too.
        except TimeoutError:
            with contextlib.suppress(RuntimeError):
                await socket.close(1008)
        except Exception:
            # A page that gets no more messages must not look alive.
            with contextlib.suppress(RuntimeError):
                await socket.close(1011)
            raise

    async def _tell(self, socket: WebSocket, page: OpenPage) -> None:
        """Show a page the machine, no faster than it reads."""
        changes = Changes()
        epoch = version = mesh_version = -1
        shown: tuple[Look | None, dict[str, Any]] = None, {}
        while True:
            began = asyncio.get_running_loop().time()
            look = self._driver.look
            self._stock.note(self._driver.seen)
            patch, epoch, version = self._stock.patch(epoch, version)
            mesh, mesh_version = await self._mesh.newer(mesh_version)
            own = self.connections.words(page) | {
                "attempt": f"{self._opening} {self.attempt.number}"
            }
            messages: list[bytes | str] = []
            if patch or mesh or look is not shown[0] or own != shown[1]:
                shown = look, own
                words = changes.since_last(self._words_of(look) | as_texts(own))
                messages = [state_message(look, cutting=bool(patch or mesh))]
                messages += [part for part in (words, patch, mesh) if part]
            for message in messages:
                self.bytes_sent += len(message)
                send = socket.send_bytes if isinstance(message, bytes) else socket.send_text
                await asyncio.wait_for(send(message), LONGEST_SEND_S)  # pyright: ignore[reportArgumentType]
            spent = asyncio.get_running_loop().time() - began
            await asyncio.sleep(max(0.001, 1.0 / PICTURES_PER_S - spent))

    def _words_of(self, look: Look) -> dict[str, str]:
        """What all pages show of a look, made once for all of them."""
        if look is not self._spoken[0]:
            self._spoken = look, as_texts(self._translated(panel_words(look)))
        return self._spoken[1]

    @staticmethod
    def _translated(words: dict[str, Any]) -> dict[str, Any]:
        """The machine's sentences in every language, so that each page can choose its own."""
        for alarm in filter(None, (words["alarm"], words["broken"], *words["alarms"])):
            found = alarm.pop("finding")
            alarm["message"] = (
                {language: finding_in(Diagnostic(**found), language) for language in LANGUAGES}
                if found
                else _in_all(alarm["message"])
            )
        words["refusal"] = words["refusal"] and _in_all(words["refusal"])
        return words


def _said_of(preview: Preview) -> dict[str, str] | None:
    """Why a path is not drawn to its end, in every language; None: nothing is to be said."""
    found = preview.finding
    if found is not None:
        return {language: finding_in(found, language) for language in LANGUAGES}
    return _in_all(preview.message) if preview.message else None


@functools.lru_cache(maxsize=256)
def _in_all(message: str) -> dict[str, str]:
    return {language: translated(message, language) for language in LANGUAGES}
