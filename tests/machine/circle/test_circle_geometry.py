"""The ball-bar diagrams of one error of geometry at a time, against their closed forms."""

from pathlib import Path

import numpy as np
import pytest

from twin.machine.circle.circular_test import circular_test
from twin.machine.load import read_machine

RADIUS = 100.0


def added(folder: Path, geometry: str, plane: str) -> tuple[np.ndarray, np.ndarray]:
    """Angles [rad], and what the geometry adds to the diagram of mill4 [µm]."""
    diagrams = []
    for text in (geometry, ""):
        path = folder / "machine.toml"
        path.write_text(f'base = "mill4"\nname = "own"\n{text}', encoding="utf-8")
        found = circular_test(read_machine(path), RADIUS, 2000.0, plane)
        diagrams.append(found.counter_clockwise_um)
        assert found.hysteresis_um < 0.01
    return np.deg2rad(found.angle_deg), diagrams[0] - diagrams[1]


def test_squareness_draws_an_ellipse_on_the_diagonal(tmp_path: Path):
    angle, diagram = added(tmp_path, "[geometry.squareness]\nXY = 20.0\n", "XY")
    expected = -20e-6 * RADIUS * 1e3 / 2 * np.sin(2 * angle)
    assert diagram == pytest.approx(expected, abs=0.002)


def test_a_pitch_error_draws_an_ellipse_along_its_axis(tmp_path: Path):
    pitch = "[geometry.errors.EXX]\nat = [-100.0, 100.0]\num = [-10.0, 10.0]\n"
    angle, diagram = added(tmp_path, pitch, "XY")
    assert diagram == pytest.approx(10.0 * np.cos(angle) ** 2, abs=0.002)


def test_the_offset_of_the_table_draws_a_circle_beside_the_commanded_one(tmp_path: Path):
    angle, diagram = added(tmp_path, "[geometry.table]\noffset_um = [15.0, 0.0]\n", "XYC")
    assert diagram == pytest.approx(-15.0 * (1.0 - np.cos(angle)), abs=0.01)
