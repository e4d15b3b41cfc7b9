"""Corners: where the path turns sharply, and how far the tool rounds them."""

import math
from typing import NamedTuple

import numpy as np

from twin.compare.figures import CornerFigures
from twin.compare.statistics import Distribution
from twin.compilation.kernel import kernel
from twin.nc.canonical import BoolArray, FloatArray, IntArray, Moves
from twin.toolpath.nearest import PathColumns, ends_of
from twin.units import UM_PER_MM


class MoveEnds(NamedTuple):
    """The ends of the m moves at hand, in the part's frame.

    Attributes:
        point: Shape (m, 3) [mm].
        sharp: Whether it is a corner; of the last not known yet, shape (m,).
        speed: How fast the place moves with the fraction at start and end of the move, shape (m, 2) [mm].
        nearest: Shortest distance of the tool so far, shape (m,) [mm].
        when: Its time, shape (m,) [s].
    """

    point: FloatArray
    sharp: BoolArray
    speed: FloatArray
    nearest: FloatArray
    when: FloatArray


@kernel
def pass_corners(ends, before, point, place, fraction, time):
    """Keep the shortest distance from each corner to the tool's path.

    The tool is taken to go straight from sample to sample. Looked at are the corners at both ends
    of the move that it is nearest to, as long as it has not gone round: a path that comes back to
    a corner within one move passes it once. Up to half a turn a place on a line or circle that is
    nearest to a tool at a distance d from the corner is no farther than pi d along the path.

    Args:
        ends: ``MoveEnds``; nearest and when are read and written.
        before: The tool one sample before the first, shape (3,) [mm].
        point: The tool, shape (n, 3) [mm].
        place: Its nearest move, shape (n,).
        fraction: Of that move, shape (n,).
        time: Shape (n,) [s].
    """
    x0, y0, z0 = before[0], before[1], before[2]
    last = len(ends.sharp) - 1
    for i in range(len(point)):
        x, y, z = point[i, 0], point[i, 1], point[i, 2]
        ax, ay, az = x - x0, y - y0, z - z0
        squared = ax * ax + ay * ay + az * az
        for end in range(max(place[i] - 1, 0), place[i] + 1):
            if not (ends.sharp[end] or end == last):
                continue
            cx, cy, cz = ends.point[end, 0], ends.point[end, 1], ends.point[end, 2]
            along = fraction[i] * ends.speed[place[i], 0]
            if end == place[i]:
                along = (1.0 - fraction[i]) * ends.speed[end, 1]
            away = math.sqrt((x - cx) ** 2 + (y - cy) ** 2 + (z - cz) ** 2)
            if along > math.pi * away:
                continue
            rx, ry, rz = cx - x0, cy - y0, cz - z0
            share = 0.0
            if squared > 0.0:
                share = min(max((rx * ax + ry * ay + rz * az) / squared, 0.0), 1.0)
            rx, ry, rz = rx - share * ax, ry - share * ay, rz - share * az
            distance = math.sqrt(rx * rx + ry * ry + rz * rz)
            if distance < ends.nearest[end]:
                ends.nearest[end], ends.when[end] = distance, time[i]
        x0, y0, z0 = x, y, z


SMALLEST_TURN = 1.0
"""From this change of direction on, the end of a block is a corner [deg]."""
CORNER_REACH_MM = 1.0
"""A tool whose place on the path is no farther than this from a corner is at the corner: a right
angle that a control rounds by 0.1 mm leaves the path over a quarter of that."""


class CornerCollector:
    """Follows the tool past the corners of the moves at hand, in step with the comparison."""

    def __init__(self) -> None:
        nothing = np.zeros(0)
        self._ends = MoveEnds(
            np.zeros((0, 3)), np.zeros(0, np.bool_), np.zeros((0, 2)), nothing, nothing
        )
        self._leaving = np.zeros(3)
        self._before: FloatArray | None = None
        self._roundings = Distribution()
        self._worst = (0, 0.0)
        self._begun = 0

    def expect(self, path: PathColumns) -> None:
        """Announce the next moves of the program, in the part's frame."""
        count = len(path.sweep)
        if not count:
            return
        ends = ends_of(path)
        leaving = np.concatenate([self._leaving[None], ends.leaving])
        begins = _turns_sharply(leaving[:-1], ends.arriving)
        self._ends.sharp[-1:] = begins[0]
        # The last at hand is no corner as long as its successor is not known.
        sharp = np.append(begins[1:], False)
        new = MoveEnds(ends.point, sharp, ends.speed, np.full(count, np.inf), np.zeros(count))
        self._ends = MoveEnds._make(map(np.concatenate, zip(self._ends, new, strict=True)))
        self._leaving = leaving[-1]

    def add(
        self, point: FloatArray, place: IntArray, fraction: FloatArray, time: FloatArray
    ) -> None:
        """Take in a chunk of n samples.

        Args:
            point: Simulated tool points in the part's frame, shape (n, 3) [mm].
            place: Move at hand of each sample's nearest place, shape (n,).
            fraction: Of that move, shape (n,).
            time: Shape (n,) [s].
        """
        before = point[0] if self._before is None else self._before
        pass_corners(self._ends, before, point, place, fraction, time)
        self._before = point[-1].copy()
        self._begun = max(self._begun, int(place.max()))

    def at_corner(self, place: IntArray, fraction: FloatArray) -> BoolArray:
        """Which places on the path are within ``CORNER_REACH_MM`` of a corner, shape (n,)."""
        ends = self._ends
        behind = fraction * ends.speed[place, 0]
        ahead = (1.0 - fraction) * ends.speed[place, 1]
        begins_sharp = (place > 0) & ends.sharp[place - 1]
        return (begins_sharp & (behind <= CORNER_REACH_MM)) | (
            ends.sharp[place] & (ahead <= CORNER_REACH_MM)
        )

    def drop(self, moves: Moves, count: int) -> None:
        """Evaluate the first ``count`` moves at hand, whose ends are all passed, and let them go."""
        self._worst = self._evaluate(moves, count, self._roundings, self._worst)
        self._ends = MoveEnds._make(column[count:].copy() for column in self._ends)
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
        ends = self._ends
        passed = np.flatnonzero(ends.sharp[:count] & np.isfinite(ends.nearest[:count]))
        greatest = roundings.add(ends.nearest[passed] * UM_PER_MM)
        if greatest is None:
            return worst
        row = int(passed[greatest])
        return int(moves.line[row]), float(ends.when[row])


def _turns_sharply(leaving: FloatArray, arriving: FloatArray) -> BoolArray:
    """Where a path turns from one unit direction to the next; standing still is no direction."""
    cosine = np.einsum("ij,ij->i", leaving, arriving)
    moving = np.any(leaving, axis=1) & np.any(arriving, axis=1)
    return moving & (cosine < np.cos(np.deg2rad(SMALLEST_TURN)))
