"""The limits of a change of a run's time law, at the instants of a simple reference."""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import arithmetic_kernel, array_arithmetic_kernel, array_kernel
from twin.motion.limits import MachineLimits
from twin.motion.retiming.run_kernels import BARELY, RunEnds, RunPieces
from twin.motion.retiming.solver_kernels import RunTable
from twin.nc.canonical import FloatArray, IntArray
from twin.toolpath.geometry_kernels import Curves

STEP_ANGLE = math.radians(6.0)
"""Longest interval of a run where it turns fastest [rad]."""

RAMP_STEPS = 20
"""Intervals of a change of velocity at least."""

LEAST_RAMP = 0.2
"""What a change of velocity turns by at twice its mean velocity at least, in runs long enough [rad]."""

LEAST_STEPS = 12
"""Intervals between the changes of velocity at least."""

SLOW = 0.6
"""Share of a run's peak from which on it needs no change of velocity to begin with."""

ACCELERATION_SHARE = 0.999
"""Of limits of acceleration: between two nodes a little more is used than at them."""

SPARE = 1.0005
"""By how much slower than it seems to need a place becomes whose limit was passed."""

VELOCITY_SHARE = 0.9995
"""Of axes' velocities: between two nodes a little more is used than at them."""

BELOW = 0.97
"""Of the highest squared rate that is known to be slow enough: where the search begins."""


class RunNodes(NamedTuple):
    """A run at n + 1 instants of the reference.

    Attributes:
        step: Lengths of the intervals, shape (n,) [s].
        piece: Shape (n + 1,).
        path: x within the piece, v, a, shape (n + 1, 3).
        distance: Of each interval, shape (n,).
        jerk: Of the path at both ends of each interval, shape (n, 2).
    """

    step: FloatArray
    piece: IntArray
    path: FloatArray
    distance: FloatArray
    jerk: FloatArray


@arithmetic_kernel
def _ramp_times(
    ends: RunEnds, turn: float, jerk: float, acceleration: float
) -> tuple[float, float, float]:
    """How long the changes to and from a run's peak take, and the peak.

    Args:
        turn: What the path turns by [rad/mm].
    """
    v0, v1, peak = ends.begin[0], ends.end[0], ends.peak
    least = min(LEAST_RAMP / turn, 0.5 * ends.distance)
    while True:
        up, down = 0.0, 0.0
        if v0 < SLOW * peak:
            rise = peak - v0
            up = max(2.4 * math.sqrt(rise / jerk), 1.6 * rise / acceleration, least / peak)
        if v1 < SLOW * peak:
            fall = peak - v1
            down = max(2.4 * math.sqrt(fall / jerk), 1.6 * fall / acceleration, least / peak)
        if 0.5 * (peak + v0) * up + 0.5 * (peak + v1) * down <= 0.95 * ends.distance:
            return up, down, peak
        peak *= 0.9


@array_arithmetic_kernel
def cut_run(ends: RunEnds, pieces: RunPieces, machine: MachineLimits) -> RunNodes:
    """A run with a smooth change of velocity to its peak and another from it, as intervals of time.

    The velocity of a change is a cosine's, which begins at rest as a constant jerk does.
    """
    piece, x, distance, (v0, _), (v1, _), peak = ends
    turn = pieces.fraction_per_length[piece] * abs(pieces.curves.angle[pieces.move[piece]])
    jerk, acceleration = pieces.path_jerk[piece], pieces.path_acceleration[piece]
    moves = v0 > 0.0 or v1 > 0.0
    # What a straight share of the path asks of an axis is the same everywhere; a curve's share, where it
    # points along the axis, counts where a change of velocity begins or ends in motion, as it is given there.
    for axis in range(len(machine.jerk)):
        even = _even_slope(pieces, piece, axis)
        if even == 0.0 and moves and axis < 3:
            even = turn * _radius(pieces.curves, pieces.move[piece], axis)
        if even > 0.0:
            jerk = min(jerk, machine.jerk[axis] / even)
            acceleration = min(acceleration, machine.acceleration[axis] / even)
    up, down, peak = _ramp_times(ends, turn, jerk, acceleration)
    hold = (distance - 0.5 * (peak + v0) * up - 0.5 * (peak + v1) * down) / peak
    times = up, hold, down
    rate = peak * turn / STEP_ANGLE
    counts = (
        max(RAMP_STEPS, math.ceil(rate * up)) if up > 0.0 else 0,
        max(LEAST_STEPS, math.ceil(rate * hold)),
        max(RAMP_STEPS, math.ceil(rate * down)) if down > 0.0 else 0,
    )
    count = counts[0] + counts[1] + counts[2]
    nodes = RunNodes(
        np.zeros(count), np.zeros(count + 1, np.int64), np.zeros((count + 1, 3)),
        np.zeros(count), np.zeros((count, 2)),
    )  # fmt: skip
    node, place, behind, before = 0, 0.0, 0.0, 0.0
    for part in range(3):
        if counts[part] == 0:
            continue
        low = v0 if part == 0 else v1
        rise = 0.5 * (peak - low) if part != 1 else 0.0
        rate = math.pi / times[part]
        for k in range(counts[part] + 1):
            t = times[part] * k / counts[part]
            # Of the last change the time counts backwards.
            gone = t if part < 2 else times[2] - t
            wave, sign = rate * gone, 1.0 if part < 2 else -1.0
            covered = (low + rise) * gone - rise / rate * math.sin(wave)
            v, a, j = (
                low + rise * (1.0 - math.cos(wave)),
                sign * rise * rate * math.sin(wave),
                rise * rate * rate * math.cos(wave),
            )
            if part == 1:
                covered, v, a, j = peak * gone, peak, 0.0, 0.0
            here = place + covered if part < 2 else distance - covered
            if k > 0:
                nodes.distance[node] = here - before
                nodes.jerk[node, 1] = j
                nodes.step[node] = times[part] / counts[part]
                node += 1
            if k < counts[part]:
                nodes.jerk[node, 0] = j
            before = here
            inside = x + here - behind
            # A run's end lies at the end of a piece, not at the begin of another.
            edge = 1.0 - BARELY if node < count else 1.0 + BARELY
            while piece + 1 < len(pieces.length) and inside >= edge * pieces.length[piece]:
                inside -= pieces.length[piece]
                behind += pieces.length[piece]
                piece += 1
            nodes.piece[node] = piece
            nodes.path[node, 0] = max(0.0, min(inside, pieces.length[piece]))
            nodes.path[node, 1], nodes.path[node, 2] = v, a
        place = before
    return nodes


@arithmetic_kernel
def _radius(curves: Curves, move: int, axis: int) -> float:
    """How far an axis goes to either side along a curve [mm]."""
    return math.hypot(curves.cosine[move, axis], curves.sine[move, axis])


@arithmetic_kernel
def _even_slope(pieces: RunPieces, piece: int, axis: int) -> float:
    """How fast an axis moves that does not follow the curve, 0 for one that does."""
    curves, move = pieces.curves, pieces.move[piece]
    if axis < 3 and (curves.cosine[move, axis] != 0.0 or curves.sine[move, axis] != 0.0):
        return 0.0
    return abs(curves.drift[move, axis] * pieces.fraction_per_length[piece])


@arithmetic_kernel
def derivatives_at(
    pieces: RunPieces, piece: int, x: float, axis: int
) -> tuple[float, float, float]:
    """q', q'', q''' of an axis at a place."""
    curves = pieces.curves
    move, scale = pieces.move[piece], pieces.fraction_per_length[piece]
    slope = curves.drift[move, axis] * scale
    if axis >= 3:
        return slope, 0.0, 0.0
    angle = curves.angle[move]
    turned, turn = angle * (pieces.begin[piece] + x * scale), angle * scale
    c, s = math.cos(turned), math.sin(turned)
    p, q = curves.cosine[move, axis], curves.sine[move, axis]
    along = turn * (q * c - p * s)
    return slope + along, -turn * turn * (p * c + q * s), -turn * turn * along


@array_arithmetic_kernel
def run_table(
    nodes: RunNodes, pieces: RunPieces, machine: MachineLimits, override: float
) -> RunTable:
    """What limits a change of a run's time law."""
    count, axes = len(nodes.step), len(machine.jerk)
    moving = np.zeros(axes, np.int64)
    used = 0
    piece = nodes.piece[0]
    for axis in range(axes):
        move = pieces.move[piece]
        bent = axis < 3 and (
            pieces.curves.cosine[move, axis] != 0.0 or pieces.curves.sine[move, axis] != 0.0
        )
        if bent or pieces.curves.drift[move, axis] != 0.0:
            moving[used] = axis
            used += 1
    kinds = used + 1
    forms, tops = np.zeros((count, 2, 2 * kinds, 3)), np.full((count + 1, 2), math.inf)
    for node in range(count + 1):
        piece, (x, v, a) = nodes.piece[node], nodes.path[node]
        # Of both intervals that meet in a node only the jerk differs.
        at, side = (node, 0) if node < count else (count - 1, 1)
        here = forms[at, side]
        squares = 0.0
        for k in range(used):
            axis = moving[k]
            q1, q2, q3 = derivatives_at(pieces, piece, x, axis)
            first = q1 * v
            second = q2 * v * v + q1 * a
            third = (q3 * v * v + 3.0 * q2 * a) * v
            tops[node, 1] = min(
                tops[node, 1], (VELOCITY_SHARE * machine.velocity[axis] / first) ** 2
            )
            squares += q2 * q2 if axis < 3 else 0.0
            limit = ACCELERATION_SHARE * machine.acceleration[axis]
            here[k, 0], here[k, 1] = second / limit, 0.5 * first / limit
            limit = machine.jerk[axis]
            here[kinds + k, 0] = third / limit
            here[kinds + k, 1], here[kinds + k, 2] = 1.5 * second / limit, 0.5 * first / limit
        curved = ACCELERATION_SHARE * machine.path[0] / (math.sqrt(squares) * v * v)
        tops[node, 0] = min((pieces.feed[piece] * override / v) ** 2, curved)
        limit = ACCELERATION_SHARE * pieces.path_acceleration[piece]
        here[used, 0], here[used, 1] = a / limit, 0.5 * v / limit
        limit = pieces.path_jerk[piece]
        here[kinds + used, 1], here[kinds + used, 2] = 1.5 * a / limit, 0.5 * v / limit
        if 0 < node < count:
            forms[node - 1, 1] = here
        for neighbour in range(max(0, node - 1), min(count, node + 1)):
            end = 1 if neighbour < node else 0
            j = nodes.jerk[neighbour, end]
            forms[neighbour, end, kinds + used, 0] = j / pieces.path_jerk[piece]
            for k in range(used):
                q1, _, _ = derivatives_at(pieces, piece, x, moving[k])
                forms[neighbour, end, kinds + k, 0] += q1 * j / machine.jerk[moving[k]]
    highest = _highest_coefficients(tops)
    # The state at an end is given, often at the feed itself.
    if nodes.path[0, 1] > 0.0:
        highest[0] = math.inf
    if nodes.path[count, 1] > 0.0:
        highest[count - 1] = math.inf
    return RunTable(nodes.step, forms, highest)


@array_arithmetic_kernel
def _highest_coefficients(tops: FloatArray) -> FloatArray:
    """Coefficients of intervals' middles with which the squared rate stays below its highest values.

    Args:
        tops: Highest values at n + 1 nodes: one that is even along a curve, and one that goes up and
            down with it, shape (n + 1, 2).

    Returns:
        Shape (n,).
    """
    count = len(tops) - 1
    highest = np.zeros(count)
    for i in range(count):
        even, (here, there) = min(tops[i, 0], tops[i + 1, 0]), tops[i : i + 2, 1]
        # A parabola's coefficient lies below the mean of its values by a quarter of its second difference.
        bend = tops[max(0, i - 1), 1] + tops[min(i + 2, count), 1] - here - there
        wavy = 0.5 * (here + there) - max(0.0, 0.125 * bend)
        # Not a number where an axis stands.
        highest[i] = min(even, wavy) if wavy > min(here, there) else min(even, here, there)
    return highest


@array_arithmetic_kernel
def first_rate(table: RunTable, ends: RunEnds, nodes: RunNodes) -> FloatArray:
    """Coefficients of a squared rate that is slow enough, with the states at the run's ends."""
    step, forms, highest = table
    count, kinds = len(step), forms.shape[2]
    rate = 1.0
    for i in range(count):
        rate = min(rate, highest[i])
        for end in range(2):
            for k in range(kinds):
                value = abs(forms[i, end, k, 0])
                rate = min(rate, 1.0 / value if 2 * k < kinds else value ** (-2.0 / 3.0))
    c = np.full(count + 2, BELOW * rate)
    for side in range(2):
        v, a = ends.begin if side == 0 else ends.end
        if v > 0.0:
            node = 0 if side == 0 else count
            own = nodes.path[node, 1]
            value = (v / own) ** 2
            slope = 2.0 * (a - value * nodes.path[node, 2]) / own
            if side == 0:
                c[0], c[1] = value, value + 0.5 * slope * step[0]
            else:
                c[count + 1], c[count] = value, value - 0.5 * slope * step[count - 1]
    return c


@array_kernel
def tightened(table: RunTable, uses: FloatArray) -> RunTable:
    """A run under limits that are stricter where they have been passed.

    Args:
        uses: Of the limits of velocity, acceleration and jerk along each of n intervals, shape (n, 3).
    """
    step, forms, highest = table[0], table[1].copy(), table[2].copy()
    first_jerk = forms.shape[2] // 2
    count = len(step)
    for i in range(count):
        # An interval sees the coefficients of both its neighbours.
        fast = max(uses[max(0, i - 1), 0], uses[i, 0], uses[min(i + 1, count - 1), 0])
        if fast > 1.0:
            highest[i] /= (SPARE * fast) ** 2
        for end in range(2):
            # Both intervals that meet in a node see the same accelerations there.
            hard = max(uses[i, 1], uses[min(max(0, i + 2 * end - 1), count - 1), 1])
            if hard > 1.0:
                forms[i, end, :first_jerk] *= SPARE**2 * hard
            if uses[i, 2] > 1.0:
                forms[i, end, first_jerk:] *= SPARE**3 * uses[i, 2]
    return RunTable(step, forms, highest)
