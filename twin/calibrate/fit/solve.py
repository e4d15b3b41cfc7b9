"""Least squares of an axis's parameters, with intervals that coloured residuals do not flatter.

What the model leaves of a log is no white noise: neighbouring samples err alike, and a formula for
white noise gives intervals that are several times too narrow. The variance of the estimate is
therefore taken from the sums of (derivative times residual) over some tens of consecutive stretches of
time, which are nearly independent whatever happens within them (the "sandwich" of Huber and White,
clustered in time), with Student's t for their number.
"""

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import t as student
from threadpoolctl import ThreadpoolController

from twin.calibrate.fit.parameters import AxisParameters, Coordinate
from twin.nc.canonical import FloatArray, IntArray

BATCHES = 40
"""Stretches of time whose sums are taken as independent."""
CONFIDENCE = 0.95
on_one_thread: Any = ThreadpoolController().wrap(limits=1, user_api="blas")
"""Decorator: matrices of ten rows are worked in a thousandth of the time that it takes to wake threads."""
_NOTHING = 1e-12
_MOST_EVALUATIONS = 40
_FIRST = 0.05
"""Share of a coordinate's step over which a tangent is taken."""
_CURVED = 2.0
"""A path is followed until what is left has changed by so many times what its tangent says of the whole."""
EXACT, ROUGH = 1e-8, 1e-5
"""Changes of the cost, as a share, below which a search ends: for an answer, and to compare structures."""


@dataclasses.dataclass(frozen=True, slots=True)
class Interval:
    """A value and where it lies with 95 %."""

    value: float
    low: float
    high: float

    def widened(self, by: float) -> "Interval":
        """This value, with bounds moved apart to either side."""
        low = self.low - by
        return Interval(self.value, low if self.low < 0.0 else max(low, 0.0), self.high + by)

    def spanning(self, *others: "Interval") -> "Interval":
        """This value, with bounds that hold those of others too."""
        return Interval(
            self.value,
            min([self.low, *(other.low for other in others)]),
            max([self.high, *(other.high for other in others)]),
        )


@dataclasses.dataclass(frozen=True, slots=True)
class Solution:
    """An optimum.

    Attributes:
        cost: Root mean square of the weighted residuals.
        squares: Their sum over each of the stretches of time, shape (batches,).
        covariance: Of the coordinates, shape (p, p), in the order of ``free``.
    """

    parameters: AxisParameters
    free: tuple[str, ...]
    cost: float
    squares: FloatArray
    intervals: dict[str, Interval]
    covariance: FloatArray

    @property
    def correlations(self) -> FloatArray:
        """Shape (p, p), in the order of ``free``."""
        size = np.sqrt(np.diag(self.covariance))
        finite = np.isfinite(size) & (size > 0)
        joint = np.eye(len(size))
        part = np.ix_(finite, finite)
        joint[part] = self.covariance[part] / np.outer(size[finite], size[finite])
        return joint


Residuals = Callable[[AxisParameters], FloatArray]


@dataclasses.dataclass(frozen=True, slots=True)
class Problem:
    """What is minimised.

    Attributes:
        residuals: Weighted, shape (n,).
        batch: Which stretch of time each residual belongs to, shape (n,).
        coordinates: How parameters are moved, by name.
    """

    residuals: Residuals
    batch: IntArray
    coordinates: dict[str, Coordinate]


def solve(
    problem: Problem, start: AxisParameters, free: Sequence[str], *, until: float = EXACT
) -> Solution:
    """Fit some parameters and keep the others.

    Args:
        start: Where the search begins; the others stay so.
        until: ``EXACT`` or ``ROUGH``.
    """
    coordinates = [problem.coordinates[name] for name in free]
    low, high = np.array([coordinate.bounds for coordinate in coordinates]).reshape(-1, 2).T
    begin = _inside(problem, start, free)
    scale = np.array(
        [
            1.0 if coordinate.logarithmic else max(1e3 * coordinate.step, _NOTHING)
            for coordinate in coordinates
        ]
    )

    def at(point: FloatArray) -> AxisParameters:
        values = {
            name: coordinate.outside(float(value))
            for name, coordinate, value in zip(free, coordinates, point, strict=True)
        }
        return dataclasses.replace(start, **values)

    last: list[tuple[bytes, FloatArray]] = []

    def residuals(point: FloatArray) -> FloatArray:
        last[:] = [(point.tobytes(), problem.residuals(at(point)))]
        return last[0][1]

    def jacobian(point: FloatArray) -> FloatArray:
        known = [rest for place, rest in last if place == point.tobytes()]
        here, columns = known[0] if known else residuals(point), []
        for index, coordinate in enumerate(coordinates):
            step = (
                coordinate.step
                if point[index] + coordinate.step <= high[index]
                else -coordinate.step
            )
            there = point.copy()
            there[index] += step
            columns.append((problem.residuals(at(there)) - here) / step)
        return np.column_stack(columns)

    inner = np.clip(begin, low + 1e-9 * scale, high - 1e-9 * scale)
    search: Any = least_squares  # its declared type of ``jac`` lacks functions
    found = search(
        residuals, inner, jac=jacobian, bounds=(low, high), x_scale=scale,
        max_nfev=_MOST_EVALUATIONS, xtol=until, ftol=until,
    )  # fmt: skip
    point = np.asarray(found.x, np.float64)
    rest = np.asarray(found.fun, np.float64)
    covariance = _covariance(np.asarray(found.jac, np.float64), rest, problem.batch)
    return Solution(
        at(point),
        tuple(free),
        float(np.sqrt(np.mean(rest**2))),
        np.asarray(np.bincount(problem.batch, rest**2), np.float64),
        _intervals(free, coordinates, point, covariance, _reach(problem.batch)),
        covariance,
    )


def linear_intervals(
    columns: FloatArray, values: FloatArray, batch: IntArray
) -> tuple[Interval, ...]:
    """Factors of columns that add up to values, by ordinary least squares.

    Args:
        columns: Shape (n, p).
        values: Shape (n,).
        batch: Which stretch of time each row belongs to, shape (n,).
    """
    found, *_ = np.linalg.lstsq(columns, values, rcond=None)
    rest = values - columns @ found
    half = _reach(batch) * np.sqrt(np.diag(_covariance(columns, rest, batch)))
    return tuple(
        Interval(float(value), float(value - to), float(value + to))
        for value, to in zip(found, half, strict=True)
    )


def movers(problem: Problem, best: Solution, names: Sequence[str]) -> list[str]:
    """Parameters that were not fitted, and that would move others out of their intervals if they were.

    By the tangents at the optimum: how far the log lets one go, and what moves with it.

    Args:
        names: Of those that were not fitted, each of which is tried by itself.
    """
    here = problem.residuals(best.parameters)
    known = np.column_stack([slope(problem, best.parameters, name, here) for name in best.free])
    reach = _reach(problem.batch)
    own = reach * np.sqrt(np.diag(_covariance(known, here, problem.batch)))
    found = []
    for name in names:
        coordinate = problem.coordinates[name]
        tangent = slope(problem, best.parameters, name, here)
        both = np.column_stack([known, tangent])
        spread = float(np.sqrt(_covariance(both, here, problem.batch)[-1, -1]))
        if not np.isfinite(spread):
            continue
        step, *_ = np.linalg.lstsq(both, -here, rcond=1e-10)
        now = coordinate.inside(getattr(best.parameters, name))
        ends = (
            np.clip(now + step[-1] + np.array([-reach, reach]) * spread, *coordinate.bounds) - now
        )
        moved, *_ = np.linalg.lstsq(known, -tangent, rcond=1e-10)
        if np.any(np.abs(ends).max() * np.abs(moved) > own):
            found.append(name)
    return found


def intervals_beside(problem: Problem, solution: Solution, name: str) -> dict[str, Interval]:
    """Intervals of the others, where one stays within the bounds that it has.

    Args:
        name: Of the fitted one.
    """
    covariance, index = solution.covariance, solution.free.index(name)
    if not np.isfinite(covariance[index, index]) or covariance[index, index] <= 0.0:
        return solution.intervals
    reach = _reach(problem.batch)
    point = _inside(problem, solution.parameters, solution.free)
    half = reach * float(np.sqrt(covariance[index, index]))
    slopes = covariance[:, index] / covariance[index, index]
    shifts = np.column_stack(
        [slopes * _as_far_as_straight(problem, solution, slopes * side, name)
         for side in (-half, half)]
    )  # fmt: skip
    shifts = shifts * np.array([-half, half])
    rest = np.diag(covariance) - slopes**2 * covariance[index, index]
    own = reach * np.sqrt(np.maximum(rest, 0.0))
    lows, highs = point + shifts.min(axis=1) - own, point + shifts.max(axis=1) + own
    found = {}
    for other, low, high in zip(solution.free, lows, highs, strict=True):
        coordinate = problem.coordinates[other]
        both = (_end(coordinate, float(low)), _end(coordinate, float(high)))
        found[other] = Interval(solution.intervals[other].value, min(both), max(both))
    return found


def _as_far_as_straight(
    problem: Problem, solution: Solution, shift: FloatArray, name: str
) -> float:
    """What share of the distance to an interval's end is open.

    It ends at the bounds of the one that leads, and where what is left has changed by more than tangents say
    of the whole distance: a short filter is not distinguished from a delay, a long one is.

    Args:
        shift: The displacement of all coordinates, shape (p,).
        name: Of the one that leads.
    """
    point = _inside(problem, solution.parameters, solution.free)
    index, coordinate = solution.free.index(name), problem.coordinates[name]
    end = float(np.clip(point[index] + shift[index], *coordinate.bounds))
    share = (end - point[index]) / shift[index]
    coordinates = [problem.coordinates[other] for other in solution.free]
    here = problem.residuals(solution.parameters)

    def changed(part: float) -> float:
        values = {
            other: one.outside(float(np.clip(value, *one.bounds)))
            for other, one, value in zip(
                solution.free, coordinates, point + part * shift, strict=True
            )
        }
        rest = problem.residuals(dataclasses.replace(solution.parameters, **values)) - here
        return float(np.sqrt(rest @ rest))

    promised = changed(_FIRST * share) / (_FIRST * share) if share > 0.0 else 0.0
    while share > _FIRST and changed(share) > _CURVED * promised:
        share /= 2.0
    return share


def _inside(problem: Problem, parameters: AxisParameters, names: Sequence[str]) -> FloatArray:
    coordinates = [problem.coordinates[name] for name in names]
    return np.array(
        [
            coordinate.inside(getattr(parameters, name))
            for name, coordinate in zip(names, coordinates, strict=True)
        ]
    )


def slope(problem: Problem, at: AxisParameters, name: str, here: FloatArray) -> FloatArray:
    """Derivative of the residuals by a coordinate, shape (n,).

    Args:
        at: Where it is taken.
        name: Of the parameter that is moved.
        here: The residuals there, shape (n,).
    """
    coordinate = problem.coordinates[name]
    value = coordinate.inside(getattr(at, name))
    step = coordinate.step if value + coordinate.step < coordinate.bounds[1] else -coordinate.step
    there = dataclasses.replace(at, **{name: coordinate.outside(value + step)})
    return (problem.residuals(there) - here) / step


def _reach(batch: IntArray) -> float:
    """Half a 95 % interval in standard errors."""
    return float(student.ppf((1 + CONFIDENCE) / 2, max(1, int(batch.max()))))


def _covariance(jacobian: FloatArray, rest: FloatArray, batch: IntArray) -> FloatArray:
    """Of the coordinates, shape (p, p); infinite where nothing depends on one."""
    size = np.sqrt(np.sum(jacobian**2, axis=0))
    seen = size > _NOTHING * max(1.0, float(size.max(initial=0.0)))
    width = len(size)
    covariance = np.full((width, width), 0.0)
    covariance[np.diag_indices(width)] = np.inf
    if not seen.any():
        return covariance
    even = jacobian[:, seen] / size[seen]
    inverse = np.linalg.pinv(even.T @ even, rcond=1e-14, hermitian=True)
    scores = even * rest[:, None]
    count = int(batch.max()) + 1
    sums = np.zeros((count, even.shape[1]))
    np.add.at(sums, batch, scores)
    few = count / max(1, count - even.shape[1])
    clustered = inverse @ (few * sums.T @ sums) @ inverse
    white = inverse * float(rest @ rest) / max(1, len(rest) - even.shape[1])
    least = np.maximum(np.diag(clustered), _NOTHING**2 * np.diag(white))
    both = np.sqrt(np.maximum(1.0, np.diag(white) / np.maximum(least, 1e-300)))
    clustered = clustered * np.outer(both, both)
    covariance[np.ix_(seen, seen)] = clustered / np.outer(size[seen], size[seen])
    return covariance


def _intervals(
    free: Sequence[str], coordinates: Sequence[Coordinate], point: FloatArray, covariance: FloatArray,
    reach: float,
) -> dict[str, Interval]:  # fmt: skip
    found = {}
    for index, (name, coordinate) in enumerate(zip(free, coordinates, strict=True)):
        half = reach * float(np.sqrt(covariance[index, index]))
        value = float(point[index])
        ends = [_end(coordinate, value + side * half) for side in (-1.0, 1.0)]
        found[name] = Interval(coordinate.outside(value), min(ends), max(ends))
    return found


def _end(coordinate: Coordinate, value: float) -> float:
    """Value at the end of an interval; infinite where a rate may be zero."""
    low, high = coordinate.bounds
    if coordinate.reciprocal and value <= 0.0:
        return float("inf")
    return coordinate.outside(min(max(value, low), high))
