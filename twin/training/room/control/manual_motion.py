"""Axes driven by hand: jog keys, the handwheel, and moves to the reference point and back to the path."""

from collections import deque
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from twin.machine.description.config import MachineConfig
from twin.nc.canonical import FloatArray
from twin.training.program.program_run import ProgramRun

SHORTEST_MOVE = 1e-4
"""Distance that counts as none when an axis is driven by hand [mm or deg]: below the handwheel's least step."""


class JogMove(NamedTuple):
    """A move of one axis by hand.

    Attributes:
        target: Machine coordinates, within the travel [mm or deg].
        feed: [mm/min or deg/min].
        wheel: The handwheel asked for it.
    """

    axis: str
    target: float
    feed: float
    wheel: bool = False


class ManualMotion:
    """Moves by hand: the first is running, the others follow; other files read it and call its methods."""

    def __init__(self) -> None:
        self.moves: deque[JogMove] = deque()

    @property
    def wheel_move(self) -> JogMove | None:
        """The last move, where the handwheel asked for it."""
        return self.moves[-1] if self.moves and self.moves[-1].wheel else None

    def plan(self, moves: Iterable[JogMove]) -> None:
        """Drive axes one after the other."""
        self.moves = deque(moves)

    def follow_wheel(self, move: JogMove, run: ProgramRun, position: float) -> None:
        """Let the axis that follows the handwheel go on to another place, or back at once.

        Args:
            position: Of the axis now, machine coordinates [mm or deg].
        """
        current = self.moves[0]
        self.moves = deque((current, move))
        if (move.target - current.target) * (current.target - position) < 0.0:
            run.drop()

    def finish_move(self) -> None:
        """The first move is done."""
        if self.moves:
            self.moves.popleft()

    def clear(self) -> None:
        """Forget all moves."""
        self.moves.clear()

    def next_move(self, machine: MachineConfig, stand: FloatArray) -> tuple[JogMove, float] | None:
        """The first move that leads anywhere, with its distance [mm or deg]; None: all are done.

        Args:
            stand: Where they are, machine coordinates, shape (k,) [mm or deg].
        """
        while self.moves:
            distance = self.moves[0].target - float(stand[machine.axes.index(self.moves[0].axis)])
            if abs(distance) >= SHORTEST_MOVE:
                return self.moves[0], distance
            self.moves.popleft()
        return None


def within_travel(machine: MachineConfig, axis: str, position: float, target: float) -> float:
    """How far an axis goes by hand: to the end of its travel; from beyond it only back.

    Args:
        position: Where it is, machine coordinates [mm or deg].
        target: Where it is to go.
    """
    low, high = machine.axis(axis).travel or (-np.inf, np.inf)
    return min(max(target, min(low, position)), max(high, position))
