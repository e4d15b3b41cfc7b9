"""The fastest rate along a run: an interior-point method with a banded matrix.

With the reference's time tau and the squared rate s = (dtau/dt)², an axis that has velocity Q',
acceleration Q'' and jerk Q''' in the reference has

    acceleration  Q'' s + Q' s'/2
    jerk          sqrt(s) (Q''' s + 3/2 Q'' s' + Q' s''/2)

and the run takes the integral of dtau / sqrt(s). A limit of the acceleration is linear in s. One of
the jerk says that a linear function of s stays below 1 / sqrt(s), which is convex: its tangent lies
below it, so that a step towards the solution of the tangent's problem breaks nothing (Debrouwere et
al., IEEE Transactions on Robotics 29, 2013). Each step is one of a primal-dual method (Nocedal and
Wright, Numerical Optimization, chapter 19).
"""

import math
from typing import NamedTuple

import numpy as np

from twin.compilation.kernel import arithmetic_kernel, array_arithmetic_kernel
from twin.motion.retiming.spline_kernels import basis_at, spline_at
from twin.nc.canonical import FloatArray

MOST_STEPS = 40
CENTERING = 0.1
"""To which share the mean complementarity is to fall with a step after a full one; the shorter the one
before, the less."""
KEPT = 0.05
"""Share of a slack that one step leaves."""
GAP = 5e-4
"""Of the time, relative, within which the solution is the fastest."""
LEAST_SLACK = 1e-3
"""Of the limits at the start; where there is less, they are loosened and tightened on the way."""
SMALLEST_SLACK = 1e-9
"""Rounding may leave less."""
LARGEST_FALL = 0.7
"""Share of the squared rate that one step may take away."""
STIFF = 1e9
"""Weight of the difference of changes that are to be alike."""
RIDGE = 1e-12
"""Added to the matrix' diagonal, for coefficients that nothing sees."""


class RunTable(NamedTuple):
    """A run of n intervals, as the solver sees it.

    Attributes:
        step: Lengths of the intervals in the reference's time, shape (n,) [s].
        forms: What is limited at both ends of each interval: linear forms of value, slope and
            second derivative of s by their limits; first the accelerations, then as many jerks;
            shape (n, 2, m, 3).
        highest: Highest coefficient of each interval's middle, shape (n,): s is never above its
            coefficients.
    """

    step: FloatArray
    forms: FloatArray
    highest: FloatArray


class Sides(NamedTuple):
    """What the method knows of each limit, at both ends of each interval; shape (n, 2, 2 m + 1).

    Attributes:
        slack: What is left of the limit, and of its loosening.
        price: Its multiplier.
        loosened: By how much more than the limit is allowed for the time being.
        price_change: Of a whole step.
    """

    slack: FloatArray
    price: FloatArray
    loosened: FloatArray
    price_change: FloatArray


@array_arithmetic_kernel
def fastest_rate(
    table: RunTable, jerk: float, start: FloatArray, free: tuple[bool, bool]
) -> tuple[FloatArray, bool]:
    """Coefficients of the squared rate that takes least time.

    Args:
        jerk: Share of the jerk limits to use.
        start: Coefficients to begin with, shape (n + 2,).
        free: Whether the run begins and ends at rest, where the coefficients may change together;
            else the first two and the last two of them are kept.

    Returns:
        The coefficients, and whether all limits are kept.
    """
    step, forms, _ = table
    count, kinds = len(step), forms.shape[2]
    c = start.copy()
    shape = (count, 2, 2 * kinds + 1)
    sides = Sides(np.ones(shape), np.zeros(shape), np.zeros(shape), np.zeros(shape))
    watched = count * (3 * kinds + 1) + kinds
    _begin(table, jerk, c, sides, watched)
    band, right = np.zeros((count + 2, 3)), np.zeros(count + 2)
    total, gone = np.sum(step), 1.0
    for _ in range(MOST_STEPS):
        gap = np.sum(sides.slack * sides.price)
        if gap < GAP and np.max(sides.loosened) == 0.0:
            break
        target = max(CENTERING, (1.0 - gone) ** 2) * gap / watched
        _assemble(table, jerk, c, sides, target, total, band, right)
        for end in range(2):
            if free[end]:
                _tie(band, 0 if end == 0 else count - 1)
            else:
                for i in range(2):
                    _fix(band, right, i + end * count)
        _solve(band, right)
        gone = _advance(table, jerk, c, right, sides, target)
    return c, np.max(sides.loosened) == 0.0


@arithmetic_kernel
def _watched(count: int, kinds: int, i: int, end: int) -> tuple[int, bool]:
    """What is watched at an end of interval i.

    Where two intervals meet only the jerk differs: the rest is watched at the begin of the second.

    Returns:
        The first form, and whether the coefficient is.
    """
    return kinds >> 1 if end == 1 and i + 1 < count else 0, end == 0


@arithmetic_kernel
def _begin(table: RunTable, jerk: float, c: FloatArray, sides: Sides, watched: int) -> None:
    """Slacks, loosened where there is none, and multipliers for them; 0 for what is not watched."""
    step, forms, _ = table
    kinds = forms.shape[2]
    for i in range(len(step)):
        for end in range(2):
            z = spline_at(step, c, i, end)
            first, whole = _watched(len(step), kinds, i, end)
            for side in range(2 * first, 2 * kinds + int(whole)):
                room = _room(table, jerk, c, i, end, z, side)
                loosened = max(0.0, LEAST_SLACK - room)
                sides.loosened[i, end, side] = loosened
                sides.slack[i, end, side] = room + loosened
                sides.price[i, end, side] = 0.1 / watched / (room + loosened)


@arithmetic_kernel
def _assemble(
    table: RunTable, jerk: float, c: FloatArray, sides: Sides, target: float, total: float,
    band: FloatArray, right: FloatArray,
) -> None:  # fmt: skip
    """The matrix and the right side of a step of Newton's.

    The two sides of a limit have the normals (lean + f0, f1, f2) and (lean - f0, -f1, -f2), f being
    its form, so that their shares come as sums and differences.
    """
    step, forms, highest = table
    kinds = forms.shape[2]
    band[:] = 0.0
    right[:] = 0.0
    basis = basis_at(step, 0, 0)
    for i in range(len(step)):
        for end in range(2):
            z = spline_at(step, c, i, end)
            basis = basis_at(step, i, end)
            root = 1.0 / math.sqrt(z[0])
            weight = 0.5 * step[i] / total * root / z[0]
            h00, h01, h02, h11, h12, h22 = 0.75 * weight / z[0], 0.0, 0.0, 0.0, 0.0, 0.0
            g0, g1, g2 = -0.5 * weight, 0.0, 0.0
            slack, price = sides.slack[i, end], sides.price[i, end]
            loosened = sides.loosened[i, end]
            first, whole = _watched(len(step), kinds, i, end)
            for k in range(first, kinds):
                lean = 0.5 * jerk * root / z[0] if 2 * k >= kinds else 0.0
                f0, f1, f2 = forms[i, end, k, 0], forms[i, end, k, 1], forms[i, end, k, 2]
                per, other_per = 1.0 / slack[2 * k], 1.0 / slack[2 * k + 1]
                share, other_share = price[2 * k] * per, price[2 * k + 1] * other_per
                push = target * per + share * loosened[2 * k]
                other_push = target * other_per + other_share * loosened[2 * k + 1]
                both, apart = share + other_share, share - other_share
                g0 += (push - other_push) * f0 + (push + other_push) * lean
                g1 += (push - other_push) * f1
                g2 += (push - other_push) * f2
                h00 += both * (f0 * f0 + lean * lean) + 2.0 * apart * f0 * lean
                h01 += (both * f0 + apart * lean) * f1
                h02 += (both * f0 + apart * lean) * f2
                h11 += both * f1 * f1
                h12 += both * f1 * f2
                h22 += both * f2 * f2
            if whole:
                normal, per = 1.0 / highest[i], 1.0 / slack[2 * kinds]
                share = price[2 * kinds] * per
                right[i + 1] -= (target * per + share * loosened[2 * kinds]) * normal
                band[i + 1, 0] += share * normal * normal
            for p in range(3):
                b0, b1, b2 = basis[p]
                right[i + p] -= b0 * g0 + b1 * g1 + b2 * g2
                t0 = h00 * b0 + h01 * b1 + h02 * b2
                t1 = h01 * b0 + h11 * b1 + h12 * b2
                t2 = h02 * b0 + h12 * b1 + h22 * b2
                for q in range(p + 1):
                    band[i + p, p - q] += basis[q][0] * t0 + basis[q][1] * t1 + basis[q][2] * t2


@arithmetic_kernel
def _fix(band: FloatArray, right: FloatArray, row: int) -> None:
    """Keep one coefficient as it is."""
    band[row, 0], band[row, 1], band[row, 2], right[row] = 1.0, 0.0, 0.0, 0.0
    for away in range(1, 3):
        if row + away < len(right):
            band[row + away, away] = 0.0


@arithmetic_kernel
def _tie(band: FloatArray, row: int) -> None:
    """Change three coefficients alike: next to a rest only the value counts, and is constant."""
    for first in range(row, row + 2):
        band[first, 0] += STIFF
        band[first + 1, 0] += STIFF
        band[first + 1, 1] -= STIFF


@arithmetic_kernel
def _solve(band: FloatArray, right: FloatArray) -> None:
    """Solve a symmetric system of five diagonals in place, as L D L'.

    Args:
        band: Row r has the entries of columns r, r - 1, r - 2; overwritten, shape (n, 3).
        right: Overwritten by the solution, shape (n,).
    """
    count = len(right)
    for row in range(count):
        one, two = band[row, 1], band[row, 2]
        if row > 1:
            two /= band[row - 2, 0]
            one -= band[row, 2] * band[row - 1, 1]
        if row > 0:
            whole = one
            one /= band[row - 1, 0]
            band[row, 0] -= one * whole + two * band[row, 2]
            right[row] -= one * right[row - 1]
            if row > 1:
                right[row] -= two * right[row - 2]
        band[row, 0] += RIDGE
        band[row, 1], band[row, 2] = one, two
    for row in range(count):
        right[row] /= band[row, 0]
    for row in range(count - 1, -1, -1):
        if row + 1 < count:
            right[row] -= band[row + 1, 1] * right[row + 1]
        if row + 2 < count:
            right[row] -= band[row + 2, 2] * right[row + 2]


@arithmetic_kernel
def _advance(
    table: RunTable, jerk: float, c: FloatArray, change: FloatArray, sides: Sides, target: float
) -> float:
    """Go as far as slacks and multipliers stay positive; the share of the change that is gone."""
    step, forms, highest = table
    kinds = forms.shape[2]
    steps = 1.0, 1.0
    for i in range(len(step)):
        for end in range(2):
            z, dz = spline_at(step, c, i, end), spline_at(step, change, i, end)
            if dz[0] < 0.0:
                steps = min(steps[0], -LARGEST_FALL * z[0] / dz[0]), steps[1]
            falls = 0.5 * jerk / (z[0] * math.sqrt(z[0])) * dz[0]
            first, whole = _watched(len(step), kinds, i, end)
            for k in range(first, kinds):
                form = forms[i, end, k]
                rises = form[0] * dz[0] + form[1] * dz[1] + form[2] * dz[2]
                lean = falls if 2 * k >= kinds else 0.0
                steps = _change_side(sides, i, end, 2 * k, -lean - rises, target, steps)
                steps = _change_side(sides, i, end, 2 * k + 1, rises - lean, target, steps)
            if whole:
                rises = change[i + 1] / highest[i]
                steps = _change_side(sides, i, end, 2 * kinds, -rises, target, steps)
    primal, dual = steps
    for i in range(len(c)):
        c[i] += primal * change[i]
    for i in range(len(step)):
        for end in range(2):
            z = spline_at(step, c, i, end)
            first, whole = _watched(len(step), kinds, i, end)
            for side in range(2 * first, 2 * kinds + int(whole)):
                room = _room(table, jerk, c, i, end, z, side)
                loosened = sides.loosened[i, end, side] * (1.0 - primal)
                if room > min(LEAST_SLACK, loosened):
                    loosened = 0.0
                sides.loosened[i, end, side] = loosened
                sides.slack[i, end, side] = max(room + loosened, SMALLEST_SLACK)
                sides.price[i, end, side] += dual * sides.price_change[i, end, side]
    return primal


@arithmetic_kernel
def _change_side(
    sides: Sides, i: int, end: int, side: int, gain: float, target: float,
    steps: tuple[float, float],
) -> tuple[float, float]:  # fmt: skip
    """Change a multiplier with its slack, and say how far both may go.

    Args:
        steps: How far slacks and multipliers may go so far.
    """
    primal, dual = steps
    slack, price = sides.slack[i, end, side], sides.price[i, end, side]
    ds = gain - sides.loosened[i, end, side]
    dp = (target - price * ds) / slack - price
    sides.price_change[i, end, side] = dp
    if primal * ds < -(1.0 - KEPT) * slack:
        primal = -(1.0 - KEPT) * slack / ds
    if dual * dp < -(1.0 - KEPT) * price:
        dual = -(1.0 - KEPT) * price / dp
    return primal, dual


@arithmetic_kernel
def _room(
    table: RunTable, jerk: float, c: FloatArray, i: int, end: int, z: tuple[float, float, float],
    side: int,
) -> float:  # fmt: skip
    """What is left of a limit."""
    kinds = table.forms.shape[2]
    if side == 2 * kinds:
        return 1.0 - c[i + 1] / table.highest[i]
    form = table.forms[i, end, side >> 1]
    value = form[0] * z[0] + form[1] * z[1] + form[2] * z[2]
    if side & 1:
        value = -value
    return 1.0 - value if side < kinds else jerk / math.sqrt(z[0]) - value
