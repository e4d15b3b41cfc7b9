"""Programs whose arcs are driven by a time law of their own: path, limits, and whatever is pressed."""

import dataclasses
import itertools

import hypothesis
import numpy as np
import pytest
from examples import examples
from hypothesis import given
from hypothesis import strategies as st
from motion_checks import (
    assert_consistent,
    assert_feed_and_path_limits,
    assert_on_path,
    assert_phases_join,
    assert_within_limits,
)
from motion_programs import PERIOD, SETTINGS, ZERO, Program, circles, limits, mill, run

from twin.columns import join
from twin.motion.limits import MotionLimits
from twin.motion.live.live_motion import LiveMotion
from twin.motion.planner import plan_phases
from twin.nc.canonical import Corner

FEWER = hypothesis.settings(SETTINGS, max_examples=examples(25))
COLUMNS = ("time", "line", "move", "fraction", "position", "velocity", "acceleration")


@st.composite
def round_programs(draw: st.DrawFn) -> Program:
    """Arcs that go round, alone or one after another, helices, and lines that meet them tangentially."""
    program = Program()
    feeds = st.sampled_from([600.0, 3000.0, 1e4, 1e6])
    for _ in range(draw(st.integers(1, 3))):
        program.corner = draw(st.sampled_from([*Corner]))
        kind = draw(st.sampled_from(["arc", "arcs", "lead"]))
        radius, sense = draw(st.floats(0.3, 30.0)), draw(st.sampled_from([-1.0, 1.0]))
        position = program.position
        center = (float(position[0]) + radius, float(position[1]), float(position[2]))
        if kind == "lead":
            way = draw(st.floats(0.1, 20.0))
            onward = position + np.array([0.0, -sense * way, 0.0, 0.0])
            center = (center[0], float(onward[1]), center[2])
            program.line(*onward, feed=draw(feeds))
        for _ in range(draw(st.integers(2, 4)) if kind == "arcs" else 1):
            sweep = sense * draw(st.floats(90.0, 1000.0))
            advance, turn = draw(st.sampled_from([(0.0, 0.0), (3.0, 0.0), (0.0, 40.0)]))
            program.arc(
                center, (0.0, 0.0, 1.0), sweep, advance=advance, turn=turn, feed=draw(feeds)
            )
            center = (center[0], center[1], float(program.position[2]))
    return program


def live(program: Program, machine: MotionLimits, largest_override: float) -> LiveMotion:
    return LiveMotion(
        program.chunks(), machine, period_s=PERIOD, part_zero=ZERO, start=program.start + ZERO,
        largest_override=largest_override,
    )  # fmt: skip


@FEWER
@given(round_programs(), st.one_of(st.just(mill()), limits()))
def test_round_programs_keep_path_and_limits(program: Program, machine: MotionLimits) -> None:
    setpoints = run(program, machine)
    assert_within_limits(setpoints, machine, PERIOD, knees=True)
    assert np.array_equal(setpoints.position[-1], program.position + ZERO)
    if all(corner != Corner.CONTINUOUS for corner in program.moves.corner):
        assert_on_path(setpoints, program.moves, ZERO)
        assert_consistent(setpoints, machine, PERIOD, knees=True)
        assert_feed_and_path_limits(setpoints, program.moves, machine)
    for phases in plan_phases(program.chunks(), machine, start=program.start):
        assert_phases_join(phases.joined())


@FEWER
@given(round_programs(), st.integers(1, 3000), st.lists(st.integers(0, 10), max_size=3))
def test_neither_slices_nor_chunks_matter(program: Program, slice_of: int, cuts: list[int]) -> None:
    planned = run(program, mill())
    chunked = run(program, mill(), *cuts)
    motion = live(program, mill(), 1.0)
    parts = list(itertools.takewhile(len, iter(lambda: motion.advance(slice_of), None)))
    for name in COLUMNS:
        assert np.array_equal(getattr(planned, name), getattr(join(parts), name)), name
        assert np.array_equal(getattr(planned, name), getattr(chunked, name)), name


def test_an_acceleration_keeps_its_limit_between_the_instants_that_are_looked_at() -> None:
    """X may go 8 mm/s on an arc of R12.8: its acceleration was 0.1 % above for some ms between two of them."""
    machine = dataclasses.replace(
        mill(),
        velocity=np.array([8.0, 110.5, 95.0, 66.1]),
        acceleration=np.array([100.0, 60.0, 19061.5, 1500.0]),
        jerk=np.array([1500.0, 600.0, 71619.0, 762668.6]),
        path_acceleration=433.7,
        path_jerk=538823.8,
    )
    program = Program().arc((0.5, 0.0, -12.8157), (0.0, 1.0, 0.0), 766.5531, turn=79.3, feed=None)
    assert np.abs(run(program, machine).acceleration[:, 0]).max() <= 100.0 * (1.0 + 1e-4)


def test_a_velocity_keeps_its_limit_between_the_instants_that_are_looked_at() -> None:
    """X may go 5 mm/s along an arc of R16.5, and its acceleration changes sign while the path brakes."""
    machine = dataclasses.replace(
        mill(),
        velocity=np.array([5.0, 5.0, 19.0, 5.0]),
        acceleration=np.full(4, 50.0),
        jerk=np.array([500.0, 500.0, 510.0, 500.0]),
        path_acceleration=50.0,
        path_jerk=501.0,
    )
    program = Program().arc((-16.5, 0.0, 0.5), (0.0, 1.0, 0.0), 87.0, feed=None)
    assert np.abs(run(program, machine).velocity[:, 0]).max() <= 5.0 * (1.0 + 1e-9)


def test_a_brake_that_begins_within_a_run_keeps_the_jerk() -> None:
    """There the acceleration was 2.6 times what the bounds allow, and Y's jerk 1.3 times its limit."""
    machine = dataclasses.replace(
        mill(),
        velocity=np.array([496.0, 496.0, 14.0, 85.0]),
        acceleration=np.array([16091.0, 5527.0, 4820.0, 1043.0]),
        jerk=np.array([16671.0, 4212.0, 771169.0, 431087.0]),
        path_acceleration=6335.0,
        path_jerk=56346.0,
    )
    program = Program()
    program.arc((-7.6, 10.4, 0.0), (0.0, 0.0, 1.0), -210.0, advance=1.2, turn=-22.0, feed=28041.0)
    for pressed in range(101, 116, 7):
        motion = live(program, machine, 1.5)
        parts = [motion.advance(pressed)]
        motion.feed_override = 0.5
        while not motion.finished:
            parts.append(motion.advance(500))
        assert_within_limits(join(parts), machine, PERIOD)


@pytest.mark.parametrize(("radius", "longest"), [(0.5, 1.3), (5.0, 1.7)])
def test_a_hold_leaves_a_run_before_its_end(radius: float, longest: float) -> None:
    """It comes back to the plan of the bounds first, whose own brake takes 1.1 s and 1.5 s."""
    program = circles(radius, 20)
    whole = len(run(program, mill()))
    for share in (0.02, 0.15, 0.3, 0.45):
        motion = live(program, mill(), 1.5)
        parts = [motion.advance(int(share * whole))]
        motion.hold()
        while not motion.standing:
            parts.append(motion.advance(10))
            assert sum(len(part) for part in parts) < whole
        held = sum(len(part) for part in parts) - int(share * whole)
        assert held * PERIOD < longest
        motion.start()
        while not motion.finished:
            parts.append(motion.advance(500))
        setpoints = join(parts)
        assert_on_path(setpoints, program.moves, ZERO)
        assert_within_limits(setpoints, mill(), PERIOD)
        assert_consistent(setpoints, mill(), PERIOD)


@FEWER
@given(round_programs(), st.lists(st.tuples(st.integers(1, 400), st.floats(0.0, 1.5)), max_size=5))
def test_any_feed_override_keeps_the_limits_of_round_programs(
    program: Program, turned: list[tuple[int, float]]
) -> None:
    motion = live(program, mill(), 1.5)
    parts = [motion.advance(1)]
    for wait, override in [*turned, (1, 1.0)]:
        parts.append(motion.advance(wait))
        motion.feed_override = override
    while not motion.finished:
        parts.append(motion.advance(500))
    setpoints = join(parts)
    assert_within_limits(setpoints, mill(), PERIOD, knees=True)
    assert np.array_equal(setpoints.position[-1], program.position + ZERO)
