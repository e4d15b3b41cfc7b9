from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from motion_programs import AXES, SETTINGS, Program, duration, limits, mill, programs, run

from twin.motion.limits import MotionLimits
from twin.motion.report.drawing import draw_plan
from twin.motion.report.reasons import FEED, SHORT, STOP
from twin.motion.report.summary import Cause, Summary, summarize
from twin.nc.canonical import Corner


def summary_of(program: Program, machine: MotionLimits) -> Summary:
    return summarize(program.chunks(), machine, start=program.start, axes=AXES)


def test_time_by_move_adds_up_to_the_cycle_time() -> None:
    program = Program().line(50.0, 0.0, 0.0, 0.0, feed=6000.0).dwell(0.25)
    program.corner = Corner.EXACT_PATH
    for i in range(20):
        program.line(50.0, 0.1 * (i + 1), 0.0, 0.0, feed=6000.0)
    program.arc((40.0, 2.0, 0.0), (0.0, 0.0, 1.0), 270.0, feed=3000.0)
    summary = summary_of(program, mill())
    assert summary.total == pytest.approx(duration(program, mill()), rel=1e-9)
    assert list(summary.move) == [0, 0, *range(1, 22)]
    assert summary.seconds[1, Cause.DWELL] == 0.25
    assert np.all(summary.lost() > -1e-9)
    # 50 mm at 100 mm/s: 0.1 s up, 0.1 s down, the rest at the feed (v 100, a 2000, j 40000).
    assert summary.seconds[0, Cause.SPEEDING_UP] == pytest.approx(0.1)
    assert summary.seconds[0].sum() == pytest.approx(0.6)
    assert summary.ideal[0] == pytest.approx(0.5)
    assert sum(summary.by_cause().values()) == pytest.approx(summary.total)


@SETTINGS
@given(programs(most=10, corners=tuple(Corner)), limits())
def test_reasons_account_for_all_that_is_lost(program: Program, machine: MotionLimits) -> None:
    summary = summary_of(program, machine)
    for lost, reasons in zip(summary.lost(), summary.lost_to, strict=True):
        assert sum(reasons.values()) == pytest.approx(lost, abs=1e-9 * (1.0 + summary.total))


def test_stops_of_a_single_move() -> None:
    summary = summary_of(Program().line(50.0, 0.0, 0.0, 0.0, feed=6000.0), mill())
    assert summary.by_reason()[STOP] == pytest.approx(0.1)
    assert summary.ramps == pytest.approx({"path jerk": 0.2})


def test_knees_are_named_by_their_axis() -> None:
    program = Program()
    program.corner = Corner.EXACT_PATH
    program.line(30.0, 0.0, 0.0, 0.0, feed=6000.0).line(60.0, 5.0, 0.0, 0.0, feed=6000.0)
    summary = summary_of(program, mill(junction_velocity_step=1.0))
    assert "junction step of the velocity of Y" in summary.by_reason()
    assert summary.lost_to[0]["junction step of the velocity of Y"] > 0.01


def test_axes_and_curves_are_named() -> None:
    fast = Program().line(300.0, 0.0, 0.0, 0.0, feed=60000.0)
    assert "velocity of X" in summary_of(fast, mill()).by_reason()
    circle = Program().arc((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), 3600.0, feed=60000.0)
    reasons = summary_of(circle, mill()).by_reason()
    assert max(reasons, key=lambda name: reasons[name]).startswith("jerk of ")
    slow = Program().line(3.0, 0.0, 0.0, 0.0, feed=60.0)
    assert summary_of(slow, mill()).by_reason()[FEED] == 0.0


def test_short_blocks_are_named() -> None:
    program = Program()
    program.corner = Corner.EXACT_PATH
    for i in range(1, 5):
        program.line(0.4 * i, 0.1 * (i % 2), 0.0, 0.0, feed=60000.0)
    reasons = summary_of(program, mill(junction_velocity_step=30.0)).by_reason()
    assert SHORT in reasons or any("junction step" in name for name in reasons)


def test_program_without_moves_takes_no_time() -> None:
    summary = summary_of(Program(), mill())
    assert summary.total == 0.0
    assert len(summary.move) == 0


@pytest.mark.parametrize("suffix", ["svg", "png"])
@pytest.mark.parametrize("seconds", [1, 600])
def test_drawing_is_written(tmp_path: Path, suffix: str, seconds: int) -> None:
    program = Program().line(50.0, 0.0, 0.0, 90.0, feed=3000.0 / seconds)
    picture = tmp_path / f"plan.{suffix}"
    setpoints = run(program, mill())
    draw_plan([setpoints[:100], setpoints[100:]], AXES, len(setpoints), picture)
    assert picture.stat().st_size > 1000
