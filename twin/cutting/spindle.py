"""Whether the spindle turns: what the program's functions say of it, by move."""

import numpy as np
import numpy.typing as npt

from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Chunk, Function
from twin.nc.functions import SPINDLE_SPEED, SPINDLE_STARTS, SPINDLE_STOPS, SpindleState

_BEFORE_THE_NEXT = 1.0 - 1e-12
"""The end of a move's path still belongs to it: a function between two moves is not yet heard."""


def speaks_of_spindle(chunk: Chunk) -> bool:
    """Whether any function of a chunk starts, stops or sets the speed of the spindle."""
    return any(
        isinstance(event, Function)
        and event.word in SPINDLE_STARTS | SPINDLE_STOPS | {SPINDLE_SPEED}
        for event in chunk.events
    )


class Spindle:
    """Follows the spindle through a program.

    A program that never speaks of the spindle runs with it turning: someone has switched it on by
    hand. One that does is held to it from its first move on; a speed alone starts nothing.
    """

    def __init__(self, *, held_to_program: bool) -> None:
        """Begin with the spindle off, or turning for good.

        Args:
            held_to_program: Whether the program speaks of the spindle at all.
        """
        self._held = held_to_program
        self._state = SpindleState()
        self._moves = 0
        self._places: list[float] = [-np.inf]
        self._turns = [not held_to_program]

    def expect(self, chunk: Chunk) -> None:
        """Take note of a chunk of the program, before its samples come."""
        if self._held:
            for event in chunk.events:
                if isinstance(event, Function):
                    self._hear(event)
        self._moves += len(chunk.moves)

    def standing(self, setpoint: Setpoints) -> npt.NDArray[np.bool_]:
        """During which setpoints the spindle is off, shape (n,)."""
        place = setpoint.move + np.clip(setpoint.fraction, 0.0, _BEFORE_THE_NEXT)
        state = np.searchsorted(self._places, place, side="right") - 1
        return ~np.array(self._turns)[state]

    def _hear(self, event: Function) -> None:
        self._state = self._state.after(event)
        turns = self._state.turns
        if turns != self._turns[-1]:
            self._places.append(self._moves + event.before + event.at)
            self._turns.append(turns)
