"""A ball-bar's circle: held to its closed forms, and to the circular test of the simulated machine."""

import json
from pathlib import Path

import numpy as np
import pytest
from command_line import Twin
from machine_logs import mill

from twin.calibrate.calibrate import calibrate
from twin.calibrate.fit.ball_bar import ONE_DIRECTION, fit_ball_bar
from twin.logs.ball_bar import BallBarLog, CircleSense
from twin.machine.circle.circular_test import circular_test
from twin.machine.description.config import MachineConfig
from twin.nc.canonical import FloatArray

pytestmark = pytest.mark.seconds("a machine is simulated, and fitted to its log")

RADIUS, SPEED = 150.0, 50.0
GAPS, SQUARE, LAGS = (0.012, 0.007), 40e-6, (0.008, 0.0078)
"""Backlash [mm], angle beyond 90 degrees [rad], lags [s]."""
MAP = """
[ball_bar]
plane = "XY"
radius = 150.0
feed = 3000.0
angle = { column = "angle", unit = "deg" }
counter_clockwise = { column = "ccw", unit = "um" }
clockwise = { column = "cw", unit = "um" }
"""


def turn(angle: FloatArray, sense: int) -> FloatArray:
    """Where axes are that lag, lose their gap and are not square: how far that is off the circle [mm]."""
    place = RADIUS * np.stack([np.cos(angle), np.sin(angle)])
    speed = sense * SPEED * np.stack([-np.sin(angle), np.cos(angle)])
    place -= np.array(LAGS)[:, None] * speed + np.array(GAPS)[:, None] / 2.0 * np.sign(speed)
    place[0] -= SQUARE * place[1]
    place += np.array([[0.003], [-0.001]])
    return np.hypot(*place) - RADIUS


@pytest.fixture
def log() -> BallBarLog:
    angle = np.deg2rad(np.arange(0.0, 360.0, 0.25) + 0.1)
    noise = 2e-4 * np.random.default_rng(4).standard_normal((2, len(angle)))
    turns = {
        sense: turn(angle, sense) + rough
        for sense, rough in zip(
            (CircleSense.COUNTER_CLOCKWISE, CircleSense.CLOCKWISE), noise, strict=True
        )
    }
    return BallBarLog("bar.csv", "XY", RADIUS, SPEED, angle, turns)


def written(path: Path, log: BallBarLog, scale: float = 1e3) -> Path:
    turns = (
        np.stack([log.turns[CircleSense.COUNTER_CLOCKWISE], log.turns[CircleSense.CLOCKWISE]])
        * scale
    )
    np.savetxt(
        path, np.column_stack([np.rad2deg(log.angle), *turns]), delimiter=",",
        header="angle,ccw,cw", comments="",
    )  # fmt: skip
    return path


def test_both_directions_tell_backlash_squareness_and_lag(log: BallBarLog) -> None:
    found = fit_ball_bar(log)
    assert found.squareness is not None
    assert found.lag is not None
    for interval, true in (
        (found.lost["X"], GAPS[0]),
        (found.lost["Y"], GAPS[1]),
        (found.squareness, SQUARE * 1e6),
        (found.lag, LAGS[0] - LAGS[1]),
    ):
        assert interval.value == pytest.approx(true, rel=0.02)
        assert interval.low < true < interval.high
    assert found.left_rms < 3e-4 < found.logged_rms


def test_one_direction_tells_backlash_and_neither_of_the_others(log: BallBarLog) -> None:
    one = log._replace(turns={CircleSense.CLOCKWISE: log.turns[CircleSense.CLOCKWISE]})
    found = fit_ball_bar(one)
    assert found.lost["X"].value == pytest.approx(GAPS[0], rel=0.05)
    assert (found.squareness, found.lag) == (None, None)
    (contract,) = calibrate(mill(), [], ball_bars=[one]).as_contract()["ball_bars"]
    assert contract["undetermined"]["squareness"] == ONE_DIRECTION


def test_a_circle_without_a_gap_leaves_the_backlash_undetermined(log: BallBarLog) -> None:
    still = log._replace(turns={sense: np.zeros(len(log.angle)) + 1e-4 for sense in log.turns})
    fit = calibrate(mill(), [], ball_bars=[still]).axes["X"].fit
    assert not fit.fitted
    assert "anything up to" in fit.undetermined["backlash"]
    assert "a ball-bar does not tell it" in fit.undetermined["stiffness"]
    assert "no log of the axis's positions" in fit.undetermined["kv"]


def with_faults() -> MachineConfig:
    """Gaps that a little friction lets the axes lose, no integrators, and different gains."""
    machine = mill(backlash=0.02, dry_friction=20.0, kv=7.3)
    return machine.changed("Y", backlash=0.01, dry_friction=20.0, reset_time_s=0.0)


@pytest.mark.thorough
def test_the_simulated_machine_s_own_circle_gives_it_back(twin: Twin, tmp_path: Path) -> None:
    machine = with_faults()
    test = circular_test(machine, 40.0, 1000.0)
    turns = {
        CircleSense.COUNTER_CLOCKWISE: test.counter_clockwise_um,
        CircleSense.CLOCKWISE: test.clockwise_um,
    }
    log = BallBarLog("c", "XY", 40.0, 50.0, np.deg2rad(test.angle_deg), turns)
    bar = written(tmp_path / "bar.csv", log, 1.0)
    (tmp_path / "map.toml").write_text(MAP.replace("150", "40").replace("3000", "1000"))
    out, figures, report = (tmp_path / name for name in ("mine.toml", "fit.json", "fit.html"))
    done = twin(
        "calibrate", "--ball-bar", bar, "--columns", tmp_path / "map.toml", "--out", out,
        "--json", figures, "--report", report,
    )  # fmt: skip
    assert done.code == 0, done.stderr
    told = json.loads(figures.read_text())
    fitted = {axis: told["axes"][axis]["fitted"]["backlash"]["value"] for axis in "XY"}
    assert fitted == {"X": pytest.approx(0.02, rel=0.1), "Y": pytest.approx(0.01, rel=0.1)}
    (circle,) = told["ball_bars"]
    lag = 0.06 * (1.0 / machine.axis("X").kv - 1.0 / machine.axis("Y").kv)
    assert circle["lag_mismatch"]["value"] == pytest.approx(lag, rel=0.05)
    assert abs(circle["squareness"]["value"]) < 1.0
    text = out.read_text()
    assert text.count("\nbacklash = ") == 2
    assert "[geometry.squareness]\nXY = " in text
    shown = twin("machine", "show", out)
    assert shown.code == 0, shown.stderr


@pytest.mark.parametrize(
    ("change", "scale", "why"),
    [
        ('"XY"', 1e6, "off a circle of"),
        ('column = "ccw"', 1e3, "has no column 'left'"),
        ("radius = 150.0", 1e3, "radius"),
        ("[ball_bar]", 1e3, "with a table such as"),
    ],
)
def test_what_is_no_ball_bar_is_refused_with_the_reason(
    twin: Twin, tmp_path: Path, log: BallBarLog, change: str, scale: float, why: str
) -> None:
    other = {'column = "ccw"': 'column = "left"', "radius = 150.0": "", "[ball_bar]": "[columns]"}
    (tmp_path / "map.toml").write_text(MAP.replace(change, other.get(change, change)))
    bar = written(tmp_path / "bar.csv", log, scale)
    done = twin("calibrate", "--ball-bar", bar, "--columns", tmp_path / "map.toml")
    assert done.code == 2
    assert why in done.stderr
