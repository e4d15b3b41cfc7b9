import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from motion_programs import SETTINGS
from numpy.polynomial import Polynomial

from twin.motion.pieces.rounding_kernels import add_at_end, add_rounding, shift_polynomials

STEPS = st.lists(st.floats(-2.0, 2.0), min_size=4, max_size=4).map(np.array)


@SETTINGS
@given(STEPS, STEPS, st.floats(1e-3, 10.0), st.sampled_from([-1.0, 1.0]))
def test_a_rounding_begins_and_ends_as_anywhere_along_it(
    tangent_step: np.ndarray, curvature_step: np.ndarray, width: float, side: float
) -> None:
    general, at_end = np.zeros((4, 6)), np.zeros((4, 6))
    add_rounding(general, side * width, width, tangent_step, curvature_step, -side)
    add_at_end(at_end, width, tangent_step, curvature_step, side)
    size = (np.abs(tangent_step) * width + np.abs(curvature_step) * width**2)[
        :, None
    ] / width ** np.arange(6.0)
    assert np.all(np.abs(general - at_end) <= 1e-14 * size)


@SETTINGS
@given(
    st.lists(st.floats(-5.0, 5.0), min_size=6, max_size=6),
    st.floats(0.0, 2.0),
    st.integers(1, 6),
)
def test_polynomials_are_the_same_from_a_place_further_on(
    coefficients: list[float], way: float, used: int
) -> None:
    before, after = np.zeros((4, 6)), np.full((4, 6), np.nan)
    before[1, :used] = coefficients[:used]
    shift_polynomials(before, way, after)
    whole = Polynomial(before[1])
    expected = [whole.deriv(power)(way) if power else whole(way) for power in range(6)]
    factorials = np.array([1.0, 1.0, 2.0, 6.0, 24.0, 120.0])
    assert np.allclose(after[1], expected / factorials, rtol=1e-12, atol=1e-11)
    assert not np.any(after[[0, 2, 3]])
