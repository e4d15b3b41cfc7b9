"""Backlash and stiffness, from logs of two masses with a gap and a spring between them."""

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest
from command_line import Twin
from machine_logs import COLUMNS, mill

from twin.calibrate.calibrate import calibrate
from twin.logs.machine_log import AxisLog, MachineLog

GAP, SPRING, FRICTION = 0.03, 8e4, 400.0
"""Backlash [mm], stiffness [N/mm] and dry friction of the guides [N]."""
MOTOR, CARRIED = 518.0, 523.0
"""Masses before and behind the gap [kg]."""
GAIN, SPEED_GAIN = 60.0, 200.0
_STEP, _EVERY = 1e-4, 10


def two_masses(gap: float = GAP, seconds: float = 4.0) -> MachineLog:
    """Strokes of a motor that pulls a table through a gap and a spring; friction on the table."""
    spring, mass = SPRING * 1e3, MOTOR + CARRIED
    damper = 0.2 * math.sqrt(spring * MOTOR * CARRIED / mass)
    motor = motor_speed = table = table_speed = 0.0
    rows = []
    for number in range(round(seconds / _STEP)):
        time = number * _STEP
        asked = 0.03 * math.sin(2.0 * math.pi * 0.9 * time) ** 3 + 0.01 * math.sin(4.0 * time)
        if number % _EVERY == 0:
            given = mass * SPEED_GAIN * (GAIN * (asked - motor) - motor_speed)
            rows.append((asked, motor, table, given))
        force = mass * SPEED_GAIN * (GAIN * (asked - motor) - motor_speed)
        bent = motor - table
        beyond = bent - max(-gap / 2e3, min(gap / 2e3, bent))
        through = spring * beyond + (damper * (motor_speed - table_speed) if beyond else 0.0)
        motor_speed += _STEP * (force - through) / MOTOR
        pushed = table_speed + _STEP * through / CARRIED
        held = _STEP * FRICTION / CARRIED
        table_speed = pushed - max(-held, min(held, pushed))
        motor += _STEP * motor_speed
        table += _STEP * table_speed
    asked, motors, tables, forces = np.array(rows).T
    noise = 2e-4 * np.random.default_rng(2).standard_normal((2, len(rows)))
    more = {"load": tables * 1e3 + noise[0], "force": forces}
    axis = AxisLog("linear", asked * 1e3, motors * 1e3 + noise[1], more, COLUMNS)
    clock = np.asarray(np.arange(len(rows)) * _STEP * _EVERY, np.float64)
    return MachineLog("two.csv", clock, {"X": axis}, np.zeros(len(rows), np.int64))


@pytest.fixture(scope="module")
def log() -> MachineLog:
    return two_masses()


def without(log: MachineLog, *roles: str) -> MachineLog:
    axis = log.axes["X"]
    more = {role: values for role, values in axis.more.items() if role not in roles}
    return dataclasses.replace(log, axes={"X": dataclasses.replace(axis, more=more)})


def test_a_second_encoder_tells_backlash_and_stiffness(log: MachineLog) -> None:
    fit = calibrate(mill(), [log]).axes["X"].fit
    backlash, (stiffness, given) = fit.fitted["backlash"], fit.conditional["stiffness"]
    assert backlash.value == pytest.approx(GAP, rel=0.05)
    assert stiffness.value == pytest.approx(SPRING, rel=0.1)
    for interval, true in ((backlash, GAP), (stiffness, SPRING)):
        assert interval.low < true < interval.high
    assert given == ("motor_inertia", "screw_inertia")
    assert "only its ratio to the mass behind the gap" in fit.undetermined["stiffness"]


def test_without_a_force_stiffness_stands_on_the_base_s_mass(log: MachineLog) -> None:
    fit = calibrate(mill(), [without(log, "force")]).axes["X"].fit
    assert fit.fitted["backlash"].value == pytest.approx(GAP, rel=0.1)
    assert fit.conditional["stiffness"][1] == ("mass", "motor_inertia", "screw_inertia")


def test_without_a_second_encoder_they_are_named_as_undetermined(log: MachineLog) -> None:
    fit = calibrate(mill(), [without(log, "load")]).axes["X"].fit
    for name in ("backlash", "stiffness"):
        assert "no second encoder" in fit.undetermined[name]
        assert name not in fit.fitted


@pytest.mark.thorough
def test_a_gap_that_may_be_none_is_named_as_undetermined() -> None:
    fit = calibrate(mill(), [without(two_masses(gap=0.0, seconds=2.0), "force")]).axes["X"].fit
    assert "backlash" not in fit.fitted
    assert "anything up to" in fit.undetermined["backlash"]


def test_a_base_without_a_screw_has_neither_and_says_so(log: MachineLog) -> None:
    fit = calibrate(mill().changed("X", lead=None), [without(log, "force")]).axes["X"].fit
    for name in ("backlash", "stiffness"):
        assert "has no 'lead'" in fit.undetermined[name]
        assert name not in fit.fitted | fit.conditional


@pytest.mark.thorough
def test_the_machine_file_with_both_loads_and_runs(
    twin: Twin, tmp_path: Path, log: MachineLog
) -> None:
    axis = log.axes["X"]
    table = np.column_stack(
        [log.time, axis.command, axis.actual, axis.more["load"], axis.more["force"]]
    )
    np.savetxt(tmp_path / "two.csv", table, delimiter=",", header="t,c,a,l,f", comments="")
    (tmp_path / "map.toml").write_text(
        '[columns]\ntime = { column = "t" }\n[columns.X]\n'
        + "".join(
            f'{role} = {{ column = "{role[0]}", unit = "{unit}" }}\n'
            for role, unit in (("command", "mm"), ("actual", "mm"), ("load", "mm"), ("force", "N"))
        ),
        encoding="utf-8",
    )
    made = tmp_path / "mine.toml"
    done = twin(
        "calibrate", tmp_path / "two.csv", "--columns", tmp_path / "map.toml", "--out", made
    )
    assert done.code == 0, done.stderr
    text = made.read_text(encoding="utf-8")
    assert "\nbacklash = " in text
    assert "\nstiffness = " in text
    assert "\nmotor_inertia = " in text
    circle = twin(
        "machine", "circle", "--machine", made, "--radius", "20", "--feed", "1000",
        "--plot", tmp_path / "circle.svg",
    )  # fmt: skip
    assert circle.code == 0, circle.stderr
