"""What lies on the table is moved by the axes below it."""

import math
from pathlib import Path
from typing import Literal

import mujoco
import numpy as np
import pytest
import trimesh

from tests.machine.machine_fixtures import PERIOD, setpoints, shipped_machine, with_fixtures
from twin.files.shipped import resource_root
from twin.job.fixture import FixtureTable
from twin.job.job_file import JobFile, StockTable
from twin.machine.description.config import Blank, MachineConfig
from twin.machine.load import read_machine
from twin.machine.model.model import BLANK, build_spec, drives, moved, physics_model
from twin.machine.simulation.servo import Servo
from twin.run.preparing.layout import blank_weight, lay_out

DISC = StockTable(shape="cylinder", diameter=340.0, height=98.21564381, density=7.85)
"""70 kg; its inertia about its axis is m r²/2 = 1.01 kg m²."""


def blank_of(machine: MachineConfig, stock: StockTable) -> Blank | None:
    """A stock as it lies on the table."""
    return lay_out(JobFile(program="part.nc", stock=stock), machine).blank


def felt(machine: MachineConfig, blank: Blank | None = None) -> dict[str, float]:
    """What each motor moves, motor and screw included."""
    model = physics_model(machine, build_spec(machine, blank=blank))
    return dict(zip(machine.axes.names, moved(machine, model), strict=True))


def test_seventy_kilograms_on_the_table_are_moved_by_x_y_and_c_but_not_by_z() -> None:
    empty = shipped_machine()
    before, after = felt(empty), felt(empty, blank_of(empty, DISC))
    for axis in "XY":
        assert after[axis] - before[axis] == pytest.approx(70.0, rel=1e-5)
    assert after["C"] - before["C"] == pytest.approx(0.5 * 70.0 * 0.17**2, rel=1e-5)
    assert after["C"] / before["C"] == pytest.approx(1.40, abs=0.01)
    assert after["Z"] == before["Z"]


def test_what_lies_beside_the_middle_turns_with_its_distance() -> None:
    """Huygens and Steiner: a fixture's m (x² + y²) comes on top of its own inertia."""
    empty = shipped_machine()
    jaw = FixtureTable(name="jaw", size=(100.0, 40.0, 50.0), position=(30.0, -120.0, 0.0), mass=4.0)
    pin = FixtureTable(name="pin", diameter=40.0, height=60.0, position=(0.0, 90.0, 0.0), mass=2.0)
    before, after = felt(empty), felt(with_fixtures(empty, jaw, pin))
    own = 4.0 * (0.1**2 + 0.04**2) / 12.0 + 0.5 * 2.0 * 0.02**2
    steiner = 4.0 * (0.03**2 + 0.12**2) + 2.0 * 0.09**2
    assert after["C"] - before["C"] == pytest.approx(own + steiner, rel=1e-9)
    assert after["X"] - before["X"] == pytest.approx(6.0, rel=1e-9)


def test_the_gains_are_those_of_the_empty_table() -> None:
    empty = shipped_machine()
    specs = [build_spec(empty, blank=blank) for blank in (None, blank_of(empty, DISC))]
    models = [physics_model(empty, spec) for spec in specs]
    assert drives(empty, models[0]) == drives(empty, models[1])


def test_a_heavier_table_lags_by_the_force_that_nobody_told_its_drive() -> None:
    """Told all of velocity and of the empty table's acceleration a, C trails by dJ a / (J w²)."""
    machine = shipped_machine(velocity_feedforward=1.0, acceleration_feedforward=1.0)
    disc = blank_of(machine, DISC)
    rate = 600.0  # deg/s²
    time = PERIOD * np.arange(301)
    position, velocity, acceleration = np.zeros((3, len(time), 4))
    position[:, 3], velocity[:, 3], acceleration[:, 3] = 0.5 * rate * time**2, rate * time, rate
    lag = []
    for blank in (None, disc):
        model = physics_model(machine, build_spec(machine, blank=blank))
        samples = Servo(machine, model).follow(setpoints(position, velocity, acceleration))
        lag.append(float(position[-1, 3] - samples.joint_position[-1, 3]))
    frequency = drives(machine, model)[3].natural_frequency
    share = felt(machine, disc)["C"] / felt(machine)["C"] - 1.0
    assert lag[0] == pytest.approx(0.0, abs=1e-5)
    assert lag[1] == pytest.approx(share * rate / frequency**2, rel=1e-3)


def test_a_blank_weighs_by_its_material_and_not_at_all_without_one() -> None:
    plain = StockTable(shape="box", size=(100.0, 80.0, 20.0))
    assert blank_weight(plain) is None
    steel = blank_weight(plain.model_copy(update={"material": "C45"}))
    assert steel is not None
    assert steel.mass == pytest.approx(0.16 * 7.85)
    assert steel.center == (0.0, 0.0, -10.0)
    light = blank_weight(plain.model_copy(update={"material": "C45", "density": 2.7}))
    assert light is not None
    assert light.mass == pytest.approx(0.16 * 2.7)


def test_a_tube_lacks_its_bore() -> None:
    tube = StockTable(shape="tube", diameter=100.0, bore=60.0, height=40.0, density=1.0)
    found = blank_weight(tube)
    whole = blank_weight(StockTable(shape="cylinder", diameter=100.0, height=40.0, density=1.0))
    core = blank_weight(StockTable(shape="cylinder", diameter=60.0, height=40.0, density=1.0))
    assert found is not None
    assert whole is not None
    assert core is not None
    assert found.mass == pytest.approx(whole.mass - core.mass)
    assert found.inertia == pytest.approx(np.subtract(whole.inertia, core.inertia))


@pytest.mark.parametrize("closed", [True, False])
def test_a_shape_from_a_file_weighs_what_its_solid_does(tmp_path: Path, closed: bool) -> None:
    """A box that is askew on its corner is the box: same mass, same moments."""
    mesh = trimesh.creation.box((60.0, 40.0, 20.0))
    mesh.apply_transform(trimesh.transformations.euler_matrix(0.4, 0.3, 0.2))
    if not closed:
        mesh.update_faces(np.arange(len(mesh.faces)) > 0)
    mesh.export(tmp_path / "part.stl")
    found = blank_weight(StockTable(shape="stl", file=str(tmp_path / "part.stl"), density=2.0))
    assert found is not None
    assert found.mass == pytest.approx(0.096, rel=1e-5)
    xx, yy, zz, xy, xz, yz = found.inertia
    moments = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    box = [0.096 * (a**2 + b**2) / 12e6 for a, b in ((20, 40), (20, 60), (40, 60))]
    assert moments == pytest.approx(box, rel=1e-4)
    height = mesh.extents[2]
    assert math.isclose(found.center[2], -0.5 * height, rel_tol=1e-4)


@pytest.mark.parametrize(("axis", "moment"), [("X", 0.5), ("Y", 1.0 / 3.0 + 0.25)])
def test_a_bar_that_lies_is_turned_about_its_axis_or_across_it(
    axis: Literal["X", "Y"], moment: float
) -> None:
    """Of a bar as long as twice its radius r: m r²/2 about its axis, m (3 r² + h²) / 12 across it."""
    machine = read_machine(resource_root("models") / "mill4a" / "machine.toml")
    bar = StockTable(
        shape="cylinder", diameter=60.0, height=60.0, axis=axis, density=7.85, position=(0, 0, 30.0)
    )
    mass = 7850.0 * math.pi * 0.03**2 * 0.06
    layout = lay_out(JobFile(program="part.nc", stock=bar, part_zero={"Z": -525.0}), machine)
    blank = layout.blank
    assert blank is not None
    off = blank.center[1] ** 2 + blank.center[2] ** 2
    before, after = felt(machine), felt(machine, blank)
    about = moment * mass * 0.03**2 + mass * off * 1e-6
    assert after["A"] - before["A"] == pytest.approx(about, rel=1e-6)
    model = build_spec(machine, blank=blank).compile()
    turned = np.zeros(9)
    mujoco.mju_quat2Mat(turned, model.geom(BLANK).quat)
    assert turned.reshape(3, 3)[:, 2] == pytest.approx(np.eye(3)["XYZ".index(axis)], abs=1e-12)
    assert model.geom(BLANK).size[:2] == pytest.approx([0.03, 0.03])
