"""Chords of a curve are driven as the curve is, however finely it is written."""

import math

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from motion_programs import Program, duration, mill, run

from twin.motion.blocks.corner_limit_kernels import CURVE_SHARE
from twin.motion.blocks.knee_kernels import (
    LONGEST_VIEW,
    MOST_TOGETHER,
    SHORTEST_SPAN,
    SPANS,
    BlockRun,
    slow_bending_chords,
    slow_dense_knees,
)
from twin.motion.corner_candidates import PiecesOfChunks
from twin.motion.limits import MotionLimits
from twin.motion.phases_of_pieces import phases_of_pieces
from twin.nc.canonical import Corner, FloatArray

STEP = 1.0
SPEEDING_UP = 1.5
"""What a change of speed on a curve may add to the mean jerk of following it."""


def knees_of_circle(radius: float, chord: float, turn: float = 270.0) -> FloatArray:
    """The velocities that the bound allows along chords of a circle, written exactly."""
    count = round(radius * math.radians(turn) / chord)
    angle = np.linspace(0.0, math.radians(turn), count + 1)
    point = np.zeros((count + 1, 4))
    point[:, 0], point[:, 1] = radius * np.cos(angle), radius * np.sin(angle)
    place = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(point, axis=0), axis=1)))
    joined = np.ones(count, np.bool_)
    joined[0] = False
    velocity = np.full(count, 1e3)
    slow_bending_chords(velocity, BlockRun(place, point, joined), np.full(4, STEP), np.full(4, 5e4))
    return velocity[1:]


@pytest.mark.parametrize("radius", [2.0, 4.0, 10.0])
def test_a_circle_is_as_slow_in_any_number_of_chords(radius: float) -> None:
    """The third difference of a circle is R (2 sin(s / 2 R))³, and the chords' speed the root of what that allows."""
    share, expected = CURVE_SHARE * 5e4, math.inf
    for span in SHORTEST_SPAN * 2.0 ** np.arange(SPANS):
        if span < radius:
            third = radius * (2.0 * math.sin(0.5 * span / radius)) ** 3
            roots = np.roots([third, -2.0 * STEP, 0.0, -share])
            expected = min(expected, span * float(roots[np.isreal(roots)].real.max()))
    arc = (share * radius**2) ** (1 / 3)
    assert arc <= expected <= 1.12 * arc
    for chord in (0.005, 0.02):
        assert knees_of_circle(radius, chord).min() == pytest.approx(expected, rel=2e-3)


def test_a_straight_chain_and_a_lone_corner_are_not_slowed() -> None:
    place = np.linspace(0.0, 20.0, 401)
    point = np.zeros((401, 4))
    point[:, 0] = place
    for corner in (False, True):
        if corner:
            point[200:, 1] = place[200:] - place[200]
        velocity = np.full(400, 100.0)
        velocity[200] = STEP
        joined = np.ones(400, np.bool_)
        slow_bending_chords(
            velocity, BlockRun(place, point, joined), np.full(4, STEP), np.full(4, 5e4)
        )
        assert np.all(velocity[np.arange(400) != 200] == 100.0)
        assert velocity[200] == STEP


def curve(bends: list[float], chord: float, corner: Corner, feed: float = 9000.0) -> Program:
    """Chords of a curve that bends in another way [1/mm] every two millimetres."""
    program, angle = Program(), 0.0
    program.corner = corner
    for bend in bends:
        for _ in range(round(2.0 / chord)):
            angle += bend * chord
            way = np.array([math.cos(angle), math.sin(angle), 0.1, 0.0])
            program.line(*(program.position + chord * way), feed=feed)
    return program


def mean_jerk(program: Program, machine: MotionLimits, ticks: int) -> float:
    """The greatest mean jerk over three times so many ticks, by what is allowed."""
    position, h = run(program, machine).position, 0.001 * ticks
    if len(position) <= 3 * ticks:
        return 0.0
    ends = [position[i * ticks : len(position) - (3 - i) * ticks] for i in range(4)]
    third = np.abs(ends[3] - 3.0 * ends[2] + 3.0 * ends[1] - ends[0]) / h**3
    return float((third / (machine.jerk + 2.0 * STEP / h**2)).max())


@pytest.mark.seconds("whole programs are planned and sampled")
@settings(derandomize=True, deadline=None, max_examples=examples(40))
@given(
    st.lists(st.floats(-1.5, 1.5), min_size=2, max_size=8),
    st.sampled_from([0.005, 0.01, 0.02, 0.05]),
)
def test_the_mean_jerk_along_chords_is_that_of_a_curve(bends: list[float], chord: float) -> None:
    machine = mill(junction_velocity_step=STEP)
    program = curve(bends, chord, Corner.EXACT_PATH)
    for ticks in (8, 16, 32):
        assert mean_jerk(program, machine, ticks) <= SPEEDING_UP


@pytest.mark.parametrize("chord", [0.005, 0.02])
def test_chords_take_the_time_of_their_arc(chord: float) -> None:
    machine = mill(junction_velocity_step=STEP, junction_acceleration_step=400.0)
    arc = Program(2.0, 0.0, 0.0, 0.0)
    arc.corner = Corner.EXACT_PATH
    arc.arc((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 300.0, feed=9000.0)
    chords = Program(2.0, 0.0, 0.0, 0.0)
    chords.corner = Corner.EXACT_PATH
    for angle in np.linspace(0.0, math.radians(300.0), round(2.0 * math.radians(300.0) / chord))[
        1:
    ]:
        chords.line(2.0 * math.cos(angle), 2.0 * math.sin(angle), 0.0, 0.0, feed=9000.0)
    assert 0.98 <= duration(chords, machine) / duration(arc, machine) <= 1.06


@pytest.mark.parametrize("corner", [Corner.EXACT_PATH, Corner.CONTINUOUS])
def test_planned_by_blocks_is_planned_whole(corner: Corner) -> None:
    """Also where what a knee depends on reaches over more blocks than others do."""
    machine = mill(junction_velocity_step=STEP)
    bends = np.random.default_rng(2).normal(size=30) * 0.4
    program = curve(list(bends), 0.02, corner)
    times = []
    for batch in (2100, 100_000):
        pieces = PiecesOfChunks(program.chunks(), machine, program.start, 1.0, batch)
        times.append([phases.end_time for phases in phases_of_pieces(pieces, machine)][-1])
    assert 2.0 * LONGEST_VIEW < 0.02 * 2100 / 2
    assert times[0] == pytest.approx(times[1], rel=1e-9)


def gains(velocity: FloatArray, turn: FloatArray, length: FloatArray) -> FloatArray:
    """What axes gain along each stretch, each knee at no more than its own velocity, by what they may gain."""
    found = [0.0]
    for i in range(1, len(length)):
        for j in range(i + 1, min(len(length), i + MOST_TOGETHER + 1)):
            fastest = max(velocity[i], velocity[j])
            if fastest < math.inf:
                gained = np.minimum(velocity[i : j + 1], fastest) @ turn[i : j + 1]
                allowed = STEP + 2000.0 * length[i:j].sum() / fastest
                found.append(float(np.abs(gained).max() / allowed))
    return np.array(found)


@settings(derandomize=True, deadline=None, max_examples=examples(20))
@given(st.integers(0, 10**6), st.sampled_from([1e-3, 0.02, 0.05]), st.sampled_from([0.0, 0.1]))
def test_a_stretch_of_knees_gains_one_step_and_what_its_acceleration_gives(
    seed: int, bend: float, corners: float
) -> None:
    rng, count = np.random.default_rng(seed), 45
    turn, length = rng.normal(size=(count, 4)) * bend, rng.uniform(0.01, 0.2, count)
    sharp = rng.random(count) < corners
    turn[sharp] = rng.uniform(-2.0, 2.0, (np.count_nonzero(sharp), 4))
    turn[rng.random(count) < 0.2] = 0.0
    with np.errstate(divide="ignore"):
        alone = (STEP / np.abs(turn)).min(axis=1)
    alone = np.where(np.isinf(alone), np.inf, np.minimum(alone, 60.0))
    found = alone.copy()
    slow_dense_knees(found, turn, length, np.zeros(count), np.full(4, STEP), np.full(4, 2000.0))
    assert np.all(found <= alone)
    assert gains(found, turn, length).max() <= 1.0 + 1e-5
    if corners == 0.0 and gains(alone, turn, length).max() <= 1.0:
        assert np.array_equal(found, alone)


def test_beside_a_corner_chords_are_as_fast_as_a_line() -> None:
    """Chords rounded to 0.1 µm, there and back at a right angle."""
    machine = mill(junction_velocity_step=STEP, junction_acceleration_step=400.0)
    times = []
    for count in (400, 1):
        program = Program()
        program.corner = Corner.EXACT_PATH
        for x, y in ((16.0, 12.0), (4.0, 28.0)):
            here = program.position
            for share in np.arange(1, count + 1) / count:
                place = here + share * (np.array([x, y, 0.0, 0.0]) - here)
                program.line(*np.round(place, 4), feed=6000.0)
        times.append(duration(program, machine))
    assert times[0] == pytest.approx(times[1], rel=1e-3)
