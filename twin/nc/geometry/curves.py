"""Geometry of plane curves, lines and arcs, as plain functions over tuples."""

import math

from twin.nc.geometry.arcs import Point, distance, turned

Curve = tuple[bool, Point, Point, Point, float]
"""Whether it is an arc; its start and end [mm]; the centre and the signed sweep of an arc [deg]."""
Box = tuple[float, float, float, float]
"""Least abscissa and ordinate, largest abscissa and ordinate [mm]."""

NEAR = 1e-7
"""Slack of comparisons along a curve [mm]."""
_BOX_SLACK = 1e-3
"""By which the box of a curve is larger than it [mm]: far above any rounding."""
_END = 1e-6
"""So near its end a curve does not cross another: there it meets its neighbours [mm]."""


def line(start: Point, end: Point) -> Curve:
    """A straight line."""
    return (False, start, end, (0.0, 0.0), 0.0)


def arc(start: Point, end: Point, center: Point, sweep: float) -> Curve:
    """An arc."""
    return (True, start, end, center, sweep)


def radius_of(curve: Curve) -> float:
    """Of an arc [mm]."""
    return distance(curve[1], curve[3])


def length_of(curve: Curve) -> float:
    """Along the curve [mm]."""
    if not curve[0]:
        return distance(curve[1], curve[2])
    return math.radians(abs(curve[4])) * radius_of(curve)


def tangent_of(curve: Curve, at_end: bool) -> Point:
    """Unit direction of travel at the start or the end; 0 0 where a slot as wide as the tool leaves no path."""
    is_arc, start, end, center, sweep = curve
    if is_arc:
        point = end if at_end else start
        x, y = point[0] - center[0], point[1] - center[1]
        x, y = (-y, x) if sweep > 0.0 else (y, -x)
    else:
        x, y = end[0] - start[0], end[1] - start[1]
    length = math.sqrt(x * x + y * y)
    return (x / length, y / length) if length > 0.0 else (0.0, 0.0)


def leaves_room(curve: Curve, by: float) -> bool:
    """There is a parallel curve, ``by`` to the left [mm]: an arc does not vanish."""
    if not curve[0]:
        return True
    return scale_of(curve, by) > NEAR


def scale_of(curve: Curve, by: float) -> float:
    """How much larger the parallel of an arc is."""
    radius = radius_of(curve)
    return (radius - math.copysign(by, by * curve[4])) / radius


def parallel_of(curve: Curve, by: float) -> Curve:
    """The parallel curve, ``by`` to the left [mm], where there is one."""
    is_arc, start, end, center, sweep = curve
    if not is_arc:
        x, y = tangent_of(curve, False)
        dx, dy = -y * by, x * by
        return (False, moved(start, dx, dy), moved(end, dx, dy), center, sweep)
    scale = scale_of(curve, by)
    return (True, towards(center, start, scale), towards(center, end, scale), center, sweep)


def along(curve: Curve, point: Point) -> float:
    """How far along the curve a point of it lies: 0 at its start, 1 at its end.

    Beyond the ends of an arc the nearer end counts: below 0 or above 1.
    """
    is_arc, start, end, center, sweep = curve
    if not is_arc:
        dx, dy = end[0] - start[0], end[1] - start[1]
        length = dx * dx + dy * dy
        if length == 0.0:
            return 0.0
        return ((point[0] - start[0]) * dx + (point[1] - start[1]) * dy) / length
    ax, ay = start[0] - center[0], start[1] - center[1]
    bx, by = point[0] - center[0], point[1] - center[1]
    angle = math.degrees(math.atan2(ax * by - ay * bx, ax * bx + ay * by))
    if sweep < 0.0:
        angle = -angle
    angle %= 360.0
    size = abs(sweep)
    over = 360.0 - size % 360.0 if size < 360.0 else 0.0
    if size < 360.0 and angle > size + over / 2.0:
        angle -= 360.0
    return angle / size


def last_along(curve: Curve, point: Point) -> float:
    """As ``along``; on an arc of several turns in its last one."""
    share = along(curve, point)
    if not curve[0] or abs(curve[4]) < 360.0:
        return share
    turn = 360.0 / abs(curve[4])
    return share + turn * math.floor((1.0 - share) / turn + NEAR)


def point_of(straight: Curve, share: float) -> Point:
    """The point of a line at a share of its length."""
    start, end = straight[1], straight[2]
    return (start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1]))


def point_at(curve: Curve, share: float) -> Point:
    """The point of a line or an arc at a share of its length."""
    return turned(curve[1], curve[3], curve[4] * share) if curve[0] else point_of(curve, share)


def head_of(curve: Curve, share: float) -> Curve:
    """The part from its start to a share of its length."""
    return (curve[0], curve[1], point_at(curve, share), curve[3], curve[4] * share)


def tangent_at(curve: Curve, share: float) -> Point:
    """Unit direction of travel at a share of its length."""
    is_arc, start, end, center, sweep = curve
    return tangent_of(
        (is_arc, start, point_at(curve, share) if is_arc else end, center, sweep), True
    )


def within(curve: Curve, fraction: float) -> bool:
    """Whether a place along the curve lies on it, with a little slack."""
    slack = NEAR / max(length_of(curve), NEAR)
    return -slack <= fraction <= 1.0 + slack


def cut(curve: Curve, start: Point, end: Point) -> Curve:
    """The part between two points of it; on an arc of several turns those nearest its ends."""
    is_arc, _, _, center, sweep = curve
    if not is_arc:
        return (False, start, end, center, sweep)
    before, after = along(curve, start), along(curve, end)
    if abs(sweep) >= 360.0:
        turn = 360.0 / abs(sweep)
        before -= turn * round(before / turn)
        after += turn * round((1.0 - after) / turn)
    return (True, start, end, center, sweep * (after - before))


def box_of(curve: Curve) -> Box:
    """Where the curve lies, with a little slack; of an arc all of its circle."""
    is_arc, start, end, center, _ = curve
    if is_arc:
        reach = radius_of(curve) + _BOX_SLACK
        return (center[0] - reach, center[1] - reach, center[0] + reach, center[1] + reach)
    return (
        min(start[0], end[0]) - _BOX_SLACK,
        min(start[1], end[1]) - _BOX_SLACK,
        max(start[0], end[0]) + _BOX_SLACK,
        max(start[1], end[1]) + _BOX_SLACK,
    )


def turn_from(first: Curve, second: Curve) -> float:
    """Signed angle from the end of one curve to the start of the next, ±180 [deg]."""
    ax, ay = tangent_of(first, True)
    bx, by = tangent_of(second, False)
    return math.degrees(math.atan2(ax * by - ay * bx, ax * bx + ay * by))


Meetings = tuple[int, Point, Point]
"""How many places there are, and these."""
_NOWHERE = (0, (0.0, 0.0), (0.0, 0.0))


def meetings(first: Curve, second: Curve) -> Meetings:
    """Where two curves meet that go on without limit."""
    if first[0] and second[0]:
        return circle_circle(first, second)
    if first[0]:
        return line_circle(second, first)
    if second[0]:
        return line_circle(first, second)
    return line_line(first, second)


def crossing_of(older: Curve, younger: Curve) -> tuple[bool, float, float]:
    """Whether two curves cross, and where, as shares of their paths: the first place on the older."""
    count, first, second = meetings(older, younger)
    found, left, right = False, 0.0, 0.0
    for number in range(count):
        point = first if number == 0 else second
        one = along(older, point)
        if not inside(older, one):
            continue
        other = along(younger, point)
        if inside(younger, other):
            if not found or (one, other) < (left, right):
                left, right = one, other
            found = True
    return (found, left, right)


def inside(curve: Curve, share: float) -> bool:
    """Whether a place lies between the curve's ends, not near them."""
    if not 0.0 < share < 1.0:
        return False
    end = _END / max(length_of(curve), _END)
    return end < share < 1.0 - end


def line_line(first: Curve, second: Curve) -> Meetings:
    """As ``meetings``, of two lines."""
    ax, ay = tangent_of(first, False)
    bx, by = tangent_of(second, False)
    area = ax * by - ay * bx
    if abs(area) < 1e-12:
        return _NOWHERE
    dx, dy = second[1][0] - first[1][0], second[1][1] - first[1][1]
    far = (dx * by - dy * bx) / area
    return (1, moved(first[1], ax * far, ay * far), (0.0, 0.0))


def line_circle(straight: Curve, circle: Curve) -> Meetings:
    """As ``meetings``, of a line and an arc."""
    ux, uy = tangent_of(straight, False)
    dx, dy = circle[3][0] - straight[1][0], circle[3][1] - straight[1][1]
    far, beside = dx * ux + dy * uy, dy * ux - dx * uy
    foot = moved(straight[1], ux * far, uy * far)
    radius, beside = radius_of(circle), abs(beside)
    if beside > radius + NEAR:
        return _NOWHERE
    half = half_chord(radius, beside)
    return (2, moved(foot, ux * half, uy * half), moved(foot, ux * -half, uy * -half))


def circle_circle(first: Curve, second: Curve) -> Meetings:
    """As ``meetings``, of two arcs."""
    apart = distance(first[3], second[3])
    if apart < NEAR:
        return _NOWHERE
    ux, uy = (second[3][0] - first[3][0]) / apart, (second[3][1] - first[3][1]) / apart
    one, other = radius_of(first), radius_of(second)
    far = (apart * apart + one * one - other * other) / (2.0 * apart)
    foot = moved(first[3], ux * far, uy * far)
    if abs(far) > one + NEAR:
        return _NOWHERE
    half = half_chord(one, abs(far))
    return (2, moved(foot, -uy * half, ux * half), moved(foot, -uy * -half, ux * -half))


def half_chord(radius: float, beside: float) -> float:
    """Half the chord that lies ``beside`` a circle's centre."""
    return math.sqrt(max(0.0, radius * radius - beside * beside))


def moved(point: Point, dx: float, dy: float) -> Point:
    """A point elsewhere."""
    return (point[0] + dx, point[1] + dy)


def towards(center: Point, point: Point, scale: float) -> Point:
    """A point moved from a centre by a factor."""
    return (
        center[0] + (point[0] - center[0]) * scale,
        center[1] + (point[1] - center[1]) * scale,
    )
