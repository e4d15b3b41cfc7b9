"""Setpoints of planned phases at the ticks of the servo clock."""

from collections.abc import Iterable, Iterator

import numpy as np

from twin.motion.profile.phases import Phases
from twin.motion.setpoints.sampling_kernels import (
    AxisSamples,
    PathSamples,
    PieceCurves,
    sample_axes,
    sample_path,
)
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray

SETTLING_TIME_S = 0.25
"""How long the last setpoint is held [s]: some 25 time constants of a loop gain of 100 1/s."""


def settle(
    chunks: Iterable[Setpoints], period_s: float, seconds: float = SETTLING_TIME_S
) -> Iterator[Setpoints]:
    """Pass setpoints on and add samples that stand still at the last one.

    Args:
        period_s: Servo period [s].
        seconds: How long to hold [s].
    """
    last: Setpoints | None = None
    for chunk in chunks:
        if len(chunk):
            last = chunk[-1:]
        yield chunk
    if last is None:
        return
    ticks = np.arange(1, round(seconds / period_s) + 1)
    first_tick = round(float(last.time[0]) / period_s)
    count = len(ticks)
    axes = last.position.shape[1]
    yield Setpoints(
        time=(first_tick + ticks) * np.float64(period_s),
        line=np.repeat(last.line, count),
        move=np.repeat(last.move, count),
        fraction=np.repeat(last.fraction, count),
        position=np.repeat(last.position, count, axis=0),
        velocity=np.zeros((count, axes)),
        acceleration=np.zeros((count, axes)),
    )


FEWEST_SAMPLES, MOST_SAMPLES = 4096, 16384
"""Bounds of a chunk, which is no longer than an eighth of the setpoints before it: nobody looks at the first before all of it was
simulated, nothing is simulated any more while the last is looked at, and long ones cost less."""


def sample(
    phases: Phases, tick: int, period_s: float, part_zero: FloatArray, most: int
) -> Iterator[Setpoints]:
    """The setpoints from a tick to the end of the phases, machine coordinates.

    Args:
        tick: Number of the first tick that is wanted.
        period_s: Servo period [s].
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        most: Samples per chunk.
    """
    for part in phases.by_part():
        for samples in _sample_part(part, tick, period_s, part_zero, most):
            tick += len(samples)
            yield samples


def _sample_part(
    phases: Phases, tick: int, period_s: float, part_zero: FloatArray, most: int
) -> Iterator[Setpoints]:
    pieces = phases.parts[0]
    cursor = np.zeros(1, np.int64)
    while True:
        room = PathSamples(
            np.zeros(most, np.int64), np.zeros((most, 3)),
            np.zeros(most, np.int64), np.zeros((most, 3)), np.zeros(most, np.bool_),
        )  # fmt: skip
        count = sample_path(
            phases.rows, phases.rows_pieces, pieces.length, tick, period_s, cursor, room
        )
        if count == 0:
            return
        where = PathSamples(
            room.piece[:count], room.path[:count],
            room.other_piece[:count], room.other_path[:count], room.other_begins[:count],
        )  # fmt: skip
        piece = where.piece
        samples = AxisSamples(
            np.zeros(count), *(np.zeros((count, len(part_zero))) for _ in range(3))
        )
        geometry = pieces.geometry
        curves = PieceCurves(
            geometry.row, pieces.begin, pieces.fraction_per_length, pieces.rounding
        )
        sample_axes(geometry.table.curves(), curves, part_zero, where, samples)
        yield Setpoints(
            time=np.arange(tick, tick + count, dtype=np.float64) * period_s,
            line=pieces.line[piece],
            move=pieces.move[piece],
            **samples._asdict(),
        )
        tick += count


def standing(position: FloatArray) -> Setpoints:
    """One sample at rest before the first move.

    Args:
        position: Machine coordinates, shape (k,) [mm or deg].
    """
    still = np.zeros((1, len(position)))
    zero = np.zeros(1, np.int64)
    return Setpoints(np.zeros(1), zero, zero - 1, np.zeros(1), position[None].copy(), still, still)


def at_end(phases: Phases) -> Setpoints:
    """One sample at rest at the end of the last piece of the phases, part coordinates."""
    pieces = phases.parts[-1]
    end = pieces.geometry[-1:].whole().end
    still = np.zeros_like(end)
    fraction = np.array([0.0 if pieces.move[-1] < 0 else 1.0])
    return Setpoints(
        np.zeros(1), pieces.line[-1:], pieces.move[-1:], fraction, end, still, still,
    )  # fmt: skip
