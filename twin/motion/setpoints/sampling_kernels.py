"""Phases of constant jerk, read off at the ticks of the servo clock."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from twin.compilation.kernel import array_kernel, kernel
from twin.nc.canonical import FloatArray, IntArray
from twin.toolpath.geometry_kernels import Curves, is_curve

SHORTEST_OVERLAP = 1e-9
"""Phases that overlap by less than this do so by rounding [s]."""

OVERLAPPING = -2
"""Instead of a row, where two of them are under way."""


class PathSamples(NamedTuple):
    """Where the path is at m ticks: results of ``sample_path``.

    Attributes:
        piece: Of each sample, shape (m,).
        path: x within the piece, v, a, shape (m, 3).
        other_piece: That of the move that overlaps, -1: none does, shape (m,).
        other_path: As ``path``, of that move, shape (m, 3).
        other_begins: Whether that move begins there, and does not end, shape (m,).
    """

    piece: IntArray
    path: FloatArray
    other_piece: IntArray
    other_path: FloatArray
    other_begins: npt.NDArray[np.bool_]


@kernel
def _overlapping(phases: FloatArray, row: int, time: float) -> bool:
    """Whether the phase after one is under way too, at a time before the end of that one."""
    if row + 1 >= len(phases) or time < phases[row + 1, 0]:
        return False
    end = phases[row, 0] + phases[row, 1]
    return phases[row + 1, 3] == 0.0 and phases[row + 1, 0] < end - SHORTEST_OVERLAP


@kernel
def _place(
    phases: FloatArray, phase_pieces: IntArray, lengths: FloatArray, row: int, t: float,
    i: int, behind: float,
) -> tuple[int, float, float, float, float]:  # fmt: skip
    """Piece, x within it, v, a at t within a phase, and x of the piece's begin in the phase.

    Args:
        phases: As in ``sample_path``.
        phase_pieces: As in ``sample_path``.
        lengths: As in ``sample_path``.
        t: Since its begin [s].
        i: A piece of the phase that is not too late.
        behind: x of its begin in the phase.
    """
    v, a, j = phases[row, 3], phases[row, 4], phases[row, 5]
    x = phases[row, 2] + ((j / 6.0 * t + 0.5 * a) * t + v) * t
    while i < phase_pieces[row, 1] and x - behind >= lengths[i]:
        behind += lengths[i]
        i += 1
    return i, min(x - behind, lengths[i]), max(0.0, v + (0.5 * j * t + a) * t), a + j * t, behind


@kernel
def sample_path(
    phases: FloatArray, phase_pieces: IntArray, lengths: FloatArray,
    first_tick: int, period: float, cursor: IntArray, samples: PathSamples,
) -> int:  # fmt: skip
    """Where the path is at consecutive ticks.

    Where two moves overlap, the sample belongs to the one that is farther from their corner.

    Args:
        phases: Rows begin [s], duration [s], x, v, a, j, shape (m, 6).
        phase_pieces: First and last piece of each phase, shape (m, 2).
        lengths: Of the pieces, in x, shape (n,).
        first_tick: Number of the first tick wanted.
        period: Servo period [s].
        cursor: Phase at which to begin; overwritten by the one to go on with, shape (1,).
        samples: Results; there is room for as many as these have rows.

    Returns:
        How many samples there are: until the phases or the room end.
    """
    piece, path, other_piece, other_path, other_begins = samples
    row = cursor[0]
    count = 0
    i, behind, placed = 0, 0.0, -1
    while row < len(phase_pieces) and count < len(piece):
        time = (first_tick + count) * period
        t = time - phases[row, 0]
        if t >= phases[row, 1]:
            row += 1
            continue
        t = max(t, 0.0)
        if placed != row:
            i, behind, placed = phase_pieces[row, 0], 0.0, row
        i, x, v, a, behind = _place(phases, phase_pieces, lengths, row, t, i, behind)
        piece[count] = i
        path[count, 0], path[count, 1], path[count, 2] = x, v, a
        other_piece[count] = -1
        if _overlapping(phases, row, time):
            # The last phase of one move and the first of the next, both from or to rest.
            left, gone = phases[row, 1] - t, time - phases[row + 1, 0]
            k, x, v, a, _ = _place(
                phases, phase_pieces, lengths, row + 1, gone, phase_pieces[row + 1, 0], 0.0
            )
            begins = phases[row, 5] * left**3 >= phases[row + 1, 5] * gone**3
            other_piece[count], other_begins[count] = k, begins
            other_path[count, 0], other_path[count, 1], other_path[count, 2] = x, v, a
            if not begins:
                piece[count], other_piece[count] = k, i
                for value in range(3):
                    own = path[count, value]
                    path[count, value] = other_path[count, value]
                    other_path[count, value] = own
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
        Piece, x within it, v, a, and the row of the phase; -1 for the row after the last,
        ``OVERLAPPING`` where two are under way.
    """
    for row in range(len(phase_pieces)):
        t = max(0.0, time - phases[row, 0])
        if t >= phases[row, 1]:
            continue
        if _overlapping(phases, row, time):
            return 0, 0.0, 0.0, 0.0, OVERLAPPING
        i, x, v, a, _ = _place(phases, phase_pieces, lengths, row, t, phase_pieces[row, 0], 0.0)
        return i, x, v, a, row
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


@kernel
def sample_axes(
    curves: Curves, pieces: PieceCurves, origin: FloatArray, where: PathSamples,
    samples: AxisSamples,
) -> None:  # fmt: skip
    """The axes where the path is.

    Args:
        origin: Machine coordinates of program zero, shape (k,).
        where: From ``sample_path``.
        samples: Results, zero before.
    """
    path, other_path = where.path, where.other_path
    for row in range(len(where.piece)):
        at = path[row, 0], path[row, 1], path[row, 2]
        samples.fraction[row] = _add_axes(curves, pieces, where.piece[row], at, 1.0, samples, row)
        k = where.other_piece[row]
        if k >= 0:
            # By how much the move that overlaps is away from their corner.
            at = other_path[row, 0], other_path[row, 1], other_path[row, 2]
            _add_axes(curves, pieces, k, at, 1.0, samples, row)
            if where.other_begins[row]:
                _add_axes(curves, pieces, k, (0.0, 0.0, 0.0), -1.0, samples, row)
            else:
                for axis in range(len(origin)):
                    samples.position[row, axis] -= curves.end[pieces.move[k], axis]
        for axis in range(len(origin)):
            samples.position[row, axis] += origin[axis]


@kernel
def _add_axes(
    curves: Curves, pieces: PieceCurves, i: int, at: tuple[float, float, float], factor: float,
    samples: AxisSamples, row: int,
) -> float:  # fmt: skip
    """Add the axes at one place to a sample.

    Args:
        at: x within it, v, a.
        samples: Results, in part coordinates.

    Returns:
        The fraction of the move.
    """
    base, drift, bend, cosine, sine, angle, end = curves
    _, position, velocity, acceleration = samples
    rounding = pieces.rounding
    x, v, a = at
    move = pieces.move[i]
    scale = pieces.fraction_per_length[i]
    u = min(1.0, pieces.begin[i] + x * scale)
    du, ddu = v * scale, a * scale
    turn, turn_v, turn_a = angle[move] * u, angle[move] * du, angle[move] * ddu
    # What a curve adds is in ``rounding``, also at its end.
    ended = u >= 1.0 and not is_curve(bend, move)
    c, s = 1.0, 0.0
    if turn_v != 0.0 or turn != 0.0:
        c, s = math.cos(turn), math.sin(turn)
    for axis in range(base.shape[1]):
        added, slope, bend = 0.0, 0.0, 0.0
        for power in range(5, -1, -1):
            bend = bend * x + 2.0 * slope
            slope = slope * x + added
            added = added * x + rounding[i, axis, power]
        here = base[move, axis] + u * drift[move, axis]
        speed = drift[move, axis] * du
        gain = drift[move, axis] * ddu
        if axis < 3 and angle[move] != 0.0:
            across = cosine[move, axis] * c + sine[move, axis] * s
            along = sine[move, axis] * c - cosine[move, axis] * s
            here += across
            speed += along * turn_v
            gain += along * turn_a - across * turn_v * turn_v
        if ended:
            here = end[move, axis]
        position[row, axis] += factor * (here + added)
        velocity[row, axis] += factor * (speed + slope * v)
        acceleration[row, axis] += factor * (gain + (bend * v * v + slope * a))
    return u
