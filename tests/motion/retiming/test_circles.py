"""How fast runs of arcs are, against the shortest time under the same limits."""

import math

import numpy as np
import pytest
from jerk_oracle import circle, helix, shortest_time
from motion_checks import assert_within_limits
from motion_programs import PERIOD, Program, circles, duration, mill, run

from twin.motion.limits import MotionLimits
from twin.motion.planner import plan_phases
from twin.nc.canonical import Corner

PLACES = 240
"""Of the oracle: with fewer it sees less of its limits, with 1,000 it would be half a percent slower."""


def even_mill(fastest: float = 500.0) -> MotionLimits:
    """All axes alike: those of the oracle."""
    return mill(
        velocity=np.full(4, fastest),
        acceleration=np.full(4, 4000.0), jerk=np.full(4, 5e4),
        path_acceleration=4000.0, path_jerk=5e4,
    )  # fmt: skip


def share_of_jerk_velocity(radius: float, turns: int) -> float:
    """Mean velocity, ramps included, over (J R²)^(1/3)."""
    machine = mill()
    seconds = duration(circles(radius, turns), machine)
    return math.tau * radius * turns / seconds / (machine.jerk[1] * radius**2) ** (1.0 / 3.0)


@pytest.mark.parametrize("radius", [0.5, 5.0])
def test_the_longer_a_path_goes_round_the_more_of_the_jerk_it_uses(radius: float) -> None:
    shares = [share_of_jerk_velocity(radius, turns) for turns in (1, 3, 10)]
    assert shares == sorted(shares)
    assert shares[-1] > 0.95


@pytest.mark.parametrize("turns", [1, 3, 12, 45])
def test_circles_keep_the_limits(turns: int) -> None:
    assert_within_limits(run(circles(2.0, turns), mill()), mill(), PERIOD)


def test_it_does_not_matter_how_many_blocks_make_a_circle() -> None:
    whole, cut = (duration(circles(3.0, 4, blocks), mill()) for blocks in (1, 4))
    assert cut == pytest.approx(whole, rel=1e-6)


def test_the_oracle_knows_a_straight_line() -> None:
    """Jerk up and down again takes 4 (s / (2 j))^(1/3); between its places the oracle gains a little."""
    nearly_straight = circle(1e4, 20.0 / (math.tau * 1e4))
    ratio = shortest_time(nearly_straight, 1e4, 5e4) / (4.0 * (20.0 / 2.0 / 5e4) ** (1.0 / 3.0))
    assert 0.97 < ratio < 1.0


@pytest.mark.parametrize(
    ("radius", "turns"),
    [
        (0.5, 1),
        (0.5, 3),
        (5.0, 1),
        (50.0, 1),
        (0.5, 0.5),
        (50.0, 0.5),
        (5.0, 0.25),
        (50.0, 0.125),
        (5.0, 0.03),
    ],
)
def test_circles_beside_the_shortest_time(radius: float, turns: float) -> None:
    """No faster than can be, and no more than 3 % slower."""
    shortest = shortest_time(circle(radius, turns, PLACES), 4000.0, 5e4)
    assert 1.0 < duration(circles(radius, turns), even_mill()) / shortest < 1.03


def test_a_circle_run_three_times_with_stops() -> None:
    program = Program()
    program.corner = Corner.EXACT_STOP
    for _ in range(3):
        program.arc((0.5, 0.0, 0.0), (0.0, 0.0, 1.0), 360.0, feed=1e6)
    shortest = 3.0 * shortest_time(circle(0.5, 1, PLACES), 4000.0, 5e4)
    assert 1.0 < duration(program, even_mill()) / shortest < 1.03


@pytest.mark.parametrize(
    ("radius", "turns", "advance", "turned"),
    [
        (5.0, 2, 4.0, 0.0),
        (20.0, 1, 5.0, 90.0),
        (5.0, 1, 0.0, 60.0),
        (5.0, 0.75, 0.0, 60.0),
        (1.0, 1, 0.0, 60.0),
        (50.0, 0.75, 10.0, 300.0),
        (50.0, 0.25, 0.0, 360.0),
        (5.0, 0.5, 0.0, 2000.0),
    ],
)
def test_helices_with_a_table_beside_the_shortest_time(
    radius: float, turns: float, advance: float, turned: float
) -> None:
    """A table that turns ten times as far is one whose limits are a tenth: with 2000 degrees it alone counts."""
    program = Program()
    program.arc(
        (radius, 0.0, 0.0), (0.0, 0.0, 1.0), 360.0 * turns, advance=advance, turn=turned, feed=1e7
    )
    machine = even_mill(fastest=1e5)
    shortest = shortest_time(helix(radius, turns, advance, turned, PLACES), 4000.0, 5e4)
    assert 1.0 < duration(program, machine) / shortest < 1.03
    assert_within_limits(run(program, machine), machine, PERIOD)


def test_the_oracle_knows_a_turn_of_the_table() -> None:
    """Jerk up, hold and down again, twice: an arc so small beside the turn takes nothing of its limits."""
    ramp = 4000.0 / 5e4
    alone = ramp + math.sqrt(ramp**2 + 4.0 * 360.0 / 4000.0)
    assert 0.97 < shortest_time(helix(5.0, 0.25, 0.0, 360.0, PLACES), 4000.0, 5e4) / alone < 1.0


@pytest.mark.parametrize(("turns", "feed"), [(0.5, 3000.0), (1.0, 3000.0), (0.25, 4500.0)])
def test_ramps_of_arcs_that_reach_their_feed(turns: float, feed: float) -> None:
    shortest = shortest_time(circle(5.0, turns, PLACES), 4000.0, 5e4, feed / 60.0)
    program = circles(5.0, turns, feed=feed)
    assert 1.0 < duration(program, even_mill()) / shortest < 1.03
    assert_within_limits(run(program, even_mill()), even_mill(), PERIOD)


def test_of_a_long_way_at_the_feed_only_the_ramps_are_planned_anew() -> None:
    (phases,) = plan_phases(circles(20.0, 1, feed=600.0).chunks(), even_mill(), start=np.zeros(4))
    holds = phases.rows[phases.rows[:, 3] >= 10.0 * (1.0 - 1e-12)]
    assert holds[:, 1].sum() > 0.9 * phases.end_time
    assert len(phases.rows) < 200
