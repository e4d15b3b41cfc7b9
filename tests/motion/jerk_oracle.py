"""Shortest time along a path under limits of each axis' acceleration and jerk, offline and slow.

With b = v² over the path parameter x, a = b'/2 and j = b'' v / 2, so that an axis has

    acceleration  q'' b + q' b'/2
    jerk          v (q''' b + 3/2 q'' b' + q' b''/2)

The first is linear in b. The second, held to J, says that a linear function of b stays below J / v,
which is convex in b: its tangent lies below it, so that with the tangent at a profile that is
feasible the bound is linear and only stricter. Linear programmes in turn, each about the solution of
the one before, come down to the optimum over feasible profiles (the convex-concave procedure of
Debrouwere et al., "Time-Optimal Path Following for Robots With Convex-Concave Constraints Using
Sequential Convex Programming", IEEE Transactions on Robotics 29, 2013).
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import linprog

from twin.nc.canonical import FloatArray

MOST_PROGRAMMES = 40
CONVERGED = 1e-5
"""Gain of a programme, relative, from which on no other is tried."""
TRUST = 0.6
"""Share of b that one programme may take away, or add."""


class Path(NamedTuple):
    """A path at n places.

    Attributes:
        x: Path parameter, dense where the path begins and ends, shape (n,) [mm].
        derivatives: q', q'', q''' of each axis, shape (3, n, k).
    """

    x: FloatArray
    derivatives: FloatArray


def circle(radius: float, turns: float, places: int = 160) -> Path:
    """A circle in X and Y from (R, 0) on."""
    share = np.linspace(0.0, 1.0, places)
    x = 2.0 * np.pi * radius * turns * share**2 * (3.0 - 2.0 * share)
    c, s = np.cos(x / radius), np.sin(x / radius)
    first, second = np.stack([-s, c], axis=1), np.stack([-c, -s], axis=1) / radius
    return Path(x, np.stack([first, second, -first / radius**2]))


def helix(radius: float, turns: float, advance: float, turned: float, places: int) -> Path:
    """A helix about Z whose feed counts the path along it, with C going on evenly.

    Args:
        radius: [mm]
        turns: How often it goes round.
        advance: Of Z in all [mm].
        turned: Of C in all [deg].
        places: Along it.
    """
    around = 2.0 * np.pi * radius * turns
    way = float(np.hypot(around, advance))
    share = np.linspace(0.0, 1.0, places)
    x = way * share**2 * (3.0 - 2.0 * share)
    rate = around / way / radius
    c, s, nothing = np.cos(rate * x), np.sin(rate * x), np.zeros(places)
    even = np.ones(places)
    first = np.stack(
        [-radius * rate * s, radius * rate * c, advance / way * even, turned / way * even]
    )
    second = -radius * rate**2 * np.stack([c, s, nothing, nothing])
    third = radius * rate**3 * np.stack([s, -c, nothing, nothing])
    return Path(x, np.stack([first.T, second.T, third.T]))


def shortest_time(path: Path, acceleration: float, jerk: float, velocity: float = np.inf) -> float:
    """From rest to rest [s].

    The limits are those of each axis, of the path along itself, and of its acceleration towards the
    centre of curvature; that of the velocity is the path's.
    """
    slope, curvature = _differences(path.x)
    inner = np.eye(len(path.x))[1:-1]
    bend = np.linalg.norm(path.derivatives[1, 1:-1, :3], axis=1)
    accelerations, jerks = [0.5 * slope, bend[:, None] * inner], [0.5 * curvature]
    for axis in range(path.derivatives.shape[2]):
        q1, q2, q3 = path.derivatives[:, 1:-1, axis, None]
        accelerations.append(q2 * inner + 0.5 * q1 * slope)
        jerks.append(q3 * inner + 1.5 * q2 * slope + 0.5 * q1 * curvature)
    fixed = np.concatenate(accelerations)
    b = _first_profile(path.x, fixed, jerks, acceleration, jerk)
    # At rest b'' v does not see a step of the acceleration: from there b is that of full jerk at most,
    # the path's or that of an axis that moves everywhere.
    away = np.minimum(path.x, path.x[-1] - path.x)
    full = jerk / max(1.0, float(np.abs(path.derivatives[0]).min(axis=0).max()))
    ceiling = (0.5 * full) ** 2 * (6.0 * away / full) ** (4.0 / 3.0)
    ceiling = np.minimum(ceiling, velocity**2)
    b *= min(1.0, float(np.min(ceiling[1:-1] / b[1:-1])))
    time = _time(path.x, b)
    for _ in range(MOST_PROGRAMMES):
        v = np.sqrt(b[1:-1])
        # J / v lies above its tangent J (3/2 - b / (2 v²)) / v; both sides are multiplied by v / J.
        tangent = 0.5 / b[1:-1, None] * inner
        rows = [v[:, None] / jerk * row for row in jerks]
        bound = [sign * row + tangent for row in rows for sign in (1.0, -1.0)]
        matrix = np.concatenate([fixed / acceleration, -fixed / acceleration, *bound])
        right = np.concatenate([np.ones(2 * fixed.shape[0]), np.full(len(v) * len(bound), 1.5)])
        unit = np.maximum(b, 1e-12)
        most = np.minimum(1.0 + TRUST, ceiling / unit)
        least = np.minimum(np.full(len(b), 1.0 - TRUST), most)
        solved = linprog(
            _time_slope(path.x, b) * unit, A_ub=matrix * unit, b_ub=right,
            bounds=np.stack([least, most], axis=1), method="highs",
        )  # fmt: skip
        if not solved.success:
            break
        # What lies between two feasible profiles is feasible too.
        steps = [b + share * (solved.x * unit - b) for share in (0.1, 0.25, 0.5, 0.75, 1.0)]
        best = min(steps, key=lambda step: _time(path.x, step))
        gained = time - _time(path.x, best)
        if gained <= CONVERGED * time:
            break
        b, time = best, time - gained
    return time


def _differences(x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """First and second derivative at the inner places of an uneven grid, as matrices."""
    before, after = np.diff(x)[:-1], np.diff(x)[1:]
    both = before + after
    slope, curvature = np.zeros((2, len(x) - 2, len(x)))
    row = np.arange(len(x) - 2)
    slope[row, row], curvature[row, row] = -after / (before * both), 2.0 / (before * both)
    slope[row, row + 1] = (after - before) / (before * after)
    curvature[row, row + 1] = -2.0 / (before * after)
    slope[row, row + 2], curvature[row, row + 2] = before / (after * both), 2.0 / (after * both)
    return slope, curvature


def _first_profile(
    x: FloatArray, fixed: FloatArray, jerks: list[FloatArray],
    acceleration: float, jerk: float,
) -> FloatArray:  # fmt: skip
    """A feasible profile: b grows as x^(4/3) from both ends, as it does under a jerk limit."""
    b = np.minimum(x, x[-1] - x) ** (4.0 / 3.0)
    b = b / b.max() / (1.0 + 4.0 * b / b.max())
    v = np.sqrt(b[1:-1])
    most = max(float(np.abs(row @ b * v).max()) for row in jerks)
    return b / max(float(np.abs(fixed @ b).max()) / acceleration, (most / jerk) ** (2.0 / 3.0))


def _time(x: FloatArray, b: FloatArray) -> float:
    """With constant acceleration between two places [s]."""
    v = np.sqrt(np.maximum(b, 0.0))
    return float(np.sum(2.0 * np.diff(x) / (v[:-1] + v[1:])))


def _time_slope(x: FloatArray, b: FloatArray) -> FloatArray:
    """Derivative of ``_time`` by b, but for the ends."""
    v = np.sqrt(np.maximum(b, 1e-15))
    part = np.diff(x) / (v[:-1] + v[1:]) ** 2
    slope = np.zeros(len(x))
    slope[:-1] -= part / v[:-1]
    slope[1:] -= part / v[1:]
    return slope
