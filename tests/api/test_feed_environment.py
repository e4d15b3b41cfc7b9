"""The Gymnasium environment, held to Gymnasium's own checker."""

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import twin
from twin.gym import FeedEnv

pytestmark = pytest.mark.oracle

JOB = twin.Job(
    program="G90 G1 X10. F3000.\nY8.\nX0.\nM30",
    dialect="haas",
    tolerance=twin.Tolerance(contour_um=5.0),
)


def action(override: float) -> np.ndarray:
    return np.array([override], np.float32)


def total(env: FeedEnv, override: float) -> tuple[float, float]:
    env.reset(seed=0)
    reward, done, time = 0.0, False, 0.0
    while not done:
        _, gained, done, _, told = env.step(action(override))
        reward, time = reward + gained, told["time_s"]
    return reward, time


@pytest.mark.filterwarnings("ignore:.*For Box action spaces, we recommend:UserWarning")
def test_it_is_an_environment_to_gymnasium():
    env = gymnasium.make("twin/Feed-v0", program=JOB, warm_up_s=0.2)
    check_env(env.unwrapped)


def test_the_reward_is_time_and_what_exceeds_the_tolerance():
    env = FeedEnv(JOB)
    slow, slow_s = total(env, 0.2)
    fast, fast_s = total(env, 1.0)
    assert slow_s > 2.0 * fast_s
    # At a fifth of the feed the corners hold 5 µm; at all of it they do not.
    assert slow == pytest.approx(-slow_s, rel=0.05)
    assert fast < -fast_s


def test_a_seed_draws_the_begin_and_environments_run_side_by_side():
    one = FeedEnv(JOB, warm_up_s=0.3)
    first, _ = one.reset(seed=7)
    again, _ = one.reset(seed=7)
    other, _ = one.reset(seed=8)
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)
    many = gymnasium.make_vec("twin/Feed-v0", num_envs=2, program=JOB)
    seen, _ = many.reset(seed=1)
    assert seen.shape == (2, 6)
    many.close()
