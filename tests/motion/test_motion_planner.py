import dataclasses
import math

import numpy as np
import pytest
import ruckig
from hypothesis import given
from hypothesis import strategies as st
from motion_checks import (
    assert_consistent,
    assert_feed_and_path_limits,
    assert_on_path,
    assert_phases_join,
    assert_within_limits,
)
from motion_programs import (
    AXES,
    PERIOD,
    SETTINGS,
    ZERO,
    Program,
    duration,
    limits,
    mill,
    programs,
    run,
)

from twin.columns import join
from twin.motion.blocks.blocks import SHORTEST
from twin.motion.limits import MotionLimits
from twin.motion.planner import plan, plan_phases
from twin.nc.canonical import Chunk, Corner, Dwell, FloatArray, Function, Moves


def shortest_time(length: float, velocity: float, acceleration: float, jerk: float) -> float:
    """Ruckig's time from rest to rest along one axis [s]."""
    generator = ruckig.Ruckig(1)
    task = ruckig.InputParameter(1)
    task.current_position, task.target_position = [0.0], [length]
    task.max_velocity, task.max_acceleration = [velocity], [acceleration]
    task.max_jerk = [jerk]
    trajectory = ruckig.Trajectory(1)
    assert generator.calculate(task, trajectory) == ruckig.Result.Working
    return float(trajectory.duration)


@SETTINGS
@given(programs(), limits())
def test_every_program_keeps_path_and_limits(program: Program, machine: MotionLimits) -> None:
    setpoints = run(program, machine)
    assert_on_path(setpoints, program.moves, ZERO)
    assert_within_limits(setpoints, machine, PERIOD)
    assert_consistent(setpoints, machine, PERIOD)
    assert np.all(setpoints.velocity[[0, -1]] == 0.0)
    assert np.array_equal(setpoints.position[-1], program.position + ZERO)
    # A first move below SHORTEST is not gone through.
    assert np.allclose(setpoints.position[0], program.start + ZERO, rtol=0, atol=SHORTEST)
    assert np.array_equal(setpoints.time, np.arange(len(setpoints)) * PERIOD)


@SETTINGS
@given(programs(most=12, corners=(Corner.EXACT_STOP, Corner.EXACT_PATH)), limits())
def test_every_program_keeps_its_feed_and_the_limits_of_the_path(
    program: Program, machine: MotionLimits
) -> None:
    assert_feed_and_path_limits(run(program, machine), program.moves, machine)


@SETTINGS
@given(programs(most=12, corners=tuple(Corner)), limits())
def test_phases_join(program: Program, machine: MotionLimits) -> None:
    for phases in plan_phases(program.chunks(), machine, start=program.start):
        assert_phases_join(phases)


@SETTINGS
@given(programs(), limits())
def test_with_exact_stops_the_times_of_the_moves_add_up(
    program: Program, machine: MotionLimits
) -> None:
    alone = [
        list(plan_phases([Chunk(move)], machine, start=move.start[0])) for move in program.parts
    ]
    expected = sum(phases[-1].end_time for phases in alone if phases)
    expected += sum(event.seconds for event in program.events if isinstance(event, Dwell))
    whole = list(plan_phases(program.chunks(), machine, start=program.start))
    assert (whole[-1].end_time if whole else 0.0) == pytest.approx(expected, rel=1e-9)


@SETTINGS
@given(programs(most=12), limits(), st.lists(st.integers(0, 12), max_size=4))
def test_chunks_do_not_matter(program: Program, machine: MotionLimits, cuts: list[int]) -> None:
    whole, cut = run(program, machine), run(program, machine, *cuts)
    for name in ("time", "line", "move", "fraction", "position", "velocity", "acceleration"):
        assert np.array_equal(getattr(whole, name), getattr(cut, name))


@SETTINGS
@given(
    st.floats(-6.0, 4.0).map(lambda exponent: 10.0**exponent),
    st.floats(1.0, 60000.0),
    st.floats(10.0, 1e4),
    st.floats(100.0, 1e7),
)
def test_single_move_takes_minimum_time(
    length: float, feed: float, acceleration: float, jerk: float
) -> None:
    machine = mill(
        velocity=np.full(4, 2000.0), acceleration=np.full(4, acceleration), jerk=np.full(4, jerk),
        path_acceleration=math.inf, path_jerk=math.inf,
    )  # fmt: skip
    program = Program().line(length, 0.0, 0.0, 0.0, feed=feed)
    expected = shortest_time(length, feed / 60.0, acceleration, jerk)
    assert duration(program, machine) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("acceleration", [5.0, 3e3])
@pytest.mark.parametrize("jerk", [1e10, 1e13, 1e16])
def test_huge_jerk_is_none(acceleration: float, jerk: float) -> None:
    """The whole of a phase then takes less than rounding elsewhere."""
    machine = mill(
        velocity=np.full(4, 2000.0), acceleration=np.full(4, acceleration), jerk=np.full(4, jerk),
        path_acceleration=math.inf, path_jerk=math.inf,
    )  # fmt: skip
    program = Program()
    program.deceleration = 0.1 * acceleration
    program.line(10.0, 0.0, 0.0, 0.0, feed=1e6)
    # Up to v and down again: v² (1 / a + 1 / d) = 2 s, and v (1 / a + 1 / d) is the time.
    each = 1.1 / (0.1 * acceleration)
    assert duration(program, machine) == pytest.approx(math.sqrt(20.0 * each), rel=1e-5)


def test_dwell_on_a_machine_without_limits_of_the_path() -> None:
    machine = mill(path_acceleration=math.inf, path_jerk=math.inf)
    program = Program().line(1.0, 0.0, 0.0, 0.0, feed=600.0).dwell(0.5)
    moving = duration(Program().line(1.0, 0.0, 0.0, 0.0, feed=600.0), machine)
    assert duration(program, machine) == pytest.approx(moving + 0.5)


def test_rapid_runs_at_the_limit_of_its_slowest_axis() -> None:
    setpoints = run(Program().line(600.0, 600.0, 600.0, 0.0), mill())
    assert np.allclose(setpoints.velocity.max(axis=0), [300.0, 300.0, 300.0, 0.0], rtol=1e-9)


def test_rapid_keeps_a_feed_that_the_program_gives_it() -> None:
    program = Program().line(50.0, 0.0, 0.0, 0.0)
    program.parts[0] = dataclasses.replace(program.parts[0], feed=np.array([1200.0]))
    assert run(program, mill()).velocity[:, 0].max() == pytest.approx(20.0)


def test_feed_counts_the_length_of_the_move() -> None:
    turning = run(Program().line(0.0, 0.0, 0.0, 90.0, feed=1800.0), mill())
    assert turning.velocity[:, 3].max() == pytest.approx(30.0)
    helix = Program().arc((10.0, 0.0, 0.0), (0.0, 0.0, 1.0), 720.0, advance=20.0, feed=1200.0)
    speed = np.linalg.norm(run(helix, mill()).velocity[:, :3], axis=1)
    assert speed.max() == pytest.approx(20.0)


def test_turn_in_step_with_a_straight_move_stays_below_its_own_limit() -> None:
    setpoints = run(Program().line(10.0, 0.0, 0.0, 3600.0, feed=6000.0), mill())
    assert setpoints.velocity[:, 3].max() == pytest.approx(360.0)


def test_next_move_starts_when_the_last_one_ends() -> None:
    program = Program()
    for i in range(1, 51):
        program.line(0.1 * i, 0.0, 0.0, 0.0, feed=3000.0)
    single = duration(Program().line(0.1, 0.0, 0.0, 0.0, feed=3000.0), mill())
    assert duration(program, mill()) == pytest.approx(50 * single, rel=1e-9)
    setpoints = run(program, mill())
    assert setpoints.time[-1] == pytest.approx(math.ceil(50 * single / PERIOD) * PERIOD)


def test_dwell_holds_and_carries_its_line() -> None:
    program = Program().dwell(0.05).line(1.0, 0.0, 0.0, 0.0, feed=600.0).dwell(0.1)
    program.line(0.0, 0.0, 0.0, 0.0, feed=600.0).dwell(0.03)
    setpoints = run(program, mill())
    for line, move, fraction, seconds in (
        (1000, -1, 0, 0.05),
        (1001, 0, 1, 0.1),
        (1002, 1, 1, 0.03),
    ):
        here = setpoints.line == line
        assert np.count_nonzero(here) * PERIOD == pytest.approx(seconds, abs=2 * PERIOD)
        assert np.all(setpoints.move[here] == move)
        assert np.all(setpoints.fraction[here] == fraction)
        assert np.all(setpoints.velocity[here] == 0.0)
        assert np.ptp(setpoints.position[here], axis=0).max() == 0.0


def test_functions_take_no_time() -> None:
    program = Program().line(1.0, 0.0, 0.0, 0.0, feed=600.0)
    bare = run(program, mill())
    program.events.append(Function(0, 5, "M3", {"S": 1000.0}))
    assert np.array_equal(run(program, mill()).time, bare.time)


def test_program_without_moves_still_has_a_sample() -> None:
    start = np.arange(4.0)
    chunks: list[Chunk] = [Chunk(Moves.empty(AXES))]
    for program in ([], chunks):
        setpoints = join(list(plan(program, mill(), period_s=PERIOD, part_zero=ZERO, start=start)))
        assert len(setpoints) == 1
        assert np.array_equal(setpoints.position[0], start)
        assert setpoints.move[0] == -1


def test_only_moves_of_no_length() -> None:
    setpoints = run(Program(1.0, 2.0, 3.0, 4.0).line(1.0, 2.0, 3.0, 4.0, feed=100.0), mill())
    assert len(setpoints) == 1
    assert np.array_equal(setpoints.position[0], np.array([1.0, 2.0, 3.0, 4.0]) + ZERO)


def test_gap_between_moves_is_refused() -> None:
    program = Program().line(1.0, 0.0, 0.0, 0.0).line(2.0, 0.0, 0.0, 0.0)
    program.parts[1] = dataclasses.replace(program.parts[1], start=np.full((1, 4), 0.5))
    with pytest.raises(ValueError, match="line 11: the move begins at"):
        run(program, mill())


def test_long_program_in_many_windows() -> None:
    program = Program()
    rng = np.random.default_rng(1)
    for _ in range(6000):
        program.line(*(program.position + rng.normal(0.0, 0.05, 4)), feed=3000.0)
    setpoints = run(program, mill())
    assert_within_limits(setpoints, mill(), PERIOD)
    assert np.all(np.diff(setpoints.move) >= 0)
    assert np.array_equal(setpoints.position[-1], program.position + ZERO)


@pytest.mark.parametrize("period_s", [0.0005, 0.004, 0.05])
def test_any_servo_period(period_s: float) -> None:
    program = Program().line(10.0, 5.0, 0.0, 0.0, feed=6000.0).arc((0, 0, 0), (0, 0, 1), 90.0)
    setpoints = run(program, mill(), period_s=period_s)
    assert_on_path(setpoints, program.moves, ZERO)
    assert np.array_equal(setpoints.position[-1], program.position + ZERO)
    assert 0.0 <= setpoints.time[-1] - duration(program, mill()) < period_s


def test_sampling_agrees_with_the_integral_of_the_phases() -> None:
    program = Program().line(3.0, 4.0, 0.0, 0.0, feed=6000.0)
    phases = next(plan_phases(program.chunks(), mill(), start=program.start))
    setpoints = run(program, mill())

    def travelled(t: float) -> float:
        x = 0.0
        for begin, length, _, v, a, j in phases.rows:
            dt = min(max(t - begin, 0.0), length)
            x += v * dt + a * dt**2 / 2 + j * dt**3 / 6
        return x

    expected: FloatArray = np.array([travelled(t) / 5.0 for t in setpoints.time])
    assert np.allclose(setpoints.fraction, expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", ["velocity", "path_jerk"])
@pytest.mark.parametrize("value", [0.0, -1.0, math.nan])
def test_limits_must_be_positive(name: str, value: float) -> None:
    bad = np.full(4, value) if name == "velocity" else value
    with pytest.raises(Exception, match=f"'{name}' must be positive"):
        mill(**{name: bad})
