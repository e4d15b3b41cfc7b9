"""The squared rate of a run as a quadratic spline over the reference's time.

Over the knots of n intervals there are n + 2 coefficients; interval i sees those from i to i + 2.
Value and slope are continuous, the second derivative is constant within an interval.
"""

from twin.compilation.kernel import arithmetic_kernel
from twin.nc.canonical import FloatArray

Basis = tuple[tuple[float, float, float], tuple[float, float, float], tuple[float, float, float]]


@arithmetic_kernel
def basis_at(step: FloatArray, i: int, end: int) -> Basis:
    """Value, slope and second derivative at one end of interval i, of each of its coefficients.

    Args:
        step: Lengths of the intervals, shape (n,) [s].
        end: 0 for its begin, 1 for its end.
    """
    here = step[i]
    before = step[i - 1] if i > 0 else 0.0
    after = step[i + 1] if i + 1 < len(step) else 0.0
    left, right = 1.0 / (before + here), 1.0 / (here + after)
    bend = 2.0 / here
    bends = bend * left, -bend * (left + right), bend * right
    if end == 0:
        return (
            (here * left, -2.0 * left, bends[0]),
            (before * left, 2.0 * left, bends[1]),
            (0.0, 0.0, bends[2]),
        )
    return (
        (0.0, 0.0, bends[0]),
        (after * right, -2.0 * right, bends[1]),
        (here * right, 2.0 * right, bends[2]),
    )


@arithmetic_kernel
def spline_at(
    step: FloatArray, coefficients: FloatArray, i: int, end: int
) -> tuple[float, float, float]:
    """Value, slope and second derivative at one end of interval i.

    Args:
        step: Lengths of the intervals, shape (n,) [s].
        coefficients: Shape (n + 2,).
        end: 0 for its begin, 1 for its end.
    """
    here = step[i]
    before = step[i - 1] if i > 0 else 0.0
    after = step[i + 1] if i + 1 < len(step) else 0.0
    c0, c1, c2 = coefficients[i], coefficients[i + 1], coefficients[i + 2]
    left, right = 1.0 / (before + here), 1.0 / (here + after)
    slope_left, slope_right = 2.0 * (c1 - c0) * left, 2.0 * (c2 - c1) * right
    bend = (slope_right - slope_left) / here
    if end == 0:
        return (here * c0 + before * c1) * left, slope_left, bend
    return (after * c1 + here * c2) * right, slope_right, bend
