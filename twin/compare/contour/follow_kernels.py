"""Following the simulated tool along the commanded path, sample by sample."""

import math

from twin.compilation.kernel import array_kernel
from twin.toolpath.nearest_kernels import distance_at, nearest_between, walk

_TIE_MM = 1e-7
"""Of places equally near within this, the last up to the command is taken: a path that goes back
over itself does not hold the tool on its first leg, nor take it to a leg not yet commanded."""
_STEPS = 2.0
"""On the inside of a bend the place runs ahead of the tool: by no more than twice the tool's own
step as long as the error stays below half the radius of curvature."""
_ERRORS = 4.0
"""Where a corner is cut the place leaps around it, over a path of twice the error at a right angle
and four times at one of 53 degrees."""


@array_kernel
def follow(path, point, command, back, state, distance, place_move, place_fraction):
    """Shortest distance from each simulated point to the path that can be meant.

    The search goes from where the tool was found one sample before to where it is commanded now,
    with a margin by the tool's own step and error on either side; it does not reach behind ``back``.

    Args:
        path: ``PathColumns`` of the moves at hand.
        point: Simulated tool points in the part's frame, shape (n, 3) [mm].
        command: Move number (within ``path``) and fraction of the setpoints, shape (n, 2).
        back: Move number and fraction of the setpoint beyond which no tool can be late, shape (n, 2).
        state: Where the tool was found before: move, fraction, its point, its error, shape (6,);
            read and written.
        distance: Out: contour error, shape (n,) [mm].
        place_move: Out: move of the nearest place, shape (n,).
        place_fraction: Out: its fraction, shape (n,).
    """
    move, u = int(state[0]), state[1]
    x0, y0, z0, error = state[2], state[3], state[4], state[5]
    for i in range(len(point)):
        x, y, z = point[i, 0], point[i, 1], point[i, 2]
        step = math.sqrt((x - x0) ** 2 + (y - y0) ** 2 + (z - z0) ** 2)
        margin = _STEPS * step + _ERRORS * error
        now_move, now_u = int(command[i, 0]), command[i, 1]
        low_move, low_u = now_move, now_u
        high_move, high_u = now_move, now_u
        was_ahead = move > now_move or (move == now_move and u > now_u)
        if not was_ahead:
            low_move, low_u = move, u
        else:
            high_move, high_u = move, u
        low_move, low_u = walk(path, low_move, low_u, -margin)
        back_move = int(back[i, 0])
        if low_move < back_move or (low_move == back_move and low_u < back[i, 1]):
            low_move, low_u = back_move, back[i, 1]
        error, move, u = nearest_between(
            path, (low_move, low_u), (now_move, now_u), x, y, z, _TIE_MM
        )
        # Within the margin ahead of the command nothing is nearer than the command less the margin.
        asked = distance_at(path, now_move, now_u, x, y, z)
        if was_ahead or asked - margin < error:
            high_move, high_u = walk(path, high_move, high_u, margin)
            ahead, ahead_move, ahead_u = nearest_between(
                path, (now_move, now_u), (high_move, high_u), x, y, z, _TIE_MM
            )
            if ahead < error - _TIE_MM:
                error, move, u = ahead, ahead_move, ahead_u
        distance[i] = error
        place_move[i], place_fraction[i] = move, u
        x0, y0, z0 = x, y, z
    state[0], state[1] = move, u
    state[2], state[3], state[4], state[5] = x0, y0, z0, error
