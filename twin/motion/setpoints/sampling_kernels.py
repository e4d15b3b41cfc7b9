"""Phases of constant jerk, read off at the ticks of the servo clock."""

import math
from typing import NamedTuple

from twin.compilation.kernel import array_kernel
from twin.nc.canonical import FloatArray, IntArray
from twin.toolpath.geometry_kernels import Curves


@array_kernel
def sample_path(
    phases: FloatArray, phase_pieces: IntArray, lengths: FloatArray,
    first_tick: int, period: float, cursor: IntArray,
    piece: IntArray, path: FloatArray,
) -> int:  # fmt: skip
    """Where the path is at consecutive ticks.

    Args:
        phases: Rows begin [s], duration [s], x, v, a, j, shape (m, 6).
        phase_pieces: First and last piece of each phase, shape (m, 2).
        lengths: Of the pieces, in x, shape (n,).
        first_tick: Number of the first tick wanted.
        period: Servo period [s].
        cursor: Phase at which to begin; overwritten by the one to go on with, shape (1,).
        piece: Result: piece of each sample, shape (capacity,).
        path: Result: x within the piece, v, a of each sample, shape (capacity, 3).

    Returns:
        How many samples there are: until the phases or the capacity end.
    """
    row = cursor[0]
    count = 0
    i, behind, placed = 0, 0.0, -1
    while row < len(phase_pieces) and count < len(piece):
        t = (first_tick + count) * period - phases[row, 0]
        if t >= phases[row, 1]:
            row += 1
            continue
        t = max(t, 0.0)
        v, a, j = phases[row, 3], phases[row, 4], phases[row, 5]
        x = phases[row, 2] + ((j / 6.0 * t + 0.5 * a) * t + v) * t
        if placed != row:
            i, behind, placed = phase_pieces[row, 0], 0.0, row
        while i < phase_pieces[row, 1] and x - behind >= lengths[i]:
            behind += lengths[i]
            i += 1
        piece[count] = i
        path[count, 0] = min(x - behind, lengths[i])
        path[count, 1] = max(0.0, v + (0.5 * j * t + a) * t)
        path[count, 2] = a + j * t
        count += 1
    cursor[0] = row
    return count


@array_kernel
def state_at(
    phases: FloatArray, phase_pieces: IntArray, lengths: FloatArray, time: float
) -> tuple[int, float, float, float, int]:
    """Where the path is at any time within the phases.

    Args:
        phases: As in ``sample_path``.
        phase_pieces: As in ``sample_path``.
        lengths: As in ``sample_path``.
        time: Not before the first phase begins [s].

    Returns:
        Piece, x within it, v, a, and the row of the phase; -1 for the row after the last.
    """
    for row in range(len(phase_pieces)):
        t = max(0.0, time - phases[row, 0])
        if t >= phases[row, 1]:
            continue
        v, a, j = phases[row, 3], phases[row, 4], phases[row, 5]
        x = phases[row, 2] + ((j / 6.0 * t + 0.5 * a) * t + v) * t
        i, behind = phase_pieces[row, 0], 0.0
        while i < phase_pieces[row, 1] and x - behind >= lengths[i]:
            behind += lengths[i]
            i += 1
        return i, min(x - behind, lengths[i]), max(0.0, v + (0.5 * j * t + a) * t), a + j * t, row
    return 0, 0.0, 0.0, 0.0, -1


class PieceCurves(NamedTuple):
    """Where pieces lie on their moves.

    Attributes:
        move: Row of each piece's move in the geometry, shape (n,).
        begin: As in ``Pieces``, and so on to ``rounding``.
        fraction_per_length: Shape (n,).
        rounding: Shape (n, k, 6).
    """

    move: IntArray
    begin: FloatArray
    fraction_per_length: FloatArray
    rounding: FloatArray


class AxisSamples(NamedTuple):
    """What the axes do at m ticks: results of ``sample_axes``.

    Attributes:
        fraction: Of the move, shape (m,).
        position: Shape (m, k), and so on to ``acceleration``.
        velocity: Shape (m, k).
        acceleration: Shape (m, k).
    """

    fraction: FloatArray
    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray


@array_kernel
def sample_axes(
    curves: Curves, pieces: PieceCurves, origin: FloatArray,
    piece: IntArray, path: FloatArray, samples: AxisSamples,
) -> None:  # fmt: skip
    """The axes where the path is.

    Args:
        curves: Of the moves.
        pieces: Where they lie.
        origin: Machine coordinates of program zero, shape (k,).
        piece: From ``sample_path``, shape (m,).
        path: From ``sample_path``, shape (m, 3).
        samples: Results.
    """
    base, drift, cosine, sine, angle, end = curves
    owner, begin, fraction_per_length, rounding = pieces
    fraction, position, velocity, acceleration = samples
    width = base.shape[1]
    for row in range(len(piece)):
        i = piece[row]
        move = owner[i]
        scale = fraction_per_length[i]
        u = min(1.0, begin[i] + path[row, 0] * scale)
        du = path[row, 1] * scale
        ddu = path[row, 2] * scale
        fraction[row] = u
        for axis in range(width):
            position[row, axis] = base[move, axis] + u * drift[move, axis]
            velocity[row, axis] = drift[move, axis] * du
            acceleration[row, axis] = drift[move, axis] * ddu
        if angle[move] != 0.0:
            turn, turn_v, turn_a = angle[move] * u, angle[move] * du, angle[move] * ddu
            c, s = math.cos(turn), math.sin(turn)
            for axis in range(3):
                across = cosine[move, axis] * c + sine[move, axis] * s
                along = sine[move, axis] * c - cosine[move, axis] * s
                position[row, axis] += across
                velocity[row, axis] += along * turn_v
                acceleration[row, axis] += along * turn_a - across * turn_v * turn_v
        x, v, a = path[row, 0], path[row, 1], path[row, 2]
        for axis in range(width):
            if u >= 1.0:
                position[row, axis] = end[move, axis]
            added, slope, bend = 0.0, 0.0, 0.0
            for power in range(5, -1, -1):
                bend = bend * x + 2.0 * slope
                slope = slope * x + added
                added = added * x + rounding[i, axis, power]
            position[row, axis] += added + origin[axis]
            velocity[row, axis] += slope * v
            acceleration[row, axis] += bend * v * v + slope * a
