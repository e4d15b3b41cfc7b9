"""Circular figures of the arc blocks of a program, collected while the tool runs through them."""

import dataclasses

import numpy as np
import numpy.typing as npt

from twin.compare.bidirectional import DirectedCircle, PairCollector, directed_circle
from twin.compare.circle import CirclePath, circle_figures
from twin.compare.figures import ArcFigures, BidirectionalFigures
from twin.nc.canonical import FloatArray, IntArray, Moves, Shape

BoolArray = npt.NDArray[np.bool_]

SMALLEST_SWEEP = 90.0 - 1e-6
"""Arcs of at least 90 degrees are evaluated; a rounded end point shall not lose one [deg]."""
POLAR_ARCS = 12
"""Of so many arcs, the worst, the path is kept for a polar plot."""
ARCS_KEPT = 10_000
"""Of a program with more arcs, those with the greatest circular deviation are kept."""
_POLAR_POINTS = 720


def plane_axes(normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Directions of 0 and 90 degrees in the planes of arcs, whichever way their normals point.

    X and Y in XY, Z and X in ZX, Y and Z in YZ, as ISO 230-4 names the planes; in an oblique plane
    the projection of the first axis of the nearest of these.

    Args:
        normal: Unit normals, shape (n, 3).
    """
    upright = np.abs(normal).argmax(axis=1)
    rows = np.arange(len(normal))
    upward = normal * np.where(normal[rows, upright] < 0.0, -1.0, 1.0)[:, None]
    first = np.zeros(normal.shape)
    first[rows, (upright + 1) % 3] = 1.0
    first -= np.einsum("ij,ij->i", first, upward)[:, None] * upward
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return first, np.asarray(np.cross(upward, first), np.float64)


@dataclasses.dataclass(slots=True)
class _OpenArc:
    time_s: float
    sweep_deg: float
    directed: DirectedCircle

    @property
    def line(self) -> int:
        return self.directed.line

    @property
    def path(self) -> CirclePath:
        return self.directed.path


class ArcCollector:
    """Takes in where the tool was relative to each arc and gives the figures of finished arcs."""

    def __init__(self) -> None:
        self._open: dict[int, _OpenArc] = {}
        self._done: list[tuple[int, ArcFigures]] = []
        self._pairs = PairCollector()

    def add(
        self, moves: Moves, circular: BoolArray, first: int, place: IntArray, fraction: FloatArray,
        offset: FloatArray, time: FloatArray,
    ) -> None:  # fmt: skip
        """Take in a chunk of n samples.

        Args:
            moves: The moves at hand.
            circular: Which of them are arcs on the part too, with the table at rest.
            first: Number of the first of them in the program.
            place: Index in ``moves`` of each sample's nearest place, shape (n,).
            fraction: Fraction of that place, shape (n,).
            offset: Tool relative to the arc's centre along the ``plane_axes``, shape (n, 2) [mm];
                unused where the nearest move is no arc.
            time: Shape (n,) [s].
        """
        wanted = (moves.shape == Shape.ARC) & (np.abs(moves.sweep) >= SMALLEST_SWEEP)
        wanted &= (moves.radius > 0.0) & circular
        # Beyond an arc's ends the distance from its centre says nothing about the arc.
        inside = wanted[place] & (fraction > 0.0) & (fraction < 1.0)
        rows = np.flatnonzero(inside)
        rows = rows[np.argsort(place[rows], kind="stable")]
        numbers, starts = np.unique(place[rows], return_index=True)
        for move, here in zip(numbers, np.split(rows, starts[1:]), strict=False):
            arc = self._open.get(first + int(move))
            if arc is None:
                arc = _OpenArc(
                    float(time[here[0]]),
                    float(moves.sweep[move]),
                    directed_circle(moves, int(move)),
                )
                self._open[first + int(move)] = arc
            arc.path.add(offset[here, 0], offset[here, 1])

    def finish(self, before: int) -> None:
        """Evaluate the arcs whose number in the program is below ``before``."""
        for number in sorted(number for number in self._open if number < before):
            arc = self._open.pop(number)
            self._done.append((number, _evaluate(arc)))
            self._pairs.add(arc.directed)
        if len(self._done) > 2 * POLAR_ARCS:
            self._done = _trimmed(self._done)

    def bidirectional(self) -> tuple[BidirectionalFigures, ...]:
        """Circles that were run both ways, by line; open arcs as far as they got."""
        pairs = self._pairs.copy()
        for _, arc in sorted(self._open.items()):
            pairs.add(arc.directed)
        return pairs.figures()

    def figures(self) -> tuple[ArcFigures, ...]:
        """All arcs so far, in program order; those still open are evaluated as far as they got."""
        still_open = [(number, _evaluate(arc)) for number, arc in self._open.items()]
        every = _trimmed([*self._done, *still_open])
        return tuple(arc for _, arc in sorted(every, key=lambda item: item[0]))


def _trimmed(done: list[tuple[int, ArcFigures]]) -> list[tuple[int, ArcFigures]]:
    """The worst arcs, greatest circular deviation first; polar plots for the worst of them."""
    ranked = sorted(done, key=lambda item: (-item[1].circular_deviation_um, item[0]))[:ARCS_KEPT]
    for index in range(POLAR_ARCS, len(ranked)):
        number, arc = ranked[index]
        if len(arc.polar):
            ranked[index] = number, dataclasses.replace(arc, polar=np.zeros((0, 2)))
    return ranked


def _evaluate(arc: _OpenArc) -> ArcFigures:
    found = circle_figures(arc.path)
    polar = arc.path.mean()
    thin = polar[:: max(1, len(polar) // _POLAR_POINTS)]
    return ArcFigures(
        line=arc.line,
        time_s=arc.time_s,
        radius_mm=arc.path.radius,
        sweep_deg=arc.sweep_deg,
        circular_deviation_um=found.circular_deviation_um,
        radial_max_um=found.radial_max_um,
        radial_min_um=found.radial_min_um,
        polar=np.column_stack([np.rad2deg(thin[:, 0]), thin[:, 1] * 1e3]),
    )
