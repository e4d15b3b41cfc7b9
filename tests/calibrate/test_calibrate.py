"""From a log to a machine file: what is told is true, and what is not told is said."""

import dataclasses
import json
import os
from pathlib import Path

import numpy as np
import pytest
from command_line import Twin
from machine_logs import (
    EMPS,
    EMPS_MAP,
    logged,
    mill,
    needs_real_logs,
    strokes,
    with_axis,
    without_force,
    write_log,
)
from scipy.io import loadmat

from twin.calibrate.calibrate import calibrate
from twin.calibrate.result import Calibration
from twin.files.shipped import machine_file
from twin.logs.column_map import AxisColumns, ColumnTable, ExternalForceTable, read_column_map
from twin.logs.machine_log import AxisLog, MachineLog, read_machine_log
from twin.machine.load import read_machine

pytestmark = pytest.mark.seconds("a machine is simulated, and fitted to its log")

TRUTH = {
    "kv": 5.0, "damping_ratio": 0.7, "dry_friction": 350.0, "viscous_friction": 3.0,
    "constant_force": 40.0, "mass": 800.0,
}  # fmt: skip


def noisy(log: MachineLog, seed: int = 1) -> MachineLog:
    axis, draw = log.axes["X"], np.random.default_rng(seed)
    actual = np.round(axis.actual + 0.5e-3 * draw.standard_normal(len(axis.actual)), 3)
    more = {
        role: values + 5.0 * draw.standard_normal(len(values)) for role, values in axis.more.items()
    }
    return with_axis(log, dataclasses.replace(axis, actual=actual, more=more))


@pytest.fixture(scope="module")
def forced() -> MachineLog:
    return noisy(logged(mill(**TRUTH)))


@pytest.fixture(scope="module")
def with_force(forced: MachineLog) -> Calibration:
    return calibrate(mill(), [forced])


def test_with_a_force_everything_is_told(with_force: Calibration) -> None:
    fit = with_force.axes["X"].fit
    for name, true in TRUTH.items():
        found = fit.fitted[name]
        assert found.value == pytest.approx(true, rel=0.03), name
        assert found.low < true < found.high, name
    assert not fit.conditional
    (figures,) = with_force.logs
    assert figures.share < 0.01
    assert figures.force_share is not None
    assert figures.force_share < 0.1


def test_positions_alone_leave_mass_and_viscous_friction_open(forced: MachineLog) -> None:
    fit = calibrate(mill(), [without_force(forced)]).axes["X"].fit
    assert {"mass", "viscous_friction", "constant_force"} <= set(fit.undetermined)
    assert not {"mass", "constant_force"} & set(fit.fitted)
    assert "correlation 1.000" in fit.undetermined["viscous_friction"]
    assert fit.fitted["kv"].low < TRUTH["kv"] < fit.fitted["kv"].high
    ratio = 1041.154 / TRUTH["mass"]
    friction, given = fit.conditional["dry_friction"]
    assert given == ("mass",)
    assert friction.value == pytest.approx(TRUTH["dry_friction"] * ratio, rel=0.05)


def test_an_integrator_tells_viscous_friction_from_the_loop_gain() -> None:
    base, true = mill(reset_time_s=0.02), {"kv": 4.0, "damping_ratio": 0.5, "viscous_friction": 4.0}
    machine = base.changed("X", reset_time_s=0.03, dry_friction=300.0, **true)
    log = noisy(without_force(logged(machine, strokes(3.0))))
    fit = calibrate(base, [log]).axes["X"].fit
    friction, given = fit.conditional["viscous_friction"]
    assert given == ("mass",)
    assert friction.low < true["viscous_friction"] < friction.high < 1.5 * friction.value
    assert fit.fitted["kv"].value == pytest.approx(true["kv"], rel=0.01)
    assert fit.fitted["damping_ratio"].value == pytest.approx(true["damping_ratio"], rel=0.02)


def test_a_log_of_mill4_gives_mill4_back(twin: Twin, tmp_path: Path) -> None:
    mill4 = read_machine(machine_file("mill4"))
    log = write_log(tmp_path / "own.csv", logged(mill4, strokes(3.0)))
    done = twin("calibrate", log, "--out", tmp_path / "again.toml", "--json", tmp_path / "a.json")
    assert done.code == 0, done.stderr
    again, base = read_machine(tmp_path / "again.toml").axis("X"), mill4.axis("X")
    assert again.kv == pytest.approx(base.kv, rel=1e-4)
    assert again.damping_ratio == pytest.approx(base.damping_ratio, rel=1e-3)
    assert again.mass == pytest.approx(1041.154, rel=1e-3)
    assert again.reset_time_s == base.reset_time_s
    assert not again.loop_delay_s + again.velocity_filter_s + again.command_filter_s
    assert abs(again.dry_friction) < 0.5
    told = json.loads((tmp_path / "a.json").read_text(encoding="utf-8"))
    assert told["schema"] == 1
    assert told["axes"]["X"]["fitted"]["kv"]["unit"] == "(m/min)/mm"
    assert told["logs"][0]["share"] < 1e-4


def test_a_delay_of_the_log_is_told_from_the_loop(forced: MachineLog) -> None:
    axis = forced.axes["X"]
    late = np.interp(forced.time - 0.003, forced.time, axis.actual)
    log = with_axis(forced, dataclasses.replace(axis, actual=late))
    fit = calibrate(mill(), [log]).axes["X"].fit
    assert fit.fitted["delay"].value == pytest.approx(0.003, abs=2e-4)
    assert fit.fitted["kv"].low < TRUTH["kv"] < fit.fitted["kv"].high


def test_without_a_reversal_friction_is_not_told_from_a_constant_force() -> None:
    course = strokes()
    course = course[(np.cumsum(course[:, 1] < -1e-9) == 0)]
    fit = calibrate(mill(), [without_force(noisy(logged(mill(**TRUTH), course)))]).axes["X"].fit
    assert {"dry_friction", "constant_force"} & set(fit.undetermined)


def test_gaps_and_jumps_of_the_clock_are_said_and_stepped_over(forced: MachineLog) -> None:
    time = forced.time.copy()
    time[3000:] += 0.7
    time[4200:] -= 2.0
    result = calibrate(mill(), [dataclasses.replace(forced, time=time)])
    assert {finding.code for finding in result.findings["own.csv"]} == {"gap", "clock-jump"}
    assert result.axes["X"].fit.fitted["kv"].value == pytest.approx(TRUTH["kv"], rel=0.03)


@needs_real_logs
def test_emps_is_predicted_beyond_what_was_fitted(tmp_path: Path) -> None:
    (tmp_path / "map.toml").write_text(EMPS_MAP, encoding="utf-8")
    log = read_machine_log(EMPS, read_column_map(tmp_path / "map.toml"))
    first, second = part(log, slice(0, 6000), "first"), part(log, slice(6000, None), "second")
    result = calibrate(mill(), [first], [second])
    fitted = result.axes["X"].fit.fitted
    assert fitted["kv"].value == pytest.approx(9.61, rel=0.01)
    assert fitted["mass"].value == pytest.approx(95.1, rel=0.03)
    assert fitted["dry_friction"].value == pytest.approx(20.4, rel=0.10)
    assert fitted["viscous_friction"].value == pytest.approx(0.2035, rel=0.10)
    held = result.logs[1]
    assert held.share < 0.006
    assert held.force_share is not None
    assert held.force_share < 0.06


def part(log: MachineLog, rows: slice, name: str) -> MachineLog:
    axis = log.axes["X"]
    less = dataclasses.replace(
        axis, command=axis.command[rows], actual=axis.actual[rows],
        more={role: values[rows] for role, values in axis.more.items()},
    )  # fmt: skip
    return MachineLog(name, log.time[rows], {"X": less}, log.line[rows])


@pytest.mark.by_hand("TWIN_TEST_EMPS names the folder of the record, which no package brings")
def test_the_whole_record_of_emps_and_its_pulses_are_predicted() -> None:
    """Fitted to the first half; pulses are volts that are added to what the drive gives."""
    folder = Path(os.environ["TWIN_TEST_EMPS"])
    volt = ColumnTable(column="volt", unit="N")
    injected = ExternalForceTable(column="volt", unit="N", at="drive")

    def record(name: str, rows: slice) -> MachineLog:
        data = {key: np.ravel(value)[rows] for key, value in loadmat(folder / name).items()
                if np.size(value) > 1}  # fmt: skip
        newtons = float(loadmat(folder / name)["gtau"][0, 0])
        more, position = {"force": data["vir"] * newtons}, ColumnTable(column="q", unit="mm")
        if "pulses_N" in data:
            more["external_force"] = data["pulses_N"] * newtons
        columns = AxisColumns(
            command=position, actual=position, force=volt, external_force=injected
        )
        axis = AxisLog("linear", data["qg"] * 1e3, data["qm"] * 1e3, more, columns)
        return MachineLog(
            f"{name} {rows}", data["t"], {"X": axis}, np.zeros(len(data["t"]), np.int64)
        )

    half = 12421
    found = calibrate(
        mill(),
        [record("DATA_EMPS.mat", slice(0, half))],
        [record("DATA_EMPS.mat", slice(half, None)), record("DATA_EMPS_PULSES.mat", slice(None))],
    )
    _, second, pulses = found.logs
    assert second.share < 0.003
    assert pulses.share < 0.0095
