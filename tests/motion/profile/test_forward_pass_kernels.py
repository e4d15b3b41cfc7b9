import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from motion_programs import SETTINGS

from twin.motion.profile.backward_pass_kernels import backward_pass
from twin.motion.profile.forward_pass_kernels import STATE_AT_REST, SegmentTimes, forward_pass
from twin.nc.canonical import FloatArray


def one_piece(length: float, velocity: float, acceleration: float, jerk: float) -> FloatArray:
    """The phases from rest to rest along one piece that last longer than rounding."""
    limits = np.array([[length], [velocity], [acceleration], [acceleration], [jerk]])
    entry = np.zeros(2)
    brakes = backward_pass(limits, entry, np.zeros((4, 0)))
    state, still = STATE_AT_REST.copy(), SegmentTimes(np.zeros(1), np.zeros(1))
    phases, _ = forward_pass(limits, entry, brakes, still, 1, math.inf, state)
    return phases[phases[:, 1] > 1e-6]


def test_a_velocity_that_rounds_above_its_limit_is_held():
    # Up to speed and down again v comes to 5.000000000000001 here.
    assert len(one_piece(115.56, 5.0, 6945.085688578546, 812887.283717028)) == 5


@SETTINGS
@given(
    st.floats(1e-3, 1e4),
    st.floats(0.1, 1e3),
    st.floats(1.0, 2e4),
    st.floats(10.0, 1e6),
)
def test_a_single_move_has_at_most_seven_phases(
    length: float, velocity: float, acceleration: float, jerk: float
):
    phases = one_piece(length, velocity, acceleration, jerk)
    assert len(phases) <= 7
