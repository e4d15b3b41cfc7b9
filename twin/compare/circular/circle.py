"""Circular figures after ISO 230-4, from points on a nominal circle.

The definitions, as they are computed here (angles about the nominal centre, deviations positive
outside):

* **radial deviation F**: distance of an actual point from the nominal centre minus the nominal
  radius; its greatest and least value are given. The nominal centre is the commanded one.
* **circular deviation G**: least radial distance between two concentric circles that enclose the
  actual path, evaluated about the least-squares circle, as the standard allows. An arc of less
  than a full turn does not determine its own centre: about the commanded centre, so that
  G = F_max - F_min.
* **bidirectional circular deviation G(b)**: the same for the clockwise and the counter-clockwise
  path together, about the least-squares circle of both.
* **mean bidirectional radial deviation D**: radius of that common circle minus the nominal radius.
* **hysteresis H**: greatest difference of the radial deviation between the two directions at the
  same angle.
"""

import dataclasses

import numpy as np

from twin.compare.circular.circle_kernels import (
    AngleBins,
    ByAngle,
    collect_by_angle,
    look_by_angle,
    radial_equations,
    radial_range,
    widest_gap,
)
from twin.nc.canonical import FloatArray
from twin.units import UM_PER_MM

BINS_PER_TURN = 7200
"""Angular resolution of the collected path: 0.05 degrees."""
FULL_TURN_GAP = 5.0
"""A path without a gap wider than this covers the full turn [deg]."""


class ActualCircle:
    """An actual path around a nominal circle, in bounded memory.

    A short path is kept point by point, a longer one by angle: of every bin the points with the
    least and the greatest radial deviation, so that however long the path is, no peak is lost.

    Args:
        radius: Nominal [mm].

    Attributes:
        radius: Nominal [mm].
        radial_min: Least radial deviation so far [mm]; infinite without points.
        radial_max: Greatest radial deviation so far [mm]; minus infinite without points.
    """

    def __init__(self, radius: float) -> None:
        self.radius = radius
        self.radial_min, self.radial_max = np.inf, -np.inf
        self._points: list[FloatArray] = []
        self._count = 0
        self._bins: AngleBins | None = None
        self._by_angle: ByAngle | None = None
        self._full_turn: bool | None = None

    def add(self, points: FloatArray) -> None:
        """Take in points relative to the nominal centre, shape (n, 2) [mm]."""
        least, greatest = radial_range(points, self.radius)
        self.radial_min, self.radial_max = (
            min(self.radial_min, least),
            max(self.radial_max, greatest),
        )
        self._by_angle = self._full_turn = None
        self._points.append(points)
        self._count += len(points)
        if self._count > BINS_PER_TURN:
            self._binned()

    def _binned(self) -> AngleBins:
        """All points so far by angle."""
        if self._bins is None:
            ends = np.zeros((2, BINS_PER_TURN, 3))
            sums = np.zeros((2, BINS_PER_TURN))
            self._bins = AngleBins(np.zeros(BINS_PER_TURN, np.int64), *sums, *ends)
        for points in self._points:
            collect_by_angle(points, self.radius, self._bins)
        self._points, self._count = [], 0
        return self._bins

    def by_angle(self) -> ByAngle:
        """What the path is like at every angle at which there are points.

        Means weigh all angles alike in the least-squares circle, wherever the tool moved slowly.
        """
        if self._by_angle is None:
            bins = self._binned()
            filled = int(np.count_nonzero(bins.samples))
            self._by_angle = ByAngle(
                np.zeros((filled, 2)), np.zeros((filled, 2)), np.zeros((2 * filled, 2))
            )
            look_by_angle(bins, self.radius, self._by_angle)
        return self._by_angle

    def covers_full_turn(self) -> bool:
        """Whether no gap in the angles is wider than ``FULL_TURN_GAP``."""
        if self._full_turn is None:
            self._full_turn = self._widest_gap() <= FULL_TURN_GAP
        return self._full_turn

    def _widest_gap(self) -> float:
        """Between neighbouring points, or bins with points [deg]; a turn, where it is not known."""
        if self._bins is not None:
            return widest_gap(self._binned().samples) * (360.0 / BINS_PER_TURN)
        points = np.concatenate([np.zeros((0, 2)), *self._points])
        if len(points) < 3:
            return 360.0
        angle = np.sort(np.arctan2(points[:, 1], points[:, 0]))
        return float(np.degrees(np.diff(np.append(angle, angle[:1] + 2.0 * np.pi)).max()))


@dataclasses.dataclass(frozen=True, slots=True)
class CircleFigures:
    """Figures of one path, or of both directions together.

    Attributes:
        circular_deviation_um: G, or G(b) of two paths [µm].
        radial_max_um: F_max [µm].
        radial_min_um: F_min [µm].
        mean_radius_error_um: Least-squares radius minus nominal; D of two paths; NaN where they do
            not cover the full turn, which would determine it [µm].
    """

    circular_deviation_um: float
    radial_max_um: float
    radial_min_um: float
    mean_radius_error_um: float


def circle_figures(*paths: ActualCircle) -> CircleFigures:
    """Evaluate one path, or the clockwise and the counter-clockwise path together.

    Raises:
        ValueError: There is no path, or a path without points.
    """
    if not paths or any(path.radial_max < path.radial_min for path in paths):
        raise ValueError("circular figures need paths with points")
    radius = paths[0].radius
    least = min(path.radial_min for path in paths)
    greatest = max(path.radial_max for path in paths)
    width, mean_error = greatest - least, np.nan
    if all(path.covers_full_turn() for path in paths):
        found = [path.by_angle() for path in paths]
        center, mean_radius = _least_squares_circle(np.concatenate([each.place for each in found]))
        ranges = [radial_range(each.extremes - center, radius) for each in found]
        width = max(far for _, far in ranges) - min(near for near, _ in ranges)
        mean_error = mean_radius - radius
    return CircleFigures(
        circular_deviation_um=float(width) * UM_PER_MM,
        radial_max_um=greatest * UM_PER_MM,
        radial_min_um=least * UM_PER_MM,
        mean_radius_error_um=mean_error * UM_PER_MM,
    )


def hysteresis_um(one: ActualCircle, other: ActualCircle) -> float:
    """H: greatest difference between the two directions at the same angle [µm].

    Either path is a chain of straight pieces over the angle. The difference of two such chains is
    greatest where one of them bends, so that reading both at the bends of both finds it exactly,
    however narrow the peak is that a reversal leaves.
    """
    paths = [path.by_angle().mean for path in (one, other)]
    bends = np.concatenate([path[:, 0] for path in paths])
    read = [np.interp(bends, path[:, 0], path[:, 1], period=2.0 * np.pi) for path in paths]
    return float(np.abs(read[0] - read[1]).max()) * UM_PER_MM


def _least_squares_circle(points: FloatArray) -> tuple[FloatArray, float]:
    """Centre and radius that minimise the squared radial distances (Gauss-Newton).

    The start is the nominal centre, which an actual path misses by little.
    """
    center = np.zeros(2)
    radius = float(np.linalg.norm(points, axis=1).mean())
    matrix, right = np.zeros((3, 3)), np.zeros(3)
    for _ in range(20):
        radial_equations(points, center, radius, matrix, right)
        change = np.linalg.solve(matrix, right)
        center, radius = center + change[:2], radius + float(change[2])
        if np.abs(change).max() < 1e-10:
            break
    return center, radius
