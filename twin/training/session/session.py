"""A session: a room, what was done in it and when; it can be frozen, wound back and lived again.

The log is the session: given the scene, the commands at their ticks make the same motion again. So
going back is living it again up to an earlier tick, and a replay is the same up to the present one.
"""

import dataclasses
from typing import Any

from twin.errors import TwinError
from twin.training.scene.scene_file import Scene
from twin.training.session.actions import carry_out
from twin.training.session.commands import (
    TRAINERS,
    Answer,
    Command,
    Finish,
    Hint,
    command_data,
    command_from,
)
from twin.training.session.log import Entry, Replay, Who, relive
from twin.training.session.room import SLICE, Room
from twin.training.session.snapshot import Snapshot, take_snapshot


class Session:
    """A scene that is being played.

    Attributes:
        scene: The scene.
        room: Its machine.
        log: Every action, in order.
        frozen: Time stands still.
        refusal: Why the last command was refused, empty when it was not.
    """

    def __init__(self, scene: Scene) -> None:
        """Begin.

        Raises:
            ConfigError: The scene does not fit its machine.
        """
        self.scene = scene
        self.room = Room(scene)
        self.log: list[Entry] = []
        self.frozen = False
        self.refusal = ""

    def submit(self, data: Any, who: Who = "operator") -> bool:
        """Give a command, from anywhere: what is malformed is refused and leaves no other trace.

        Args:
            data: A mapping with ``do`` and what belongs to it, or a command.
            who: Who gives it.

        Returns:
            Whether the machine did it.
        """
        plain: dict[str, Any] = {}
        try:
            command = command_from(data)
            plain = command_data(command)
            self._require_allowed(command, who)
            carry_out(self.room, command)
            self.refusal = ""
        except TwinError as error:
            self.refusal = str(error)
        if plain:
            self.log.append(Entry(self.room.tick, who, plain, self.refusal))
        return not self.refusal

    def _require_allowed(self, command: Command, who: Who) -> None:
        if isinstance(command, TRAINERS) and who != "trainer":
            raise TwinError("only the trainer can do that")
        if self.room.judge.over and isinstance(command, Answer | Finish | Hint):
            raise TwinError("the scene has been handed in already")

    def advance(self, slices: int = 1) -> None:
        """Let time go on by slices, unless it is frozen."""
        if not self.frozen:
            self.room.advance(slices)

    def rewind(self, seconds: float) -> None:
        """Go back; what was done after that is forgotten.

        Args:
            seconds: How far, in machine time [s].
        """
        back = SLICE * round(seconds / self.room.slice_s)
        tick = max(0, self.room.tick - back)
        kept = [entry for entry in self.log if entry.tick <= tick]
        self.room = relive(self.scene, kept, tick)
        self.log = kept
        self.refusal = ""

    def replay(self) -> Replay:
        """What there is to show again."""
        return Replay(self.scene, self.log, self.room.tick)

    def snapshot(self) -> Snapshot:
        """Look at the machine."""
        return dataclasses.replace(
            take_snapshot(self.room), frozen=self.frozen, refusal=self.refusal
        )
