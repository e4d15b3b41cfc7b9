"""What the page says of a loop, held against closed forms."""

import dataclasses

import numpy as np
import pytest

from twin.calibrate.fit.parameters import AxisParameters, of_base
from twin.calibrate.report.loop_plots import autocorrelation, margins, open_loop, whiteness
from twin.calibrate.result import TimeSeries
from twin.files.shipped import machine_file
from twin.machine.load import read_machine

NONE = np.zeros(0)


def loop(**changes: float) -> AxisParameters:
    base = of_base(read_machine(machine_file("mill4")).axis("X"), 350.0)
    plain = {
        "reset_time_s": 0.0,
        "velocity_filter_s": 0.0,
        "loop_delay_s": 0.0,
        "viscous_friction": 0.0,
    }
    return dataclasses.replace(base, **{"kv": 6.0, "damping_ratio": 1.0, **plain, **changes})


def course(left: np.ndarray) -> TimeSeries:
    time = np.asarray(np.arange(len(left)) * 1e-3, np.float64)
    return TimeSeries(time, left, np.zeros(len(left)), False, NONE, NONE, NONE, time)


def test_the_margin_of_a_second_order_loop_is_its_closed_form() -> None:
    # L = (2 z w s + w²) / s², w = 2 z kv: |L| = 1 at w sqrt(2 z² + sqrt(4 z⁴ + 1)).
    kv, z = 6.0 / 60.0 * 1000.0, 0.7
    w = 2.0 * z * kv
    crossing = w * np.sqrt(2.0 * z**2 + np.sqrt(4.0 * z**4 + 1.0))
    found = margins(loop(damping_ratio=z), "linear")
    assert found.crossover_hz == pytest.approx(crossing / (2.0 * np.pi), rel=5e-3)
    assert found.phase_deg == pytest.approx(np.degrees(np.arctan(2.0 * z * crossing / w)), abs=0.3)


def test_dead_time_takes_its_phase_and_friction_its_pole() -> None:
    still, late = margins(loop(), "linear"), margins(loop(loop_delay_s=1e-3), "linear")
    assert late.crossover_hz == pytest.approx(still.crossover_hz, rel=1e-6)
    assert still.phase_deg - late.phase_deg == pytest.approx(0.36 * late.crossover_hz, rel=1e-3)
    rough = loop(viscous_friction=7.0)
    s = 2j * np.pi * 3.0
    share = open_loop(rough, "linear", np.array([3.0])) / open_loop(
        loop(), "linear", np.array([3.0])
    )
    assert share[0] == pytest.approx(s / (s + 7000.0 / rough.mass), rel=1e-9)


def test_noise_is_white_and_what_swings_is_not() -> None:
    draw = np.random.default_rng(1)
    noise = draw.standard_normal(4000)
    assert whiteness(course(noise)).endswith("it is as good as noise.")
    swing = noise + np.sin(np.arange(4000) / 20.0)
    assert "something is left" in whiteness(course(swing))
    pairs = np.repeat(draw.standard_normal(2000), 2)
    assert autocorrelation(course(pairs))[0] == pytest.approx(0.5, abs=0.03)
    assert whiteness(course(noise[:50])).startswith("Too few samples")
