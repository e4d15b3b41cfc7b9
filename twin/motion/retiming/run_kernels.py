"""Runs: stretches of a plan along smooth arcs, where nothing steps and nothing stands still."""

import enum
import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import arithmetic_kernel, array_kernel
from twin.motion.blocks.corner_choice_kernels import LEAST_TURN
from twin.nc.canonical import FloatArray, IntArray
from twin.toolpath.geometry_kernels import Curves

MOST_TURN = 40.0 * math.pi
"""What a run turns by at most [rad]: a longer one is cut, and each part takes its own time to plan."""

LEAST_TURN_FROM_REST = math.radians(10.0)
"""What a run turns by at least to get a time law of its own that begins or ends at rest, or at a step of the
path that holds it back [rad]."""

HOLD_TURN = 0.5 * math.pi
"""What a run turns by at most while it keeps the programmed feed [rad]: there is nothing to gain."""

AT_FEED = 0.999
"""Share of the programmed feed from which on it is the feed that bounds a phase, not its curve."""


class RunKind(enum.IntEnum):
    """What becomes of a run."""

    KEPT = 0
    """It is not worth a new time law."""
    SHORT = 1
    """It turns by less than ``LEAST_TURN``."""
    LONG = 2


REST = 1e-9
"""What is slower at a run's end is rounding [mm/s]."""

BARELY = 1e-9
"""Of a piece: what reaches less far into it ends before it."""


class RunPieces(NamedTuple):
    """The columns of ``Pieces`` that runs need, and the curves that they lie on.

    Attributes:
        move: Row of each piece's move in the curves, shape (n,).
        begin: As in ``Pieces``, and so on to ``path_jerk``.
    """

    move: IntArray
    begin: FloatArray
    fraction_per_length: FloatArray
    length: FloatArray
    feed: FloatArray
    entry: FloatArray
    rounding: FloatArray
    path_acceleration: FloatArray
    path_jerk: FloatArray
    curves: Curves


@array_kernel
def find_runs(
    phases: FloatArray, phase_pieces: IntArray, pieces: RunPieces, override: float
) -> IntArray:
    """First phase of each run, the one after its last, and its kind.

    Args:
        phases: Rows begin [s], duration [s], x, v, a, j, shape (p, 6).
        phase_pieces: First and last piece of each phase, shape (p, 2).
        pieces: Of the plan; phases that go beyond them are in no run.

    Returns:
        Shape (m, 3).
    """
    found = np.zeros((len(phases), 3), np.int64)
    used = 0
    first, turned, freely = -1, 0.0, 0.0
    hold, held = -1, 0.0
    for row in range(len(phases) + 1):
        turn, holds = 0.0, False
        if row < len(phases) and phase_pieces[row, 1] < len(pieces.length):
            feed = pieces.feed[phase_pieces[row, 0]] * override
            holds = phases[row, 3] > AT_FEED * feed and phases[row, 4] == phases[row, 5] == 0.0
            turn = _turn_of(phases, phase_pieces, pieces, row)
        inside = turn > 0.0
        joined = inside and first >= 0 and turned < MOST_TURN
        if joined:
            piece = phase_pieces[row, 0]
            if phases[row, 2] <= BARELY * pieces.length[piece]:
                joined = _goes_on(pieces, piece)
        ends = row
        if joined and holds and held + turn > HOLD_TURN:
            joined = inside = False
            ends = hold if hold >= 0 else row
        if not joined:
            if ends > first >= 0:
                found[used, 0], found[used, 1] = first, ends
                rests = _from_step(phases, phase_pieces, pieces, first)
                rests |= _from_step(phases, phase_pieces, pieces, ends)
                rests |= _end_velocity(phases[ends - 1]) < REST
                least = LEAST_TURN_FROM_REST if rests else LEAST_TURN
                if freely >= least * (1.0 - BARELY):
                    found[used, 2] = (
                        RunKind.LONG if turned >= LEAST_TURN * (1.0 - BARELY) else RunKind.SHORT
                    )
                used += 1
            inside = inside and not holds
            first, turned, freely = row if inside else -1, 0.0, 0.0
        turned += turn
        if holds and joined:
            hold, held = row if hold < 0 else hold, held + turn
        else:
            hold, held = -1, 0.0
            freely += turn
    return found[:used]


@arithmetic_kernel
def _from_step(phases: FloatArray, phase_pieces: IntArray, pieces: RunPieces, row: int) -> bool:
    """Whether a phase begins at rest, or where a step of the path holds it back."""
    if row == len(phases):
        return False
    _, _, x, v, _, _ = phases[row]
    piece = phase_pieces[row, 0]
    if v == 0.0 or piece >= len(pieces.length):
        return v == 0.0
    return x <= BARELY * pieces.length[piece] and pieces.entry[piece] != math.inf


@arithmetic_kernel
def _end_velocity(phase: FloatArray) -> float:
    """Velocity at a phase's end."""
    _, t, _, v, a, j = phase
    return v + (0.5 * j * t + a) * t


@arithmetic_kernel
def _turn_of(phases: FloatArray, phase_pieces: IntArray, pieces: RunPieces, row: int) -> float:
    """What a phase turns by, 0 where it leaves smooth arcs [rad]."""
    _, t, x, v, a, j = phases[row]
    piece = phase_pieces[row, 0]
    left = ((j / 6.0 * t + 0.5 * a) * t + v) * t
    turn = 0.0
    while True:
        angle = abs(pieces.curves.angle[pieces.move[piece]])
        if angle == 0.0:
            return 0.0
        rounding = pieces.rounding[piece]
        for axis in range(len(rounding)):
            for power in range(6):
                if rounding[axis, power] != 0.0:
                    return 0.0
        here = min(left, pieces.length[piece] - x)
        turn += here * pieces.fraction_per_length[piece] * angle
        left -= here
        if left <= BARELY * pieces.length[piece] or piece == phase_pieces[row, 1]:
            return turn
        piece += 1
        x = 0.0
        if not _goes_on(pieces, piece):
            return 0.0


@arithmetic_kernel
def _goes_on(pieces: RunPieces, piece: int) -> bool:
    """Whether nothing steps between a piece and the one before it, what is asked for included."""
    return (
        pieces.entry[piece] == math.inf
        and pieces.feed[piece] == pieces.feed[piece - 1]
        and pieces.path_acceleration[piece] == pieces.path_acceleration[piece - 1]
        and pieces.path_jerk[piece] == pieces.path_jerk[piece - 1]
    )


class RunEnds(NamedTuple):
    """Between which states a run is driven.

    Attributes:
        piece: In which it begins.
        x: Place within that [mm].
        distance: How far it goes [mm].
        begin: v, a at its begin.
        end: v, a at its end.
        peak: About how fast it may go [mm/s].
    """

    piece: int
    x: float
    distance: float
    begin: tuple[float, float]
    end: tuple[float, float]
    peak: float


@array_kernel
def run_ends(phases: FloatArray, phase_pieces: IntArray) -> RunEnds:
    """Where a run begins and ends.

    Args:
        phases: Of the run, as in ``find_runs``.
        phase_pieces: As in ``find_runs``.
    """
    distance, peak = 0.0, 0.0
    for row in range(len(phases)):
        _, t, _, v, a, j = phases[row]
        distance += ((j / 6.0 * t + 0.5 * a) * t + v) * t
        peak = max(peak, v)
    _, t, _, v, a, j = phases[-1]
    end = max(0.0, v + (0.5 * j * t + a) * t), a + j * t
    if end[0] < REST:
        end = 0.0, 0.0
    begin = phases[0, 3], phases[0, 4]
    return RunEnds(phase_pieces[0, 0], phases[0, 2], distance, begin, end, peak)
