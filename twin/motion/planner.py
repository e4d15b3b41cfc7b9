"""Canonical moves to setpoints: the order of the steps."""

import dataclasses
import math
from collections.abc import Iterable, Iterator

import numpy as np

from twin.motion.corner_candidates import PiecesOfChunks
from twin.motion.limits import MotionLimits
from twin.motion.phases_of_pieces import phases_of_pieces
from twin.motion.profile.phases import Phases
from twin.motion.setpoints.sampling import FEWEST_SAMPLES, MOST_SAMPLES, at_end, sample, standing
from twin.motion.setpoints.setpoints import Setpoints
from twin.motion.steps import PipelineStage
from twin.nc.canonical import Chunk, FloatArray


def plan_phases(
    chunks: Iterable[Chunk], limits: MotionLimits, *, start: FloatArray
) -> Iterator[Phases]:
    """Plan the velocity along a program.

    Args:
        start: Where the axes are before, part coordinates, shape (k,) [mm or deg].
    """
    return phases_of_pieces(PiecesOfChunks(chunks, limits, start), limits)


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
        period_s: Servo period [s].
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        start: Where the axes are before the program, machine coordinates, shape (k,) [mm or deg].

    Yields:
        Setpoints in machine coordinates, at most ``MOST_SAMPLES`` at a time.

    Raises:
        ValueError: The first move does not begin at ``start``, or a move not where the one before
            it ended.
    """
    tick = 0
    end_time = 0.0
    last = standing(start)
    watched = WatchedEnd(chunks, start, part_zero)
    for phases in plan_phases(watched, limits, start=start - part_zero):
        end_time = phases.end_time
        most = min(max(FEWEST_SAMPLES, tick // 8), MOST_SAMPLES)
        for samples in sample(phases, tick, period_s, part_zero, most):
            tick += len(samples)
            yield samples
        last = at_end(phases)
    final_tick = max(tick, math.ceil(end_time / period_s - 1e-9))
    time = np.array([final_tick * period_s])
    yield dataclasses.replace(last, time=time, position=watched.position[None])


class WatchedEnd(PipelineStage[Chunk, Chunk]):
    """Passes chunks on and notes where the program ends: moves too short to take time count too.

    Args:
        start: Where the axes are before, machine coordinates, shape (k,) [mm or deg].
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].

    Attributes:
        position: End of the moves so far, machine coordinates, shape (k,) [mm or deg].
    """

    def __init__(self, chunks: Iterable[Chunk], start: FloatArray, part_zero: FloatArray) -> None:
        super().__init__(chunks)
        self._part_zero = part_zero
        self.position = start

    def take(self, part: Chunk) -> Iterator[Chunk]:
        """The chunk itself."""
        if len(part.moves) > 0:
            self.position = part.moves.end[-1] + self._part_zero
        yield part
