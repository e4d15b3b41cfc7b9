"""An axis whose moved mass was measured: what moves is scaled until the motor moves that."""

import mujoco
import numpy as np

from twin.errors import ConfigError
from twin.machine.description.config import MachineConfig
from twin.nc.canonical import FloatArray


def set_measured_masses(spec: mujoco.MjSpec, machine: MachineConfig) -> None:
    """Give every axis with a measured ``mass`` that mass at its motor.

    The axis's own body, its motor and its screw are scaled by one factor; what it carries beyond (the
    tool, another axis's body) keeps its own mass.

    Args:
        spec: The model, its joints with the inertia of motor and screw.

    Raises:
        ConfigError: What the axis carries weighs more than the measured mass.
    """
    measured = [name for name in machine.axes.names if machine.axis(name).mass]
    for name in sorted(measured, key=lambda name: -_depth(spec, machine.axis(name).joint)):
        axis = machine.axis(name)
        joint = spec.joint(axis.joint)
        apparent = _apparent_inertia(spec, axis.joint)
        armature = float(np.ravel(joint.armature)[0])
        mass, inertia = float(joint.parent.mass), np.array(joint.parent.inertia)
        _scale(joint, mass, inertia, armature, factor=0.5)
        own = 2.0 * (apparent - _apparent_inertia(spec, axis.joint))
        carried = apparent - own
        if axis.mass <= carried:
            raise ConfigError(
                f"{machine.path}: axes.{name}.mass = {axis.mass:g} is less than the {carried:.3g} "
                "that the axis carries besides its own body in the model"
            )
        _scale(joint, mass, inertia, armature, factor=(axis.mass - carried) / own)


def _scale(
    joint: mujoco.MjsJoint, mass: float, inertia: FloatArray, armature: float, *, factor: float
) -> None:
    joint.armature = armature * factor
    joint.parent.mass = mass * factor
    joint.parent.inertia = inertia * factor


def _depth(spec: mujoco.MjSpec, joint: str) -> int:
    """How many bodies lie between the world and a joint's body."""
    body, depth = spec.joint(joint).parent, 0
    while body is not None and body.name != "world":
        body, depth = body.parent, depth + 1
    return depth


def _apparent_inertia(spec: mujoco.MjSpec, joint: str) -> float:
    """Mass or inertia at a joint [kg or kg m²]."""
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    inertia = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, inertia)
    dof = int(model.joint(joint).dofadr[0])
    return float(inertia[dof, dof])
