"""A training room with its page open for a long time.

The scene's program is cut again and again, each time from a new blank, while a page and a watcher
look on; with ``-s`` each look says how machine time has kept up with the wall's and what the room needs of memory.
"""

import time
from collections.abc import Iterator
from typing import NamedTuple

import pytest
from panel_player import browser

from tests.training.server.measured_room import MeasuredRoom, RoomProcess, room_process

MINUTES = 20.0
LOOK_S = 10.0
SETTLED_MINUTES = 2.0
"""After so long the room has all that it keeps of one program [min]."""
GROWN_MB = 15.0
"""Growth from then on that counts as none [MB]."""


class Look(NamedTuple):
    """A look at the room: wall's and machine's time, time lost [s], memory [MB], programs begun."""

    wall_s: float
    machine_s: float
    lost_s: float
    memory_mb: float
    programs: int


def looks(room: RoomProcess, minutes: float) -> Iterator[Look]:
    """Keep the room busy, and look at it."""
    begin, programs = time.perf_counter(), 0
    while (passed := time.perf_counter() - begin) < 60.0 * minutes:
        programs += room.ask(MeasuredRoom.keep_busy, 100)
        machine_s, lost_s, memory_mb = room.ask(MeasuredRoom.condition)
        yield Look(passed, machine_s, lost_s, memory_mb, programs)
        time.sleep(LOOK_S)


@pytest.mark.by_hand("twenty minutes of real time with a browser")
def test_a_long_session_loses_no_time_and_does_not_grow() -> None:
    seen: list[Look] = []
    with room_process() as room, browser() as opened:
        addresses = room.ask(MeasuredRoom.addresses)
        for role in ("operator", "watcher"):
            page = opened.new_context(viewport={"width": 1280, "height": 720}).new_page()
            page.goto(addresses[role])
            page.wait_for_selector("body[data-view=ready]")
        for look in looks(room, MINUTES):
            seen.append(look)
            print(look, flush=True)
    settled = [one.memory_mb for one in seen if one.wall_s > 60.0 * SETTLED_MINUTES]
    assert seen[-1].lost_s == 0.0
    assert max(settled) - settled[0] <= GROWN_MB
