"""The rooms of a class: begun when a pupil comes, ended when he has left, each in its own process."""

import asyncio
import contextlib
import dataclasses
import time
from collections.abc import Iterator, Mapping
from multiprocessing.connection import Connection
from typing import Any

from twin.training.classroom.door import Door
from twin.training.classroom.hosts import START_S, RoomError, RoomHost, RoomWorker
from twin.training.classroom.marks import ClassFile
from twin.training.classroom.room_process import RoomOrder
from twin.training.classroom.roster import Pupil
from twin.training.scene.vocabulary import Language

GRACE_S = 120.0
"""How long a room waits for its pupil to come back, before it is ended [s]."""
LOOKED_EVERY_S = 2.0
"""Between two looks for rooms that have been left, or have died [s]."""
END_S = 5.0
"""Longest that a room takes to write its last sheet [s]; then it is killed."""


@dataclasses.dataclass
class Seat:
    """A pupil's place in the class.

    Attributes:
        key: First part of the pupil's address.
        scene: What has been handed out last.
        held: The teacher holds it.
        streams: How many pages are open, the teacher's with them.
        left_at: When the last of them was closed, by the monotonic clock [s].
        status: The last report of its room; empty: there is none.
        acted_at: When the pupil has done something last, by the monotonic clock [s].
        alarmed_at: Since when an alarm is active, by the monotonic clock [s]; None: none does.
        failed: Why its room could not be begun, or ended by itself; empty: it did not.
        process: The room's; None: there is none.
        node: What a cluster calls the computer on which it runs.
    """

    key: str
    pupil: Pupil
    scene: str
    held: bool = False
    streams: int = 0
    left_at: float = 0.0
    status: dict[str, Any] = dataclasses.field(default_factory=dict)
    acted_at: float = 0.0
    alarmed_at: float | None = None
    failed: str = ""
    process: RoomWorker | None = None
    pipe: Connection | None = None
    door: Door | None = None
    node: str = ""
    lock: asyncio.Lock = dataclasses.field(default_factory=asyncio.Lock)

    def take(self, status: dict[str, Any]) -> None:
        """Take a report of the room."""
        now = time.monotonic()
        if status["done"] != self.status.get("done"):
            self.acted_at = now
        if not status["alarm"]:
            self.alarmed_at = None
        elif self.alarmed_at is None:
            self.alarmed_at = now
        self.status = status


class Rooms:
    """Begins and ends rooms; of its methods all but ``close`` belong to the server's event loop."""

    def __init__(
        self,
        pupils: tuple[Pupil, ...],
        scene: str,
        language: Language | None,
        file: ClassFile,
        host: RoomHost,
    ) -> None:
        """Prepare the seats, with what each pupil was given before.

        Args:
            language: Of all pages; None: of each scene.
        """
        kept, numbers = file.scenes(), file.seats(pupil.name for pupil in pupils)
        self._file = file
        self._language: Language | None = language
        self.seats: dict[str, Seat] = {}
        for pupil in pupils:
            key = f"seat-{numbers[pupil.name]}"
            self.seats[key] = Seat(key, pupil, kept.get(pupil.name) or pupil.scene or scene)
        self._host = host
        self._keeper: asyncio.Task[None] | None = None

    async def opened(self, seat: Seat) -> Door:
        """The door of a seat's room, which is begun where there is none.

        Raises:
            RoomError: It cannot be begun.
        """
        if self._keeper is None:
            self._keeper = asyncio.create_task(self._look_after())
        async with seat.lock:
            if seat.process is None or not seat.process.is_alive():
                self._forget(seat)
                seat.left_at = time.monotonic()
                await self._begin(seat)
            assert seat.door is not None
            return seat.door

    async def _begin(self, seat: Seat) -> None:
        folder = self._file.folder.absolute()
        order = RoomOrder(
            pupil=seat.pupil.name,
            scene=seat.scene,
            language=self._language,
            folder=folder,
            sheets=folder / seat.key,
        )
        process, ours = await asyncio.to_thread(self._host.begin, order)
        seat.process, seat.pipe = process, ours
        answer = await asyncio.to_thread(_first_answer, ours)
        seat.failed = answer.get("failed", "")
        if seat.failed:
            process.kill()
            self._forget(seat)
            raise RoomError(seat.failed)
        seat.door, seat.node = answer["door"], answer["node"]
        seat.acted_at = time.monotonic()
        asyncio.get_running_loop().add_reader(ours.fileno(), self._hear, seat, ours)
        if seat.held:
            self.say(seat, {"do": "freeze"})

    def _hear(self, seat: Seat, pipe: Connection) -> None:
        """Take what a room tells; one that has died tells nothing more."""
        try:
            status = pipe.recv()
        except (EOFError, OSError):
            asyncio.get_running_loop().remove_reader(pipe.fileno())
            pipe.close()
            if seat.pipe is pipe:
                seat.failed = "the room has ended by itself"
                self._forget(seat)
            return
        seat.take(status)
        if seat.held and not status["frozen"]:
            self.say(seat, {"do": "freeze"})

    def say(self, seat: Seat, what: Mapping[str, Any]) -> None:
        """Send a room a message, if there is one."""
        if seat.pipe is not None:
            with contextlib.suppress(OSError):
                seat.pipe.send(dict(what))

    def hold(self, seat: Seat, held: bool) -> None:
        """Hold a pupil's machine, or let it go on; also one that is begun later."""
        seat.held = held
        self.say(seat, {"do": "freeze" if held else "go_on"})

    def hand_out(self, seat: Seat, scene: str) -> None:
        """Give a pupil another scene, or the same again; he finds it also when he comes later."""
        self._file.hand_out(seat.pupil.name, scene)
        seat.scene = scene
        self.say(seat, {"attempt": scene})

    @contextlib.contextmanager
    def watched(self, seat: Seat) -> Iterator[None]:
        """Keep a seat's room while a page shows it."""
        seat.streams += 1
        try:
            yield
        finally:
            seat.streams -= 1
            seat.left_at = time.monotonic()

    async def _look_after(self) -> None:
        """End rooms that have been left."""
        while True:
            await asyncio.sleep(LOOKED_EVERY_S)
            for seat in self.seats.values():
                left = time.monotonic() - seat.left_at
                if seat.process is not None and seat.streams == 0 and left > GRACE_S:
                    async with seat.lock:
                        await asyncio.to_thread(self.end, seat)

    def end(self, seat: Seat) -> None:
        """End a room: what it has come to is in the class's file."""
        process = seat.process
        self.say(seat, {"end": True})
        seat.pipe = None
        if process is not None:
            process.join(END_S)
            if process.is_alive():
                process.kill()
                process.join()
        seat.process, seat.status, seat.alarmed_at = None, {}, None

    def _forget(self, seat: Seat) -> None:
        seat.process, seat.pipe, seat.status, seat.alarmed_at = None, None, {}, None

    def close(self) -> None:
        """End all rooms."""
        running = [seat for seat in self.seats.values() if seat.process is not None]
        for seat in running:
            self.say(seat, {"end": True})
        for seat in running:
            self.end(seat)
        self._host.close()


def _first_answer(pipe: Connection) -> dict[str, Any]:
    """What a room says first: that it is ready, or why it is not."""
    try:
        if pipe.poll(START_S):
            return pipe.recv()
    except (EOFError, OSError):
        return {"failed": "the room ended before it had begun"}
    return {"failed": f"the room has not begun within {START_S:.0f} s"}
