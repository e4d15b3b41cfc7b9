from types import SimpleNamespace
from typing import cast

import mujoco
import numpy as np
import pytest

from tests.machine.machine_fixtures import shipped_machine, write_machine
from twin.errors import ConfigError
from twin.files.shipped import machine_file
from twin.job.job_file import ToolTable
from twin.machine.load import read_machine
from twin.machine.model.model import (
    build_spec,
    compiled,
    drives,
    physics_model,
)
from twin.toolpath.part_frame import PartFrame
from twin.units import DEGREE, MM


def pose(machine, tool=None, **coordinates) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = build_spec(machine, tool).compile()
    data = mujoco.MjData(model)
    for name, value in coordinates.items():
        unit = MM if machine.axis(name).kind == "linear" else DEGREE
        data.joint(machine.axis(name).joint).qpos[0] = value * unit
    mujoco.mj_forward(model, data)
    return model, data


def tip_seen_from_table(data: mujoco.MjData) -> np.ndarray:
    """The tool tip in the frame of the rotary table [mm]."""
    top = data.site("table_top")
    return top.xmat.reshape(3, 3).T @ (data.site("tool_tip").xpos - top.xpos) / MM


@pytest.mark.parametrize("name", ["mill4", "mill4_light"])
@pytest.mark.parametrize(
    "at",
    [(0, 0, 0, 0), (120, -45, -100, 0), (100, 0, -10, 90), (-30, 70, -90, 400), (10, 20, -5, -77)],
)
def test_the_tool_stands_where_machine_coordinates_and_part_frame_say(name, at):
    machine = read_machine(machine_file(name))
    _, data = pose(machine, **dict(zip("XYZC", at, strict=True)))
    over = machine.at_zero.spindle_over_table - ToolTable(number=1).length
    expected = machine.part_frame.position(np.array([at], float))[0] + [0.0, 0.0, over]
    assert tip_seen_from_table(data) == pytest.approx(expected, abs=1e-9)
    assert machine.part_frame == PartFrame(rotary=3, center=(0.0, 0.0))


def test_the_lowest_tip_of_a_short_tool_stays_above_the_table():
    _, data = pose(shipped_machine(), Z=-550.0)
    assert tip_seen_from_table(data)[2] == pytest.approx(10.0)


@pytest.mark.parametrize("kind", ["flat", "ball"])
@pytest.mark.parametrize(
    ("diameter", "length", "flute"), [(10, 60, 25), (0.5, 30, 3), (63, 90, 40), (6, 20, 40)]
)
def test_the_tool_reaches_from_the_nose_to_its_tip(kind, diameter, length, flute):
    tool = ToolTable(number=1, kind=kind, diameter=diameter, length=length, flute=flute)
    model, data = pose(shipped_machine(), tool)
    names = [model.geom(i).name for i in range(model.ngeom)]
    pieces = [name for name in names if name.startswith("tool_")]
    bottoms, tops = [], []
    for name in pieces:
        half = model.geom(name).size[0 if name == "tool_ball" else 1]
        z = data.geom(name).xpos[2]
        bottoms.append(z - half)
        tops.append(z + half)
    nose = data.site("spindle_nose").xpos[2]
    assert min(bottoms) == pytest.approx(nose - length * MM)
    assert max(tops) == pytest.approx(nose)
    assert data.site("tool_tip").xpos[2] == pytest.approx(min(bottoms))
    assert ("tool_ball" in pieces) == (kind == "ball")


def test_gains_follow_from_what_is_moved():
    machine = shipped_machine()
    model = physics_model(machine, build_spec(machine))
    x, y, z, c = drives(machine, model)
    screw = 2 * np.pi / 0.016
    assert x.moved == pytest.approx(485 + 38 + (0.00096 + 0.0024) * screw**2)
    assert y.moved == pytest.approx(420 + 485 + 38 + (0.00123 + 0.0021) * screw**2)
    assert z.moved == pytest.approx(430 + 12 + (0.00123 + 0.0018) * screw**2)
    assert c.moved == pytest.approx(0.77 + (0.0002 + 0.0003) * 60**2)
    for drive in (x, y, z, c):
        assert drive.natural_frequency == pytest.approx(2 * 7.5 * 1000 / 60)
        assert drive.position_gain / drive.velocity_gain == pytest.approx(7.5 * 1000 / 60)


@pytest.mark.parametrize("camera", ["overview", "tool", "table", "top"])
def test_the_cameras_that_jobs_name_exist(camera):
    assert camera in [found.name for found in build_spec(shipped_machine()).cameras]


def test_a_joint_that_the_model_lacks_is_named_with_those_it_has(tmp_path):
    text = machine_file("mill4").read_text().replace('joint = "C"', 'joint = "B"')
    with pytest.raises(ConfigError, match="no joint 'B'; it has Y, X, C, Z"):
        build_spec(read_machine(write_machine(tmp_path, text)))


def test_a_joint_of_the_wrong_kind_is_refused(tmp_path):
    text = machine_file("mill4").read_text()
    text = text.replace('joint = "X"', 'joint = "?"').replace('joint = "C"', 'joint = "X"')
    text = text.replace('joint = "?"', 'joint = "C"')
    with pytest.raises(ConfigError, match="joint 'C' does not move as axis X, which is linear"):
        build_spec(read_machine(write_machine(tmp_path, text)))


def test_a_model_that_is_no_mjcf_is_refused(tmp_path):
    (tmp_path / "broken.xml").write_text("<mujoco><worldbody>")
    path = tmp_path / "machine.toml"
    path.write_text(machine_file("mill4").read_text().replace("scene.xml", "broken.xml"))
    with pytest.raises(ConfigError, match="is not an MJCF model"):
        build_spec(read_machine(path))


def test_a_model_that_cannot_be_compiled_without_a_reason_is_refused():
    machine = read_machine(machine_file("mill3"))

    def fails() -> mujoco.MjModel:
        raise RuntimeError("Caught an unknown exception!")

    spec = SimpleNamespace(compile=fails)
    with pytest.raises(ConfigError, match="so it is where memory runs out"):
        compiled(cast("mujoco.MjSpec", spec), machine)
