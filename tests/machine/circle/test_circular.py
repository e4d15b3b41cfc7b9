"""The circular test: each imperfection alone, against its closed form or hand-worked size."""

import json

import numpy as np
import pytest

from tests.machine.machine_fixtures import shipped_machine
from twin.errors import UsageError
from twin.files.shipped import machine_file
from twin.machine.circle.circle_path import PLANES
from twin.machine.circle.circle_plot import write_circle_plot
from twin.machine.circle.circular_test import CircularTest, circular_test
from twin.machine.description.config import MachineConfig
from twin.machine.description.machine_file import MachineFile
from twin.machine.load import read_machine
from twin.machine.model.model import build_spec, drives
from twin.machine.model.transmission import give_stiffness
from twin.units import MM, UM_PER_MM

PERFECT = {"velocity_feedforward": 1.0, "acceleration_feedforward": 1.0}


def changed(machine: MachineConfig, axis: str, **fields) -> MachineConfig:
    data = machine.file.model_dump(by_alias=True)
    data["axes"][axis].update(fields)
    return MachineConfig(machine.path, MachineFile.model_validate(data))


@pytest.mark.parametrize("plane", [plane for plane in PLANES if plane not in ("ZXB", "YZA")])
def test_a_perfect_machine_draws_a_perfect_circle(plane):
    result = circular_test(shipped_machine(**PERFECT), 50.0, 3000.0, plane)
    assert result.circular_deviation_um < 0.01
    assert result.hysteresis_um < 0.01
    assert max(np.abs(result.radial_deviation_um)) < 0.1


@pytest.mark.parametrize(
    ("name", "plane"), [("mill4a", "YZA"), ("mill5", "XYC"), ("mill5h", "XYC"), ("mill3", "YZ")]
)
def test_a_circle_with_the_table_of_any_machine_is_round(name, plane):
    """Loops of one gain: the table follows the circle without an error of its own, to the simulator's own."""
    result = circular_test(read_machine(machine_file(name)), 40.0, 1000.0, plane)
    assert result.circular_deviation_um < 0.05
    assert result.hysteresis_um < 0.05


@pytest.mark.parametrize("plane", ["XY", "ZX", "YZ"])
def test_matched_loops_lose_radius_and_stay_round(plane):
    """Two equal lags of w = 250 1/s, z = 1: dR = R (1/(1 + r²) - 1), r = v/(R w)."""
    result = circular_test(shipped_machine(), 50.0, 6000.0, plane)
    ratio = 100.0 / 50.0 / 250.0
    expected = 50.0 * (1 / (1 + ratio**2) - 1) * UM_PER_MM
    assert result.mean_radius_error_um == pytest.approx(expected, abs=0.01)
    assert result.circular_deviation_um < 0.01


@pytest.mark.parametrize(
    ("late", "meant"),
    [
        ({"command_filter_s": 0.01}, lambda s: 1.0 / (1.0 + 0.01 * s)),
        (
            {"velocity_filter_s": 0.002, "velocity_feedforward": 0.0},
            lambda s: 62500.0 / (s**2 + 500.0 * s / (1.0 + 0.002 * s) + 62500.0),
        ),
        (
            {"loop_delay_s": 0.001, "velocity_feedforward": 0.0},
            lambda s: 62500.0 / (s**2 * np.exp(0.001 * s) + 500.0 * s + 62500.0),
        ),
    ],
)
def test_lags_of_the_drives_change_the_radius_as_their_transfer_functions(late, meant):
    machine = shipped_machine(**PERFECT | {"acceleration_feedforward": 0.0} | late)
    rate = 100.0 / 50.0
    told = 0.0 if "velocity_feedforward" in late else 500.0
    ideal = abs((62500.0 + told * 1j * rate) / ((1j * rate) ** 2 + 500.0 * 1j * rate + 62500.0))
    factor = abs(meant(1j * rate)) * (ideal if told else 1.0)
    result = circular_test(machine, 50.0, 6000.0)
    assert result.mean_radius_error_um == pytest.approx(50e3 * (factor - 1.0), abs=0.02)
    assert result.circular_deviation_um < 0.02


def test_a_filter_of_one_axis_alone_gives_an_ellipse():
    """A lag of T in Y alone: G(b) = v T to the first order, its long axis at 45° or 135°."""
    late = 0.001
    machine = changed(shipped_machine(**PERFECT), "Y", command_filter_s=late)
    result = circular_test(machine, 50.0, 3000.0)
    assert result.circular_deviation_um == pytest.approx(50.0 * late * UM_PER_MM, rel=0.01)
    assert result.hysteresis_um == pytest.approx(50.0 * late * UM_PER_MM, rel=0.01)


def test_mismatched_loops_give_an_ellipse_at_45_degrees():
    """Lags T and T + d turn the circle into an ellipse: G(b) = v d, long axis at 45° or 135°."""
    machine = changed(shipped_machine(), "Y", kv=7.5 * 0.98)
    speed = 50.0
    result = circular_test(machine, 50.0, speed * 60)
    late = 1 / (125.0 * 0.98) - 1 / 125.0
    assert result.hysteresis_um == pytest.approx(speed * late * UM_PER_MM, rel=0.02)
    assert result.circular_deviation_um == pytest.approx(speed * late * UM_PER_MM, rel=0.05)
    longest = result.angle_deg[np.argmax(result.counter_clockwise_um)] % 180.0
    other = result.angle_deg[np.argmax(result.clockwise_um)] % 180.0
    assert {round(longest / 45), round(other / 45)} == {1, 3}
    assert min(abs(longest - 45), abs(longest - 135)) < 3.0


@pytest.mark.seconds("circles are driven both ways")
def test_backlash_gives_steps_of_its_size():
    """Either axis is behind by half the gap and by what friction bends, whichever way it goes.

    Across the reversal of X at 0°, seen at 4° on either side, that is the whole of both, times
    cos 4°, less what Y is behind at the same place, times sin 4°.
    """
    backlash, friction = 0.02, 100.0
    machine = shipped_machine(backlash=backlash, dry_friction=friction, **PERFECT)
    result = circular_test(machine, 50.0, 1000.0)
    model = build_spec(machine).compile()
    loop = drives(machine, model)[0]
    wall = give_stiffness(machine.axis("X"), loop.moved, machine.file.servo_period_s)
    bend = 2 * friction * (1 / loop.position_gain + 1 / wall) / MM
    around = np.abs((result.angle_deg + 180) % 360 - 180)
    before = (around > 3.0) & (around < 5.0) & (result.angle_deg > 180)
    after = (around > 3.0) & (around < 5.0) & (result.angle_deg < 180)
    step = result.counter_clockwise_um[after].mean() - result.counter_clockwise_um[before].mean()
    seen = np.cos(np.deg2rad(4.0)) - np.sin(np.deg2rad(4.0))
    assert step == pytest.approx((backlash + bend) * seen * UM_PER_MM, rel=0.01)
    assert result.hysteresis_um == pytest.approx(step, rel=0.15)


def test_friction_with_integral_action_gives_peaks_that_fade():
    result = circular_test(
        shipped_machine(dry_friction=800.0, reset_time_s=0.02, **PERFECT), 50.0, 3000.0
    )
    loop = drives(shipped_machine(reset_time_s=0.02), build_spec(shipped_machine()).compile())[0]
    largest = 2 * 800.0 / loop.position_gain / MM * UM_PER_MM
    for peak in result.quadrant_peaks_um:
        assert 0.2 * largest < abs(peak) <= largest
    middle = np.abs((result.angle_deg % 90.0) - 45.0) < 15.0
    assert np.abs(result.counter_clockwise_um[middle]).max() < 0.1 * largest
    assert result.quadrant_names == ("+X", "+Y", "-X", "-Y")


@pytest.mark.seconds("circles are driven both ways")
def test_a_step_is_no_peak():
    """Backlash shifts one side against the other; friction leaps out of both."""
    play = shipped_machine(backlash=0.02, dry_friction=100.0, **PERFECT)
    result = circular_test(play, 50.0, 1000.0)
    assert result.hysteresis_um > 15.0
    assert max(np.abs(result.quadrant_peaks_um)) < 0.25 * result.hysteresis_um


def test_a_table_that_turns_late_is_seen_in_xyc():
    """C later than X and Y by d: the followed point trails by v d, seen along the bar's direction."""
    machine = changed(shipped_machine(), "C", kv=7.5 * 0.9)
    result = circular_test(machine, 60.0, 1500.0, "XYC")
    late = 1 / (125.0 * 0.9) - 1 / 125.0
    expected = 25.0 * late * UM_PER_MM
    assert max(np.abs(result.radial_deviation_um)) == pytest.approx(expected, rel=0.02)


def refuse(match: str, *arguments, machine: MachineConfig | None = None) -> None:
    with pytest.raises(UsageError, match=match):
        circular_test(machine or shipped_machine(), *arguments)


def test_circles_that_the_machine_cannot_run_are_refused_with_what_it_can():
    refuse("known are XY, ZX, YZ, XYC", 50.0, 1000.0, "UV")
    refuse("must be positive", -1.0, 1000.0)
    refuse("must be positive", 50.0, 0.0)
    refuse("X reaches 30000 mm/min", 50.0, 31000.0)
    refuse("up to 3795 mm/min fits", 1.0, 20000.0)
    refuse("does not fit the travel of Y; up to 300 mm does", 301.0, 1000.0)
    refuse("C is fast enough for 2513 mm/min", 10.0, 3000.0, "XYC")
    refuse("no rotary table for YZA", 50.0, 1000.0, "YZA")


def test_the_plot_shows_the_figures(tmp_path):
    result: CircularTest = circular_test(shipped_machine(dry_friction=500.0), 30.0, 2000.0)
    path = tmp_path / "circle.svg"
    write_circle_plot(result, path)
    text = path.read_text()
    assert text.startswith("<?xml")
    assert len(text) < 1_000_000
    again = tmp_path / "again.svg"
    write_circle_plot(result, again)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["again.svg", "circle.svg"]


def test_the_contract_of_the_command():
    result = circular_test(shipped_machine(), 50.0, 3000.0)
    told = json.loads(json.dumps(result.as_contract("circle.svg")))
    assert set(told) >= {
        "circular_deviation_um", "radial_deviation_um", "hysteresis_um",
        "mean_radius_error_um", "quadrant_peaks_um", "plot",
    }  # fmt: skip
    assert set(told["radial_deviation_um"]) == {"max", "min"}
    assert len(told["quadrant_peaks_um"]) == 4
