import numpy as np
import pytest

from twin.motion.retiming.spline_kernels import basis_at, spline_at


def test_value_and_slope_go_on_from_interval_to_interval() -> None:
    rng = np.random.default_rng(3)
    step, coefficients = rng.uniform(0.1, 2.0, 9), rng.uniform(-1.0, 1.0, 11)
    for i in range(8):
        here, there = spline_at(step, coefficients, i, 1), spline_at(step, coefficients, i + 1, 0)
        assert here[:2] == pytest.approx(there[:2], abs=1e-12)


def test_within_an_interval_it_is_a_parabola() -> None:
    rng = np.random.default_rng(4)
    step, coefficients = rng.uniform(0.1, 2.0, 5), rng.uniform(-1.0, 1.0, 7)
    for i, h in enumerate(step):
        value, slope, bend = spline_at(step, coefficients, i, 0)
        then = value + h * slope + 0.5 * h * h * bend, slope + h * bend, bend
        assert spline_at(step, coefficients, i, 1) == pytest.approx(then, abs=1e-12)


@pytest.mark.parametrize("end", [0, 1])
def test_its_basis_gives_the_same(end: int) -> None:
    rng = np.random.default_rng(5)
    step, coefficients = rng.uniform(0.1, 2.0, 4), rng.uniform(-1.0, 1.0, 6)
    for i in range(4):
        given = coefficients[i : i + 3] @ np.array(basis_at(step, i, end))
        assert spline_at(step, coefficients, i, end) == pytest.approx(tuple(given), abs=1e-12)
