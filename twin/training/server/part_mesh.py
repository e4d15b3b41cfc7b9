"""The part that is cut from any side as pages draw it: a mesh, made again in parallel with the machine while it is cut."""

import asyncio
import time

import anyio.to_thread

from twin.cutting.tridexel.dexels import TriDexel
from twin.cutting.tridexel.surface.mesh import mesh_message
from twin.training.room.room import Room
from twin.training.server.driver import Driver

EVERY_S, STILL_S = 0.7, 1.5
"""Between two meshes while the part is cut, and after how long one that is no longer cut is drawn finely [s]."""
COARSE, FINE = 8_000, 40_000
"""Crossings of the mesh of a part that is cut, and of one that is not."""


class PartMesh:
    """Keeps the mesh of the part that is seen; of its methods all belong to the server's event loop."""

    def __init__(self, driver: Driver) -> None:
        self._driver = driver
        self._version = 0
        self._message = b""
        self._made: tuple[float, bool] | None = None
        self._made_at = 0.0
        self._making: asyncio.Task[None] | None = None

    async def newer(self, version: int) -> tuple[bytes | None, int]:
        """The mesh where a page has an older one, or none; and the version that it has with it."""
        work = self._driver.seen.setup.work
        if work is None or work.dexels is None:
            return None, version
        since = time.monotonic() - self._made_at
        cut = self._made is None or self._made[0] != work.removed
        finer = self._made is not None and not cut and not self._made[1] and since > STILL_S
        if (self._making is None or self._making.done()) and ((cut and since > EVERY_S) or finer):
            self._making = asyncio.create_task(self._make(fine=finer or self._made is None))
        if version == self._version:
            return None, version
        return self._message, self._version

    async def _make(self, *, fine: bool) -> None:
        """Copy the part between two slices of the machine, and make the mesh in parallel."""
        self._made_at = time.monotonic()

        def copied(_room: Room) -> tuple[float, TriDexel] | None:
            work = self._driver.seen.setup.work
            part = None if work is None else work.dexels
            return None if part is None or work is None else (work.removed, part.copy())

        found = await asyncio.wrap_future(self._driver.inquire(copied))
        if found is None:
            return
        removed, part = found
        message = await anyio.to_thread.run_sync(mesh_message, part, FINE if fine else COARSE)
        self._message, self._made = message, (removed, fine)
        self._version += 1
        self._made_at = time.monotonic()
