"""Nearest points on the commanded path, one at a time, for compiled loops.

Lines and circles with the table at rest are solved in closed form;
helices, and whatever the table or a chain of joints turns, by Newton's method kept inside brackets.
"""

import math

from twin.compilation.compilable import inlined
from twin.compilation.kernel import kernel
from twin.toolpath.place_kernels import PathKind, derivatives, distance_at

_RESOLUTION_MM = 1e-9
"""A piece of a curve that can hold nothing nearer by more than this is left out."""
_STEP_MM = 1e-10
"""Newton's method ends when a step is shorter than this; the distance changes by far less."""
_LAST_STEP_MM = 1e-5
"""So short a step of Newton's method leaves less than its square over the radius of curvature."""
_SMALLEST_PIECE = 2.0**-10
"""Share of the searched fractions below which a piece is solved without the proof."""
_ITERATIONS = 80
"""More than bisection alone needs to halve a bracket down to rounding."""


@inlined
def nearest_on_move(path, move, low, high, guess, x, y, z):
    """Nearest place of one move between two fractions; a good guess of it saves time on curves.

    Returns:
        Its distance [mm] and its fraction. Of several equally near places on a circle, the last.
    """
    kind = path.kind[move]
    if kind != PathKind.LINE and kind != PathKind.CIRCLE:
        return _nearest_on_curve(path, move, low, high, guess, x, y, z)
    c, t = path.facing[move, 0], path.facing[move, 1]
    o = path.origin[move]
    rx, ry, rz = c * x + t * y - o[0], c * y - t * x - o[1], z - o[2]
    if kind == PathKind.LINE:
        u = _project_on_line(path.along[move], low, high, rx, ry, rz)
    else:
        u = _project_on_circle(path, move, low, high, rx, ry, rz)
    return distance_at(path, move, u, x, y, z), u


@inlined
def _project_on_line(along, low, high, rx, ry, rz):
    squared = along[0] ** 2 + along[1] ** 2 + along[2] ** 2
    if squared == 0.0:
        return high
    u = (rx * along[0] + ry * along[1] + rz * along[2]) / squared
    return min(max(u, low), high)


@inlined
def _project_on_circle(path, move, low, high, rx, ry, rz):
    first, second, sweep = path.first[move], path.second[move], path.sweep[move]
    cosine = rx * first[0] + ry * first[1] + rz * first[2]
    sine = rx * second[0] + ry * second[1] + rz * second[2]
    if sweep == 0.0 or (cosine == 0.0 and sine == 0.0):
        return high
    angle = math.atan2(sine, cosine)
    turn = 2.0 * math.pi / abs(sweep)
    u = angle / sweep
    u += math.floor((high - u) / turn) * turn
    if u >= low:
        return u
    # Not between the two: the end that is nearer around the circle.
    return high if u + turn - high < low - u else low


@inlined
def _look(path, move, u, x, y, z):
    """From one place: distance, slope and curvature of half its square, and the place's speed."""
    px, py, pz, dx, dy, dz, wx, wy, wz = derivatives(path, move, u)
    rx, ry, rz = px - x, py - y, pz - z
    squared_speed = dx * dx + dy * dy + dz * dz
    return (
        math.sqrt(rx * rx + ry * ry + rz * rz),
        rx * dx + ry * dy + rz * dz,
        squared_speed + rx * wx + ry * wy + rz * wz,
        math.sqrt(squared_speed),
    )


@kernel
def _minimum_between(path, move, piece, u, look, x, y, z):
    """Distance and place of the minimum of a convex piece, from what one place of it looks like."""
    here, slope, curvature, speed = look
    begin, end = piece
    low, high = piece
    for _ in range(_ITERATIONS):
        if slope > 0.0:
            high = u
        else:
            low = u
        new = u - slope / curvature if curvature > 0.0 else low
        quadratic = low < new < high
        if not quadratic:
            new = 0.5 * (low + high)
            # Where the piece falls up to its end, the end is the minimum.
            if slope > 0.0 and low == begin:
                at_end, falling, _, _ = _look(path, move, begin, x, y, z)
                if falling >= 0.0:
                    return at_end, begin
            elif slope <= 0.0 and high == end:
                at_end, rising, _, _ = _look(path, move, end, x, y, z)
                if rising <= 0.0:
                    return at_end, end
        moved = abs(new - u) * speed
        u = new
        here, slope, curvature, speed = _look(path, move, u, x, y, z)
        if moved < _STEP_MM or (quadratic and moved < _LAST_STEP_MM):
            break
    return here, u


@inlined
def _bounds(path, move):
    """Largest second and third derivative of a move in the part's frame [mm]."""
    f, o, a = path.first[move], path.origin[move], path.along[move]
    radius = math.sqrt(f[0] ** 2 + f[1] ** 2 + f[2] ** 2)
    straight = math.sqrt(a[0] ** 2 + a[1] ** 2 + a[2] ** 2)
    reach = math.hypot(o[0], o[1]) + straight + radius
    sweep, rate = abs(path.sweep[move]), abs(path.turn_rate[move])
    speed = straight + sweep * radius
    second = sweep**2 * radius
    third = sweep**3 * radius
    if path.kind[move] == PathKind.CHAIN:
        far = math.sqrt(o[0] ** 2 + o[1] ** 2 + o[2] ** 2) + straight + radius
        return _bounds_of_chain(path, move, far, speed, second, third)
    return (
        second + 2.0 * rate * speed + rate**2 * reach,
        third + 3.0 * rate * second + 3.0 * rate**2 * speed + rate**3 * reach,
    )


@kernel
def _bounds_of_chain(path, move, far, speed, second, third):
    """Largest second and third derivative where a chain turns [mm], from those of X, Y and Z together.

    A joint that turns at a rate r about a point no farther than d adds r d, 2 r v + r² d and
    3 r w + 3 r² v + r³ d to the bounds v, w and of the third derivative.
    """
    tip = path.tip[move]
    away = math.sqrt(tip[0] ** 2 + tip[1] ** 2 + tip[2] ** 2) + far
    for number in range(path.rate.shape[1]):
        joint = path.joint[move, number]
        rate = abs(path.rate[move, number])
        if joint[1] == 0.0:
            if joint[0] < 0.0:
                away += abs(path.begin[move, number]) + rate
                speed += rate
            continue
        anchor = math.sqrt(joint[5] ** 2 + joint[6] ** 2 + joint[7] ** 2)
        away += anchor
        third += 3.0 * rate * second + 3.0 * rate**2 * speed + rate**3 * away
        second += 2.0 * rate * speed + rate**2 * away
        speed += rate * away
        away += anchor
    return second, third


@inlined
def _bend(second, third, here, speed, half):
    """How much the curvature of half the squared distance may change within half a piece [mm²]."""
    across = (speed + 0.5 * second * half) * half
    return (3.0 * (speed + second * half) * second + (here + across) * third) * half


@kernel
def _nearest_on_curve(path, move, low, high, guess, x, y, z):
    """Nearest place of a curve between two fractions; no minimum is missed, cusps included.

    The fractions are gone through in pieces, each of which is proved to hold nothing nearer, or
    proved convex and solved, or halved. Halving has an end where the distance hardly changes, as
    it does about the middle of a circle.
    """
    second, third = _bounds(path, move)
    start, step = low, high - low
    guess = min(max(guess, low), high)
    look = _look(path, move, guess, x, y, z)
    if look[2] > _bend(second, third, look[0], look[3], max(guess - low, high - guess)):
        return _minimum_between(path, move, (low, high), guess, look, x, y, z)
    best, best_u = distance_at(path, move, high, x, y, z), high
    at_low = distance_at(path, move, low, x, y, z)
    if at_low < best:
        best, best_u = at_low, low
    smallest = step * _SMALLEST_PIECE
    while start < high:
        end = min(start + step, high)
        half = 0.5 * (end - start)
        middle = start + half
        look = _look(path, move, middle, x, y, z)
        here, slope, curvature, speed = look
        if here < best:
            best, best_u = here, middle
        across = (speed + 0.5 * second * half) * half
        if here - across < best - _RESOLUTION_MM and across > _RESOLUTION_MM:
            bend = _bend(second, third, here, speed, half)
            # Taylor's bound on half the squared distance: of circles about the point, and of all
            # that is nearly so, it leaves out far longer pieces than the speed alone.
            falls = abs(slope) * half + 0.5 * max(bend / 3.0 - curvature, 0.0) * half**2
            nearest_possible = math.sqrt(max(here * here - 2.0 * falls, 0.0))
            if nearest_possible < best - _RESOLUTION_MM:
                if curvature <= bend and step > smallest:
                    step = half
                    continue
                here, u = _minimum_between(path, move, (start, end), middle, look, x, y, z)
                if here < best:
                    best, best_u = here, u
        start, step = end, 4.0 * half
    return best, best_u


@kernel
def nearest_between(path, low, high, guess, x, y, z, tie):
    """Nearest place between two places of the path, ends included.

    Args:
        low: Move and fraction where the search begins.
        high: Move and fraction where it ends, not before the beginning.
        guess: Move and fraction about which it may lie; what is found does not depend on it.
        x: The point's X in the part's frame [mm].
        y: Its Y.
        z: Its Z.
        tie: Of places whose distance differs by no more than this, the last is taken [mm].

    Returns:
        The shortest distance [mm], the move and the fraction of its place.
    """
    least = math.inf
    place_move, place_u = high
    for move in range(low[0], high[0] + 1):
        begin = low[1] if move == low[0] else 0.0
        end = high[1] if move == high[0] else 1.0
        middle = guess[1] if move == guess[0] else 0.5 * (begin + end)
        here, u = nearest_on_move(path, move, begin, end, middle, x, y, z)
        if here <= least + tie:
            place_move, place_u = move, u
        least = min(least, here)
    return least, place_move, place_u
