"""A log that is not what it is said to be is refused with the reason."""

import dataclasses
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_line import Twin
from machine_logs import logged, mill, strokes, with_axis, without_force, write_log

from twin.calibrate.calibrate import calibrate
from twin.calibrate.health import resolution
from twin.calibrate.refusal import straight_law
from twin.errors import UsageError
from twin.logs.machine_log import AxisLog, MachineLog
from twin.nc.canonical import FloatArray


@pytest.fixture(scope="module")
def log() -> MachineLog:
    return logged(mill(), strokes(4.0))


def swapped(axis: AxisLog) -> AxisLog:
    return dataclasses.replace(axis, command=axis.actual, actual=axis.command)


def scaled(factor: float) -> Callable[[AxisLog], AxisLog]:
    return lambda axis: dataclasses.replace(axis, actual=axis.actual * factor)


def both_scaled(factor: float) -> Callable[[AxisLog], AxisLog]:
    return lambda axis: dataclasses.replace(
        axis, actual=axis.actual * factor, command=axis.command * factor
    )


def of_another_axis(axis: AxisLog) -> AxisLog:
    time = np.arange(len(axis.actual))
    return dataclasses.replace(axis, actual=30.0 * np.sin(time / 211.0))


def dropped(axis: AxisLog) -> AxisLog:
    actual = axis.actual.copy()
    actual[1200:1203] = -5000.0
    return dataclasses.replace(axis, actual=actual)


def pushing_back(axis: AxisLog) -> AxisLog:
    return dataclasses.replace(axis, more={"force": -axis.more["force"]})


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        (swapped, "actual leads command by 8.* swapped"),
        (scaled(1 / 25.4), "one of them is in inches"),
        (scaled(1000.0), "micrometres"),
        (scaled(-1.0), "the other sense"),
        (both_scaled(1000.0), "the unit of position or of time is another one"),
        (both_scaled(1e-6), "the unit is another one"),
        (of_another_axis, "position of another axis"),
        (pushing_back, "scale of the other sign"),
        (dropped, "jumps by .* between samples 1200 and 1201"),
        (lambda axis: dataclasses.replace(axis, actual=axis.command), "the same quantity"),
        (lambda axis: dataclasses.replace(axis, kind="rotary"), "rotary axis, the base's X"),
        (lambda axis: dataclasses.replace(axis, command=axis.command * 0), "does not move"),
    ],
)
def test_a_wrong_log_is_refused_with_the_reason(
    log: MachineLog, wrong: Callable[[AxisLog], AxisLog], told: str
) -> None:
    with pytest.raises(UsageError, match=told):
        calibrate(mill(), [with_axis(log, wrong(log.axes["X"]))])


def test_an_axis_that_the_base_lacks_is_refused(log: MachineLog) -> None:
    with pytest.raises(UsageError, match="no axis U: it has X, Y, Z, C"):
        calibrate(mill(), [dataclasses.replace(log, axes={"U": log.axes["X"]})])
    with pytest.raises(UsageError, match="no log has axis Y"):
        calibrate(mill(), [log], axes=["Y"])


@pytest.mark.parametrize(
    ("rows", "clock", "told"),
    [
        (slice(0, 10), 1.0, "has 10 samples; a fit needs 50"),
        (slice(None), 0.0, "clock stops or jumps back at 3999 of 4000 samples"),
        (slice(None), -1.0, "give the map a 'period' in place of 'time'"),
        (slice(None), np.where(np.arange(4000) % 40, 1.0, 20.0), "without a gap"),
    ],
)
def test_a_clock_that_leaves_nothing_to_fit_is_refused_with_the_reason(
    log: MachineLog, rows: slice, clock: float | FloatArray, told: str
) -> None:
    time = np.cumsum(0.001 * clock * np.ones(4000)).astype(np.float64)[rows]
    axis = log.axes["X"]
    less = dataclasses.replace(
        axis, command=axis.command[rows], actual=axis.actual[rows],
        more={role: values[rows] for role, values in axis.more.items()},
    )  # fmt: skip
    with pytest.raises(UsageError, match=told):
        calibrate(mill(), [MachineLog("own.csv", time, {"X": less}, log.line[rows])])


def test_a_log_may_rest_before_its_first_gap(log: MachineLog) -> None:
    axis = log.axes["X"]
    still = 100
    command = np.concatenate([np.full(still, axis.command[0]), axis.command])
    actual = np.concatenate([np.full(still, axis.actual[0]), axis.actual])
    before: FloatArray = np.linspace(-0.5, -0.401, still)
    time = np.concatenate([before, log.time])
    rested = MachineLog(
        "own.csv", time,
        {"X": dataclasses.replace(axis, command=command, actual=actual * 1000.0, more={})},
        np.zeros(len(time), np.int64),
    )  # fmt: skip
    with pytest.raises(UsageError, match="micrometres"):
        calibrate(mill(), [rested])


def test_the_scale_of_a_circle_is_told(log: MachineLog) -> None:
    """On a circle acceleration is a multiple of position: no law may divide motion among them."""
    phase = np.arange(0.0, 6.0, 0.001)
    circle = dataclasses.replace(
        log.axes["X"], command=50.0 * np.cos(phase), actual=50.0 * np.cos(phase - 0.008), more={}
    )
    ratio, lead, left = straight_law(circle, 0.001)
    assert ratio == pytest.approx(1.0, abs=1e-3)
    assert lead == pytest.approx(-0.008, rel=1e-3)
    assert left < 1e-3


def test_a_slow_log_is_fitted_as_far_as_it_tells(log: MachineLog) -> None:
    axis = log.axes["X"]
    every = slice(0, None, 50)
    slow = without_force(
        dataclasses.replace(
            log, time=log.time[every], line=log.line[every],
            axes={"X": dataclasses.replace(
                axis, command=axis.command[every], actual=axis.actual[every], more={})},
        )
    )  # fmt: skip
    result = calibrate(mill(), [slow])
    assert [finding.code for finding in result.findings["own.csv"]] == ["slow"]
    fit = result.axes["X"].fit
    assert {"kv", "damping_ratio", "mass"} <= set(fit.undetermined)
    assert fit.parameters.kv == mill().axis("X").kv
    assert fit.fitted["delay"].low < 0.0 < fit.fitted["delay"].high


@pytest.mark.parametrize(("rapid", "told"), [(2000.0, False), (500.0, True)])
def test_friction_that_grows_with_speed_is_not_extrapolated(
    log: MachineLog, rapid: float, told: bool
) -> None:
    axis, every = log.axes["X"], slice(0, None, 50)
    current = axis.more["force"][every] / 100.0
    slow = dataclasses.replace(
        log, time=log.time[every], line=log.line[every],
        axes={"X": dataclasses.replace(axis, command=axis.command[every], actual=axis.actual[every],
                                       more={"current": current})},
    )  # fmt: skip
    fit = calibrate(mill(velocity=rapid), [slow]).axes["X"].fit
    assert ("viscous_friction" in fit.conditional) == told
    assert "viscous_friction" in fit.undetermined
    if not told:
        assert "would be extrapolated" in fit.undetermined["viscous_friction"]
        assert fit.parameters.viscous_friction == mill().axis("X").viscous_friction


def test_the_step_of_quantised_values_is_found() -> None:
    draw = np.random.default_rng(2)
    values = draw.standard_normal(500)
    assert resolution(np.round(values, 2)) == pytest.approx(0.01)
    assert resolution(values) == 0.0


@pytest.mark.seconds("a machine is fitted")
def test_require_turns_a_share_into_an_exit_code(twin: Twin, tmp_path: Path) -> None:
    first = write_log(tmp_path / "first.csv", logged(mill(), strokes(2.0)))
    other = write_log(tmp_path / "other.csv", logged(mill(kv=5.0), strokes(1.5)))
    for held, code in ((first, 0), (other, 1)):
        done = twin("calibrate", first, "--hold-out", held, "--require", "0.1")
        assert done.code == code, done.stderr
    assert twin("calibrate", first, "--require", "0.1").code == 2
    assert twin("calibrate", tmp_path / "no.csv").code == 2
    (tmp_path / "bad.csv").write_text("a,b\n1,2\n3,4\n", encoding="utf-8")
    done = twin("calibrate", tmp_path / "bad.csv")
    assert done.code == 2
    assert "[columns.X]" in done.stderr
