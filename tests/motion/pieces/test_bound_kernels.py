import numpy as np
import numpy.typing as npt
from hypothesis import example, given
from hypothesis import strategies as st
from motion_programs import SETTINGS

from twin.motion.pieces.bound_kernels import bound_derivatives
from twin.nc.canonical import FloatArray
from twin.toolpath.geometry_kernels import Curves


def bounds_of(
    coefficients: FloatArray, slope: float, length: float
) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
    """Bounds of one axis, a straight one of a polynomial, and where q'' adds to a."""
    rounding = np.zeros((1, 4, 6))
    rounding[0, 1] = coefficients
    drift, none = np.array([[0.0, slope, 0.0, 0.0]]), np.zeros((1, 3))
    bend = np.zeros((1, 4, 4))
    curves = Curves(np.zeros((1, 4)), drift, bend, none, none, np.zeros(1), drift)
    bounds, _, against = bound_derivatives(
        curves, np.zeros(1, np.int64), np.zeros(1), np.ones(1), np.array([length]), rounding
    )
    return bounds[0, :, 1], against[0, :, 1]


def numbers(largest: float) -> st.SearchStrategy[float]:
    return st.one_of(st.just(0.0), st.floats(-largest, largest))


@SETTINGS
@example([0.0, 0.0, 0.0, 1.0, -2.0, 1.0], 0.5, 1.0)
@given(st.lists(numbers(5.0), min_size=6, max_size=6), numbers(1.0), st.floats(0.01, 3.0))
def test_bounds_are_those_of_a_dense_table(
    coefficients: list[float], slope: float, length: float
) -> None:
    bounds, _ = bounds_of(np.array(coefficients), slope, length)
    path = np.polynomial.Polynomial(coefficients) + np.polynomial.Polynomial([0.0, slope])
    x = np.linspace(0.0, length, 4001)
    for order, bound in enumerate(bounds, start=1):
        most = np.abs(path.deriv(order)(x)).max()
        assert bound >= most * (1.0 - 1e-9) - 1e-12
        if order > 1:
            assert bound <= most * (1.0 + 1e-4) + 1e-5


@SETTINGS
@given(st.floats(0.01, 5.0), st.floats(-1.0, 1.0), st.sampled_from([-1.0, 1.0]))
def test_noise_where_a_rounding_begins_has_no_sign(third: float, slope: float, sign: float) -> None:
    """There q'' is 0 but for rounding: of whichever sign that is, the limits are the same."""
    clean = np.array([0.0, 0.0, 0.0, third, 0.0, 0.0])
    noisy = np.array([0.0, 0.0, sign * 1e-16, third, 0.0, 0.0])
    for expected, found in zip(
        bounds_of(clean, slope, 0.5), bounds_of(noisy, slope, 0.5), strict=True
    ):
        assert np.allclose(found, expected, rtol=1e-12, atol=0.0)
