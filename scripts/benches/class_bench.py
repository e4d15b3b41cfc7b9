"""A class: do the machines of four pupils who cut keep up with the wall's time, while twenty more stand.

The pages are streams that are read and not drawn: pupils have computers of their own.
"""

import contextlib
import json
import os
import statistics
import struct
import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from benches.row import Row
from websockets.exceptions import ConnectionClosed

from tests.training.classroom.class_server import ClassServer, stream, until
from tests.training.server.measured_room import OVERRIDE, SCENE
from twin.training.server.frames import STATE

SEATS, CUTTING = 24, 4
SETTLED_S, WATCHED_S = 8.0, 30.0
"""What the rooms are left alone before they are watched, and how long they are [s]."""


class _Page:
    """A pupil's page, read on a thread of its own."""

    def __init__(self, school: ClassServer, name: str) -> None:
        self.told: dict[str, Any] = {}
        self.machine_time = 0.0
        self._line = contextlib.ExitStack()
        self._stream = self._line.enter_context(stream(school, name))
        threading.Thread(target=self._hear, daemon=True).start()

    def _hear(self) -> None:
        with contextlib.suppress(ConnectionClosed):
            for message in self._stream.line:
                if isinstance(message, str):
                    self.told |= json.loads(message)
                elif message[0] == STATE:
                    (self.machine_time,) = struct.unpack_from("<d", message, 8)

    def say(self, **what: Any) -> None:
        self._stream.say(**what)

    def close(self) -> None:
        self._line.close()


def rows() -> Iterator[Row]:
    """What each room costs while all stand, and how four that cut keep up."""
    names = [f"pupil {number}" for number in range(SEATS)]
    with tempfile.TemporaryDirectory() as place, contextlib.ExitStack() as at_the_end:
        roster = Path(place) / "roster.csv"
        roster.write_text("\n".join(names), encoding="utf-8")
        school = ClassServer(roster, Path(place) / "class", SCENE)
        at_the_end.callback(school.stop)
        begin = time.perf_counter()
        pages = [at_the_end.enter_context(contextlib.closing(_Page(school, n))) for n in names]
        until(lambda: all("mode" in page.told for page in pages), "the rooms")
        yield Row("class", f"{SEATS} rooms begun", time.perf_counter() - begin, "s")
        time.sleep(SETTLED_S)
        shares = _shares(school)
        yield Row("class", "a room that stands", 100.0 * statistics.median(shares), "% of a core")
        for page in pages[:CUTTING]:
            page.say(do="override", dial="feed", percent=OVERRIDE)
            page.say(do="cycle_start")
        time.sleep(SETTLED_S)
        before, begin = [page.machine_time for page in pages], time.perf_counter()
        shares = sorted(_shares(school))[-CUTTING:]
        passed = time.perf_counter() - begin
        factors = [
            (page.machine_time - then) / passed
            for page, then in zip(pages[:CUTTING], before, strict=False)
        ]
        yield Row("class", f"the slowest of {CUTTING} that cut", min(factors), "x real time")
        lost = max(page.told["lost_s"] for page in pages)
        yield Row("class", "  time that a room has lost at most", lost, "s")
        yield Row("class", "  each of them", 100.0 * statistics.median(shares), "% of a core")


def _shares(school: ClassServer) -> list[float]:
    """Of a core, what each room uses for a while."""
    rooms, begin = school.rooms(), time.perf_counter()
    before = [_processor_s(room) for room in rooms]
    time.sleep(WATCHED_S)
    passed = time.perf_counter() - begin
    return [(_processor_s(room) - then) / passed for room, then in zip(rooms, before, strict=True)]


def _processor_s(process: int) -> float:
    """Processor time of a process so far [s]."""
    fields = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
