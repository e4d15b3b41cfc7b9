"""Logs made by the simulated machine itself, and the real ones where they are at hand."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from twin.files.shipped import machine_file
from twin.logs.column_map import AxisColumns, ColumnTable
from twin.logs.machine_log import AxisLog, MachineLog
from twin.machine.description.config import MachineConfig
from twin.machine.load import read_machine
from twin.machine.model.model import build_spec, physics_model
from twin.machine.simulation.simulate import simulate
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray

PERIOD = 0.001
REAL = Path(__file__).parents[2].parent / "shared" / "data"
EMPS = REAL / "emps" / "first_half.csv"
needs_real_logs = pytest.mark.skipif(
    not EMPS.is_file(), reason=f"needs the logs of real machines in {REAL}"
)
EMPS_MAP = """
[columns]
time = { column = "time_s", unit = "s" }
[columns.X]
command = { column = "X_command_mm", unit = "mm" }
actual = { column = "X_actual_mm", unit = "mm" }
force = { column = "X_motor_voltage_V", unit = "N", scale = 35.15065 }
"""
_ANY = ColumnTable(column="a", unit="mm")
COLUMNS = AxisColumns(command=_ANY, actual=_ANY)


def mill(**changes: float) -> MachineConfig:
    """``mill4`` without integral action on X, and with fields of X changed."""
    machine = read_machine(machine_file("mill4"))
    return machine.changed("X", **{"reset_time_s": 0.0} | changes)


def strokes(seconds: float = 5.0, period: float = PERIOD) -> FloatArray:
    """Smooth strokes of X at several speeds, with slow reversals and rests: (n, 3)."""
    time: FloatArray = np.arange(0.0, seconds, period)
    acceleration = np.zeros(len(time))
    begin = 0.2
    for speed, rise, hold in [
        (120, 0.1, 0.3),
        (5, 0.04, 0.5),
        (300, 0.15, 0.2),
        (40, 0.06, 0.4),
    ] * 3:
        for sense in (1, -1):
            for start, sign in ((begin, sense), (begin + rise + hold, -sense)):
                part = (time - start) / rise
                hump = (part > 0) & (part < 1)
                acceleration[hump] += sign * speed / rise * (1 - np.cos(2 * np.pi * part[hump]))
            begin += 2 * rise + hold + 0.05
    velocity = (
        np.concatenate([[0.0], np.cumsum((acceleration[1:] + acceleration[:-1]) / 2)]) * period
    )
    position = np.concatenate([[0.0], np.cumsum((velocity[1:] + velocity[:-1]) / 2)]) * period
    return np.column_stack([position, velocity, acceleration])


def logged(machine: MachineConfig, course: FloatArray | None = None) -> MachineLog:
    """What a perfect log of X of a machine holds, its force included."""
    course = strokes() if course is None else course
    columns = [np.zeros((len(course), 4)) for _ in range(3)]
    for column, values in zip(columns, course.T, strict=True):
        column[:, 0] = values
    n = len(course)
    still = np.zeros(n, np.int64)
    asked = Setpoints(np.arange(n, dtype=np.float64) * PERIOD, still, still, np.zeros(n), *columns)
    (samples,) = simulate(machine, physics_model(machine, build_spec(machine)), [asked])
    more = {"force": samples.drive_force[:, 0].copy()}
    axis = AxisLog("linear", course[:, 0], samples.joint_position[:, 0].copy(), more, COLUMNS)
    return MachineLog("own.csv", asked.time, {"X": axis}, still)


def without_force(log: MachineLog) -> MachineLog:
    """The same log with positions alone."""
    return with_axis(log, dataclasses.replace(log.axes["X"], more={}))


def with_axis(log: MachineLog, axis: AxisLog) -> MachineLog:
    """The same log with another X."""
    return dataclasses.replace(log, axes={"X": axis})


def write_log(path: Path, log: MachineLog) -> Path:
    """A log as CSV whose headings say what they are."""
    axis = log.axes["X"]
    columns, heading = [log.time, axis.command, axis.actual], "time_s,X_command_mm,X_actual_mm"
    if "force" in axis.more:
        columns.append(axis.more["force"])
        heading += ",X_force_N"
    np.savetxt(
        path, np.column_stack(columns), delimiter=",", header=heading, comments="", fmt="%.9g"
    )
    return path
