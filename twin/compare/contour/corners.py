"""Corners: where the path turns sharply, and how far the tool rounds them."""

import math

import numpy as np

from twin.compare.figures import CornerFigures
from twin.compare.statistics import Distribution
from twin.compilation.kernel import kernel
from twin.nc.canonical import FloatArray, IntArray, Moves
from twin.toolpath.nearest import PathColumns, ends_of
from twin.units import UM_PER_MM


@kernel
def pass_corners(corner, sharp, before, point, place, time, nearest, when):
    """Keep the shortest distance from each corner to the tool's path.

    The tool is taken to go straight from sample to sample. Looked at are the corners at both ends
    of the move that it is nearest to.

    Args:
        corner: End point of every move, shape (m, 3) [mm].
        sharp: Whether it is a corner, shape (m,).
        before: The tool one sample before the first, shape (3,) [mm].
        point: The tool, shape (n, 3) [mm].
        place: Its nearest move, shape (n,).
        time: Shape (n,) [s].
        nearest: By corner: shortest distance so far, shape (m,) [mm]; read and written.
        when: By corner: its time, shape (m,) [s]; read and written.
    """
    x0, y0, z0 = before[0], before[1], before[2]
    for i in range(len(point)):
        x, y, z = point[i, 0], point[i, 1], point[i, 2]
        ax, ay, az = x - x0, y - y0, z - z0
        squared = ax * ax + ay * ay + az * az
        for end in range(max(place[i] - 1, 0), place[i] + 1):
            if not sharp[end]:
                continue
            rx, ry, rz = corner[end, 0] - x0, corner[end, 1] - y0, corner[end, 2] - z0
            share = 0.0
            if squared > 0.0:
                share = min(max((rx * ax + ry * ay + rz * az) / squared, 0.0), 1.0)
            rx, ry, rz = rx - share * ax, ry - share * ay, rz - share * az
            distance = math.sqrt(rx * rx + ry * ry + rz * rz)
            if distance < nearest[end]:
                nearest[end], when[end] = distance, time[i]
        x0, y0, z0 = x, y, z


SMALLEST_TURN = 1.0
"""From this change of direction on, the end of a block is a corner [deg]."""
CORNER_REACH_MM = 1.0
"""A tool whose place on the path is no farther than this from a corner is at the corner: a right
angle that a control rounds by 0.1 mm leaves the path over a quarter of that."""


class CornerCollector:
    """Follows the tool past the corners of the moves at hand, in step with the comparison."""

    def __init__(self) -> None:
        self._point = np.zeros((0, 3))
        self._speed = np.zeros((0, 2))
        self._sharp = np.zeros(0, np.bool_)
        self._begins_sharp = np.zeros(0, np.bool_)
        self._nearest = np.zeros(0)
        self._when = np.zeros(0)
        self._leaving = np.zeros(3)
        self._before: FloatArray | None = None
        self._roundings = Distribution()
        self._worst = (0, 0.0)
        self._begun = 0

    def expect(self, path: PathColumns) -> None:
        """Announce the next moves of the program, in the part's frame."""
        if not len(path.sweep):
            return
        ends = ends_of(path)
        leaving = np.concatenate([self._leaving[None], ends.leaving])
        begins = _turns_sharply(leaving[:-1], ends.arriving)
        if len(self._sharp):
            self._sharp[-1] = begins[0]
        # The last at hand is no corner as long as its successor is not known.
        self._sharp = np.concatenate([self._sharp, begins[1:], [False]])
        self._begins_sharp = np.concatenate([self._begins_sharp, begins])
        self._point = np.concatenate([self._point, ends.point])
        self._speed = np.concatenate([self._speed, ends.speed])
        self._nearest = np.append(self._nearest, np.full(len(begins), np.inf))
        self._when = np.append(self._when, np.zeros(len(begins)))
        self._leaving = leaving[-1]

    def add(self, point: FloatArray, place: IntArray, time: FloatArray) -> None:
        """Take in a chunk of n samples.

        Args:
            point: Simulated tool points in the part's frame, shape (n, 3) [mm].
            place: Move at hand of each sample's nearest place, shape (n,).
            time: Shape (n,) [s].
        """
        before = point[0] if self._before is None else self._before
        pass_corners(
            self._point, self._sharp, before, point, place, time, self._nearest, self._when
        )
        self._before = point[-1].copy()
        self._begun = max(self._begun, int(place.max()))

    def at_corner(self, place: IntArray, fraction: FloatArray) -> np.ndarray:
        """Which places on the path are within ``CORNER_REACH_MM`` of a corner, shape (n,)."""
        behind = fraction * self._speed[place, 0]
        ahead = (1.0 - fraction) * self._speed[place, 1]
        return (self._begins_sharp[place] & (behind <= CORNER_REACH_MM)) | (
            self._sharp[place] & (ahead <= CORNER_REACH_MM)
        )

    def drop(self, moves: Moves, count: int) -> None:
        """Evaluate the first ``count`` moves at hand and let them go."""
        self._worst = self._evaluate(moves, count, self._roundings, self._worst)
        self._point, self._speed = self._point[count:].copy(), self._speed[count:].copy()
        self._sharp = self._sharp[count:].copy()
        self._begins_sharp = self._begins_sharp[count:].copy()
        self._nearest, self._when = self._nearest[count:].copy(), self._when[count:].copy()
        self._begun -= count

    def figures(self, moves: Moves) -> CornerFigures:
        """The corners that the tool has passed, those of the moves at hand included.

        The end of a move is passed once the tool is at the next: one that stopped on the way, as
        at an alarm, says nothing about the corner ahead.
        """
        roundings = self._roundings.copy()
        line, time = self._evaluate(moves, self._begun, roundings, self._worst)
        return CornerFigures(
            count=roundings.count,
            rounding_um=roundings.greatest,
            line=line,
            time_s=time,
            rms_um=roundings.rms,
            p99_um=roundings.percentile(99.0),
        )

    def _evaluate(
        self, moves: Moves, count: int, roundings: Distribution, worst: tuple[int, float]
    ) -> tuple[int, float]:
        """Take the corners of the first moves in; line and time of the most rounded so far."""
        passed = np.flatnonzero(self._sharp[:count] & np.isfinite(self._nearest[:count]))
        greatest = roundings.add(self._nearest[passed] * UM_PER_MM)
        if greatest is None:
            return worst
        row = int(passed[greatest])
        return int(moves.line[row]), float(self._when[row])


def _turns_sharply(leaving: FloatArray, arriving: FloatArray) -> np.ndarray:
    """Where a path turns from one unit direction to the next; standing still is no direction."""
    cosine = np.einsum("ij,ij->i", leaving, arriving)
    moving = np.any(leaving, axis=1) & np.any(arriving, axis=1)
    return moving & (cosine < np.cos(np.deg2rad(SMALLEST_TURN)))
