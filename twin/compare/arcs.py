"""Circular figures of the arc blocks of a program, collected while the tool runs through them."""

import dataclasses

import numpy as np
import numpy.typing as npt

from twin.compare.bidirectional import DirectedCircle, PairCollector, directed_circle
from twin.compare.circle import CirclePath, circle_figures
from twin.compare.figures import ArcFigures, BidirectionalFigures
from twin.nc.canonical import FloatArray, IntArray, Moves, Shape
from twin.toolpath.nearest import PathColumns

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
    """An arc that the tool may still be on.

    Attributes:
        time_s: When the tool reached it [s].
        sweep_deg: Commanded opening angle [deg].
        directed: Where the tool was.
        center: Its centre in the part's frame, shape (3,) [mm].
        across: Directions of 0 and 90 degrees in the part's frame, shape (3, 2).
    """

    time_s: float
    sweep_deg: float
    directed: DirectedCircle
    center: FloatArray
    across: FloatArray

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
        self, moves: Moves, path: PathColumns, first: int, place: IntArray, fraction: FloatArray,
        point: FloatArray, time: FloatArray,
    ) -> None:  # fmt: skip
        """Take in a chunk of n samples.

        Args:
            moves: The moves at hand.
            path: The same in the part's frame; arcs on which the table turns are no circles there.
            first: Number of the first of them in the program.
            place: Index in ``moves`` of each sample's nearest place, shape (n,).
            fraction: Fraction of that place, shape (n,).
            point: Simulated tool points in the part's frame, shape (n, 3) [mm].
            time: Shape (n,) [s].
        """
        # Beyond an arc's ends the distance from its centre says nothing about the arc.
        inside = np.flatnonzero(_wanted(moves, path)[place] & (fraction > 0.0) & (fraction < 1.0))
        starts = np.flatnonzero(np.diff(place[inside], prepend=-1))
        for rows in np.split(inside, starts[1:]) if len(inside) else ():
            move = int(place[rows[0]])
            arc = self._open.get(first + move)
            if arc is None:
                arc = _open_arc(moves, path, move, float(time[rows[0]]))
                self._open[first + move] = arc
            offset = (point[rows] - arc.center) @ arc.across
            arc.path.add(offset[:, 0], offset[:, 1])

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


def _wanted(moves: Moves, path: PathColumns) -> BoolArray:
    """Which moves have circular figures, shape (n,)."""
    wide = (moves.shape == Shape.ARC) & (np.abs(moves.sweep) >= SMALLEST_SWEEP)
    return wide & (moves.radius > 0.0) & (path.turn_rate == 0.0)


def _open_arc(moves: Moves, path: PathColumns, move: int, time_s: float) -> _OpenArc:
    first, second = plane_axes(moves.normal[move : move + 1])
    cosine, sine = np.cos(path.turn[move]), np.sin(path.turn[move])
    turned = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return _OpenArc(
        time_s=time_s,
        sweep_deg=float(moves.sweep[move]),
        directed=directed_circle(moves, move),
        center=turned @ path.origin[move],
        across=turned @ np.column_stack([first[0], second[0]]),
    )


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
