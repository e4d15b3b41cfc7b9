"""Blends: what takes the place of a corner between two moves.

A blend lies in a plane; height and further axes go linearly along what it leaves of the moves, and
stand still on the blend itself.
"""

import dataclasses
import enum
import math
from collections.abc import Sequence

from twin.nc.geometry import curves
from twin.nc.geometry.arcs import Point, distance, sweep_between
from twin.nc.geometry.biarcs import biarc
from twin.nc.geometry.curves import Curve
from twin.nc.geometry.planes import Plane, Vector, cross, plane_with_normal
from twin.nc.path.move_columns import Segment
from twin.nc.path.segments import direction_of, element_of, line_between, part_of
from twin.nc.path.splines import chords

_STRAIGHT_ON = 1e-4
"""Corners that turn by less need no blend, those that turn back by less allow none [deg]."""

_SMALL = 1e-9


class BlendKind(enum.Enum):
    """What takes the corner's place."""

    FILLET = "arc of a radius, tangent to both moves"
    CHAMFER = "line between two points at a distance from the corner"
    CHAMFER_LENGTH = "line of a length, as far from the corner on both moves"
    ARC = "arc between two points at a distance from the corner"
    SPLINE = "spline between two points at a distance from the corner"


@dataclasses.dataclass(frozen=True, slots=True)
class Blend:
    """A blend to be made.

    Attributes:
        size: Radius of a fillet; length of a ``CHAMFER_LENGTH``; distance from the corner of the others [mm].
        plane: In which it lies, part coordinates.
        halves: At most half of each move is given up, so that the size adapts to short moves.
        feed: Of the blend [mm/min]; NaN: that of the first move.
    """

    kind: BlendKind
    size: float
    plane: Plane
    halves: bool = False
    feed: float = math.nan


class NoBlendError(Exception):
    """The blend does not fit; the message says why."""


def blend_corner(
    first: Segment, second: Segment, blend: Blend
) -> tuple[Segment, list[Segment], Segment]:
    """Replace the corner between two moves.

    Returns:
        What is left of the first move, the blend, what is left of the second move.

    Raises:
        NoBlendError: It does not fit, or there is nothing to blend.
    """
    plane = _plane_of(first, second, blend)
    before, behind = element_of(first, plane), element_of(second, plane)
    if before is None or behind is None:
        raise NoBlendError("one of the moves does not lie in the working plane")
    turn = curves.turn_from(before, behind)
    if abs(turn) < _STRAIGHT_ON:
        return first, [], second
    if abs(turn) > 180.0 - _STRAIGHT_ON:
        raise NoBlendError("the path turns back on itself")
    if blend.kind is BlendKind.CHAMFER_LENGTH:
        if before[0] or behind[0]:
            raise NoBlendError("a chamfer of a length lies between two lines")
        legs = blend.size / (2.0 * math.cos(math.radians(turn) / 2.0))
        blend = dataclasses.replace(blend, kind=BlendKind.CHAMFER, size=legs)
    if blend.kind is BlendKind.FILLET:
        left, right, center = _fillet(before, behind, turn, blend.size)
    else:
        left, right = _cut(before, behind, blend)
        center = (0.0, 0.0)
    begin, end = curves.point_at(before, left), curves.point_at(behind, right)
    head = part_of(first, before, plane, 0.0, left)
    tail = part_of(second, behind, plane, right, 1.0)
    with_feed = head if math.isnan(blend.feed) else dataclasses.replace(head, feed=blend.feed)
    if blend.kind is BlendKind.CHAMFER:
        return head, [line_between(with_feed, head.end, tail.start)], tail
    if blend.kind is BlendKind.SPLINE:
        return head, _spline(head, tail, curves.length_of(before) * (1.0 - left)), tail
    if blend.kind is BlendKind.FILLET:
        sweep = sweep_between(begin, end, center, clockwise=turn < 0.0)
        return head, _arcs(with_feed, tail, plane, [curves.arc(begin, end, center, sweep)]), tail
    leaving, arriving = curves.tangent_at(before, left), curves.tangent_at(behind, right)
    return head, _arcs(head, tail, plane, biarc(begin, end, leaving, arriving)), tail


def _cut(before: Curve, behind: Curve, blend: Blend) -> tuple[float, float]:
    """Where both moves are cut, as shares of their paths."""
    size, lengths = blend.size, (curves.length_of(before), curves.length_of(behind))
    shorter = min(lengths)
    if blend.halves:
        size = min(size, shorter / 2.0)
    elif size > shorter + _SMALL:
        raise NoBlendError(f"{size:g} mm are longer than the shorter move, {shorter:.4f} mm")
    return max(0.0, 1.0 - size / lengths[0]), min(1.0, size / lengths[1])


def _plane_of(first: Segment, second: Segment, blend: Blend) -> Plane:
    """The blend's own plane; two lines in space span theirs."""
    if first.center is not None or second.center is not None or not blend.halves:
        return blend.plane
    a, b = direction_of(first, at_end=True), direction_of(second, at_end=False)
    normal = cross(a, b)
    size = math.hypot(*a) * math.hypot(*b)
    if math.hypot(*cross(normal, blend.plane.normal)) <= _SMALL * size:
        return blend.plane
    return plane_with_normal(normal)


def _fillet(before: Curve, behind: Curve, turn: float, radius: float) -> tuple[float, float, Point]:
    """Where a fillet touches both moves, as shares of their paths, and its centre."""
    side = math.copysign(radius, turn)
    if not (curves.leaves_room(before, side) and curves.leaves_room(behind, side)):
        raise NoBlendError(f"the radius {radius:g} does not fit into the arc beside the corner")
    beside, following = curves.parallel_of(before, side), curves.parallel_of(behind, side)
    fitting: list[tuple[float, float, Point]] = []
    count, *centers = curves.meetings(beside, following)
    for center in centers[:count]:
        left, right = curves.last_along(beside, center), curves.along(following, center)
        if curves.within(before, left) and curves.within(behind, right):
            fitting.append((min(max(left, 0.0), 1.0), min(max(right, 0.0), 1.0), center))
    if not fitting:
        raise NoBlendError(f"the radius {radius:g} is too large for the moves beside the corner")
    return min(fitting, key=lambda each: distance(each[2], before[2]))


def _arcs(before: Segment, behind: Segment, plane: Plane, pieces: list[Curve]) -> list[Segment]:
    """Plane pieces as moves; their ends meet those of the moves beside them exactly."""
    made: list[Segment] = []
    here = before.end
    height = plane.local(here).height
    for number, (is_arc, _, end, center, sweep) in enumerate(pieces):
        last = number == len(pieces) - 1
        there = behind.start if last else [*plane.world(*end, height), *here[3:]]
        move = line_between(before, here, there)
        if is_arc:
            center = plane.world(*center, height)
            move = dataclasses.replace(move, center=center, normal=plane.normal, sweep=sweep)
        made.append(move)
        here = there
    return made


def _spline(before: Segment, behind: Segment, size: float) -> list[Segment]:
    """A curve of degree 5 without a jump of direction or curvature where it meets straight moves."""
    start, end = before.end, behind.start
    leave = _unit(direction_of(before, at_end=True))
    arrive = _unit(direction_of(behind, at_end=False))
    control = [
        *([start[i] + share * size * leave[i] for i in range(3)] for share in (0.0, 0.5, 1.0)),
        *([end[i] - share * size * arrive[i] for i in range(3)] for share in (1.0, 0.5, 0.0)),
    ]
    bends = [
        20.0 * math.hypot(*(a - 2.0 * b + c for a, b, c in zip(*control[k : k + 3], strict=True)))
        for k in range(4)
    ]

    def at(u: float) -> Vector:
        weights = [math.comb(5, k) * u**k * (1.0 - u) ** (5 - k) for k in range(6)]
        x, y, z = (sum(w * p[i] for w, p in zip(weights, control, strict=True)) for i in range(3))
        return (x, y, z)

    return chords(line_between(before, start, end), at, max(bends))


def _unit(vector: Sequence[float]) -> Vector:
    size = math.hypot(*vector)
    return (vector[0] / size, vector[1] / size, vector[2] / size)
