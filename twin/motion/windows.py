"""Windows of pieces: those to plan next, and those that the planner looks ahead to.

A window is taken to end in a stop, so what is planned in it stays possible whatever follows.
Windows are counted in pieces from the start of the program, whatever chunks the moves come in.
"""

from collections.abc import Iterable, Iterator

import numpy as np

from twin.motion.pieces import Pieces, join_pieces
from twin.nc.canonical import FloatArray

BATCH = 2048
"""Pieces that are planned at a time."""

LOOK_AHEAD = 2048
"""Pieces beyond these that the planner sees."""


def windows(parts: Iterable[Pieces]) -> Iterator[tuple[Pieces, bool]]:
    """Windows of BATCH + LOOK_AHEAD pieces, BATCH apart, and whether a window is the last."""
    waiting: list[Pieces] = []
    count = 0
    for part in parts:
        if len(part) == 0:
            continue
        waiting.append(part)
        count += len(part)
        if count <= BATCH + LOOK_AHEAD:
            continue
        window = join_pieces(waiting)
        while len(window) > BATCH + LOOK_AHEAD:
            yield window[: BATCH + LOOK_AHEAD], False
            window = window[BATCH:]
        waiting, count = [window], len(window)
    if count > 0:
        yield join_pieces(waiting), True


def limit_table(pieces: Pieces) -> FloatArray:
    """Rows length, velocity, acceleration, deceleration, jerk of n pieces, shape (5, n)."""
    return np.stack(
        [pieces.length, pieces.velocity, pieces.acceleration, pieces.deceleration, pieces.jerk]
    )


def entry_velocities(pieces: Pieces) -> FloatArray:
    """Highest velocity at each border of n pieces; a window ends at rest, shape (n + 1,)."""
    return np.append(pieces.entry, 0.0)
