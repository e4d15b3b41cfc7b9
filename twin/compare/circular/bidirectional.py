"""Full circles that are run in both directions, evaluated together after ISO 230-4."""

import dataclasses

import numpy as np

from twin.compare.circular.circle import ActualCircle, circle_figures, hysteresis_um
from twin.compare.figures import BidirectionalFigures
from twin.nc.canonical import Moves

RECENT_CIRCLES = 16
"""So many circles are remembered, to be found again in the other direction."""
PAIRS_KEPT = 1000
"""Of circles run in both directions, those with the greatest circular deviation are kept."""


@dataclasses.dataclass(frozen=True, slots=True)
class DirectedCircle:
    """The actual path of one arc, with what tells its circle from others.

    Attributes:
        circle: Centre, plane and radius, to a micrometre: equal for both directions.
    """

    line: int
    circle: tuple[float, ...]
    counter_clockwise: bool
    path: ActualCircle


def directed_circle(moves: Moves, row: int) -> DirectedCircle:
    """An arc of the program before the tool has come to it."""
    normal = moves.normal[row]
    sign = 1.0 if normal[int(np.abs(normal).argmax())] > 0.0 else -1.0
    radius = float(moves.radius[row])
    values = (*moves.center[row], *(sign * normal), radius)
    return DirectedCircle(
        line=int(moves.line[row]),
        circle=tuple(round(float(value), 3) + 0.0 for value in values),
        counter_clockwise=bool(sign * moves.sweep[row] > 0.0),
        path=ActualCircle(radius),
    )


class PairCollector:
    """Finds the last run of the same circle in the other direction for every arc."""

    def __init__(self) -> None:
        self._recent: dict[tuple[tuple[float, ...], bool], DirectedCircle] = {}
        self._pairs: dict[tuple[int, int], BidirectionalFigures] = {}

    def copy(self) -> "PairCollector":
        """A collector that goes on from here by itself."""
        other = PairCollector()
        other._recent, other._pairs = self._recent.copy(), self._pairs.copy()
        return other

    def add(self, arc: DirectedCircle) -> None:
        """Take in an arc that the tool has left; those of less than a full turn do not pair."""
        if not arc.path.covers_full_turn():
            return
        self._recent.pop((arc.circle, arc.counter_clockwise), None)
        self._recent[arc.circle, arc.counter_clockwise] = arc
        if len(self._recent) > RECENT_CIRCLES:
            del self._recent[next(iter(self._recent))]
        other = self._recent.get((arc.circle, not arc.counter_clockwise))
        if other is None:
            return
        ccw, cw = (arc, other) if arc.counter_clockwise else (other, arc)
        found = _evaluate(ccw, cw)
        known = self._pairs.get((ccw.line, cw.line))
        if known is None or found.circular_deviation_um > known.circular_deviation_um:
            self._pairs[ccw.line, cw.line] = found
        if len(self._pairs) > PAIRS_KEPT:
            del self._pairs[min(self._pairs, key=lambda k: self._pairs[k].circular_deviation_um)]

    def figures(self) -> tuple[BidirectionalFigures, ...]:
        """The pairs found so far, by line; of a pair run several times the worst."""
        return tuple(self._pairs[key] for key in sorted(self._pairs))


def _evaluate(ccw: DirectedCircle, cw: DirectedCircle) -> BidirectionalFigures:
    both = circle_figures(ccw.path, cw.path)
    return BidirectionalFigures(
        counter_clockwise_line=ccw.line,
        clockwise_line=cw.line,
        radius_mm=ccw.path.radius,
        circular_deviation_um=both.circular_deviation_um,
        mean_radial_deviation_um=both.mean_radius_error_um,
        hysteresis_um=hysteresis_um(ccw.path, cw.path),
    )
