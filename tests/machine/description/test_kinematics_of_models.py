"""The chain that is read from a model against where MuJoCo has the model's bodies."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

from twin.errors import ConfigError
from twin.files.shipped import machine_file, machine_names
from twin.kinematics import tool_direction, tool_point
from twin.machine.description.config import MachineConfig
from twin.machine.description.kinematics import in_words
from twin.machine.description.machine_file import MachineFile
from twin.machine.load import read_machine
from twin.nc.canonical import FloatArray
from twin.units import MM


def seen_by_mujoco(
    machine: MachineConfig, joints: FloatArray, length: float
) -> tuple[FloatArray, FloatArray]:
    """Place of a point of the tool and direction of the tool, against the table's frame of all axes at zero."""
    model = mujoco.MjModel.from_xml_path(str(machine.model_path))
    data = mujoco.MjData(model)
    poses = []
    for row in (np.zeros_like(joints), joints):
        for name, value in zip(machine.axes.names, row * machine.joint_scale, strict=True):
            data.joint(machine.axis(name).joint).qpos[0] = value
        mujoco.mj_kinematics(model, data)
        nose, table = data.site("spindle_nose"), data.site("table_top")
        turn = table.xmat.reshape(3, 3).copy()
        up = nose.xmat.reshape(3, 3)[:, 2].copy()
        poses.append((turn, table.xpos.copy(), nose.xpos - length * MM * up, up, nose.xpos.copy()))
    (turn0, table0, _, _, nose0), (turn, table, tip, up, _) = poses
    frame = machine_frame(machine, model)
    place = turn0 @ turn.T @ (tip - table) + table0 - nose0
    return frame @ place / MM, frame @ turn0 @ turn.T @ up


def machine_frame(machine: MachineConfig, model: mujoco.MjModel) -> FloatArray:
    """Where the nose goes against the table as X, Y and Z go: rows."""
    rows = []
    for name in "XYZ":
        data, joint = mujoco.MjData(model), machine.axis(name).joint
        places = []
        for value in (0.0, 1.0):
            data.qpos[:] = 0.0
            data.joint(joint).qpos[0] = value * machine.axis(name).direction
            mujoco.mj_kinematics(model, data)
            places.append(data.site("spindle_nose").xpos - data.site("table_top").xpos)
        rows.append(places[1] - places[0])
    return np.array(rows)


@pytest.mark.parametrize("name", machine_names())
def test_the_chain_is_where_mujoco_has_the_bodies(name):
    machine = read_machine(machine_file(name))
    chain, generator = machine.kinematics, np.random.default_rng(841)
    for _ in range(20):
        joints = generator.uniform(-400.0, 400.0, len(machine.axes))
        length = generator.uniform(0.0, 200.0)
        place, direction = seen_by_mujoco(machine, joints, length)
        np.testing.assert_allclose(tool_point(chain, joints[None], length)[0], place, atol=1e-9)
        np.testing.assert_allclose(tool_direction(chain, joints[None])[0], direction, atol=1e-12)


AXIS = {"kind": "linear", "velocity": 1.0, "acceleration": 1.0, "jerk": 1.0, "kv": 1.0}
FIVE_AXES = """
<mujoco><compiler angle="degree"/><worldbody>
<body name="column" pos="0.4 0 1" euler="20 30 40"><joint name="x" type="slide" axis="1 0 0"/><geom size="0.1"/>
 <body name="saddle" pos="0.1 0.2 0"><joint name="z" type="slide" axis="0 0 1"/><geom size="0.1"/>
  <body name="head" pos="0 0.1 0.1"><joint name="b" type="hinge" pos="0.01 0.02 0.3" axis="0 1 1"/><geom size="0.1"/>
   <site name="spindle_nose" pos="0 0 -0.1"/></body></body></body>
<body name="bed" pos="0 0 0.5" euler="20 30 40"><joint name="y" type="slide" axis="0 -1 0"/><geom size="0.1"/>
 <body name="rotary_table" pos="0.1 0 0"><joint name="a" type="hinge" pos="0 0.03 0.1" axis="1 0 0"/>
  <joint name="c" type="hinge" pos="0.02 0.04 0" axis="0 0 -1"/><geom size="0.1"/><site name="table_top" pos="0 0 0.2"/>
 </body></body>
</worldbody></mujoco>
"""  # fmt: skip


def made_up(folder: Path, text: str = FIVE_AXES, **axes: dict[str, object]) -> MachineConfig:
    folder.joinpath("model.xml").write_text(text)
    turning = {"kind": "rotary"}
    kinds = {"X": {}, "Y": {}, "Z": {}, "B": turning, "A": turning, "C": turning} | axes
    data = {
        "schema": 1,
        "name": "made up",
        "model": "model.xml",
        "path": {"acceleration": 1.0, "jerk": 1.0},
        "axes": {name: {**AXIS, "joint": name.lower(), **more} for name, more in kinds.items()},
    }
    return MachineConfig(folder / "machine.toml", MachineFile.model_validate(data))


def test_head_and_tables_with_two_joints_on_a_body_are_where_mujoco_has_them(tmp_path):
    for direction in (1, -1):
        machine = made_up(tmp_path, A={"kind": "rotary", "direction": direction})
        chain, generator = machine.kinematics, np.random.default_rng(10791)
        for _ in range(20):
            joints = generator.uniform(-400.0, 400.0, 6)
            place, direction_seen = seen_by_mujoco(machine, joints, 77.0)
            np.testing.assert_allclose(tool_point(chain, joints[None], 77.0)[0], place, atol=1e-8)
            seen = tool_direction(chain, joints[None])[0]
            np.testing.assert_allclose(seen, direction_seen, atol=1e-9)


def test_the_chain_is_told_in_words(tmp_path):
    machine = made_up(tmp_path)
    words = in_words(machine.axes.names, machine.kinematics)
    assert words == "the part turns on C, C on A, A on Y; the tool turns on B, B on Z, Z on X"
    for name, told in (
        ("mill4", "the part turns on C, C on X, X on Y; the tool moves in Z"),
        ("mill4_light", "the part turns on C; the tool moves in X, Y and Z"),
    ):
        machine = read_machine(machine_file(name))
        assert in_words(machine.axes.names, machine.kinematics) == told


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ('name="y" type="slide" axis="0 -1 0"', 'name="y" type="slide" axis="0 1 0"', "left-handed"),
        ('type="slide" axis="1 0 0"', 'type="slide" axis="1 0.1 0"', "not at right angles"),
        ('name="y" type="slide"', 'name="y" type="hinge"', "'y' does not move as a linear axis"),
        ('<body name="bed"', '<body name="loose"><joint name="w"/><geom size="1"/></body><body name="bed"', None),
        ('<joint name="y"', '<joint name="w" type="slide"/><joint name="y"', "'w' between base and tool or part"),
        ('<site name="spindle_nose"', '<site name="nose"', "no site 'spindle_nose'"),
        ('name="table_top" pos="0 0 0.2"', 'name="table_top" euler="0 0 9"', "must not be turned"),
        ('<body name="head"', '<body name="head" euler="0 90 0"', "not along Z"),
    ],
)  # fmt: skip
def test_what_is_no_mill_is_refused_with_the_reason(tmp_path, old, new, reason):
    assert old in FIVE_AXES
    machine = made_up(tmp_path, FIVE_AXES.replace(old, new))
    if reason is None:
        assert len(machine.kinematics.column) == 6
        return
    with pytest.raises(ConfigError, match=reason):
        _ = machine.kinematics


def test_what_carries_tool_and_part_is_no_axis_between_them(tmp_path):
    inside = FIVE_AXES.replace(
        '</body></body></body>\n<body name="bed"', '</body></body>\n<body name="bed"'
    )
    machine = made_up(
        tmp_path,
        inside.replace("</body></body>\n</worldbody>", "</body></body></body>\n</worldbody>"),
    )
    with pytest.raises(ConfigError, match="'x' moves tool and part together"):
        _ = machine.kinematics


def test_an_axis_whose_joint_moves_neither_is_named(tmp_path):
    text = FIVE_AXES.replace('<joint name="z" type="slide" axis="0 0 1"/>', "").replace(
        "</worldbody>",
        '<body name="loose"><joint name="z" type="slide"/><geom size="1"/></body></worldbody>',
    )
    with pytest.raises(ConfigError, match="Z moves neither tool nor part"):
        _ = made_up(tmp_path, text).kinematics


@pytest.mark.parametrize(
    ("table", "told"),
    [
        ({"axis": "C", "center": (-0.02, 0.0)}, None),
        ({"axis": "A"}, "C about X"),
        ({"axis": "C", "center": (500.0, 0.0)}, "C about X"),
    ],
)
def test_a_table_of_the_machine_file_must_be_that_of_the_model(tmp_path, table, told):
    machine = made_up(tmp_path)
    joint = machine.kinematics.anchor[machine.kinematics.rotary][-1]
    center = table.get("center", (0.0, 0.0)) if told else (float(joint[0]), float(joint[1]))
    data = machine.file.model_dump(by_alias=True)
    data["table"] = {"axis": table["axis"], "center": center}
    changed = MachineConfig(machine.path, MachineFile.model_validate(data))
    if told is None:
        assert changed.part_frame.chain is not None
        return
    with pytest.raises(ConfigError, match=told):
        _ = changed.part_frame
