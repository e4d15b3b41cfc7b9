"""Following the simulated tool along the commanded path, sample by sample."""

import math
from typing import NamedTuple

from twin.compilation.compilable import inlined
from twin.compilation.kernel import kernel
from twin.nc.canonical import FloatArray, IntArray
from twin.toolpath.nearest_kernels import nearest_between
from twin.toolpath.place_kernels import derivatives, distance_at, moved_along, speed_at

_TIE_MM = 1e-7
"""Of places equally near within this, the last up to the command is taken: a path that goes back
over itself does not hold the tool on its first leg, nor take it to a leg not yet commanded."""
_STEPS = 2.0
"""On the inside of a bend the place runs ahead of the tool: by no more than twice the tool's own
step as long as the error stays below half the radius of curvature."""
_ERRORS = 4.0
"""Where a corner is cut the place leaps around it, over a path of twice the error at a right angle
and four times at one of 53 degrees."""
_BLUNT = -0.6
"""Cosine of the turn of the path beyond which a corner is more acute than that."""
_GAP = 4.0
"""The place leaps back around an acute corner as long as its legs are apart by less than twice the
error; so many errors leave room for how that is measured."""


class Commanded(NamedTuple):
    """Where m setpoints are on the path, the late ones before a chunk's own.

    Attributes:
        time: Shape (m,) [s].
        move: Number in the program; below 0 before the first move, shape (m,).
        fraction: Of that move, shape (m,).
    """

    time: FloatArray
    move: IntArray
    fraction: FloatArray


class NearestPlaces(NamedTuple):
    """The nearest places on the path of n points.

    Attributes:
        distance: Contour error, shape (n,) [mm].
        move: Of the moves at hand, shape (n,).
        fraction: Of that move, shape (n,).
    """

    distance: FloatArray
    move: IntArray
    fraction: FloatArray


@kernel
def follow(path, first, point, commanded, reach_s, state, found):
    """Shortest distance from each simulated point to the path that can be meant.

    The search goes from where the tool was found one sample before to where it is commanded now,
    with a margin by the tool's own step and error on either side; it does not reach behind what was
    commanded ``reach_s`` ago.

    Args:
        path: ``PathColumns`` of the moves at hand.
        first: Number in the program of the first of them.
        point: Simulated tool points in the part's frame, shape (n, 3) [mm].
        commanded: The setpoints, those of the points last.
        reach_s: How late a tool can be [s].
        state: Where the tool was found before: move, fraction, its point, its error, shape (6,);
            read and written.
        found: Written.

    Returns:
        The row of ``commanded`` that the last point does not reach behind.
    """
    move, u = int(state[0]) - first, state[1]
    x0, y0, z0, error = state[2], state[3], state[4], state[5]
    before, late = len(commanded.time) - len(point), 0
    now_move, now_u = move, u
    if before > 0:
        now_move, now_u = _place(commanded, before - 1, first)
    corner, acute = -1, False
    for i in range(len(point)):
        x, y, z = point[i, 0], point[i, 1], point[i, 2]
        step = math.sqrt((x - x0) ** 2 + (y - y0) ** 2 + (z - z0) ** 2)
        margin = _STEPS * step + _ERRORS * error
        last_move, last_u = now_move, now_u
        now_move, now_u = _place(commanded, before + i, first)
        # The tool goes on as the command does.
        advance = now_u - last_u if now_move == last_move else 0.0
        while commanded.time[late] < commanded.time[before + i] - reach_s:
            late += 1
        low_move, low_u = now_move, now_u
        high_move, high_u = now_move, now_u
        was_ahead = move > now_move or (move == now_move and u > now_u)
        if not was_ahead:
            low_move, low_u = move, u
        else:
            high_move, high_u = move, u
        if move != corner:
            corner, acute = move, _begins_acutely(path, move)
        back_move, back_u = _place(commanded, late, first)
        around = 0.0
        if acute:
            around = _around_corner(path, (move, u), (back_move, back_u), step + error)
        low_move, low_u = moved_along(path, low_move, low_u, -margin - around)
        if low_move < back_move or (low_move == back_move and low_u < back_u):
            low_move, low_u = back_move, back_u
        error, move, u = nearest_between(
            path, (low_move, low_u), (now_move, now_u), (move, u + advance), x, y, z, _TIE_MM
        )
        # Within the margin ahead of the command nothing is nearer than the command less the margin.
        asked = distance_at(path, now_move, now_u, x, y, z)
        if was_ahead or asked - margin < error:
            high_move, high_u = moved_along(path, high_move, high_u, margin)
            ahead, ahead_move, ahead_u = nearest_between(
                path, (now_move, now_u), (high_move, high_u), (now_move, now_u), x, y, z, _TIE_MM
            )
            if ahead < error - _TIE_MM:
                error, move, u = ahead, ahead_move, ahead_u
        found.distance[i], found.move[i], found.fraction[i] = error, move, u
        x0, y0, z0 = x, y, z
    state[0], state[1] = move + first, u
    state[2], state[3], state[4], state[5] = x0, y0, z0, error
    return late


@inlined
def _place(commanded, row, first):
    """Move at hand and fraction of a setpoint; before the first move, where that begins."""
    move = commanded.move[row]
    if move < 0:
        return -first, 0.0
    return move - first, commanded.fraction[row]


@kernel
def _begins_acutely(path, move):
    """Whether a move begins at a corner with an acute angle between its legs."""
    if move == 0:
        return False
    _, _, _, ax, ay, az, _, _, _ = derivatives(path, move - 1, 1.0)
    _, _, _, bx, by, bz, _, _, _ = derivatives(path, move, 0.0)
    lengths = math.sqrt((ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz))
    return lengths > 0.0 and (ax * bx + ay * by + az * bz) / lengths <= _BLUNT


@kernel
def _around_corner(path, place, back, error):
    """How far back a place may leap around the acute corner where its move begins [mm].

    Both legs of a corner are equally near to a tool between them, at equal distances from its point.

    Args:
        place: Move and fraction.
        back: What the search does not reach behind, move and fraction.
        error: Of the tool, with what it may change by in a sample [mm].
    """
    move, u = place
    beyond = u * speed_at(path, move, u)
    x, y, z, _, _, _, _, _, _ = derivatives(path, move, u)
    other_move, other_u = moved_along(path, move - 1, 1.0, -beyond)
    if other_move < back[0] or (other_move == back[0] and other_u < back[1]):
        other_move, other_u = back
    apart = distance_at(path, other_move, other_u, x, y, z)
    return 2.0 * beyond if apart < _GAP * error else 0.0
