"""A training room in a process of its own, as an operator's is, and what a bench asks of it.

Whoever leads the browser works hard while it clicks: in the room's process that would be measured.
"""

import contextlib
import multiprocessing
import os
import resource
import sys
import threading
import time
from collections.abc import Callable, Iterator
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.server.launch import OpenRoom, open_room
from twin.training.session.log import Who

SCENE = "mefi_helix_hold"
OVERRIDE = 20
"""Feed override, so that the program lasts [%]."""
FEED = 400.0
"""The helix's feed at this override [mm/min]."""
PATIENCE_S = 60.0
LONG_LOOK_S = 0.1
"""Between two looks at whether a program runs [s]."""
LOOK_S = 0.002
"""Between two looks at the machine [s]: often enough to tell, and rarely enough not to disturb."""
STEADY = 0.005
"""Share of the feed that the speed may be off by: the teeth shake the axes."""
GONE = 0.02
"""Share of the speed that is gone when the machine counts as having reacted."""


class MeasuredRoom:
    """What a bench may ask of the room, called in the room's own process."""

    def __init__(self, room: OpenRoom) -> None:
        self._room = room
        self._asked = 0.0
        self._ask, self._advance = room.driver.ask, room.session.advance
        room.driver.ask, room.session.advance = self._note_ask, self._note_advance
        self._slowest_steady = 0.0
        self._braked = threading.Event()
        self._braked_at = 0.0
        room.session.room.panel.turn_dial("feed", OVERRIDE)

    def _note_ask(self, command: Any, who: Who, page: int) -> None:
        self._asked = time.time()
        self._ask(command, who, page)

    def _note_advance(self, slices: int = 1) -> None:
        """Look at the machine on its own thread: a look from another one would keep it waiting."""
        self._advance(slices)
        if not self._braked.is_set() and self._speed() < self._slowest_steady:
            self._braked_at = time.time()
            self._braked.set()

    def asked(self) -> float:
        """When the last command of a page was heard, by ``time.time`` [s]."""
        return self._asked

    def preceding_threads(self) -> int:
        """How many of the room's threads the system lets run before other programs."""
        threads = [thread.native_id or 0 for thread in threading.enumerate()]
        if sys.platform != "linux":
            return 0
        return sum(os.sched_getscheduler(thread) != os.SCHED_OTHER for thread in threads)

    def addresses(self) -> dict[str, str]:
        """Of its pages."""
        return self._room.addresses

    def bytes_sent(self) -> int:
        """Through all streams so far."""
        return self._room.app.bytes_sent

    def memory_mb(self) -> float:
        """The most that the process has needed so far [MB]."""
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0

    def machine_time(self) -> float:
        """What the machine has lived so far [s]."""
        return self._room.session.room.time_s

    def condition(self) -> tuple[float, float, float]:
        """What the machine has lived and what it has lost [s], and what the room needs now [MB]."""
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
        memory = pages * resource.getpagesize() / 1e6
        return self.machine_time(), self._room.driver.lost_s, memory

    def keep_busy(self, percent: int) -> bool:
        """Begin the program again on a new blank where it has come to its end; whether it was so.

        Args:
            percent: Feed override.
        """
        room = self._room.session.room
        if room.slot.running or room.machine.moving:
            return False
        for command in (
            {"do": "reset"},
            {"do": "mode", "mode": "jog"},
            {"do": "spindle", "on": False},
            {"do": "new_blank"},
            {"do": "mode", "mode": "auto"},
            {"do": "override", "dial": "feed", "percent": percent},
            {"do": "cycle_start"},
        ):
            self._room.driver.ask(command, "operator", 0)
        wait_until(lambda: bool(self._room.session.room.slot.running))
        return True

    def run_steadily(self) -> None:
        """Let the program run at its steady feed: go on where it is held, begin again at its end."""
        end = time.perf_counter() + PATIENCE_S
        while not self._steady():
            room = self._room.session.room
            if room.slot.held and not room.machine.moving:
                self._room.driver.ask({"do": "cycle_start"}, "operator", 0)
            else:
                self.keep_busy(OVERRIDE)
            if time.perf_counter() > end:
                raise TimeoutError(f"the program does not run: {room.alarm}, {room.line}")
            time.sleep(LONG_LOOK_S)

    def wait_for_braking(self) -> float:
        """Wait for the first loss of speed; returns when it was, by ``time.time`` [s]."""
        self._slowest_steady = (1.0 - GONE) * self._speed()
        self._braked.clear()
        if not self._braked.wait(PATIENCE_S):
            raise TimeoutError("the machine did not brake")
        return self._braked_at

    def _steady(self) -> bool:
        return abs(self._speed() - FEED) < STEADY * FEED

    def _speed(self) -> float:
        velocity = self._room.session.room.samples.joint_velocity[-1, :3]
        return 60.0 * float((velocity @ velocity) ** 0.5)


class RoomProcess:
    """The other end of it."""

    def __init__(self, line: Connection) -> None:
        self._line = line

    def begin(self, method: Callable[..., Any], *arguments: Any) -> None:
        """Ask for something that takes a while: for a method of ``MeasuredRoom``."""
        self._line.send((method.__name__, arguments))

    def end(self) -> Any:
        """What it said.

        Raises:
            TimeoutError: It did not do what it was asked for.
        """
        if not self._line.poll(2.0 * PATIENCE_S):
            raise TimeoutError("the training room did not do what it was asked for")
        return self._line.recv()

    def ask(self, method: Callable[..., Any], *arguments: Any) -> Any:
        """Ask for something, and wait."""
        self.begin(method, *arguments)
        return self.end()


@contextlib.contextmanager
def room_process() -> Iterator[RoomProcess]:
    """Open the room."""
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    process = context.Process(target=_live, args=(there,), daemon=True)
    process.start()
    there.close()
    try:
        yield RoomProcess(here)  # pyright: ignore[reportArgumentType] (Windows names it otherwise)
    finally:
        here.close()
        process.join(timeout=10.0)
        process.kill()


def _live(line: Connection) -> None:
    with open_room(read_scene(scene_path(SCENE)), promptly=True) as room:
        measured = MeasuredRoom(room)

        def answer() -> None:
            # The line breaks when the bench is over.
            with contextlib.suppress(EOFError):
                while True:
                    name, arguments = line.recv()
                    line.send(getattr(measured, name)(*arguments))
            room.stop()

        threading.Thread(target=answer, daemon=True).start()
        room.serve()


def wait_until(come: Callable[[], bool]) -> None:
    """Wait for something.

    Raises:
        TimeoutError: It did not come.
    """
    end = time.perf_counter() + PATIENCE_S
    while not come():
        if time.perf_counter() > end:
            raise TimeoutError("the training room did not do what it was asked for")
        time.sleep(LOOK_S)
