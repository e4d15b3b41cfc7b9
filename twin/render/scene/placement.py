"""Where the part's frame lies on the drawn machine."""

import dataclasses

import mujoco
import numpy as np

from twin.machine.description.config import MachineConfig
from twin.machine.description.kinematics import SPINDLE_NOSE, part_carrier
from twin.nc.canonical import FloatArray
from twin.toolpath.part_frame import PartFrame
from twin.units import MM

_ROUNDED = 9
"""Digits of a direction that the rounding of quaternions leaves."""


@dataclasses.dataclass(frozen=True, slots=True)
class FrameOnBody:
    """The part's frame, seen from a body of the machine.

    Attributes:
        origin: Where the part frame's origin lies in the body's frame, shape (3,) [m].
        rotation: Part frame to body frame, shape (3, 3).
    """

    origin: FloatArray
    rotation: FloatArray

    def points(self, part: FloatArray) -> FloatArray:
        """Points of the part's frame [mm] in the body's frame [m], shape (n, 3)."""
        return self.origin + MM * part @ self.rotation.T

    @property
    def quaternion(self) -> FloatArray:
        """The rotation as MuJoCo writes it, shape (4,)."""
        result = np.zeros(4)
        mujoco.mju_mat2Quat(result, self.rotation.ravel())
        return result


@dataclasses.dataclass(frozen=True, slots=True)
class Placement(FrameOnBody):
    """The part's frame, seen from the body that carries the part and turns with it.

    Attributes:
        at_rest: Where it lies, seen from the body that carries the turning one, while the part's frame
            is parallel to the machine's.
        up: Direction upwards in the room, seen from the part's frame there, shape (3,).
    """

    at_rest: FrameOnBody
    up: FloatArray


class Joints:
    """Sets the drawn machine's joints from machine coordinates."""

    def __init__(self, machine: MachineConfig, model: mujoco.MjModel) -> None:
        names = machine.axes.names
        self._address = [int(model.joint(machine.axis(name).joint).qposadr[0]) for name in names]
        self._factor = machine.joint_scale

    def set(self, data: mujoco.MjData, position: FloatArray) -> None:
        """Put the axes to ``position``, shape (k,) [mm or deg]."""
        data.qpos[self._address] = position * self._factor


def place(
    machine: MachineConfig, model: mujoco.MjModel, tool_length: float, part_frame: PartFrame
) -> Placement:
    """Find the part's frame on the machine: by moving the tool point along its axes.

    Args:
        tool_length: From the spindle nose to the tip [mm].
    """
    data = mujoco.MjData(model)
    joints = Joints(machine, model)
    zero = part_frame.rotary_zero(len(machine.axes))

    def tip_from(body: int, offset: FloatArray) -> FloatArray:
        position = zero.copy()
        position[:3] += offset
        joints.set(data, position)
        mujoco.mj_kinematics(model, data)
        tip = tip_position(model, data, tool_length)
        return data.xmat[body].reshape(3, 3).T @ (tip - data.xpos[body])

    def frame(body: int) -> tuple[FloatArray, FloatArray]:
        origin = tip_from(body, np.zeros(3))
        columns = [(tip_from(body, direction) - origin) / MM for direction in np.eye(3)]
        return origin, np.stack(columns, axis=1)

    table = part_carrier(model)
    carrier = int(model.body_parentid[table])
    at_rest = FrameOnBody(*frame(carrier))
    up = data.xmat[carrier].reshape(3, 3) @ at_rest.rotation
    return Placement(*frame(table), at_rest, np.round(up[2], _ROUNDED))


def tip_position(model: mujoco.MjModel, data: mujoco.MjData, tool_length: float) -> FloatArray:
    """Where the tool's tip is in the world, shape (3,) [m]."""
    nose = data.site(int(model.site(SPINDLE_NOSE).id))
    return nose.xpos - MM * tool_length * nose.xmat.reshape(3, 3)[:, 2]
