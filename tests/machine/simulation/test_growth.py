"""A machine that grows as it warms, against the step response of a first-order lag."""

import dataclasses
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.machine.machine_fixtures import PERIOD, setpoints
from twin.errors import ConfigError
from twin.files.shipped import machine_file
from twin.machine.circle.circular_test import circular_test
from twin.machine.description.config import MachineConfig
from twin.machine.description.machine_file import MachineFile
from twin.machine.load import read_machine
from twin.machine.simulation.growth import Growth
from twin.nc.canonical import FloatArray
from twin.recording.reader import Samples, open_recording
from twin.run.preparing.preparation import prepare
from twin.run.progress import no_progress
from twin.run.run import Run

SPINDLE = {"source": "spindle", "at": 8000.0, "um": [1.0, 2.0, -12.0], "time_constant_s": 3.0}
SCREW = {"source": "X", "at": 200.0, "um": [8.0, 0.0, 0.0], "time_constant_s": 1.5}


def growing(**thermal: dict[str, Any]) -> MachineConfig:
    """``mill4`` that grows."""
    path = machine_file("mill4")
    data = tomllib.loads(path.read_text(encoding="utf-8"))
    return MachineConfig(path, MachineFile.model_validate(data | {"thermal": thermal}))


def driven(count: int, force: float, speed: float) -> Samples:
    """Samples of an X that goes at a speed [mm/s] and is pushed by a force [N]."""
    zero = np.zeros((count, 4))
    push, velocity = zero.copy(), zero.copy()
    push[:, 0], velocity[:, 0] = force, speed
    return Samples(setpoints(zero, velocity, zero), zero, velocity, push)


def grown(machine: MachineConfig, samples: Samples, turns: FloatArray, rows: int) -> FloatArray:
    """Growth along a run in chunks of so many rows, shape (n, 3) [µm]."""
    growth = Growth(machine, lambda points: turns[np.searchsorted(time, points.time)])
    time = samples.setpoint.time
    parts = [growth.warm(samples[i : i + rows]).growth for i in range(0, len(samples), rows)]
    return np.concatenate([part for part in parts if part is not None]) * 1000.0


@pytest.mark.parametrize("rows", [6000, 777, 1])
def test_a_spindle_warms_and_cools_as_a_lag_of_first_order(rows: int) -> None:
    """u (1 - exp(-t/T)) while it turns, and down by exp(-t/T) when it is at rest; either way round."""
    turns = np.where(np.arange(6000) < 4000, -6000.0, 0.0)
    found = grown(growing(nose=SPINDLE), driven(6000, 0.0, 0.0), turns, rows)
    time = PERIOD * np.arange(1, 6001)
    rising = 1.0 - np.exp(-np.minimum(time, 4.0) / 3.0)
    state = 0.75 * rising * np.exp(-np.maximum(time - 4.0, 0.0) / 3.0)
    assert found == pytest.approx(state[:, None] * np.array([1.0, 2.0, -12.0]), abs=1e-9)


def test_a_drive_warms_by_its_power_whichever_way_it_goes() -> None:
    """500 N at 300 mm/s are 150 W; braking warms as much."""
    for force in (500.0, -500.0):
        found = grown(growing(screw=SCREW), driven(3000, force, 300.0), np.zeros(3000), 500)
        assert found[-1, 0] == pytest.approx(0.75 * 8.0 * (1.0 - np.exp(-2.0)), abs=1e-9)


def test_a_speed_that_nobody_knows_warms_nothing() -> None:
    found = grown(growing(nose=SPINDLE), driven(50, 0.0, 0.0), np.full(50, np.nan), 50)
    assert not found.any()


def test_a_machine_without_the_table_does_not_grow() -> None:
    samples = driven(10, 100.0, 100.0)
    growth = Growth(growing(), lambda points: np.full(len(points), 9000.0))
    assert growth.warm(samples) is samples


def test_the_verdict_says_what_of_the_error_is_growth(tmp_path: Path) -> None:
    """A dwell of 3 s with the spindle on, then a line: the tool is off it by what grew along Y."""
    program, machine = tmp_path / "part.nc", tmp_path / "warm.toml"
    program.write_text("S4000 M3\nG4 P3.\nG1 X20. F1200.\nM30\n")
    machine.write_text(
        'base = "mill4"\nname = "warm"\n[axes.Y]\nvelocity_feedforward = 1.0\n'
        '[spindle]\nacceleration = 0.0\n[thermal.nose]\nsource = "spindle"\nat = 4000.0\n'
        "um = [0.0, 9.0, 0.0]\ntime_constant_s = 2.0\n"
    )
    run = Run(prepare(program, dialect="haas", machine=str(machine)))
    outcome = run.execute(tmp_path, no_progress)
    figures = outcome.figures
    time = figures.contour.worst_time_s + PERIOD
    meant = 9.0 * (1.0 - np.exp(-time / 2.0))
    assert 3.0 < time < 5.0
    assert figures.shares["thermal growth"] == pytest.approx(meant, abs=0.01)
    assert figures.contour.max == pytest.approx(sum(figures.shares.values()))
    with open_recording(tmp_path / "recording.h5") as recording:
        kept = [samples.growth for samples in recording.chunks()]
    assert all(part is not None for part in kept)
    whole = np.concatenate([part for part in kept if part is not None])
    assert whole[round(figures.contour.worst_time_s / PERIOD), 1] * 1000.0 == pytest.approx(
        meant, abs=0.01
    )


def test_what_warms_nothing_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(
        'base = "mill4"\nname = "warm"\n[thermal.nose]\nsource = "spindel"\nat = 1.0\n'
        "um = [0.0, 9.0, 0.0]\ntime_constant_s = 2.0\n"
    )
    with pytest.raises(ConfigError, match=r"spindel.*spindle, X, Y, Z, C"):
        read_machine(path)


def test_growth_shifts_the_tool_beside_its_bend() -> None:
    machine = growing()
    samples = dataclasses.replace(driven(3, 0.0, 0.0), growth=np.full((3, 3), 0.002))
    assert samples.real(machine.part_frame)[:, :3] == pytest.approx(np.full((3, 3), 0.002))


def test_a_drive_that_warms_shows_in_the_circular_test() -> None:
    """Both directions in one session: what grew along X moves the second circle aside."""
    screw = SCREW | {"at": 1.0, "time_constant_s": 600.0, "um": [50.0, 0.0, 0.0]}
    cold = circular_test(growing(), 30.0, 4000.0)
    warm = circular_test(growing(screw=screw), 30.0, 4000.0)
    aside = [
        getattr(warm, way) - getattr(cold, way) for way in ("counter_clockwise_um", "clockwise_um")
    ]
    shift = [float(2.0 * np.mean(one * np.cos(np.deg2rad(cold.angle_deg)))) for one in aside]
    assert 0.05 < shift[0] < shift[1]
    assert max(np.abs(one).max() for one in aside) < 2.0 * shift[1]
