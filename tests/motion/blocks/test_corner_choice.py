"""At each continuous corner the best of rounding, overlapping moves and a plain stop is taken."""

import itertools
import math

import numpy as np
import pytest
from motion_checks import assert_consistent, assert_within_limits, points_on_path
from motion_programs import ZERO, Program, duration, mill, run
from random_programs import KINDS, UNEVEN_KINDS, random_machine, random_program

from twin.nc.canonical import Corner

TOLERANCES = [0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0]


def square(corner: Corner, feed: float, side: float = 50.0) -> Program:
    program = Program()
    program.corner = corner
    for x, y in ((side, 0.0), (side, side), (0.0, side), (0.0, 0.0)):
        program.line(x, y, 0.0, 0.0, feed=feed)
    return program


@pytest.mark.parametrize(
    ("seed", "kinds"),
    [(seed, KINDS) for seed in (*range(24), 202, 659, 886, 2670)]
    + [(seed, UNEVEN_KINDS) for seed in (*range(6), 14, 175, 218, 256)],
)
def test_continuous_is_never_slower_than_stops(seed: int, kinds: tuple[str, ...]) -> None:
    times = []
    for corner in (Corner.CONTINUOUS, Corner.EXACT_STOP):
        rng = np.random.default_rng(seed)
        machine = random_machine(rng)
        times.append(duration(random_program(rng, corner, kinds=kinds), machine))
    assert times[0] <= times[1] * (1.0 + 1e-9)


@pytest.mark.parametrize("feed", [600.0, 3000.0, 10000.0])
def test_more_tolerance_costs_no_time(feed: float) -> None:
    program = square(Corner.CONTINUOUS, feed)
    times = [duration(program, mill(corner_tolerance=wide)) for wide in TOLERANCES]
    assert all(after <= before * (1.0 + 1e-9) for before, after in itertools.pairwise(times))
    assert times[0] < duration(square(Corner.EXACT_STOP, feed), mill())


def wave(corner: Corner, count: int) -> Program:
    """Half circles of 1 mm that turn to and fro: the curvature steps, the tangent does not."""
    program = Program()
    program.corner = corner
    for number in range(count):
        program.arc(
            (2.0 * number + 1.0, 0.0, 0.0), (0.0, 0.0, 1.0), -180.0 * (-1.0) ** number, feed=3e3
        )
    return program


def test_a_chain_of_arcs_is_not_stopped_where_each_alone_would_be() -> None:
    """A stop at one corner of a chain pays only if its neighbours stop too: the chain goes on."""
    machine = mill(jerk=np.full(4, 4e4), corner_tolerance=0.05)
    flowing = duration(wave(Corner.CONTINUOUS, 40), machine)
    assert flowing < 0.85 * duration(wave(Corner.EXACT_STOP, 40), machine)


def test_what_is_chosen_depends_only_on_what_lies_near() -> None:
    """However much of a program follows, the moves before it are driven alike."""
    machine = mill(corner_tolerance=0.05)
    short, long = (run(wave(Corner.CONTINUOUS, count), machine) for count in (320, 340))
    same = short.move < 40
    assert np.array_equal(short.position[same], long.position[: len(short)][same])


def test_moves_overlap_by_what_the_tolerance_allows() -> None:
    """At the switch both moves are one tolerance away from the corner: jerk t³/6 each."""
    machine = mill(corner_tolerance=0.01, jerk=np.full(4, 4e4))
    stopping = duration(square(Corner.EXACT_STOP, 3000.0), machine)
    overlap = 2.0 * (6.0 * 0.01 / 4e4) ** (1.0 / 3.0)
    taken = duration(square(Corner.CONTINUOUS, 3000.0), machine)
    assert taken == pytest.approx(stopping - 3.0 * overlap, rel=1e-9)


@pytest.mark.parametrize("turn", [90.0, 120.0, 150.0, 180.0])
def test_overlapping_moves_keep_tolerance_and_limits(turn: float) -> None:
    program = Program()
    program.corner = Corner.CONTINUOUS
    program.line(20.0, 0.0, 0.0, 0.0, feed=3000.0)
    angle = math.radians(turn)
    program.line(20.0 + 15.0 * math.cos(angle), 15.0 * math.sin(angle), 0.0, 0.0, feed=3000.0)
    machine, period = mill(corner_tolerance=0.02), 1e-4
    setpoints = run(program, machine, period_s=period)
    assert_within_limits(setpoints, machine, period)
    assert_consistent(setpoints, machine, period)
    points = points_on_path(program.moves[setpoints.move], setpoints.fraction) + ZERO
    away = np.linalg.norm((setpoints.position - points)[:, :3], axis=1).max()
    assert 0.95 * 0.02 < away <= 0.02 * (1.0 + 1e-9)
    assert np.all(np.diff(setpoints.move) >= 0)


def test_the_table_keeps_its_own_tolerance_where_moves_overlap() -> None:
    program = Program()
    program.corner = Corner.CONTINUOUS
    program.line(20.0, 0.0, 0.0, 30.0, feed=3000.0).line(20.0, 20.0, 0.0, 0.0, feed=3000.0)
    machine = mill(corner_tolerance=0.05, further_corner_tolerance=0.004)
    setpoints = run(program, machine, period_s=1e-4)
    points = points_on_path(program.moves[setpoints.move], setpoints.fraction) + ZERO
    assert np.abs(setpoints.position - points)[:, 3].max() <= 0.004 * (1.0 + 1e-9)
