"""A machine for those who know MuJoCo."""

import mujoco
import numpy as np
import pytest

import twin
from twin.errors import UsageError


@pytest.mark.parametrize("name", ["mill4", "mill4_light", "mill4/uncompensated"])
def test_joints_and_actuators_are_those_of_the_model(name: str):
    machine = twin.Machine(name)
    for axis in machine.axes:
        joint = machine.model.joint(machine.joints[axis])
        names = (machine.actuators, machine.feedforward_actuators, machine.integral_actuators)
        for actuators in names:
            if axis in actuators:
                assert machine.model.actuator(actuators[axis]).trnid[0] == joint.id


def test_an_axis_goes_where_its_actuator_is_told():
    machine = twin.Machine("mill4")
    model, data = machine.model, mujoco.MjData(machine.model)
    data.ctrl[model.actuator(machine.actuators["X"]).id] = 0.01
    second = round(1.0 / model.opt.timestep)
    integral = data.ctrl[model.actuator(machine.integral_actuators["X"]).id :]
    # The input is a speed that the drive integrates: 10 mm/s over a second, and time to settle.
    for step in range(second):
        integral[0] = 0.01 * step / second
        mujoco.mj_step(model, data)
    data.ctrl[0], integral[0] = 0.0, 0.01
    mujoco.mj_step(model, data, second)
    assert data.joint(machine.joints["X"]).qpos[0] == pytest.approx(0.01, abs=1e-5)


def test_a_specification_is_new_each_time():
    machine = twin.Machine("mill4")
    spec = machine.spec()
    spec.worldbody.add_geom(name="mine", type=mujoco.mjtGeom.mjGEOM_BOX, size=np.full(3, 0.1))
    assert "mine" not in [geom.name for geom in machine.spec().geoms]
    assert spec.compile().ngeom == machine.model.ngeom + 1


def test_no_such_machine_lists_those_that_there_are():
    with pytest.raises(UsageError, match=r"shipped machines are .*mill4"):
        twin.Machine("mill9")
