"""How fast circles are, against the velocity at which their jerk alone reaches the limit."""

import math

import numpy as np
import pytest
from jerk_oracle import circle, shortest_time
from motion_checks import assert_within_limits
from motion_programs import PERIOD, Program, duration, mill, run

from twin.motion.limits import MotionLimits
from twin.nc.canonical import Corner


def circles(radius: float, turns: int, blocks: int = 1) -> Program:
    program = Program()
    program.corner = Corner.EXACT_PATH
    for _ in range(blocks):
        program.arc((radius, 0.0, 0.0), (0.0, 0.0, 1.0), 360.0 * turns / blocks, feed=1e6)
    return program


def share_of_jerk_velocity(radius: float, turns: int) -> float:
    """Mean velocity, ramps included, over (J R²)^(1/3)."""
    machine = mill()
    seconds = duration(circles(radius, turns), machine)
    return math.tau * radius * turns / seconds / (machine.jerk[1] * radius**2) ** (1.0 / 3.0)


@pytest.mark.parametrize("radius", [0.5, 5.0])
def test_the_longer_a_path_goes_round_the_more_of_the_jerk_it_uses(radius: float) -> None:
    shares = [share_of_jerk_velocity(radius, turns) for turns in (1, 3, 10)]
    assert shares == sorted(shares)
    assert shares[-1] > 0.85


@pytest.mark.parametrize("turns", [1, 3, 12])
def test_circles_keep_the_limits(turns: int) -> None:
    assert_within_limits(run(circles(2.0, turns), mill()), mill(), PERIOD)


def test_it_does_not_matter_how_many_blocks_make_a_circle() -> None:
    whole, cut = (duration(circles(3.0, 4, blocks), mill()) for blocks in (1, 4))
    assert cut == pytest.approx(whole, rel=1e-6)


def even_mill() -> MotionLimits:
    """X and Y alike: the oracle's axes."""
    return mill(
        acceleration=np.full(4, 4000.0), jerk=np.full(4, 5e4),
        path_acceleration=4000.0, path_jerk=5e4,
    )  # fmt: skip


def test_the_oracle_knows_a_straight_line() -> None:
    """Jerk up and down again takes 4 (s / (2 j))^(1/3); between its places the oracle gains a little."""
    nearly_straight = circle(1e4, 20.0 / (math.tau * 1e4))
    ratio = shortest_time(nearly_straight, 1e4, 5e4) / (4.0 * (20.0 / 2.0 / 5e4) ** (1.0 / 3.0))
    assert 0.97 < ratio < 1.0


@pytest.mark.parametrize(
    ("radius", "turns", "most"), [(0.5, 3, 1.26), (5.0, 1, 1.35), (50.0, 1, 1.29)]
)
def test_circles_beside_the_shortest_time(radius: float, turns: int, most: float) -> None:
    """No faster than can be, and no slower than they are known to be."""
    shortest = shortest_time(circle(radius, turns), 4000.0, 5e4)
    assert 1.0 < duration(circles(radius, turns), even_mill()) / shortest < most
