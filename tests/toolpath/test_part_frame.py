import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from twin.toolpath.part_frame import PartFrame

coordinate = st.floats(-500, 500)


def test_positive_c_carries_the_tool_counter_clockwise_around_the_part():
    frame = PartFrame(3, (0.0, 0.0))
    seen = frame.position(np.array([[100.0, 0.0, 5.0, 90.0]]))
    np.testing.assert_allclose(seen, [[0.0, 100.0, 5.0]], atol=1e-12)


def test_nothing_turns_without_a_rotary_axis():
    seen = PartFrame(None, (10.0, 20.0)).position(np.array([[11.0, 22.0, 3.0]]))
    np.testing.assert_array_equal(seen, [[1.0, 2.0, 3.0]])


@settings(derandomize=True)
@given(coordinate, coordinate, coordinate, st.floats(-2000, 2000), st.floats(-360, 360))
def test_turning_keeps_radius_and_height(x: float, y: float, z: float, c: float, zero: float):
    frame = PartFrame(3, (7.0, -3.0), zero)
    seen = frame.position(np.array([[x, y, z, c]]))[0]
    assert np.isclose(np.hypot(*seen[:2]), np.hypot(x - 7.0, y + 3.0))
    assert seen[2] == z


@settings(derandomize=True)
@given(coordinate, coordinate, st.floats(-360, 360))
def test_at_its_zero_the_part_lies_as_the_machine(x: float, y: float, zero: float):
    seen = PartFrame(3, (0.0, 0.0), zero).position(np.array([[x, y, 0.0, zero]]))[0]
    np.testing.assert_allclose(seen, [x, y, 0.0])
