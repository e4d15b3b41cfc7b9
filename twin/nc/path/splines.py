"""Cardinal splines: curves through points, joined to their neighbours without a kink.

The tangent at an inner point is parallel to the line between its neighbours; at the ends it is the
tangent of the element before or behind, or the chord where there is none (CODESYS SoftMotion's page
on splines). Its length, which the page leaves open, is half the distance of the neighbours, at the
ends the chord: a cardinal spline without tension. One point is looked ahead.
"""

import itertools
import math
from collections.abc import Callable

from twin.nc.geometry.planes import Vector
from twin.nc.path.move_columns import Segment
from twin.nc.path.segments import direction_of, line_between

CHORD_ERROR = 5e-4
"""Largest distance of a chord from its curve [mm]: half a micrometre, below what a mill resolves."""

MOST_CHORDS = 20_000
"""Chords that one curve may have."""

_SMALL = 1e-9


class Spline:
    """A spline that is being drawn.

    Args:
        before: The element that it leaves, or None.
        emit: Takes its chords.
    """

    def __init__(self, before: Segment | None, emit: Callable[[Segment], None]) -> None:
        self._before = before
        self._emit = emit
        self._held: tuple[Segment, bool] | None = None
        self._tangent: Vector | None = None

    def add(self, move: Segment, *, flat: bool) -> None:
        """The straight path to the next point; ``flat``: Z goes linearly."""
        if self._held is None:
            self._tangent = _tangent_of(self._before, move, at_end=True)
        else:
            across = _difference(move.end, self._held[0].start)
            self._draw((0.5 * across[0], 0.5 * across[1], 0.5 * across[2]))
        self._held = (move, flat)

    def finish(self, behind: Segment | None) -> None:
        """Draw what is kept; the spline ends with the tangent of the element behind it."""
        if self._held is not None:
            self._draw(_tangent_of(behind, self._held[0], at_end=False))
        self._held = None

    def _draw(self, end_tangent: Vector | None) -> None:
        """Draw the kept piece; without a tangent its chord counts."""
        assert self._held is not None
        move, flat = self._held
        chord = _difference(move.end, move.start)
        first, last = self._tangent or chord, end_tangent or chord
        self._tangent = end_tangent
        if flat:
            first, last = (*first[:2], chord[2]), (*last[:2], chord[2])
        for piece in chords(move, _hermite(move, chord, first, last), _bend(chord, first, last)):
            self._emit(piece)


def _tangent_of(neighbour: Segment | None, move: Segment, *, at_end: bool) -> Vector | None:
    """Direction of a neighbouring element, as long as the chord of the spline's own piece."""
    if neighbour is None:
        return None
    direction = direction_of(neighbour, at_end=at_end)
    size, length = math.hypot(*direction), math.dist(move.start[:3], move.end[:3])
    if size < _SMALL:
        return None
    return (
        direction[0] * length / size,
        direction[1] * length / size,
        direction[2] * length / size,
    )


def _hermite(
    move: Segment, chord: Vector, first: Vector, last: Vector
) -> Callable[[float], Vector]:
    begin = move.start

    def at(u: float) -> Vector:
        a, b, c = u * (1.0 - u) ** 2, u * u * (3.0 - 2.0 * u), u * u * (u - 1.0)
        x, y, z = (begin[i] + a * first[i] + b * chord[i] + c * last[i] for i in range(3))
        return (x, y, z)

    return at


def _bend(chord: Vector, first: Vector, last: Vector) -> float:
    """Largest second derivative of the cubic, which is linear in u: that of one of its ends."""
    ends = (
        [6.0 * d - 4.0 * a - 2.0 * b for d, a, b in zip(chord, first, last, strict=True)],
        [-6.0 * d + 2.0 * a + 4.0 * b for d, a, b in zip(chord, first, last, strict=True)],
    )
    return max(math.hypot(*each) for each in ends)


def chords(move: Segment, at: Callable[[float], Vector], bend: float) -> list[Segment]:
    """A curve in place of a straight move, as chords that leave it by ``CHORD_ERROR`` at most.

    Args:
        move: From the curve's first point to its last; further axes go linearly.
        at: The curve by u from 0 to 1.
        bend: Largest second derivative of the curve by u.
    """
    count = min(MOST_CHORDS, max(1, math.ceil(math.sqrt(bend / (8.0 * CHORD_ERROR)))))
    points = [move.start]
    for number in range(1, count):
        u = number / count
        rest = [a + u * (b - a) for a, b in zip(move.start[3:], move.end[3:], strict=True)]
        points.append([*at(u), *rest])
    points.append(move.end)
    return [line_between(move, a, b) for a, b in itertools.pairwise(points)]


def _difference(end: list[float], start: list[float]) -> Vector:
    return (end[0] - start[0], end[1] - start[1], end[2] - start[2])
