"""What a log of ten samples a second tells, and what a page says of one that tells too little."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from machine_logs import COLUMNS, REAL, mill

from twin.calibrate.calibrate import calibrate
from twin.calibrate.jumps import jumps_of
from twin.calibrate.report.page import calibration_page
from twin.calibrate.result import verdict_sentence
from twin.logs.column_map import read_column_map
from twin.logs.machine_log import AxisLog, MachineLog, read_machine_log

PERIOD = 0.1
TRAIL_S = 0.012
"""How far the axis trails its command."""
MICHIGAN = [REAL / "umich_mill" / f"experiment_{number}.csv" for number in ("01", "03")]
needs_michigan = pytest.mark.skipif(
    not MICHIGAN[0].is_file(), reason=f"needs the logs of real machines in {REAL}"
)


def feeds(count: int = 400) -> MachineLog:
    """There and back at 40 mm/s, and one peck of 3 mm within a sample."""
    time = np.asarray(np.arange(count) * PERIOD, np.float64)
    travelled = np.maximum(40.0 * (time - 4.0), 0.0)
    command = 60.0 - np.abs(60.0 - travelled % 120.0)
    command[15:25] = 3.0
    actual = command - TRAIL_S * np.gradient(command, PERIOD)
    axis = AxisLog("linear", command, actual, {}, COLUMNS)
    return MachineLog("slow.csv", time, {"X": axis}, np.zeros(count, np.int64))


def with_repeated_rows(log: MachineLog) -> MachineLog:
    """The same with ten rows of another time every forty, as a logger that starts again writes them."""
    axis = log.axes["X"]
    command, actual = axis.command.copy(), axis.actual.copy()
    for begin in range(60, len(command) - 10, 40):
        command[begin : begin + 10] = actual[begin : begin + 10] = 120.0
    return dataclasses.replace(
        log, axes={"X": dataclasses.replace(axis, command=command, actual=actual)}
    )


def test_rows_of_another_time_are_found_and_motion_is_not() -> None:
    log = feeds()
    assert not jumps_of(log, PERIOD).any()
    wrong = with_repeated_rows(log)
    steps = np.flatnonzero(jumps_of(wrong, PERIOD))
    begins = np.arange(60, 390, 40)
    assert steps.tolist() == sorted([*(begins - 1), *(begins + 9)])


def test_rows_of_another_time_are_told_and_do_not_spoil_a_lag() -> None:
    base = mill()
    sound, wrong = feeds(), with_repeated_rows(feeds())
    result = calibrate(base, [sound], [dataclasses.replace(wrong, name="wrong.csv")])
    told = {one.code: one.message for one in result.findings["wrong.csv"]}
    assert "18 times as no axis moves, first from row 60 to 61" in told["jump"]
    # An axis that turns round between two samples leaves what straight lines do not show.
    assert result.logs[1].share < 0.1
    assert not result.logs[1].lag_is_unexplained
    assert "jump" not in {one.code for one in result.findings["slow.csv"]}


def test_what_ramps_need_is_named_where_the_map_lacks_it() -> None:
    told = {one.code: one.message for one in calibrate(mill(), [feeds()]).findings["slow.csv"]}
    assert "map lacks: X command_velocity, velocity, command_acceleration" in told["slow"]


@pytest.mark.parametrize(
    ("other_trail", "said"),
    [(0.3, "is worse than no model"), (0.6, "unexplained; "), (0.95, "predicts the lag")],
)
def test_a_lag_that_is_not_predicted_is_no_green_page(other_trail: float, said: str) -> None:
    log = feeds()
    axis = log.axes["X"]
    other = dataclasses.replace(
        axis, actual=axis.command - other_trail * (axis.command - axis.actual)
    )
    unseen = MachineLog("unseen.csv", log.time, {"X": other}, log.line)
    result = calibrate(mill(), [log], [unseen])
    sentence = verdict_sentence("X", result.axes["X"], result.logs)
    assert said in sentence
    page = calibration_page(result)
    green = said == "predicts the lag"
    assert ('class="verdict fail"' not in page) == green
    assert ("More than half of the logged lag is left unexplained (unseen.csv, X)" in page) != green


def _map(folder: Path, roles: dict[str, str]) -> Path:
    lines = [f"period = {PERIOD}"]
    for name in "XYZ":
        lines.append(f"[columns.{name}]")
        for role, column in roles.items():
            unit = "mm" + "/s" * ("velocity" in role) + "/s2" * ("acceleration" in role)
            lines.append(f'{role} = {{ column = "{name}1_{column}", unit = "{unit}" }}')
    (folder / "map.toml").write_text("\n".join(lines), encoding="utf-8")
    return folder / "map.toml"


_POSITIONS = {"command": "CommandPosition", "actual": "ActualPosition"}
_RAMPS = {
    "command_velocity": "CommandVelocity",
    "velocity": "ActualVelocity",
    "command_acceleration": "CommandAcceleration",
}


@needs_michigan
@pytest.mark.seconds("ramps of two logs of a real mill are simulated")
def test_ramps_of_a_real_mill_are_predicted_in_a_run_that_was_not_seen(tmp_path: Path) -> None:
    columns = read_column_map(_map(tmp_path, _POSITIONS | _RAMPS))
    first, third = (read_machine_log(path, columns) for path in MICHIGAN)
    result = calibrate(mill(), [first], [third])
    held = {one.axis: one.judged_share for one in result.logs if one.role == "hold-out"}
    assert held["X"] < 0.18
    assert held["Y"] < 0.22
    assert held["Z"] < 0.08
    lines = [one.ramps_line for one in result.logs]
    assert any(
        "03.csv, X: lag of velocity within 19 ramps: 4.81 mm/s rms" in line for line in lines
    )
    assert "in 19 ramps of a log" in verdict_sentence("X", result.axes["X"], result.logs)
    fit = result.axes["X"].fit
    assert "kv" in fit.undetermined
    assert fit.conditional["velocity_feedforward"][1] == ("kv",)
    assert "holds for the base's kv" in fit.undetermined["velocity_feedforward"]
    assert "jump" in {one.code for one in result.findings[third.name]}


@needs_michigan
@pytest.mark.seconds("two logs of a real mill are fitted and a page is drawn")
def test_positions_of_a_real_mill_alone_are_no_green_page(tmp_path: Path) -> None:
    columns = read_column_map(_map(tmp_path, _POSITIONS))
    first, third = (read_machine_log(path, columns) for path in MICHIGAN)
    result = calibrate(mill(), [first], [third])
    held = [one for one in result.logs if one.role == "hold-out"]
    # Its positions have three digits: steps of 1 mm in X, and lags of a tenth of it.
    assert max(one.share for one in held) < 1.2
    assert all(one.lag_is_unexplained for one in held if one.axis != "Z")
    assert 'class="verdict fail"' in calibration_page(result)
