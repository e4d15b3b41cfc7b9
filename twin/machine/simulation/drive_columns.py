"""The drives of a machine as columns, one row per axis: what kernels step them by."""

from collections.abc import Iterable

import mujoco
import numpy as np
import numpy.typing as npt

from twin.machine.description.config import MachineConfig
from twin.machine.model.drives import Drive, feedforward_name, integral_name
from twin.machine.model.model import moved
from twin.machine.model.transmission import directly_driven, give_name, has_give
from twin.machine.simulation.drive_kernels import Drives
from twin.nc.canonical import IntArray
from twin.units import kv_per_second


def drive_columns(
    machine: MachineConfig, model: mujoco.MjModel, loops: tuple[Drive, ...]
) -> Drives:
    """Gains of the drives, and where their inputs, joints and states are in the model.

    Args:
        loops: One per axis.
    """
    everywhere, period, joined = len(loops), machine.file.servo_period_s, 1 + model.nq
    names = machine.axes.names
    axes = [machine.axis(name) for name in names]
    driven = list(zip(axes, loops, strict=True))
    joints = [model.joint(axis.joint) for axis in axes]
    dof = np.array([int(joint.dofadr[0]) for joint in joints])
    integrates = np.flatnonzero([loop.integral_gain > 0 for loop in loops])
    gives = np.flatnonzero([has_give(axis) for axis in axes])
    give = [model.joint(give_name(axes[index])) for index in gives]
    give_qpos = np.array([int(joint.qposadr[0]) for joint in give], np.int64)
    give_dof = np.array([int(joint.dofadr[0]) for joint in give], np.int64)
    servos = actuators(model, names)
    forces = actuators(model, map(feedforward_name, names))
    integral = actuators(model, (integral_name(names[index]) for index in integrates))
    return Drives(
        period=period,
        scale=machine.joint_scale,
        position_gain=np.array([loop.position_gain for loop in loops]),
        velocity_gain=np.array([loop.damping_gain for loop in loops]),
        integral_gain=np.array([loop.integral_gain for loop in loops]),
        velocity_feedforward=np.array(
            [axis.velocity_feedforward * loop.velocity_gain for axis, loop in driven]
        ),
        acceleration_feedforward=np.array(
            [axis.acceleration_feedforward * loop.moved for axis, loop in driven]
        ),
        trail=np.array(
            [(1.0 - axis.velocity_feedforward) / kv_per_second(axis.kv) for axis in axes]
        ),
        speed_bulge=np.array(
            [
                axis.velocity_feedforward * loop.velocity_gain / directly_driven(axis, float(size))
                for (axis, loop), size in zip(driven, moved(machine, model), strict=True)
            ]
        )
        * (period**2 / 12),
        limit=np.array([axis.force_limit or np.inf for axis in axes]),
        constant=np.array([axis.constant_force for axis in axes]),
        velocity_input=_numbers(everywhere, slice(None), model.actuator_ctrladr[servos]),
        force_input=_numbers(everywhere, slice(None), model.actuator_ctrladr[forces]),
        position_input=_numbers(everywhere, integrates, model.actuator_ctrladr[integral]),
        qpos=1 + np.array([int(joint.qposadr[0]) for joint in joints]),
        qvel=joined + dof,
        dof=dof,
        give_qpos=_numbers(everywhere, gives, 1 + give_qpos),
        give_qvel=_numbers(everywhere, gives, joined + give_dof),
        give_dof=_numbers(everywhere, gives, give_dof),
        integral=_numbers(
            everywhere, integrates, joined + model.nv + model.actuator_actadr[integral]
        ),
    )


def actuators(model: mujoco.MjModel, names: Iterable[str]) -> IntArray:
    """Numbers of actuators by their names."""
    return np.array([model.actuator(name).id for name in names], np.int64)


def _numbers(count: int, axes: IntArray | slice, numbers: npt.NDArray[np.integer]) -> IntArray:
    """Numbers of some of all axes, -1 elsewhere, shape (k,)."""
    out = np.full(count, -1)
    out[axes] = numbers
    return out
