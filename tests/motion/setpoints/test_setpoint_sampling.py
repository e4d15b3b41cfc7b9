import numpy as np

from twin.columns import join
from twin.motion.setpoints.sampling import settle
from twin.motion.setpoints.setpoints import Setpoints


def moving(first: int, count: int) -> Setpoints:
    ticks = np.arange(first, first + count)
    rows = np.repeat(ticks[:, None] * np.float64(0.5), 4, axis=1)
    return Setpoints(
        ticks * np.float64(0.001), ticks, ticks, ticks * np.float64(0.01), rows, rows, rows
    )


def test_the_end_is_held_at_rest_on_the_same_clock():
    held = join(list(settle([moving(0, 3), moving(3, 2)], 0.001, 0.004)))
    np.testing.assert_allclose(held.time, np.arange(9) * 0.001, rtol=0, atol=1e-15)
    np.testing.assert_array_equal(held.position[5:], np.repeat(held.position[4:5], 4, axis=0))
    assert not held.velocity[5:].any()
    assert not held.acceleration[5:].any()
    assert set(held.line[5:]) == {4}


def test_nothing_follows_nothing():
    assert list(settle([], 0.001)) == []
