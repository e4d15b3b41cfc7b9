import dataclasses

import hypothesis
import hypothesis.strategies as st
import mujoco
import numpy as np
import pytest

from tests.render.conftest import MODEL, TOOL
from twin.machine.description.config import MachineConfig
from twin.render.scene.placement import Joints, place, tip_position

reach = st.floats(-200.0, 200.0)


@pytest.fixture(name="model", scope="module")
def shared_model() -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(MODEL)


@hypothesis.settings(derandomize=True, max_examples=40)
@hypothesis.given(reach, reach, reach, st.floats(-800.0, 800.0), reach, reach, st.floats(-90, 90))
def test_tool_point_is_drawn_where_the_part_frame_says(
    machine: MachineConfig,
    model: mujoco.MjModel,
    x: float,
    y: float,
    z: float,
    c: float,
    center_x: float,
    center_y: float,
    turn_zero: float,
) -> None:
    # The slides stand so that the tool is over the axis of rotation at ``center``.
    model.body_pos[model.body("slide").id, :2] = [0.02 + center_x / 1e3, 0.01 + center_y / 1e3]
    frame = dataclasses.replace(
        machine.part_frame, center=(center_x, center_y), turn_zero=turn_zero
    )
    moved = MachineConfig(machine.path, machine.file)
    moved.part_frame = frame
    placement = place(moved, model, TOOL.length, frame)
    position = np.array([x, y, z, c])
    data = mujoco.MjData(model)
    Joints(moved, model).set(data, position)
    mujoco.mj_kinematics(model, data)
    body = data.body("rotary_table")
    seen = placement.points(frame.position(position[None]))[0]
    world = body.xpos + body.xmat.reshape(3, 3) @ seen
    np.testing.assert_allclose(world, tip_position(model, data, TOOL.length), atol=1e-9)


def test_quaternion_is_the_rotation(machine: MachineConfig) -> None:
    model = mujoco.MjModel.from_xml_string(MODEL)
    placement = place(
        machine, model, TOOL.length, dataclasses.replace(machine.part_frame, turn_zero=15.0)
    )
    matrix = np.zeros(9)
    mujoco.mju_quat2Mat(matrix, placement.quaternion)
    np.testing.assert_allclose(matrix.reshape(3, 3), placement.rotation, atol=1e-12)
    np.testing.assert_allclose(placement.origin, [0.0, 0.0, 0.25], atol=1e-12)
