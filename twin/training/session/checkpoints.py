"""Copies of a room at earlier moments, so that going back takes no longer after hours."""

import copy
import dataclasses
from typing import Any

import mujoco

from twin.machine.description.config import Machine
from twin.nc.text.source import Source
from twin.training.scene.scene_file import Scene
from twin.training.session.program_run import ProgramRun, ProgramRunCopy
from twin.training.session.room import SLICE, Room

APART_S = 4.0
"""Machine time between two copies [s]."""
DENSE = 20
"""Newest copies that are kept; older ones lie further apart the older they are."""

_SHARED = (Scene, Machine, Source, mujoco.MjModel)
"""What never changes and need not be copied."""


@dataclasses.dataclass(frozen=True, slots=True)
class Checkpoint:
    """A room as it was.

    Attributes:
        tick: Servo periods since the beginning.
        done: How many commands had been given by then.
        room: The copy; its run is planned anew when the copy is used.
    """

    tick: int
    done: int
    room: Room

    def restored(self) -> Room:
        """A room that goes on from there; the copy stays as it is."""
        room = _copied(self.room)
        room.run = _made_again(room.run)
        return room


class Checkpoints:
    """The copies of a session's room."""

    def __init__(self, room: Room) -> None:
        """Begin with the room as it is."""
        self._kept = [Checkpoint(room.tick, 0, _copied(room))]
        self._apart = SLICE * round(APART_S / room.slice_s)

    def note(self, room: Room, done: int) -> None:
        """Take a copy where the last one is old enough.

        Args:
            room: As it is.
            done: How many commands have been given to it.
        """
        if room.tick - self._kept[-1].tick >= self._apart:
            self._kept.append(Checkpoint(room.tick, done, _copied(room)))
            self._thin_out()

    def before(self, tick: int) -> Checkpoint:
        """The newest copy that is not younger than a tick; younger ones are forgotten."""
        while self._kept[-1].tick > tick:
            self._kept.pop()
        return self._kept[-1]

    def _thin_out(self) -> None:
        """Of the older copies keep such as lie apart by a share of their age."""
        newest = self._kept[-1].tick
        kept = self._kept[:1]
        for number, one in enumerate(self._kept[1:], 1):
            recent = number >= len(self._kept) - DENSE
            if recent or one.tick - kept[-1].tick >= 0.1 * (newest - one.tick):
                kept.append(one)
        self._kept = kept


def _made_again(run: ProgramRun | ProgramRunCopy | None) -> ProgramRun | None:
    return run.made_again() if isinstance(run, ProgramRunCopy) else run


def _copied(room: Room) -> Room:
    memo: dict[int, Any] = {}
    _share(room, memo, set())
    return copy.deepcopy(room, memo)


def _share(thing: object, memo: dict[int, Any], seen: set[int]) -> None:
    """Let a copy share what never changes with what it is a copy of."""
    if id(thing) in seen:
        return
    seen.add(id(thing))
    if isinstance(thing, _SHARED):
        memo[id(thing)] = thing
        return
    for part in getattr(thing, "__dict__", {}).values():
        if getattr(type(part), "__module__", "").startswith(("twin.", "mujoco")):
            _share(part, memo, seen)
