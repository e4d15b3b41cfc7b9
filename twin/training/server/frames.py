"""Messages to a page: the machine's state as numbers, patches of the stock, words on change."""

import dataclasses
import json
import struct
import threading
from collections import deque
from typing import Any

import numpy as np

from twin.cutting.heights.height_map import HeightMap
from twin.cutting.heights.patches import patch_message
from twin.cutting.heights.sweeping import Rectangle, union
from twin.training.program.preview import Preview
from twin.training.room.room import Room
from twin.training.server.driver import Look
from twin.training.session.snapshot import Snapshot

STATE = 1
"""First byte of the state; patches have their own."""
MOST_TOOL = 255
"""Tools of higher numbers are distinguished from this one no more by what they have cut."""
PATCHES_KEPT = 512
"""Changes of the stock that are remembered; a page that is further behind gets the whole stock."""

_STATE_ALONE = (
    "time_s",
    "position",
    "machine_position",
    "distance_to_go",
    "following_error",
    "load",
)
_IN_STATE = frozenset({*_STATE_ALONE, "feed", "speed", "trail", "moving", "loads"})


def state_message(look: Look, cutting: bool) -> bytes:
    """The state: kind, flags, number of axes k, then numbers of 64 bits.

    Numbers: time [s], machine time per time on the wall, feed, spindle speed, the tip's X, Y, Z in
    the part's frame [mm]; then k each of: position as the screen shows it, machine position,
    distance to go, following error [mm or deg], load [share]; then ``Loads``. Flags: 1 moving, 2 the
    feeler lamp, 4 the spindle turns, 8 coolant, 16 material is being cut.
    """
    now = look.now
    flags = now.moving | now.touches << 1 | now.spindle.turns << 2 | now.coolant << 3 | cutting << 4
    rows = [getattr(now, name) for name in _STATE_ALONE[1:]]
    numbers = [
        now.time_s,
        now.speed,
        now.feed,
        abs(now.spindle.turning or now.spindle.asked or 0.0),
        *now.trail,
    ]
    for row in rows:
        numbers += row
    numbers += now.loads
    return struct.pack(f"<BBHI{len(numbers)}d", STATE, flags, len(now.axes), 0, *numbers)


def path_message(preview: Preview, message: dict[str, str] | None) -> bytes:
    """A program's path: the length of a head in JSON, that head, then the points.

    The head, filled up to a multiple of four, has ``moves``, ``points``, ``origin``, ``complete``,
    ``line`` and ``message``. X, Y, Z
    of each point follow as numbers of 32 bits, then a byte each: 1 where a rapid leads to it.
    """
    head = json.dumps(
        {
            "moves": preview.moves,
            "points": len(preview.points),
            "origin": preview.origin.tolist(),
            "complete": preview.complete,
            "line": preview.line,
            "message": message,
        }
    ).encode()
    head += b" " * (-len(head) % 4)
    rapid = preview.rapid.astype("u1").tobytes()
    return struct.pack("<I", len(head)) + head + preview.points.astype("<f4").tobytes() + rapid


def panel_words(look: Look) -> dict[str, Any]:
    """All that a page shows and that is not in the state, as plain data."""
    now: Snapshot = look.now
    found: dict[str, Any] = {}
    for field in dataclasses.fields(now):
        if field.name not in _IN_STATE:
            value = getattr(now, field.name)
            found[field.name] = _plain(value)
    found["lost_s"] = round(look.lost_s, 1)
    found["trouble"] = look.trouble
    return found


def _plain(value: Any) -> Any:
    if hasattr(value, "model_dump"):
        return value.model_dump()
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return dataclasses.asdict(value)
    if isinstance(value, tuple):
        return [_plain(each) for each in value]
    return value


def as_texts(words: dict[str, Any]) -> dict[str, str]:
    """Words as JSON, each for itself; in ASCII, so that also a name that is no Unicode can be sent."""
    return {name: json.dumps(value) for name, value in words.items()}


class Changes:
    """Which words a page has not been sent yet."""

    def __init__(self) -> None:
        self._sent: dict[str, str] = {}

    def since_last(self, texts: dict[str, str]) -> str:
        """Those that have changed since the last call as one JSON object; empty where none have.

        Args:
            texts: Each word's value as JSON.
        """
        found = {name: text for name, text in texts.items() if self._sent.get(name) != text}
        self._sent |= found
        inner = ",".join(f'"{name}":{text}' for name, text in found.items())
        return f"{{{inner}}}" if found else ""


class StockFeed:
    """The live stock as patches; the machine's thread notes changes, the server's reads them.

    Attributes:
        epoch: Grows when all that was sent is void.
        version: Grows with every change.
    """

    def __init__(self) -> None:
        self.epoch = 0
        self.version = 0
        self._map: HeightMap | None = None
        self._known = np.zeros((0, 0))
        self._tools = np.zeros((0, 0), np.uint8)
        self._changes: deque[tuple[int, Rectangle]] = deque(maxlen=PATCHES_KEPT)
        self._lock = threading.Lock()

    def note(self, room: Room) -> None:
        """Look at the stock of the room that is seen."""
        work = room.setup.work
        stock = None if work is None else work.map
        if work is None or stock is None:
            return
        with self._lock:
            if stock is not self._map:
                self._map = stock
                self.epoch += 1
                self.version += 1
                self._changes.clear()
                self._begin_tools(stock)
            changed = work.take_changed()
            if changed[0] < changed[1]:
                self.version += 1
                self._changes.append((self.version, changed))
                self._note_tool(stock, changed, room.setup.tables.spindle)

    def _begin_tools(self, stock: HeightMap) -> None:
        """Of a stock as it was earlier, what is cut was cut by whom it is known of."""
        cut = stock.machined()
        same = self._tools.shape == cut.shape
        self._tools = np.where(cut, self._tools if same else 0, 0).astype(np.uint8)
        self._known = stock.heights.copy()

    def _note_tool(self, stock: HeightMap, changed: Rectangle, tool: int) -> None:
        """What is lower than before was cut by the tool in the spindle."""
        row, row_end, column, column_end = changed
        cells = slice(row, row_end), slice(column, column_end)
        lower = stock.heights[cells] < self._known[cells]
        self._tools[cells][lower] = min(tool, MOST_TOOL)
        self._known[cells] = stock.heights[cells]

    def patch(self, epoch: int, version: int) -> tuple[bytes | None, int, int]:
        """What a page lacks.

        Returns:
            A message, or None where it lacks nothing; and what the page has with it.
        """
        with self._lock:
            stock = self._map
            if stock is None or (epoch, version) == (self.epoch, self.version):
                return None, epoch, version
            rows, columns = stock.heights.shape
            rectangle: Rectangle = (0, rows, 0, columns)
            known = self._changes[0][0] - 1 if self._changes else self.version
            if epoch == self.epoch and version >= known:
                rectangle = (0, 0, 0, 0)
                for number, changed in self._changes:
                    if number > version:
                        rectangle = union(rectangle, changed)
            message = patch_message(stock, rectangle, self.epoch, self._tools)
            return message, self.epoch, self.version
