"""A session: a room and its log of commands; it can be frozen, wound back and replayed.

The log holds all that was asked for, also what was taken back later. Going back takes a copy of the
room from a time before and lives the rest again, by the same commands at the same ticks.
"""

import dataclasses
from typing import Any, get_args

from twin.errors import TwinError
from twin.training.room.room import SLICE, Room
from twin.training.scene.scene_file import Scene
from twin.training.session.actions import carry_out
from twin.training.session.checkpoints import Checkpoints
from twin.training.session.commands import (
    TRAINERS,
    AnswerQuestion,
    Command,
    EmergencyStop,
    EndReplay,
    Finish,
    Freeze,
    Hint,
    Rewind,
    SessionCommand,
    Sign,
    StartReplay,
    Unfreeze,
    command_data,
    command_from,
)
from twin.training.session.log import LogEntry, Replay, Who, relive
from twin.training.session.snapshot import Snapshot, take_snapshot

LIVED_AGAIN_S = 4.0
"""Machine time that going back lives again at most [s]."""


class SceneSession:
    """A scene that is being played.

    Attributes:
        replay: What is being shown again; None: the machine itself is seen.
        refusal: Why the last command was refused, empty when it was not.
        signature: Who is at the panel, as far as somebody has said.
    """

    def __init__(self, scene: Scene) -> None:
        """Begin.

        Raises:
            ConfigError: The scene does not fit its machine.
        """
        self.scene = scene
        self.room = Room(scene)
        self.log: list[LogEntry] = []
        self.frozen = False
        self.replay: Replay | None = None
        self.refusal = ""
        self.refusals = 0
        self.signature = ""
        self._done: list[LogEntry] = []
        self._checkpoints = Checkpoints(self.room)

    def submit(self, data: Any, who: Who = "operator") -> bool:
        """Give a command, from anywhere: what is malformed is refused and leaves no other trace.

        Args:
            data: A mapping with ``do`` and what belongs to it, or a command.

        Returns:
            Whether it was done.
        """
        plain: dict[str, Any] = {}
        tick = self.room.tick
        command: Command | None = None
        try:
            command = command_from(data)
            plain = command_data(command)
            self._require_allowed(command, who)
            if isinstance(command, get_args(SessionCommand)):
                self._change_time(command)
            else:
                if isinstance(command, EmergencyStop):
                    self.replay = None
                carry_out(self.room, command)
                if isinstance(command, Sign):
                    self.signature = command.name.strip()
            self.refusal = ""
        except TwinError as error:
            self.refusal = str(error)
            self.refusals += 1
        if plain:
            entry = LogEntry(tick, who, plain, self.refusal)
            self.log.append(entry)
            if not isinstance(command, get_args(SessionCommand)):
                self._done.append(entry)
        return not self.refusal

    def _require_allowed(self, command: Command, who: Who) -> None:
        if isinstance(command, TRAINERS) and who != "trainer":
            raise TwinError("only the trainer can do that")
        if self.room.judge.over and isinstance(command, AnswerQuestion | Finish | Hint):
            raise TwinError("the scene has been handed in already")
        if self.replay is not None and not isinstance(command, EndReplay | EmergencyStop):
            raise TwinError("the session is being shown again: end that first")

    def _change_time(self, command: Command) -> None:
        if isinstance(command, Freeze | Unfreeze):
            self.frozen = isinstance(command, Freeze)
        elif isinstance(command, Rewind):
            self.rewind(command.seconds)
            self.frozen = True
        elif isinstance(command, StartReplay):
            self.replay = Replay(Room(self.scene), self._done, self.room.tick)
        elif self.replay is None:
            raise TwinError("nothing is being shown again")
        else:
            self.replay = None

    def advance(self, slices: int = 1) -> None:
        """Let time go on by slices, unless it is frozen."""
        if not self.frozen:
            self.room.advance(slices)
            self._checkpoints.note(self.room, len(self._done))

    def rewind(self, seconds: float) -> None:
        """Go back; what was done after that stays in the log.

        Args:
            seconds: How far, in machine time [s]. What lies too far from a checkpoint to be lived
                again at once is given up for the checkpoint.
        """
        back = SLICE * round(seconds / self.room.slice_s)
        tick = max(0, self.room.tick - back)
        checkpoint = self._checkpoints.before(tick)
        if (tick - checkpoint.tick) * self.room.slice_s > SLICE * LIVED_AGAIN_S:
            tick = checkpoint.tick
        self._done = [entry for entry in self._done if entry.tick <= tick]
        self.room = relive(checkpoint.restored(), self._done[checkpoint.done :], tick)

    def snapshot(self) -> Snapshot:
        """Look at the machine, or at what is being shown again."""
        replay = self.replay
        return dataclasses.replace(
            take_snapshot(self.room if replay is None else replay.room),
            frozen=self.frozen,
            replaying=replay is not None,
            refusal=self.refusal,
            refusals=self.refusals,
            signature=self.signature,
        )
