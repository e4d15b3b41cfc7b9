"""Canonical moves to setpoints: the order of the steps, and what is carried between windows.

Pieces are planned in windows: a fixed number of new pieces, and as many again to look ahead. The
window is taken to end in a stop, so what is planned in it stays possible whatever follows. Windows
are counted in pieces from the start of the program, whatever chunks the moves come in.
"""

import dataclasses
import math
from collections.abc import Iterable, Iterator

import numpy as np

from twin.motion.limits import MotionLimits
from twin.motion.pieces import Pieces, join_pieces, pieces_of_chunks
from twin.motion.profile_kernels import find_phases
from twin.motion.reach_kernels import find_reach
from twin.motion.sampling_kernels import sample_axes, sample_path
from twin.motion.setpoints import Setpoints
from twin.nc.canonical import Chunk, FloatArray, IntArray

BATCH = 2048
"""Pieces that are planned at a time."""

LOOK_AHEAD = 2048
"""Pieces beyond these that the planner sees."""

SAMPLES = 16384
"""Setpoints per chunk at most."""


@dataclasses.dataclass(frozen=True, slots=True)
class Phases:
    """A run of phases of constant jerk over a window of pieces.

    Attributes:
        pieces: The window.
        rows: Begin [s], duration [s], x within the piece, v, a, j; shape (m, 6).
        rows_pieces: Rows of ``pieces`` in which each phase begins and ends, shape (m, 2).
    """

    pieces: Pieces
    rows: FloatArray
    rows_pieces: IntArray

    @property
    def end_time(self) -> float:
        """When the last phase ends [s]."""
        return float(self.rows[-1, 0] + self.rows[-1, 1])


def plan_phases(
    chunks: Iterable[Chunk], limits: MotionLimits, *, start: FloatArray
) -> Iterator[Phases]:
    """Plan the velocity along a program.

    Args:
        chunks: The program.
        limits: Of the axes and the path.
        start: Where the axes stand before, part coordinates, shape (k,) [mm or deg].
    """
    state = np.zeros(5)
    known = np.zeros(0)
    for window, whole in _windows(pieces_of_chunks(chunks, limits, start)):
        first = int(state[0])
        pieces = window[first:]
        table = np.stack(
            [pieces.length, pieces.velocity, pieces.acceleration, pieces.deceleration, pieces.jerk]
        )
        entry = np.append(pieces.entry, 0.0)
        reach = find_reach(table, entry, known)
        stop = len(pieces) if whole else BATCH - first
        state[0] = 0.0
        rows, rows_pieces = find_phases(table, entry, reach, pieces.pause, stop, state)
        known = reach[int(state[0]) : -1]
        state[0] += first - BATCH
        if len(rows) > 0:
            yield Phases(pieces, rows, rows_pieces)


def _windows(parts: Iterable[Pieces]) -> Iterator[tuple[Pieces, bool]]:
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


def plan(
    chunks: Iterable[Chunk],
    limits: MotionLimits,
    *,
    period_s: float,
    part_zero: FloatArray,
    start: FloatArray,
) -> Iterator[Setpoints]:
    """Plan a program's setpoints.

    The first sample is at time 0, the last is the first tick at or after the program's end, at rest
    exactly at its end position. How a block's end is passed says its ``corner``; functions take no
    time of their own.

    Args:
        chunks: The program: consecutive moves in part coordinates.
        limits: Of the axes and the path.
        period_s: Servo period [s].
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        start: Where the axes stand before the program, machine coordinates, shape (k,) [mm or deg].

    Yields:
        Setpoints in machine coordinates, at most ``SAMPLES`` at a time.

    Raises:
        ValueError: The first move does not begin at ``start``, or a move not where the one before
            it ended.
    """
    tick = 0
    end_time = 0.0
    last = _standing(start)
    end = last.position[0]

    def watched() -> Iterator[Chunk]:
        # Moves too short to take time still move the end.
        for chunk in chunks:
            if len(chunk.moves) > 0:
                end[:] = chunk.moves.end[-1] + part_zero
            yield chunk

    for phases in plan_phases(watched(), limits, start=start - part_zero):
        end_time = phases.end_time
        for samples in _sample(phases, tick, period_s, part_zero):
            tick += len(samples)
            yield samples
        last = _rest(phases)
    final_tick = max(tick, math.ceil(end_time / period_s - 1e-9))
    time = np.array([final_tick * period_s])
    yield dataclasses.replace(last, time=time, position=end[None])


def _sample(
    phases: Phases, tick: int, period_s: float, part_zero: FloatArray
) -> Iterator[Setpoints]:
    pieces = phases.pieces
    cursor = np.zeros(1, np.int64)
    while True:
        piece = np.zeros(SAMPLES, np.int64)
        path = np.zeros((SAMPLES, 3))
        count = sample_path(
            phases.rows, phases.rows_pieces, pieces.length, tick, period_s, cursor, piece, path
        )
        if count == 0:
            return
        piece, path = piece[:count], path[:count]
        fraction = np.zeros(count)
        position, velocity, acceleration = (np.zeros((count, len(part_zero))) for _ in range(3))
        shape = pieces.geometry
        sample_axes(
            shape.base, shape.drift, shape.cosine, shape.sine, shape.angle, shape.end,
            pieces.begin, pieces.fraction_per_length, pieces.rounding, part_zero,
            piece, path, fraction, position, velocity, acceleration,
        )  # fmt: skip
        yield Setpoints(
            time=np.arange(tick, tick + count, dtype=np.float64) * period_s,
            line=pieces.line[piece],
            move=pieces.move[piece],
            fraction=fraction,
            position=position,
            velocity=velocity,
            acceleration=acceleration,
        )
        tick += count


def _standing(position: FloatArray) -> Setpoints:
    """One sample at rest before the first move."""
    still = np.zeros((1, len(position)))
    zero = np.zeros(1, np.int64)
    return Setpoints(np.zeros(1), zero, zero - 1, np.zeros(1), position[None].copy(), still, still)


def _rest(phases: Phases) -> Setpoints:
    """One sample at rest at the end of the last piece that was planned."""
    pieces = phases.pieces
    still = np.zeros((1, pieces.geometry.end.shape[1]))
    fraction = np.array([0.0 if pieces.move[-1] < 0 else 1.0])
    return Setpoints(
        np.zeros(1), pieces.line[-1:], pieces.move[-1:], fraction, pieces.geometry.end[-1:],
        still, still,
    )  # fmt: skip
