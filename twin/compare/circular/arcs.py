"""Circular figures of the arc blocks of a program, collected while the tool runs through them."""

import dataclasses

import numpy as np

from twin.compare.circular.bidirectional import DirectedCircle, PairCollector, directed_circle
from twin.compare.circular.circle import ActualCircle, circle_figures
from twin.compare.circular.circle_kernels import into_planes
from twin.compare.figures import ArcFigures, BidirectionalFigures
from twin.nc.canonical import BoolArray, FloatArray, IntArray, Moves, Shape
from twin.toolpath.nearest import PathColumns
from twin.toolpath.place_kernels import PathKind
from twin.units import UM_PER_MM

SMALLEST_SWEEP = 90.0 - 1e-6
"""Arcs of at least 90 degrees are evaluated; a rounded end point shall not lose one [deg]."""
POLAR_ARCS = 12
"""Of so many arcs, the worst, the path is kept for a polar plot."""
ARCS_KEPT = 10_000
"""Of a program with more arcs, those with the greatest circular deviation are kept."""
_POLAR_POINTS = 720
_NO_POLAR = np.zeros((0, 2))


def plane_axes(normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Directions of 0 and 90 degrees in the planes of arcs, whatever the sense of their normals.

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
    """An arc that the tool may still be on.

    Attributes:
        time_s: When the tool reached it [s].
        sweep_deg: Commanded opening angle [deg].
    """

    number: int
    time_s: float
    sweep_deg: float
    directed: DirectedCircle

    @property
    def path(self) -> ActualCircle:
        return self.directed.path


class ArcCollector:
    """Takes in where the tool was relative to each arc and gives the figures of finished arcs."""

    def __init__(self) -> None:
        self._open: dict[int, _OpenArc] = {}
        self._done: dict[int, ArcFigures] = {}
        self._worst: list[tuple[float, int, ActualCircle]] = []
        self._pairs = PairCollector()

    def add(
        self, moves: Moves, path: PathColumns, first: int, place: IntArray, fraction: FloatArray,
        point: FloatArray, time: FloatArray,
    ) -> None:  # fmt: skip
        """Take in a chunk of n samples.

        Args:
            path: The moves in the part's frame; arcs on which the table turns are no circles there.
            first: Number of the first of them in the program.
            place: Index in ``moves`` of each sample's nearest place, shape (n,).
            fraction: Fraction of that place, shape (n,).
            point: Simulated tool points in the part's frame, shape (n, 3) [mm].
            time: Shape (n,) [s].
        """
        # Beyond an arc's ends the distance from its centre says nothing about the arc.
        inside = np.flatnonzero(_wanted(moves, path)[place] & (fraction > 0.0) & (fraction < 1.0))
        if not len(inside):
            return
        starts = np.flatnonzero(np.diff(place[inside], prepend=-1))
        runs = place[inside[starts]]
        length = np.diff(starts, append=len(inside))
        seen = _in_their_planes(moves, path, runs, length, point[inside])
        for move, row, points in zip(runs, inside[starts], np.split(seen, starts[1:]), strict=True):
            number = first + int(move)
            arc = self._open.get(number)
            if arc is None:
                arc = _OpenArc(
                    number=number,
                    time_s=float(time[row]),
                    sweep_deg=float(moves.sweep[move]),
                    directed=directed_circle(moves, int(move)),
                )
                self._open[number] = arc
            arc.path.add(points)

    def finish(self, before: int) -> None:
        """Evaluate the arcs whose number in the program is below ``before``."""
        for number in sorted(number for number in self._open if number < before):
            arc = self._open.pop(number)
            self._done[number] = figures = _evaluate(arc)
            self._worst.append((-figures.circular_deviation_um, number, arc.path))
            self._pairs.add(arc.directed)
        self._worst = sorted(self._worst, key=lambda worst: worst[:2])[:POLAR_ARCS]
        if len(self._done) > 2 * ARCS_KEPT:
            self._done = _greatest(self._done)

    def bidirectional(self) -> tuple[BidirectionalFigures, ...]:
        """Circles that were run in both directions, by line; open arcs as far as they got."""
        pairs = self._pairs.copy()
        for _, arc in sorted(self._open.items()):
            pairs.add(arc.directed)
        return pairs.figures()

    def figures(self) -> tuple[ArcFigures, ...]:
        """All arcs so far, in program order; those still open are evaluated as far as they got."""
        still_open = {number: _evaluate(arc) for number, arc in self._open.items()}
        every = _greatest({**self._done, **still_open})
        paths = {number: path for _, number, path in self._worst}
        paths.update({number: arc.path for number, arc in self._open.items()})
        for number in list(every)[:POLAR_ARCS]:
            every[number] = dataclasses.replace(every[number], polar=_polar(paths[number]))
        return tuple(every[number] for number in sorted(every))


def _wanted(moves: Moves, path: PathColumns) -> BoolArray:
    """Which moves have circular figures, shape (n,)."""
    wide = (moves.shape == Shape.ARC) & (np.abs(moves.sweep) >= SMALLEST_SWEEP)
    return wide & (moves.radius > 0.0) & (path.turn_rate == 0.0) & (path.kind != PathKind.CHAIN)


def _in_their_planes(
    moves: Moves, path: PathColumns, runs: IntArray, length: IntArray, point: FloatArray
) -> FloatArray:
    """Where tool points lie in the planes of arcs, about their centres.

    Args:
        path: The moves in the part's frame.
        runs: Which arcs the tool runs through in turn, shape (m,).
        length: In how many points each, shape (m,).
        point: In the part's frame, shape (n, 3) [mm].

    Returns:
        Along 0 and 90 degrees, shape (n, 2) [mm].
    """
    cosine, sine = path.facing[runs].T
    turned = np.zeros((len(runs), 3, 3))
    turned[:, 0, 0] = turned[:, 1, 1] = cosine
    turned[:, 1, 0], turned[:, 0, 1] = sine, -sine
    turned[:, 2, 2] = 1.0
    across = turned @ np.stack(plane_axes(moves.normal[runs]), axis=2)
    center = (turned @ path.origin[runs][:, :, None])[:, :, 0]
    seen = np.zeros((len(point), 2))
    into_planes(point, np.repeat(np.arange(len(runs)), length), center, across, seen)
    return seen


def _greatest(arcs: dict[int, ArcFigures]) -> dict[int, ArcFigures]:
    """The arcs that are kept, greatest circular deviation first, by their numbers."""
    ranked = sorted(arcs.items(), key=lambda item: (-item[1].circular_deviation_um, item[0]))
    return dict(ranked[:ARCS_KEPT])


def _evaluate(arc: _OpenArc) -> ArcFigures:
    found = circle_figures(arc.path)
    return ArcFigures(
        line=arc.directed.line,
        time_s=arc.time_s,
        radius_mm=arc.path.radius,
        sweep_deg=arc.sweep_deg,
        circular_deviation_um=found.circular_deviation_um,
        radial_max_um=found.radial_max_um,
        radial_min_um=found.radial_min_um,
        polar=_NO_POLAR,
    )


def _polar(path: ActualCircle) -> FloatArray:
    mean = path.by_angle().mean
    thin = mean[:: max(1, len(mean) // _POLAR_POINTS)]
    return np.column_stack([np.rad2deg(thin[:, 0]), thin[:, 1] * UM_PER_MM])
