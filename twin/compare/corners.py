"""Rounding of corners: how near the tool comes to the point where the path turns sharply."""

import dataclasses

import numpy as np

from twin.nc.canonical import FloatArray, IntArray, Moves
from twin.toolpath.nearest import PathColumns, ends_of

SMALLEST_TURN = 1.0
"""From this change of direction on, the end of a block is a corner [deg]."""


@dataclasses.dataclass(frozen=True, slots=True)
class CornerFigures:
    """The corners of a program.

    Attributes:
        count: How many were passed.
        rounding_um: Greatest rounding: shortest distance from a corner to the tool's path [µm].
        line: Source line that ends at that corner; 0 without corners.
        time_s: When the tool was nearest to it [s].
    """

    count: int = 0
    rounding_um: float = 0.0
    line: int = 0
    time_s: float = 0.0


NO_CORNERS = CornerFigures()


class CornerCollector:
    """Follows the tool past the corners of the moves at hand, in step with the comparison."""

    def __init__(self) -> None:
        self._nearest = np.zeros(0)
        self._time = np.zeros(0)
        self._before: FloatArray | None = None
        self._worst = NO_CORNERS

    def add(self, path: PathColumns, point: FloatArray, place: IntArray, time: FloatArray) -> None:
        """Take in a chunk of n samples.

        Args:
            path: The moves at hand, in the part's frame.
            point: Simulated tool points in the part's frame, shape (n, 3) [mm].
            place: Move of each sample's nearest place, shape (n,).
            time: Shape (n,) [s].
        """
        missing = len(path.sweep) - len(self._nearest)
        self._nearest = np.append(self._nearest, np.full(missing, np.inf))
        self._time = np.append(self._time, np.zeros(missing))
        before = np.concatenate([point[:1] if self._before is None else self._before, point[:-1]])
        self._before = point[-1:].copy()
        ends = ends_of(path)
        for corner in (place, np.maximum(place - 1, 0)):
            distance = _distance_to_segments(ends.point[corner], before, point)
            order = np.argsort(-distance, kind="stable")
            rows, distance = corner[order], distance[order]
            nearer = distance < self._nearest[rows]
            # Of several values written to one corner the last, the least, stays.
            self._nearest[rows[nearer]] = distance[nearer]
            self._time[rows[nearer]] = time[order][nearer]

    def drop(self, moves: Moves, path: PathColumns, count: int) -> None:
        """Evaluate the first ``count`` moves at hand and let them go."""
        self._worst = self._with(moves, path, count)
        self._nearest, self._time = self._nearest[count:].copy(), self._time[count:].copy()

    def figures(self, moves: Moves, path: PathColumns) -> CornerFigures:
        """The corners so far, those of the moves at hand included."""
        return self._with(moves, path, len(self._nearest))

    def _with(self, moves: Moves, path: PathColumns, count: int) -> CornerFigures:
        sharp = np.flatnonzero(_is_corner(path)[:count] & np.isfinite(self._nearest[:count]))
        if not len(sharp):
            return self._worst
        row = int(sharp[self._nearest[sharp].argmax()])
        rounding = float(self._nearest[row]) * 1e3
        total = self._worst.count + len(sharp)
        if rounding <= self._worst.rounding_um:
            return dataclasses.replace(self._worst, count=total)
        return CornerFigures(total, rounding, int(moves.line[row]), float(self._time[row]))


def _is_corner(path: PathColumns) -> np.ndarray:
    """Which moves end in a corner; the last at hand does not, its successor is not known."""
    ends = ends_of(path)
    cosine = np.einsum("ij,ij->i", ends.leaving[:-1], ends.arriving[1:])
    moving = np.any(ends.leaving[:-1], axis=1) & np.any(ends.arriving[1:], axis=1)
    return np.append(moving & (cosine < np.cos(np.deg2rad(SMALLEST_TURN))), [False])


def _distance_to_segments(point: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    along = end - start
    length = np.einsum("ij,ij->i", along, along)
    share = np.einsum("ij,ij->i", point - start, along) / np.maximum(length, 1e-300)
    share = np.clip(share, 0.0, 1.0)
    return np.linalg.norm(start + share[:, None] * along - point, axis=1)
