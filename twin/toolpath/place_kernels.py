"""Places of a path: point, derivatives and speed at a fraction of a move, for compiled loops.

``path`` is a ``PathColumns``; a place on it is a move number and a fraction from 0 to 1; points
are in the part's frame [mm].
"""

import enum
import math

from twin.compilation.compilable import inlined
from twin.compilation.kernel import kernel
from twin.toolpath.pose_kernels import turned


class PathKind(enum.IntEnum):
    """What a move's tip traces in the part, by which its nearest point is found."""

    LINE = 0
    CIRCLE = 1
    """An arc without lead: as a line, in closed form."""
    CURVE = 2
    """An arc with lead, or what a turntable turns: by Newton's method, as a chain's."""
    CHAIN = 3
    """What a chain of joints carries."""


@inlined
def derivatives(path, move, u):
    """Point, first and second derivative by fraction in the part's frame, nine numbers [mm]."""
    sweep = path.sweep[move]
    cosine, sine = 1.0, 0.0
    if sweep != 0.0:
        cosine, sine = math.cos(u * sweep), math.sin(u * sweep)
    f, s, o, a = path.first[move], path.second[move], path.origin[move], path.along[move]
    px = o[0] + u * a[0] + cosine * f[0] + sine * s[0]
    py = o[1] + u * a[1] + cosine * f[1] + sine * s[1]
    pz = o[2] + u * a[2] + cosine * f[2] + sine * s[2]
    dx = a[0] + sweep * (cosine * s[0] - sine * f[0])
    dy = a[1] + sweep * (cosine * s[1] - sine * f[1])
    dz = a[2] + sweep * (cosine * s[2] - sine * f[2])
    ddx = -sweep * sweep * (cosine * f[0] + sine * s[0])
    ddy = -sweep * sweep * (cosine * f[1] + sine * s[1])
    ddz = -sweep * sweep * (cosine * f[2] + sine * s[2])
    if path.kind[move] == PathKind.CHAIN:
        return _carried(path, move, u, (px, dx, ddx), (py, dy, ddy), (pz, dz, ddz))
    rate = path.turn_rate[move]
    vx, vy = dx - rate * py, dy + rate * px
    wx = ddx - 2.0 * rate * dy - rate * rate * px
    wy = ddy + 2.0 * rate * dx - rate * rate * py
    c, t = _facing(path, move, u)
    return (
        c * px - t * py, t * px + c * py, pz,
        c * vx - t * vy, t * vx + c * vy, dz,
        c * wx - t * wy, t * wx + c * wy, ddz,
    )  # fmt: skip


@kernel
def _carried(path, move, u, x, y, z):
    """Where a chain of joints carries the tip: point, first and second derivative, nine numbers [mm].

    Args:
        move: One that a chain turns.
        u: Fraction of it.
        x: Coordinate of X with its first and second derivative [mm].
        y: Of Y.
        z: Of Z.
    """
    px, py, pz = path.tip[move, 0], path.tip[move, 1], path.tip[move, 2]
    vx, vy, vz, wx, wy, wz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for number in range(path.rate.shape[1]):
        joint = path.joint[move, number]
        ax, ay, az = joint[2], joint[3], joint[4]
        rate = path.rate[move, number]
        value = path.begin[move, number] + u * rate
        if joint[1] == 0.0:
            slope, bend = rate, 0.0
            if joint[0] == 0.0:
                value, slope, bend = x
            elif joint[0] == 1.0:
                value, slope, bend = y
            elif joint[0] == 2.0:
                value, slope, bend = z
            px, py, pz = px + value * ax, py + value * ay, pz + value * az
            vx, vy, vz = vx + slope * ax, vy + slope * ay, vz + slope * az
            wx, wy, wz = wx + bend * ax, wy + bend * ay, wz + bend * az
            continue
        px, py, pz = px - joint[5], py - joint[6], pz - joint[7]
        # About the joint: v + r a x p, and w + 2 r a x v + r² a x (a x p).
        sx, sy, sz = ay * pz - az * py, az * px - ax * pz, ax * py - ay * px
        tx, ty, tz = ay * vz - az * vy, az * vx - ax * vz, ax * vy - ay * vx
        wx += 2.0 * rate * tx + rate * rate * (ay * sz - az * sy)
        wy += 2.0 * rate * ty + rate * rate * (az * sx - ax * sz)
        wz += 2.0 * rate * tz + rate * rate * (ax * sy - ay * sx)
        vx, vy, vz = vx + rate * sx, vy + rate * sy, vz + rate * sz
        c, s = math.cos(value), math.sin(value)
        px, py, pz = turned(px, py, pz, ax, ay, az, c, s)
        vx, vy, vz = turned(vx, vy, vz, ax, ay, az, c, s)
        wx, wy, wz = turned(wx, wy, wz, ax, ay, az, c, s)
        px, py, pz = px + joint[5], py + joint[6], pz + joint[7]
    return px, py, pz, vx, vy, vz, wx, wy, wz


@inlined
def _facing(path, move, u):
    """Cosine and sine of how far the table has turned the part."""
    rate = path.turn_rate[move]
    if rate == 0.0:
        return path.facing[move, 0], path.facing[move, 1]
    turned = path.turn[move] + u * rate
    return math.cos(turned), math.sin(turned)


@inlined
def _point_at(path, move, u):
    """The point alone, at a third of the cost of its derivatives [mm]."""
    if path.kind[move] == PathKind.CHAIN:
        cx, cy, cz, _, _, _, _, _, _ = derivatives(path, move, u)
        return cx, cy, cz
    f, s, o, a = path.first[move], path.second[move], path.origin[move], path.along[move]
    px, py, pz = o[0] + u * a[0], o[1] + u * a[1], o[2] + u * a[2]
    if path.kind[move] != PathKind.LINE:
        angle = u * path.sweep[move]
        cosine, sine = math.cos(angle), math.sin(angle)
        px += cosine * f[0] + sine * s[0]
        py += cosine * f[1] + sine * s[1]
        pz += cosine * f[2] + sine * s[2]
    c, t = _facing(path, move, u)
    return c * px - t * py, t * px + c * py, pz


@inlined
def distance_at(path, move, u, x, y, z):
    """Distance from a point to one place of the path [mm]."""
    px, py, pz = _point_at(path, move, u)
    return math.sqrt((px - x) ** 2 + (py - y) ** 2 + (pz - z) ** 2)


@inlined
def speed_at(path, move, u):
    """How fast the place moves with the fraction, seen from the part [mm]."""
    if path.kind[move] == PathKind.LINE:
        a = path.along[move]
        return math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
    if path.kind[move] == PathKind.CIRCLE:
        f = path.first[move]
        return abs(path.sweep[move]) * math.sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2])
    _, _, _, dx, dy, dz, _, _, _ = derivatives(path, move, u)
    return math.sqrt(dx * dx + dy * dy + dz * dz)


@kernel
def moved_along(path, move, u, distance):
    """The place a signed path length away, or the end of the path.

    On curves whose speed changes, the length is measured with the speed where a move is entered:
    good for margins, not for measuring.
    """
    last = len(path.sweep) - 1
    left = abs(distance)
    while left > 0.0:
        speed = speed_at(path, move, u)
        room = 1.0 - u if distance > 0.0 else u
        if speed * room > left:
            share = left / speed
            return move, u + share if distance > 0.0 else u - share
        left -= speed * room
        if distance > 0.0:
            if move == last:
                return move, 1.0
            move, u = move + 1, 0.0
        else:
            if move == 0:
                return move, 0.0
            move, u = move - 1, 1.0
    return move, u
