"""A training room with its page open for a long time: scripts/bench --room [MINUTES].

The scene's program is cut again and again, each time from a new blank, while a page and a watcher
look on. A line for each minute says how machine time has kept up with the wall's and what the room
needs of memory; the exit code is 1 where time was lost or memory has grown.
"""

import sys
import time
from collections.abc import Iterator
from typing import NamedTuple

from benches.training_room import RoomProcess, room_process
from panel_player import browser
from rich.console import Console
from rich.table import Table

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
        programs += room.ask("keep_busy", 100)
        machine_s, lost_s, memory_mb = room.ask("condition")
        yield Look(passed, machine_s, lost_s, memory_mb, programs)
        time.sleep(LOOK_S)


def main(minutes: float) -> int:
    """Look on; the exit code."""
    table = Table("minute", "machine time per time", "lost", "memory", "programs begun")
    seen: list[Look] = []
    with room_process() as room, browser() as opened:
        addresses = room.ask("addresses")
        for role in ("operator", "watcher"):
            page = opened.new_context(viewport={"width": 1280, "height": 720}).new_page()
            page.goto(addresses[role])
            page.wait_for_selector("body[data-view=ready]")
        for look in looks(room, minutes):
            seen.append(look)
            if int(look.wall_s / 60.0) > len(table.rows):
                first = seen[0]
                factor = (look.machine_s - first.machine_s) / (look.wall_s - first.wall_s)
                table.add_row(
                    f"{look.wall_s / 60.0:.0f}", f"{factor:.4f}", f"{look.lost_s:.1f} s",
                    f"{look.memory_mb:.0f} MB", str(look.programs),
                )  # fmt: skip
                line = ", ".join(str(next(reversed(list(each.cells)))) for each in table.columns)
                Console(stderr=True).print(line)
    Console(width=100).print(table)
    settled = [one.memory_mb for one in seen if one.wall_s > 60.0 * SETTLED_MINUTES]
    grown = max(settled, default=0.0) - min(settled[:1], default=0.0)
    return int(seen[-1].lost_s > 0.0 or grown > GROWN_MB)


if __name__ == "__main__":
    sys.exit(main(float(sys.argv[1]) if len(sys.argv) > 1 else MINUTES))
