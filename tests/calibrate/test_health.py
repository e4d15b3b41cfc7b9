"""What is wrong with a log is found and said, with what can still be fitted."""

import dataclasses

import numpy as np
import pytest
from machine_logs import mill
from other_drive import KV, Logger, log_of

from twin.calibrate.calibrate import calibrate
from twin.calibrate.fit.solve import Interval
from twin.calibrate.health import look_at_axis, look_at_clock, look_at_fit, look_at_motion
from twin.calibrate.result import Calibration
from twin.logs.machine_log import MachineLog

pytestmark = pytest.mark.seconds("a machine is simulated, and fitted to its log")


def found(log: MachineLog) -> tuple[Calibration, dict[str, str]]:
    """The calibration, and the findings about the log by their code."""
    result = calibrate(mill(), [log])
    return result, {one.code: one.message for one in result.findings[log.name]}


def told_of_clock(log: MachineLog) -> dict[str, str]:
    """The findings about the clock of a log by their code."""
    return {one.code: one.message for one in look_at_clock(log).findings}


def holds_the_truth(result: Calibration) -> bool:
    interval = result.axes["X"].fit.fitted["kv"]
    return interval.low <= KV <= interval.high and abs(interval.value / KV - 1.0) < 0.05


def test_a_sound_log_has_no_findings() -> None:
    result, findings = found(log_of(Logger()))
    assert not findings
    assert holds_the_truth(result)


def test_ten_samples_a_second_are_too_few_for_dynamics() -> None:
    result, findings = found(log_of(Logger(period_s=0.1), seconds=12.0))
    assert set(findings) == {"slow"}
    assert "the lag as a whole" in findings["slow"]
    assert {"kv", "damping_ratio"} <= set(result.axes["X"].fit.undetermined)


def test_coarse_steps_are_told_beside_the_lag_that_they_hide() -> None:
    _, findings = found(log_of(Logger(noise=0.0, step=0.5)))
    assert "steps of 500 µm" in findings["coarse"]


@pytest.mark.thorough
def test_columns_that_were_taken_at_different_times_are_told_from_lag() -> None:
    result, findings = found(log_of(Logger(late_s=0.004, current=True)))
    assert set(findings) == {"skew"}
    assert "X: actual position is logged" in findings["skew"]
    assert result.axes["X"].fit.fitted["delay"].value == pytest.approx(0.004, abs=4e-4)
    assert holds_the_truth(result)


def test_a_filtered_column_is_told_from_lag_and_from_skew() -> None:
    result, findings = found(log_of(Logger(filter_s=0.006, current=True)))
    assert "filtered" in findings
    assert "loop gain, damping and friction can still be fitted" in findings["filtered"]
    assert result.axes["X"].fit.fitted["measuring_filter"].value == pytest.approx(0.006, rel=0.1)
    assert holds_the_truth(result)


@pytest.mark.thorough
def test_a_filter_is_seen_from_the_noise_of_positions_alone() -> None:
    """Behind a filter or behind one of the command, the motion is the same; the noise is not."""
    result, findings = found(log_of(Logger(filter_s=0.006)))
    assert "noise falls off towards high frequencies" in findings["filtered"]
    assert result.axes["X"].fit.fitted["measuring_filter"].value == pytest.approx(0.006, rel=0.1)
    assert holds_the_truth(result)


def test_gaps_and_a_clock_that_jumps_back_are_stepped_over() -> None:
    log = log_of(Logger())
    time = log.time.copy()
    time[1500:] += 0.4
    time[2600:] -= 1.0
    result, findings = found(dataclasses.replace(log, time=time))
    assert set(findings) == {"gap", "clock-jump"}
    assert holds_the_truth(result)


def test_a_clock_that_stands_is_a_jump_too() -> None:
    log = log_of(Logger())
    time = log.time.copy()
    time[2000:] -= 0.001
    assert "stops or jumps back" in told_of_clock(dataclasses.replace(log, time=time))["clock-jump"]


def test_uneven_samples_are_told() -> None:
    log = log_of(Logger())
    shaken = 0.0004 * np.random.default_rng(1).uniform(-1.0, 1.0, len(log.time))
    assert (
        "as they are" in told_of_clock(dataclasses.replace(log, time=log.time + shaken))["uneven"]
    )


def test_a_command_that_is_held_over_samples_is_told() -> None:
    log = log_of(Logger())
    axis = log.axes["X"]
    held = np.repeat(axis.command[::8], 8)[: len(axis.command)]
    (finding,) = look_at_axis("X", dataclasses.replace(axis, command=held), look_at_clock(log))
    assert finding.code == "held"
    assert "every 8 ms only" in finding.message


def test_positions_of_another_scale_or_another_zero_are_told() -> None:
    log = log_of(Logger())
    axis = log.axes["X"]
    for actual, code, told in (
        (axis.actual, None, ""),
        (axis.actual * 1.05, "scale", "actual moves 1.048 times as far"),
        (axis.actual + 5.0, "offset", "actual stands 5 mm off it"),
    ):
        wrong = dataclasses.replace(axis, actual=actual)
        findings = {one.code: one.message for one in look_at_motion("X", wrong, 0.001)}
        assert code is None or told in findings[code]
        assert code is not None or not findings


def test_a_mass_far_from_the_base_s_is_told_as_another_unit() -> None:
    fitted = {"mass": Interval(26416.0, 26400.0, 26430.0)}
    (finding,) = look_at_fit("X", fitted, 1040.0, filtered=False)
    assert finding.code == "unit"
    assert "25.4 times the base's" in finding.message
    assert not look_at_fit("X", fitted, 20000.0, filtered=False)
