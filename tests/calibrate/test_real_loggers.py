"""Logs as real loggers make them: uneven, held, cut off, with spikes, lost references and empty cells."""

import dataclasses
from collections.abc import Iterator
from pathlib import Path

import integrated_axes
import numpy as np
import pytest
from integrated_axes import Axis, draw, fitted, misses
from machine_logs import COLUMNS
from other_drive import Logger, log_of

from twin.calibrate.defects import find_defects
from twin.calibrate.findings import LogFinding
from twin.calibrate.fit.simulation import command_of
from twin.calibrate.fit.solve import Interval
from twin.calibrate.fit.stretch import stretches_of
from twin.calibrate.health import look_at_clock, look_at_fit
from twin.calibrate.prepared import prepared
from twin.logs.column_map import ExternalForceTable
from twin.logs.machine_log import AxisLog, MachineLog


@pytest.fixture(scope="module")
def sound() -> MachineLog:
    return log_of(Logger(current=True))


def changed(log: MachineLog, **columns: np.ndarray) -> MachineLog:
    axis = log.axes["X"]
    more = dict(axis.more) | ({"current": columns.pop("current")} if "current" in columns else {})
    return dataclasses.replace(log, axes={"X": dataclasses.replace(axis, more=more, **columns)})


def told(log: MachineLog) -> dict[str, LogFinding]:
    found = find_defects("X", log.axes["X"], log.time, look_at_clock(log).stretches)
    return {one.code: one for one in found.findings}


@pytest.fixture(scope="module")
def short() -> Iterator[None]:
    """Half the time of the study's logs: each fit of these tests takes a second or two."""
    before, integrated_axes.SECONDS = integrated_axes.SECONDS, 4.0
    yield
    integrated_axes.SECONDS = before


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("axis", "code"),
    [
        (dataclasses.replace(draw("uneven", 1), period=0.004), "uneven"),
        (draw("held", 3), "repeated"),
        (draw("clipped", 5), "clipped"),
        (draw("clipped", 7), "clipped"),
    ],
    ids=["uneven", "held", "clipped", "clipped, and pieces that seem to lead"],
)
@pytest.mark.usefixtures("short")
def test_intervals_of_another_integrator_s_axis_hold_the_truth(axis: Axis, code: str) -> None:
    result = fitted(axis)
    count, wrong = misses(axis, result)
    assert count == len(axis.truth)
    assert not wrong
    assert code in {one.code for one in result.findings[result.logs[0].log]}


def test_a_sound_log_has_no_defects(sound: MachineLog) -> None:
    assert not told(sound)


def test_a_spike_is_named_with_its_row_and_left_out(sound: MachineLog) -> None:
    actual = sound.axes["X"].actual.copy()
    actual[1234] += 0.7
    log = changed(sound, actual=actual)
    assert "first in row 1235" in told(log)["spike"].message
    (piece,) = prepared(log, "fit").stretches("X")
    assert not piece.seen[1234]
    assert np.count_nonzero(~piece.seen[200:]) == 3


def test_a_lost_reference_is_named_and_the_longest_part_is_kept(sound: MachineLog) -> None:
    actual = sound.axes["X"].actual.copy()
    actual[2600:] += 0.25
    log = changed(sound, actual=actual)
    found = told(log)
    assert set(found) == {"reference"}
    message = found["reference"].message
    assert "mm in row 2601" in message
    assert float(message.split("jumps by ")[1].split(" mm")[0]) == pytest.approx(0.25, abs=0.005)
    assert prepared(log, "fit").rows("X") == ((0, 2600),)


def test_single_repetitions_are_named_and_left_out(sound: MachineLog) -> None:
    random = np.random.default_rng(5)
    rows = np.arange(len(sound.time))
    rows[1:] -= random.uniform(size=len(rows) - 1) < 0.1
    axis = sound.axes["X"]
    log = changed(sound, command=axis.command[rows], actual=axis.actual[rows])
    assert "repeats the sample before" in told(log)["repeated"].message


def test_a_force_that_rests_at_its_end_by_itself_is_not_cut_off(sound: MachineLog) -> None:
    current = sound.axes["X"].more["current"]
    steady = np.where(np.abs(current) < 0.2 * current.max(), 0.0, current)
    assert "clipped" not in told(changed(sound, current=steady))
    cut = np.clip(current, None, 0.6 * float(current.max()))
    assert "above" in told(changed(sound, current=cut))["clipped"].message


def test_stamps_with_few_digits_count_as_even_and_precise_ones_as_they_are() -> None:
    time = np.arange(500) / 600.0
    axis = AxisLog("linear", np.sin(time), np.sin(time), {}, COLUMNS)
    for stamps, even in ((np.round(time, 3), True), (time + 1e-4 * np.sin(50 * time), False)):
        (piece,) = stretches_of(axis, stamps, ((0, 500),))
        assert bool(np.ptp(np.diff(piece.time)) < 1e-9) == even


def test_a_command_is_drawn_through_its_own_stamps() -> None:
    random = np.random.default_rng(2)
    time = np.cumsum(0.004 * random.uniform(0.9, 1.1, 400))
    command = command_of("linear", time, np.sin(6.0 * time), np.sin(6.0 * time))
    inputs = time[0] + command.step_s * np.arange(len(command.position))
    inside = inputs <= time[-1]
    off = np.abs(command.position[:, 0] - np.sin(6.0 * inputs))[inside]
    assert off.max() < 1e-7


def test_a_few_lost_samples_are_bridged_and_many_end_a_stretch(sound: MachineLog) -> None:
    for lost, pieces in ((3, 1), (40, 2)):
        kept = np.ones(len(sound.time), np.bool_)
        kept[1500 : 1500 + lost] = False
        log = MachineLog(
            sound.name, sound.time[kept], {"X": sound.axes["X"].of_rows(kept)}, sound.line[kept]
        )
        health = look_at_clock(log)
        assert "gap" in {one.code for one in health.findings}
        assert len(health.stretches) == pieces


@pytest.mark.parametrize("at", ["drive", "load"])
def test_the_drive_s_force_holds_what_is_injected_there(at: str) -> None:
    time = np.linspace(0.0, 0.399, 400)
    table = ExternalForceTable.model_validate({"column": "a", "unit": "N", "at": at})
    columns = COLUMNS.model_copy(update={"external_force": table})
    push = np.where(np.arange(400) < 200, 0.0, 50.0)
    axis = AxisLog("linear", np.sin(time), np.sin(time), {"external_force": push}, columns)
    (piece,) = stretches_of(axis, time, ((0, 400),))
    assert (piece.driven is not None) == (at == "drive")
    assert (piece.pushed is not None) == (at == "load")


def test_a_position_that_seems_to_come_early_speaks_for_feed_forward() -> None:
    (finding,) = look_at_fit(
        "X", {"delay": Interval(-0.003, -0.0032, -0.0028)}, 1e3, filtered=False
    )
    assert finding.code == "feed-forward"
    message = finding.message
    assert "velocity_feedforward" in message
    assert "delay_s" in message


def test_missing_cells_are_gaps_with_their_rows(tmp_path: Path) -> None:
    from twin.logs.machine_log import read_machine_log

    log = log_of(Logger(), seconds=1.0)
    axis = log.axes["X"]
    rows = [
        f"{t:.4f},{c:.6f},{a:.6f}"
        for t, c, a in zip(log.time, axis.command, axis.actual, strict=True)
    ]
    rows[16] = rows[16].rsplit(",", 1)[0] + ","
    rows[40] = rows[40].rsplit(",", 1)[0] + ",NaN"
    path = tmp_path / "log.csv"
    path.write_text("time_s,X_command_mm,X_actual_mm\n" + "\n".join(rows) + "\n", encoding="utf-8")
    read = read_machine_log(path, gaps_allowed=True)
    assert read.missing.tolist() == [17, 41]
    assert (
        "row 17, 41" in {one.code: one.message for one in look_at_clock(read).findings}["missing"]
    )
