"""What a class is served: each pupil his room, the teacher all of them, on one page and one by one."""

import asyncio
import contextlib
import http.client
import json
import time
import urllib.parse
from collections import Counter
from typing import Annotated, Any, Literal

import anyio.to_thread
import pydantic
from pydantic import Field
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import BaseRoute, Mount, Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect
from websockets.exceptions import WebSocketException

from twin.errors import TwinError
from twin.files.toml import Table
from twin.training.classroom.door import HEADER, Door
from twin.training.classroom.hosts import RoomError
from twin.training.classroom.marks import (
    MADE_SCENES,
    AttemptResult,
    ClassFile,
    as_csv,
    as_statements,
)
from twin.training.classroom.rooms import Rooms, Seat
from twin.training.scene.scene_file import read_scene, scene_names, scene_path
from twin.training.scene.vocabulary import LANGUAGES, Language, Vocabulary
from twin.training.server.app import PAGE, static_routes

TEACHER = "teacher"
REPORT_EVERY_S = 0.5
"""Between two looks at the class for the teacher's page [s]."""
ALARM_S, IDLE_S = 60.0, 180.0
"""A pupil is stuck when an alarm has stood for so long, or when so long nothing was done while nothing ran
[s]."""
_ASKED = (
    "scene.json",
    "words/{language}.json",
    "machine.json",
    "machine.glb",
    "path.bin",
    "sheet.html",
)
"""What a page asks its room for; nothing else is passed on."""


class Hold(Table):
    """Hold machines, or let them go on."""

    do: Literal["hold", "go_on"]
    seats: Annotated[tuple[str, ...], Field(max_length=100)]


class HandOut(Table):
    """Give pupils a scene."""

    do: Literal["hand_out"]
    seats: Annotated[tuple[str, ...], Field(max_length=100)]
    scene: Annotated[str, Field(max_length=1000)]


_Wish = pydantic.TypeAdapter[Hold | HandOut](Annotated[Hold | HandOut, Field(discriminator="do")])


class ClassApp:
    """The application of a class, behind the origin check.

    Attributes:
        asgi: What answers; the first part of a path is ``teacher`` or the key of a seat.
    """

    def __init__(
        self, rooms: Rooms, file: ClassFile, links: dict[str, str], language: Language
    ) -> None:
        """Prepare it.

        Args:
            links: Address of each seat, with its token.
            language: Of the teacher's page, until he chooses another.
        """
        self._rooms, self._file, self._links, self._language = rooms, file, links, language
        self._shipped = {name: read_scene(scene_path(name)).file.title for name in scene_names()}
        teacher: list[BaseRoute] = [
            Route("/", self._page),
            Route("/class.json", self._class),
            Route("/words/{language}.json", self._words),
            Route("/marks.csv", self._marks_csv),
            Route("/marks.json", self._marks_json),
            WebSocketRoute("/stream", self._stream),
            *static_routes()[1:],
        ]
        teacher += [
            Mount(f"/{key}", routes=self._doors(seat, "trainer"))
            for key, seat in rooms.seats.items()
        ]
        pupils = [
            Mount(f"/{key}", routes=self._doors(seat, "operator"))
            for key, seat in rooms.seats.items()
        ]
        self.asgi = Starlette(routes=[Mount(f"/{TEACHER}", routes=teacher), *pupils])

    def _doors(self, seat: Seat, role: str) -> list[BaseRoute]:
        """The pages of a seat's room for a role."""

        async def ask(request: Request) -> Response:
            asked = request.url.path.rpartition("/")[2]
            if "language" in request.path_params:
                if request.path_params["language"] not in LANGUAGES:
                    return Response(status_code=404)
                asked = f"words/{asked}"
            query = urllib.parse.urlencode(request.query_params.multi_items())
            try:
                door = await self._rooms.opened(seat)
                return await anyio.to_thread.run_sync(_answer, door, f"/{role}/{asked}?{query}")
            except (RoomError, OSError, http.client.HTTPException) as error:
                return JSONResponse({"failed": str(error)}, 503)

        async def stream(page: WebSocket) -> None:
            with self._rooms.watched(seat):
                await page.accept()
                try:
                    door = await self._rooms.opened(seat)
                    await _splice(page, door, f"/{role}/stream")
                except (RoomError, OSError, WebSocketException):
                    pass  # The page sees the closed line, and asks again.
                with contextlib.suppress(RuntimeError):
                    await page.close(1013)

        asked = (Route(f"/{path}", ask, methods=["GET"]) for path in _ASKED)
        return [*asked, WebSocketRoute("/stream", stream), *static_routes()]

    async def _page(self, _request: Request) -> Response:
        return FileResponse(PAGE / "class.html")

    async def _words(self, request: Request) -> Response:
        language = request.path_params["language"]
        if language not in LANGUAGES:
            return Response(status_code=404)
        return JSONResponse(Vocabulary(language, "").as_data())

    async def _class(self, _request: Request) -> Response:
        scenes = await anyio.to_thread.run_sync(self._scenes)
        return JSONResponse({"language": self._language, "languages": LANGUAGES, "scenes": scenes})

    def _scenes(self) -> dict[str, dict[Language, str]]:
        """Titles of all scenes that can be handed out: the shipped ones, and those that were made in a room."""
        made: dict[str, dict[Language, str]] = {}
        for path in sorted((self._file.folder / MADE_SCENES).glob("*.toml")):
            with contextlib.suppress(TwinError):
                made[str(path)] = read_scene(path).file.title
        return made | self._shipped

    async def _marks_csv(self, _request: Request) -> Response:
        text = as_csv(await anyio.to_thread.run_sync(self._file.marks))
        headers = {"Content-Disposition": 'attachment; filename="marks.csv"'}
        return Response(text, media_type="text/csv", headers=headers)

    async def _marks_json(self, request: Request) -> Response:
        marks = await anyio.to_thread.run_sync(self._file.marks)
        home = str(request.base_url).partition(f"/{TEACHER}")[0].rstrip("/")
        headers = {"Content-Disposition": 'attachment; filename="marks.json"'}
        return JSONResponse(as_statements(marks, home), headers=headers)

    async def _stream(self, page: WebSocket) -> None:
        await page.accept()
        telling = asyncio.create_task(self._tell(page))
        try:
            while True:
                answer = self._do(await page.receive_text())
                if answer:
                    await page.send_text(json.dumps({"refused": answer}))
        except (WebSocketDisconnect, RuntimeError):
            pass  # The page is gone.
        finally:
            telling.cancel()

    def _do(self, text: str) -> str:
        """Do what the teacher asks for; why it is refused, else nothing."""
        try:
            wish = _Wish.validate_json(text)
            seats = [self._rooms.seats[key] for key in wish.seats]
            if isinstance(wish, HandOut) and wish.scene not in self._scenes():
                return f"no scene {wish.scene!r}"
        except pydantic.ValidationError as error:
            return str(error.errors()[0]["msg"])
        except KeyError as error:
            return f"no seat {error}"
        for seat in seats:
            if isinstance(wish, HandOut):
                self._rooms.hand_out(seat, wish.scene)
            else:
                self._rooms.hold(seat, wish.do == "hold")
        return ""

    async def _tell(self, page: WebSocket) -> None:
        """Tell the teacher's page of the class, where it has changed."""
        sent = ""
        with contextlib.suppress(WebSocketDisconnect, RuntimeError):
            while True:
                marks = await anyio.to_thread.run_sync(self._file.marks)
                now = json.dumps({"seats": self._seen(marks)})
                if now != sent:
                    sent = now
                    await page.send_text(now)
                await asyncio.sleep(REPORT_EVERY_S)

    def _seen(self, marks: list[AttemptResult]) -> list[dict[str, Any]]:
        """The class as the page shows it."""
        attempts = Counter((mark.pupil, mark.scene) for mark in marks)
        best: dict[tuple[str, str], AttemptResult] = {}
        for mark in sorted(marks, key=lambda mark: mark.points):
            if mark.handed_in:
                best[mark.pupil, mark.scene] = mark
        return [
            {
                "key": seat.key,
                "name": seat.pupil.name,
                "link": self._links[seat.key],
                "scene": seat.status.get("scene", seat.scene),
                "title": seat.status.get("title") or self._shipped.get(seat.scene, seat.scene),
                "held": seat.held,
                "failed": seat.failed,
                "room": {**seat.status, "stuck": stuck(seat, time.monotonic())}
                if seat.status
                else None,
                "marks": [
                    {
                        "scene": scene,
                        "title": self._shipped.get(scene) or mark.title,
                        "points": mark.points,
                        "of": mark.points_of,
                        "attempts": attempts[pupil, scene],
                    }
                    for (pupil, scene), mark in sorted(best.items())
                    if pupil == seat.pupil.name
                ],
            }
            for seat in self._rooms.seats.values()
        ]


def stuck(seat: Seat, now: float) -> str:
    """Why a pupil needs help: ``alarm``, ``idle``, or nothing.

    Args:
        now: By the monotonic clock [s].
    """
    status = seat.status
    if not status or status["over"] or status["frozen"]:
        return ""
    if seat.alarmed_at is not None and now - seat.alarmed_at > ALARM_S:
        return "alarm"
    waits = not status["running"] or status["held"]
    return "idle" if waits and now - seat.acted_at > IDLE_S else ""


def _answer(door: Door, path: str) -> Response:
    """What a room answers."""
    with contextlib.closing(door.connection()) as connection:
        connection.request("GET", path, headers={"Connection": "close", HEADER: door.secret})
        answer = connection.getresponse()
        media_type = answer.headers.get("content-type", "application/octet-stream")
        return Response(answer.read(), answer.status, media_type=media_type)


async def _splice(page: WebSocket, door: Door, path: str) -> None:
    """Pass what a page and its room say to each other on, until one of them goes."""
    async with door.stream(path) as room:

        async def up() -> None:
            with contextlib.suppress(WebSocketDisconnect):
                while True:
                    await room.send(await page.receive_text())

        async def down() -> None:
            async for message in room:
                if isinstance(message, bytes):
                    await page.send_bytes(message)
                else:
                    await page.send_text(message)

        directions = [asyncio.create_task(up()), asyncio.create_task(down())]
        _, left = await asyncio.wait(directions, return_when=asyncio.FIRST_COMPLETED)
        for direction in left:
            direction.cancel()
        await asyncio.gather(*directions, return_exceptions=True)
