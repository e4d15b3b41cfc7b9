import math
from typing import Any

import hypothesis
import numpy as np
import pytest
from examples import examples
from hypothesis import given
from hypothesis import strategies as st
from motion_checks import assert_consistent, assert_on_path, assert_within_limits, points_on_path
from motion_programs import PERIOD, SETTINGS, ZERO, Program, duration, limits, mill, programs, run

from twin.columns import join
from twin.motion.corner_candidates import PiecesOfChunks
from twin.motion.limits import MotionLimits
from twin.motion.pieces.rounding_kernels import add_rounding
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Corner, FloatArray

FEWER = hypothesis.settings(SETTINGS, max_examples=examples(40))
STEPS: dict[str, Any] = {"junction_velocity_step": 1.0, "junction_acceleration_step": 400.0}


def with_corner(corner: Corner, *start: float) -> Program:
    program = Program(*start)
    program.corner = corner
    return program


def deviation(setpoints: Setpoints, program: Program) -> FloatArray:
    """Distance of X Y Z from where the path is at the same fraction; the path itself is nearer."""
    points = points_on_path(program.moves[setpoints.move], setpoints.fraction) + ZERO
    return np.linalg.norm((setpoints.position - points)[:, :3], axis=1)


@pytest.mark.seconds("whole programs are planned")
@FEWER
@given(programs(most=12, corners=(Corner.EXACT_PATH,)), limits())
def test_exact_path_keeps_path_and_limits(program: Program, machine: MotionLimits) -> None:
    setpoints = run(program, machine)
    assert_on_path(setpoints, program.moves, ZERO)
    assert_within_limits(setpoints, machine, PERIOD, knees=True)
    assert_consistent(setpoints, machine, PERIOD, knees=True)
    assert np.array_equal(setpoints.position[-1], program.position + ZERO)


@pytest.mark.seconds("whole programs are planned")
@FEWER
@given(programs(most=12, corners=(Corner.CONTINUOUS,)), st.one_of(limits(), limits(most_knee=0.0)))
def test_continuous_path_keeps_tolerance_and_limits(
    program: Program, machine: MotionLimits
) -> None:
    knees = bool(np.any(machine.junction_velocity_step))
    setpoints = run(program, machine)
    assert np.array_equal(setpoints.position[-1], program.position + ZERO)
    assert_within_limits(setpoints, machine, PERIOD, knees=knees)
    assert_consistent(setpoints, machine, PERIOD, knees=knees)
    moving = setpoints.move >= 0
    tolerance = max(0.3, machine.corner_tolerance)
    if np.any(moving):
        points = points_on_path(program.moves[setpoints.move[moving]], setpoints.fraction[moving])
        away = setpoints.position[moving] - points - ZERO
        assert np.linalg.norm(away[:, :3], axis=1).max() <= tolerance * 1.001
        assert np.abs(away[:, 3]).max() <= machine.further_corner_tolerance * 1.001


@FEWER
@given(programs(most=12, corners=tuple(Corner)), limits(), st.lists(st.integers(0, 12)))
def test_chunks_do_not_matter_in_any_mode(
    program: Program, machine: MotionLimits, cuts: list[int]
) -> None:
    whole, cut = run(program, machine), run(program, machine, *cuts)
    for name in ("time", "line", "move", "fraction", "position", "velocity", "acceleration"):
        assert np.array_equal(getattr(whole, name), getattr(cut, name))


def zigzag(corner: Corner, angle: float, feed: float = 6000.0) -> Program:
    """Two straight moves of 30 mm that meet at an angle [deg]."""
    program = with_corner(corner).line(30.0, 0.0, 0.0, 0.0, feed=feed)
    turn = np.deg2rad(angle)
    return program.line(30.0 + 30.0 * np.cos(turn), 30.0 * np.sin(turn), 0.0, 0.0, feed=feed)


@pytest.mark.parametrize("angle", [0.01, 0.5, 10.0, 90.0, 179.9, 180.0])
def test_knee_is_passed_as_fast_as_its_step_allows(angle: float) -> None:
    machine = mill(**STEPS)
    setpoints = run(zigzag(Corner.EXACT_PATH, angle), machine)
    after = int(np.flatnonzero(setpoints.move == 1)[0])
    speed = np.linalg.norm(setpoints.velocity[:, :3], axis=1)
    turn = np.deg2rad(angle)
    steps = np.array([1.0 - np.cos(turn), np.sin(turn)])
    expected = min(100.0, 1.0 / steps.max())
    assert speed[after - 1 : after + 1].min() == pytest.approx(expected, abs=2000.0 * PERIOD)
    assert_on_path(setpoints, zigzag(Corner.EXACT_PATH, angle).moves, ZERO)


def test_no_step_allowed_means_stop() -> None:
    stopping = duration(zigzag(Corner.EXACT_STOP, 90.0), mill())
    assert duration(zigzag(Corner.EXACT_PATH, 90.0), mill()) == pytest.approx(stopping)
    assert duration(zigzag(Corner.EXACT_PATH, 90.0), mill(**STEPS)) < stopping


def test_straight_into_tangent_arc_keeps_the_acceleration_step() -> None:
    program = with_corner(Corner.EXACT_PATH).line(50.0, 0.0, 0.0, 0.0, feed=12000.0)
    program.arc((50.0, 10.0, 0.0), (0.0, 0.0, 1.0), 90.0, feed=12000.0)
    setpoints = run(program, mill(**STEPS))
    after = int(np.flatnonzero(setpoints.move == 1)[0])
    speed = np.linalg.norm(setpoints.velocity[after, :3])
    assert speed == pytest.approx(math.sqrt(400.0 * 10.0), abs=2000.0 * PERIOD)
    step = np.abs(np.diff(setpoints.acceleration[after - 1 : after + 1], axis=0)).max(axis=0)
    assert np.all(step <= 400.0 + mill().jerk * PERIOD * 1.001)


@pytest.mark.parametrize("angle", [5.0, 45.0, 90.0, 135.0, 180.0])
def test_continuous_corner_uses_its_tolerance(angle: float) -> None:
    program = zigzag(Corner.CONTINUOUS, angle)
    setpoints = run(program, mill(corner_tolerance=0.05), period_s=1e-4)
    assert_within_limits(setpoints, mill(), 1e-4)
    away = deviation(setpoints, program).max()
    assert away <= 0.05 * (1.0 + 1e-9)
    # Where both moves press the same axis, a stop is faster than any rounding.
    assert away > 0.98 * 0.05 or duration(program, mill()) == duration(
        zigzag(Corner.EXACT_STOP, angle), mill()
    )


@pytest.mark.parametrize("straight", [0.5, 0.8, 1.05, 1.3, 1.6, 2.1, 4.0])
def test_roundings_of_both_ends_of_a_block_share_the_tolerance(straight: float) -> None:
    """Between two tangent arcs; alone, the change of curvature is rounded over 0.96 mm."""
    program = with_corner(Corner.CONTINUOUS).arc((0.0, 1.0, 0.0), (0.0, 0.0, 1.0), 180.0)
    program.line(-straight, 2.0, 0.0, 0.0, feed=600.0)
    program.arc((-straight, 1.0, 0.0), (0.0, 0.0, 1.0), 180.0)
    away = deviation(run(program, mill(corner_tolerance=0.01), period_s=1e-4), program)
    assert 0.0075 < away.max() <= 0.01 * (1.0 + 1e-9)


def test_programmed_tolerance_counts() -> None:
    wide = Program()
    wide.corner, wide.corner_tolerance = Corner.CONTINUOUS, 0.06
    wide.line(30.0, 0.0, 0.0, 0.0, feed=6000.0).line(30.0, 30.0, 0.0, 0.0, feed=6000.0)
    assert deviation(run(wide, mill()), wide).max() == pytest.approx(0.06, rel=0.05)


def chords(radius: float, chord: float, corner: Corner, feed: float, turn: float = 90.0) -> Program:
    """An arc as CAM writes it: a chain of short straight blocks, rounded to 0.1 µm."""
    program = with_corner(corner, radius, 0.0, 0.0, 0.0)
    count = round(radius * np.deg2rad(turn) / chord)
    for angle in np.linspace(0.0, np.deg2rad(turn), count + 1)[1:]:
        x, y = np.round(radius * np.array([np.cos(angle), np.sin(angle)]), 4)
        program.line(x, y, 0.0, 0.0, feed=feed)
    return program


def test_chain_of_short_blocks_runs_near_its_feed() -> None:
    program = chords(20.0, 0.05, Corner.CONTINUOUS, 2400.0)
    setpoints = run(program, mill(corner_tolerance=0.005))
    assert_within_limits(setpoints, mill(), PERIOD)
    assert deviation(setpoints, program).max() <= 0.005 * (1.0 + 1e-9)
    assert setpoints.time[-1] < 1.2 * (20.0 * np.pi / 2 / 40.0)
    middle = setpoints[len(setpoints) // 4 : -len(setpoints) // 4]
    assert np.linalg.norm(middle.velocity[:, :3], axis=1).min() > 0.9 * 40.0


def derivative_steps(program: Program, machine: MotionLimits, order: int) -> FloatArray:
    """Steps of a derivative of the path from piece to piece where it does not stop, shape (n, k)."""
    pieces = join(list(PiecesOfChunks(program.chunks(), machine, program.start)))
    rows = np.arange(len(pieces))

    def at(x: FloatArray) -> FloatArray:
        fraction = pieces.begin + x * pieces.fraction_per_length
        if order == 0:
            values = pieces.geometry.whole().position(rows, fraction)
        else:
            values = pieces.geometry.whole().derivative(rows, fraction, order)
        added = pieces.rounding
        for _ in range(order):
            added = added[:, :, 1:] * np.arange(1, added.shape[2])
        powers = x[:, None, None] ** np.arange(added.shape[2])
        scale = pieces.fraction_per_length[:, None] ** order
        return values * scale + np.sum(added * powers, axis=2)

    return (at(np.zeros(len(rows)))[1:] - at(pieces.length)[:-1])[pieces.entry[1:] > 0.0]


@pytest.mark.parametrize("tolerance", [0.003, 0.3])
def test_roundings_go_on_from_piece_to_piece(tolerance: float) -> None:
    """Roundings as wide as they may be, over the blocks that are cut at a time."""
    program = with_corner(Corner.CONTINUOUS)
    program.corner_tolerance = tolerance
    rng = np.random.default_rng(4)
    for _ in range(1500):
        step = np.append(rng.normal(size=3) * 0.002 + [0.01, 0.0, 0.0], 0.0)
        program.line(*(program.position + step), feed=6000.0)
    for order, largest in ((0, 1e-12), (1, 1e-9), (2, 1e-4)):
        assert np.abs(derivative_steps(program, mill(), order)).max() < largest, order


def test_tangent_blocks_run_through() -> None:
    program = with_corner(Corner.EXACT_PATH)
    for i in range(1, 10_001):
        program.line(0.01 * i, 0.0, 0.0, 0.0, feed=6000.0)
    single = duration(Program().line(100.0, 0.0, 0.0, 0.0, feed=6000.0), mill())
    assert duration(program, mill()) == pytest.approx(single, rel=1e-6)


@pytest.mark.parametrize("stop", [1999, 2000, 2001, 3999, 4000, 4001])
@pytest.mark.parametrize("same_line", [True, False])
def test_stop_at_the_end_of_a_window_is_seen_in_time(stop: int, same_line: bool) -> None:
    """Moves of 10 µm at 500 mm/s: the way to brake is longer than any window."""
    program = with_corner(Corner.EXACT_PATH)
    machine = mill(path_acceleration=200.0, path_jerk=2000.0, junction_velocity_step=0.5)
    for i in range(1, 4501):
        program.corner = Corner.EXACT_STOP if i == stop else Corner.EXACT_PATH
        aside = 0.0 if same_line else 1e-5 * (i % 2)
        program.line(0.01 * i, aside, 0.0, 0.0, feed=30000.0)
    setpoints = run(program, machine)
    assert_within_limits(setpoints, machine, PERIOD, knees=True)
    at_stop = np.argmin(np.abs(setpoints.position[:, 0] - ZERO[0] - 0.01 * stop))
    assert np.abs(setpoints.velocity[at_stop]).max() < 200.0 * PERIOD
    assert setpoints.velocity[: at_stop - 300].max() > 10.0


@pytest.mark.parametrize("corner", list(Corner))
@pytest.mark.parametrize(
    "case",
    [
        "tiny circle", "reversal", "nanometre", "only C", "C faster", "no length", "helix", "feed",
        "braking",
    ],
)  # fmt: skip
def test_cases_that_planners_get_wrong(case: str, corner: Corner) -> None:
    machine = mill(**STEPS)
    program = with_corner(corner)
    if case == "tiny circle":
        for _ in range(3):
            program.arc((0.002, 0.0, 0.0), (0.0, 0.0, 1.0), 360.0, feed=6000.0)
    elif case == "reversal":
        program.line(20.0, 0.0, 0.0, 0.0, feed=6000.0).line(0.0, 0.0, 0.0, 0.0, feed=6000.0)
    elif case == "nanometre":
        program.line(20.0, 0.0, 0.0, 0.0, feed=6000.0).line(20.0, 1e-6, 0.0, 0.0, feed=6000.0)
        program.line(40.0, 1e-6, 0.0, 0.0, feed=6000.0)
    elif case == "only C":
        for i in range(5):
            program.line(0.0, 0.0, 0.0, 100.0 * (-1) ** i, feed=20000.0)
    elif case == "C faster":
        program.line(0.001, 0.0, 0.0, 720.0, feed=600.0).line(0.001, 1e-11, 0.0, 900.0, feed=600.0)
        program.line(10.0, 0.0, 0.0, 900.0, feed=600.0)
    elif case == "no length":
        program.line(5.0, 0.0, 0.0, 0.0, feed=600.0).line(5.0, 0.0, 0.0, 0.0, feed=600.0)
        program.line(10.0, 0.0, 0.0, 0.0, feed=600.0)
    elif case == "helix":
        program.arc((5.0, 0.0, 0.0), (0.0, 0.0, 1.0), 7200.0, advance=10.0, turn=50.0, feed=9000.0)
    elif case == "feed":
        program.line(30.0, 10.0, 0.0, 5.0, feed=1e9).line(60.0, 0.0, 5.0, 0.0, feed=1e9)
    else:
        program.acceleration, program.deceleration = 1500.0, 30.0
        program.line(30.0, 0.0, 0.0, 0.0, feed=6000.0).line(30.0, 30.0, 0.0, 0.0, feed=6000.0)
    setpoints = run(program, machine)
    assert_within_limits(setpoints, machine, PERIOD, knees=corner == Corner.EXACT_PATH)
    if corner != Corner.CONTINUOUS:
        assert_on_path(setpoints, program.moves, ZERO)
    assert np.array_equal(setpoints.position[-1], program.position + ZERO)
    if case == "braking":
        speed = np.linalg.norm(setpoints.velocity[:, :3], axis=1)
        gain = np.diff(speed) / PERIOD
        assert gain.max() > 500.0
        first = (setpoints.move == 0) & (setpoints.fraction < 0.9)
        assert gain[first[1:]].min() >= -30.0 * 1.001


def test_rounding_takes_the_steps_away() -> None:
    """Before and after the border the added polynomials differ by minus the steps, and end flat."""
    knee, bend, width = np.array([0.3, -0.7]), np.array([0.05, 0.2]), 0.8

    def added(away: float) -> FloatArray:
        out = np.zeros((2, 6))
        add_rounding(out, away, width, knee, bend)
        return out

    before, after = added(-width), added(0.0)
    powers = np.arange(6)
    at_border = np.array(
        [before @ width**powers, before[:, 1:] @ (powers[1:] * width ** powers[:5])]
    )
    assert np.allclose(before[:, :3], 0.0, atol=1e-15)
    assert np.allclose(at_border[0], after[:, 0])
    assert np.allclose(at_border[1] - after[:, 1], knee)
    second = before[:, 2:] @ (powers[2:] * powers[1:5] * width ** powers[:4])
    assert np.allclose(second - 2.0 * after[:, 2], bend)
    assert np.allclose(after @ width**powers, 0.0, atol=1e-15)
    assert np.allclose(after[:, 1:] @ (powers[1:] * width ** powers[:5]), 0.0, atol=1e-15)
