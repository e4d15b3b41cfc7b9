"""The log of a session, and its replay: the same commands at the same ticks."""

import dataclasses
from collections.abc import Sequence
from typing import Any, Literal

from twin.training.room.room import SLICE, Room
from twin.training.session.actions import carry_out
from twin.training.session.commands import command_from

Who = Literal["operator", "trainer"]


@dataclasses.dataclass(frozen=True, slots=True)
class LogEntry:
    """A line of the log.

    Attributes:
        tick: Servo periods since the beginning.
        command: What, as plain data.
        refusal: Why it was not done; empty when it was.
    """

    tick: int
    who: Who
    command: dict[str, Any]
    refusal: str = ""


class Replay:
    """A session that is replayed in slices.

    Attributes:
        over: It has come to where the session had come to.
    """

    def __init__(self, room: Room, entries: Sequence[LogEntry], tick: int) -> None:
        """Go back.

        Args:
            room: The machine as it was at the beginning, or later.
        """
        self.room = room
        self._entries = [entry for entry in entries if entry.tick <= tick]
        self._given = 0
        self._end = tick

    @property
    def over(self) -> bool:
        """Whether the replay has come to its end."""
        return self.room.tick >= self._end

    def advance(self, seconds: float) -> None:
        """Go on by machine time [s], to the end at most."""
        room = self.room
        goal = min(self._end, room.tick + SLICE * round(seconds / room.slice_s))
        while self._given < len(self._entries) and self._entries[self._given].tick <= goal:
            entry = self._entries[self._given]
            room.advance((entry.tick - room.tick) // SLICE)
            if not entry.refusal:
                carry_out(room, command_from(entry.command))
            self._given += 1
        room.advance((goal - room.tick) // SLICE)


def relive(room: Room, entries: Sequence[LogEntry], tick: int) -> Room:
    """Replay a session.

    Args:
        room: The machine as it was at the beginning, or later.
    """
    replay = Replay(room, entries, tick)
    while not replay.over:
        replay.advance(1.0)
    return replay.room
