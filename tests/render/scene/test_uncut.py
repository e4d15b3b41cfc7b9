"""A part that the tool comes to from several sides is drawn as it was clamped, and turns with its table."""

import mujoco
import numpy as np
import pytest

from twin.files.shipped import machine_file
from twin.job.job_file import StockTable
from twin.machine.load import read_machine
from twin.machine.model.model import build_spec
from twin.render.scene.placement import Joints, place
from twin.render.scene.work_holding import add_uncut
from twin.units import MM


@pytest.mark.parametrize("shape", ["box", "cylinder"])
def test_the_blank_is_where_the_part_s_frame_says(shape: str) -> None:
    machine = read_machine(machine_file("mill5"))
    zero, length = np.array([3.0, 4.0, -440.0, 0.0, 0.0]), 100.0
    frame = machine.part_frame.at(zero, length)
    sizes = {"size": (60.0, 60.0, 50.0)} if shape == "box" else {"diameter": 60.0, "height": 50.0}
    stock = StockTable.model_validate({"shape": shape, **sizes})
    spec = build_spec(machine)
    placement = place(machine, spec.compile(), length, frame)
    add_uncut(spec, stock, placement, frame.program_zero(zero))
    model = spec.compile()
    data = mujoco.MjData(model)
    for joints in (zero, zero + np.array([10.0, -20.0, 30.0, -90.0, 200.0])):
        Joints(machine, model).set(data, joints)
        mujoco.mj_kinematics(model, data)
        # Seen from the part the tip is so far from the middle of the blank as it is in the world.
        middle = frame.program_zero(zero) - [0.0, 0.0, 25.0]
        away = np.linalg.norm(frame.position(joints[None])[0] - middle)
        nose = data.site("spindle_nose")
        tip = nose.xpos - length * MM * nose.xmat.reshape(3, 3)[:, 2]
        there = np.linalg.norm(tip - data.geom("uncut stock seen").xpos) / MM
        assert there == pytest.approx(away, abs=1e-6)
