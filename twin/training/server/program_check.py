"""What the control says of a program that somebody is typing, before it is loaded."""

import asyncio
import contextlib
import dataclasses
import json
from collections.abc import Awaitable, Callable
from typing import Any

import anyio.to_thread
import pydantic
from starlette.websockets import WebSocketDisconnect

from twin.nc.text.diagnostics.diagnostics import Diagnostic
from twin.nc.text.source import source_from_text
from twin.training.program.preview import PathToCome
from twin.training.room.room import Room
from twin.training.room.run_settings import path_to_come
from twin.training.scene.phrases import finding_in, translated
from twin.training.scene.vocabulary import LANGUAGES
from twin.training.server.driver import Driver
from twin.training.session.commands import Load


class ProgramCheck:
    """Reads programs in parallel with the machine's thread, one at a time; of what a page types meanwhile the last."""

    def __init__(self, driver: Driver) -> None:
        """Prepare it.

        Args:
            driver: Of the machine that the program would run on.
        """
        self._driver = driver
        self._one = asyncio.Lock()
        self._typed: dict[int, Any] = {}
        self._checking: dict[int, asyncio.Task[None]] = {}

    def soon(self, page: int, text: Any, tell: Callable[[str], Awaitable[None]]) -> None:
        """Check what a page types, and tell it as JSON: ``{"checked": ...}``.

        Args:
            text: What is there now.
            tell: Sends it.
        """
        self._typed[page] = text
        if page not in self._checking:
            self._checking[page] = asyncio.create_task(self._check(page, tell))

    async def _check(self, page: int, tell: Callable[[str], Awaitable[None]]) -> None:
        try:
            while page in self._typed:
                # What is no program is refused when it is loaded.
                with contextlib.suppress(pydantic.ValidationError):
                    await tell(json.dumps({"checked": await self.of(self._typed.pop(page))}))
        except (WebSocketDisconnect, RuntimeError):
            self._typed.pop(page, None)  # The page is gone.
        finally:
            self._checking.pop(page)

    async def of(self, text: Any) -> dict[str, Any]:
        """What is wrong with a program, as the control would begin it now.

        Returns:
            ``line`` and ``column`` of the first mistake, ``width`` in letters, ``message`` by language;
            of a program that is right, ``moves`` alone.
        """
        program = Load(text=text).text

        def asked(room: Room) -> PathToCome:
            source = source_from_text(program, room.program.source.name)
            return dataclasses.replace(path_to_come(room), source=source, search=0)

        async with self._one:
            path = await asyncio.wrap_future(self._driver.inquire(asked))
            preview = await anyio.to_thread.run_sync(path.drawn)
        found = preview.finding
        if found is not None:
            return _as_json(found)
        if preview.message:
            message = {language: translated(preview.message, language) for language in LANGUAGES}
            return {"line": preview.line, "column": 0, "width": 0, "message": message}
        return {"moves": preview.moves}


def _as_json(found: Diagnostic) -> dict[str, Any]:
    message = {language: finding_in(found, language) for language in LANGUAGES}
    return {"line": found.line, "column": found.column, "width": found.width, "message": message}
