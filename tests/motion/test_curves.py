"""Moves of a tip that is led: the planner keeps the path, the limits and the feed of the tip."""

import dataclasses

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import settings as examples
from hypothesis import strategies as st
from motion_checks import assert_consistent, assert_within_limits

from tests.five_axes import on_machine, settings, trunnion
from tests.nc.running import run
from twin.machine.watching.travel import move_bounds
from twin.motion.limits import MotionLimits
from twin.motion.planner import plan
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Chunk, FloatArray, Moves, Shape
from twin.nc.path.tool_center.tool_center import ToolCenter

PERIOD = 0.001
SETTINGS = settings(on_machine(trunnion()))
TIP = ToolCenter(on_machine(trunnion()), 0.0, [0.0] * 5)
LIMITS = MotionLimits(
    velocity=np.array([500.0, 500.0, 500.0, 90.0, 240.0]),
    acceleration=np.array([4000.0, 4000.0, 4000.0, 600.0, 1500.0]),
    jerk=np.array([5e4, 5e4, 5e4, 8e3, 1.5e4]),
    path_acceleration=4000.0,
    path_jerk=5e4,
    rotary_path_acceleration=600.0,
    rotary_path_jerk=8e3,
    junction_velocity_step=np.array([1.0, 1.0, 1.0, 0.5, 0.5]),
    junction_acceleration_step=np.array([400.0, 400.0, 400.0, 100.0, 150.0]),
)
START = "O1\nG64\nG43.4 H1\n"


def _planned(program: str) -> tuple[Moves, Setpoints]:
    outcome = run(program, "fanuc", SETTINGS)
    assert outcome.error is None, outcome.error
    zero = np.zeros(5)
    start = outcome.moves.start[0]
    made = plan([Chunk(outcome.moves)], LIMITS, period_s=PERIOD, part_zero=zero, start=start)
    parts = list(made)
    columns = {
        field.name: np.concatenate([getattr(part, field.name) for part in parts])
        for field in dataclasses.fields(Setpoints)
    }
    return outcome.moves, Setpoints(**columns)


def _tips(positions: FloatArray) -> FloatArray:
    return np.array([TIP.tip(place.tolist()) for place in positions])


def _contour(targets: list[tuple[float, ...]], feed: float) -> str:
    lines = [f"X{x:.3f} Y{y:.3f} Z{z:.3f} A{a:.3f} C{c:.3f}" for x, y, z, a, c in targets]
    return START + f"G1 F{feed:.0f}.\n" + "\n".join(lines) + "\nM30\n"


_TARGETS = st.tuples(
    *[st.floats(-60.0, 60.0)] * 3, st.floats(-80.0, 80.0), st.floats(-300.0, 300.0)
)


@examples(max_examples=8, deadline=None)
@given(st.lists(_TARGETS, min_size=1, max_size=4), st.sampled_from((300.0, 3000.0, 20000.0)))
def test_every_program_keeps_the_limits(targets: list[tuple[float, ...]], feed: float) -> None:
    assume(any(any(target) for target in targets))
    _, setpoints = _planned(_contour(targets, feed))
    assert_within_limits(setpoints, LIMITS, PERIOD, knees=True)
    assert_consistent(setpoints, LIMITS, PERIOD, knees=True)
    assert np.all(setpoints.velocity[[0, -1]] == 0.0)


def test_the_tip_is_on_its_line_at_every_instant() -> None:
    target = (40.0, -10.0, 5.0, 50.0, 170.0)
    _, setpoints = _planned(_contour([target], 2000.0))
    tips = _tips(setpoints.position)
    way = np.array(target)
    share = tips[:, :3] @ way[:3] / (way[:3] @ way[:3])
    assert np.abs(tips - share[:, None] * way).max() < 2e-9


def test_f_counts_the_way_of_the_tip() -> None:
    _, setpoints = _planned(_contour([(60.0, 0.0, 0.0, 10.0, 20.0)], 600.0))
    speed = np.linalg.norm(np.diff(_tips(setpoints.position)[:, :3], axis=0), axis=1) / PERIOD
    assert speed.max() == pytest.approx(10.0, rel=1e-6)
    assert np.median(speed) == pytest.approx(10.0, rel=1e-6)


def test_a_rapid_of_the_tip_does_not_stop_within() -> None:
    moves, setpoints = _planned(START + "G0 X60. Y20. Z5. A40. C90.\nM30\n")
    assert len(moves) > 20
    speed = np.linalg.norm(np.diff(_tips(setpoints.position)[:, :3], axis=0), axis=1)
    moving = speed > 0.05 * speed.max()
    # One stretch of motion, from the first instant to the last.
    assert np.count_nonzero(np.diff(moving.astype(int)) == 1) == 1
    whole = len(setpoints) * PERIOD
    assert whole < 3.0


def test_a_stop_asked_for_between_blocks_is_one() -> None:
    program = _contour([(30.0, 0.0, 0.0, 20.0, 40.0), (60.0, 5.0, 0.0, 0.0, 60.0)], 3000.0)
    _, setpoints = _planned(program.replace("G64", "G61"))
    speed = np.linalg.norm(setpoints.velocity, axis=1)
    # The instant of the stop lies between two ticks.
    assert speed[50:-50].min() < 1e-3 * speed.max()


def test_a_curve_knows_how_far_it_goes() -> None:
    moves, _ = _planned(_contour([(10.0, 0.0, 0.0, 70.0, 200.0)], 2000.0))
    low, high = move_bounds(moves)
    curves = np.flatnonzero(moves.shape == Shape.CURVE)
    assert moves.curve is not None
    fraction = np.linspace(0.0, 1.0, 400)[:, None, None] ** np.arange(1, 6)
    for row in curves:
        places = moves.start[row] + np.sum(moves.curve[row] * fraction, axis=2)
        assert places.max(axis=0) == pytest.approx(high[row], abs=1e-6)
        assert places.min(axis=0) == pytest.approx(low[row], abs=1e-6)
